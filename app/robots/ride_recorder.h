// The ways of the links that carry the rig and sensors of their own, while robots are driven.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/robots/mission_robot.h"
#include "app/sensors/robot_readings.h"
#include "io/recording/recording.h"
#include "kernel/world/world.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

class RideRecorder {
 public:
  // Throws InputError, with the key of the ride, for a link that the robot has not.
  RideRecorder(const Scenario& scenario, const std::vector<MissionRobot>& robots);

  // At the start, and after each step.
  void note(const World& world);
  // step: of the world; unit: s. Adds the ways to the readings. Result: where the rig is, on a link.
  std::optional<RigMount> finish(double step, const std::vector<RobotRecord>& records, RobotReadings& readings);

 private:
  // A place on a link, and where it was.
  struct Ridden : RiddenLink {
    Carrier carrier;
    std::size_t robot = 0;
    std::vector<Pose> poses;  // one a step
  };
  Ridden find(const Carrier& carrier, const std::string& key) const;
  void add(const Carrier& carrier, const std::string& key);

  std::vector<std::string> names_;  // of the robots
  const std::vector<MissionRobot>& robots_;
  bool rig_ = false;  // whether the first of those below is the rig
  std::vector<Ridden> ridden_;
};

}  // namespace rubble
