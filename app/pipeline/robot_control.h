// From the robots of a mission to models and controllers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/pipeline/resolved_mission.h"
#include "kernel/model/robot.h"
#include "app/robots/mission_robot.h"
#include "kernel/robot/robot_run.h"

namespace rubble {

// Where URDF files are looked for: beside the script, and in the folders of the run's packs.
std::vector<std::string> robot_folders(const ResolvedMission& mission);

// Models of the mission's robots, in their order; warnings of files go to the context. Throws InputError.
std::vector<MissionRobot> make_robots(const ResolvedMission& mission, RunContext& context);
RobotRunOptions robot_run_options(const Scenario& scenario, int threads);

// The joint of that name, which must have a motor: its index. Throws InputError, with that key, naming those that
// have one.
std::size_t find_motor(const RobotModel& model, const std::string& name, const std::string& key);

// Drives by the legs of `drive`, which are in order.
RobotController make_leg_controller(const RobotItem& robot, const RobotModel& model);

// Joints that mimic others follow them: what those are asked for, or where they stand.
RobotController with_mimics(RobotController control, const std::vector<MimicJoint>& mimics);

// Drives by functions of the script, which is run again: in the sandbox, by what its provenance keeps.
class ScriptControl {
 public:
  explicit ScriptControl(const ResolvedMission& mission);
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
