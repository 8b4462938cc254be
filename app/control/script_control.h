// Functions of a script as controllers of robots.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "app/mission/resolved_mission.h"
#include "kernel/model/robot.h"
#include "kernel/robot/robot_run.h"
#include "scripting/values/value.h"

namespace rubble {

// Drives by functions of the script, which is run again: in the sandbox, by what its provenance keeps.
class ScriptControl {
 public:
  // Adds what the function of a robot with `senses` is told of its sensors.
  using Tell = std::function<void(std::size_t robot, Value& told)>;
  ScriptControl(const ResolvedMission& mission, Tell tell);
  ~ScriptControl();
  ScriptControl(const ScriptControl&) = delete;
  ScriptControl& operator=(const ScriptControl&) = delete;

  // robot: its index in the mission. The controller throws InputError, with the line of `control`, for
  // what the function raises and for what it returns and no motor can follow. It must not outlive this.
  RobotController controller_of(std::size_t robot, const RobotModel& model);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
