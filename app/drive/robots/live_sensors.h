// What the robots of a drive sense while they are driven: joints, odometry, contacts, inertial units and
// the scans of their LiDARs.
#pragma once

#include <memory>
#include <vector>

#include "app/robots/live_imus.h"
#include "app/robots/live_ranges.h"
#include "app/robots/mission_robot.h"
#include "app/robots/robot_log.h"
#include "kernel/robot/robot_run.h"
#include "render/scene/sample.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class LiveSensors {
 public:
  // The scenario and the robots must outlive this.
  LiveSensors(const Scenario& scenario, const std::vector<MissionRobot>& robots, std::unique_ptr<LiveRanges> ranges,
              std::unique_ptr<LiveImus> imus);

  void restart(const World& world);  // at the robots' time 0
  void note(std::size_t robot, const RobotSense& sense) { logs_[robot].note(sense); }
  void note_step(const World& world);  // after each step
  // All since the last call, in order of their stamps.
  std::vector<Sample> take();

  const LiveRanges& ranges() const { return *ranges_; }

 private:
  const Scenario& scenario_;
  const std::vector<MissionRobot>& robots_;
  std::unique_ptr<LiveRanges> ranges_;
  std::unique_ptr<LiveImus> imus_;
  std::vector<RobotLog> logs_;
};

}  // namespace rubble
