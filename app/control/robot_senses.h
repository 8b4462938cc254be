// What the functions that drive robots are told of LiDARs and cameras: measured while the robots are driven.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/robots/live_ranges.h"
#include "app/robots/mission_robot.h"
#include "app/scene/moving_scene.h"
#include "kernel/model/pile_state.h"
#include "kernel/robot/robot_run.h"
#include "scripting/values/value.h"

namespace rubble {

class RobotSenses {
 public:
  // Measures what `senses` of the mission's robots name. All but `threads` must outlive this. Throws InputError for a
  // sensor that no robot carries.
  RobotSenses(const ResolvedMission& mission, const PileState& pile, const std::vector<MissionRobot>& robots,
              int threads);

  // Once all robots are added, before the first step. step: unit: s. Throws InputError for a camera with a lens.
  void begin(const RobotRun& run, double step);
  void note_step(const World& world);  // after each step
  // Adds `lidars` and `cameras` to what the robot's function is told: what was measured since its last call.
  void tell(std::size_t robot, Value& told);

 private:
  // What a robot has not been told yet.
  struct Untold {
    std::vector<std::shared_ptr<const LidarScan>> scans;
    std::vector<std::shared_ptr<const SensedDepth>> images;
  };
  bool senses(std::size_t robot, const std::string& name) const;
  void measure();

  const ResolvedMission& mission_;
  const PileState& pile_;
  int threads_;
  std::vector<std::string> camera_names_;
  std::vector<RidingSensor> lidars_, cameras_;  // that any robot senses
  std::vector<Untold> untold_;                  // by robot
  RobotTrack seen_;                             // models and ids
  std::unique_ptr<LiveRanges> ranges_;
};

}  // namespace rubble
