// From the robots of a mission to models and controllers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/robots/mission_robot.h"
#include "kernel/model/robot.h"
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

// The mistake, with that key, of more values than there are motors at joints.
std::optional<Diagnostic> find_surplus(const RobotModel& model, std::size_t values, const std::string& key);

// The mistake, with that key, of a position asked of a motor that holds none, as those of wheels. names: of joints; none: so
// many of all motors, in their order.
std::optional<Diagnostic> find_unheld(const RobotModel& model, const std::vector<std::string>& names, std::size_t values,
                                      const std::string& key);

// Asks the motors, which are numbered among themselves, in their order.
void ask_motors(const RobotModel& model, const std::vector<double>& targets, MotorMode mode, RobotCommand& command);

// What a leg of `drive` asks for at that time since the start; unit: s
RobotCommand command_of_leg(const RobotItem& robot, const RobotModel& model, const RobotLeg& leg, double time);
// Drives by the legs of `drive`, which are in order. The model must outlive it.
RobotController make_leg_controller(const RobotItem& robot, const RobotModel& model);

// Joints that mimic others follow them: what those are asked for, or where they stand.
RobotController with_mimics(RobotController control, const std::vector<MimicJoint>& mimics);

}  // namespace rubble
