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

// Refuses, with its line, what contradicts the models of the robots: commands, joints, links that carry sensors. Before the
// pile settles: it needs the models alone. Throws InputError.
void check_robot_models(const Scenario& scenario, const AssetLibrary& assets, const SourceFile& script);

// Models of the mission's robots, in their order; warnings of files go to the context. Throws InputError.
std::vector<MissionRobot> make_robots(const ResolvedMission& mission, RunContext& context);
RobotRunOptions robot_run_options(const Scenario& scenario, int threads);

// The joint of that name, which must have a motor: its index. Throws InputError, with that key, naming those that
// have one.
std::size_t find_motor(const RobotModel& model, const std::string& name, const std::string& key);

// For find_miscount(), of lists that need not have a value for every motor.
constexpr const char* kNameSome = "`joint_names` as well, of as many joints, asks some of the motors";

// The mistake, with that key, of another number of values than there are motors at joints; no values are none.
std::optional<Diagnostic> find_miscount(const RobotModel& model, std::size_t values, const std::string& key,
                                        const std::string& hint = "");

// The mistake, with that key, of a position asked of a motor that holds none, as those of wheels. names: of joints; none: so
// many of all motors, in their order.
std::optional<Diagnostic> find_unheld(const RobotModel& model, const std::vector<std::string>& names, std::size_t values,
                                      const std::string& key);

// Asks the motors of these joints; no names: all motors, in their order.
void ask_motors(const RobotModel& model, const std::vector<double>& targets, const std::vector<std::string>& names,
                MotorMode mode, RobotCommand& command);

// A sentence on a twist that is beyond the speed of the robot's tracks or wheels, so that its curve is lost; "": it is not.
// unit: m/s, rad/s
std::string describe_lost_turn(const RobotModel& model, double linear, double angular);

// What a leg of `drive` asks for at that time since the start; unit: s
RobotCommand command_of_leg(const RobotItem& robot, const RobotModel& model, const RobotLeg& leg, double time);
// Drives by the legs of `drive`, which are in order. The model must outlive it.
RobotController make_leg_controller(const RobotItem& robot, const RobotModel& model);

// Joints that mimic others follow them: what those are asked for, or where they stand.
RobotController with_mimics(RobotController control, const std::vector<MimicJoint>& mimics);

}  // namespace rubble
