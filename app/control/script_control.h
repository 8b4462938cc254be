// Functions of a script as controllers of robots.
#pragma once

#include <memory>

#include "app/control/robot_senses.h"
#include "app/mission/resolved_mission.h"
#include "kernel/model/robot.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

// Drives by functions of the script, which is run again: in the sandbox, by what its provenance keeps.
class ScriptControl {
 public:
  // senses: what the functions are told of LiDARs and cameras; must outlive the controllers.
  ScriptControl(const ResolvedMission& mission, RobotSenses& senses);
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
