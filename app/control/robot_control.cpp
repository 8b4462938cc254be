#include "app/control/robot_control.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/robots/robot_log.h"
#include "kernel/base/number_text.h"
#include "scripting/robots/robot_kind.h"

namespace rubble {

void ask_motors(const RobotModel& model, const std::vector<double>& targets, MotorMode mode, RobotCommand& command) {
  command.joints.resize(model.joints.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < model.joints.size() && next < targets.size(); ++i) {
    if (model.joints[i].motor.effort > 0) command.joints[i] = {mode, targets[next++]};
  }
}

namespace {

void ask_leg_joints(const RobotModel& model, const RobotLeg& leg, RobotCommand& command) {
  if (leg.joint_names.empty()) return ask_motors(model, leg.joints, MotorMode::position, command);
  command.joints.resize(model.joints.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const auto name = std::find(leg.joint_names.begin(), leg.joint_names.end(), model.joints[i].name);
    if (name != leg.joint_names.end())
      command.joints[i] = {MotorMode::position, leg.joints[std::size_t(name - leg.joint_names.begin())]};
  }
}

// What other kinds alone understand must be left at its defaults.
void check_figures(const RobotItem& robot, const RobotLeg& leg, const std::string& key) {
  const FiguresOfKinds usual = make_command_figures();
  std::size_t next = 0;
  for (const RobotKind* kind : robot_kinds()) {
    if (!kind->command_figures()) continue;
    const std::size_t at = next++;
    if (kind == &kind_of(robot) || leg.figures.all()[at]->equals(*usual.all()[at])) continue;
    Schema keys;
    usual.all()[at]->add_keys(keys);
    std::string names;
    for (const Key& one : keys.keys()) names += (names.empty() ? "" : ", ") + one.path;
    throw InputError({"", 0, key, "a command of another robot", "what a " + kind_of(robot).name() + " does",
                      "one of " + names + ", which are those of a " + kind->name(), ""});
  }
}

// key: of the robot. What is named must be there, no value may be left over, and nothing that the robot cannot do.
void check_legs(const RobotItem& robot, const RobotModel& model, const std::string& key) {
  const auto motors = std::count_if(model.joints.begin(), model.joints.end(), [](const RobotJoint& j) { return j.motor.effort > 0; });
  for (std::size_t k = 0; k < robot.drive.size(); ++k) {
    const RobotLeg& leg = robot.drive[k];
    const std::string at = key + ".drive[" + std::to_string(k + 1) + "]";
    for (const std::string& name : leg.joint_names) find_motor(model, name, at + ".joint_names");
    if (leg.joint_names.empty())
      if (const auto mistake = find_surplus(model, leg.joints.size(), at + ".joints")) throw InputError(*mistake);
    if (const auto mistake = find_unheld(model, leg.joint_names, leg.joints.size(), at + ".joints")) throw InputError(*mistake);
    if (!model.sides.any() && (leg.linear != 0 || leg.angular != 0))
      throw InputError({"", 0, at + (leg.linear != 0 ? ".linear" : ".angular"), "this robot has neither tracks nor driven wheels",
                        "0", exact_text(leg.linear != 0 ? leg.linear : leg.angular), ""});
    const std::size_t flippers = model.sides.belts ? std::size_t(motors) : 0;
    if (leg.flippers_deg.size() > flippers)
      throw InputError({"", 0, at + ".flippers_deg", "more angles than the robot has flippers", std::to_string(flippers) + " at most",
                        std::to_string(leg.flippers_deg.size()), ""});
    check_figures(robot, leg, at);
  }
}

}  // namespace

std::size_t find_motor(const RobotModel& model, const std::string& name, const std::string& key) {
  std::string all, hint;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].motor.effort <= 0) {
      if (model.joints[i].name == name) hint = "`efforts` of a URDF robot gives its joints motors";
      continue;
    }
    if (model.joints[i].name == name) return i;
    all += (all.empty() ? "one of " : ", ") + model.joints[i].name;
  }
  throw InputError({"", 0, key, "the robot has no joint of this name with a motor",
                    all.empty() ? "no joint: this robot has no motor at a joint" : all, "\"" + name + "\"", hint});
}

std::optional<Diagnostic> find_surplus(const RobotModel& model, std::size_t values, const std::string& key) {
  std::string names;
  std::size_t motors = 0;
  for (const RobotJoint& joint : model.joints) {
    if (joint.motor.effort <= 0) continue;
    names += (motors++ == 0 ? "" : ", ") + joint.name;
  }
  if (values <= motors) return std::nullopt;
  return Diagnostic{"", 0, key, "more values than the robot has motors at joints",
                    motors == 0 ? "none: no joint has a motor" : std::to_string(motors) + " at most: " + names,
                    std::to_string(values), ""};
}

std::optional<Diagnostic> find_unheld(const RobotModel& model, const std::vector<std::string>& names, std::size_t values,
                                      const std::string& key) {
  std::size_t next = 0;
  for (const RobotJoint& joint : model.joints) {
    if (joint.motor.effort <= 0) continue;
    const bool asked = names.empty() ? next++ < values : std::find(names.begin(), names.end(), joint.name) != names.end();
    if (asked && joint.motor.stiffness <= 0)
      return Diagnostic{"", 0, key, "the motor of " + joint.name + " turns at a speed and holds no position",
                        "`linear` and `angular` of a robot with wheels", "a position", "a controller may return `speeds` or `torques`"};
  }
  return std::nullopt;
}

RobotRunOptions robot_run_options(const Scenario& scenario, int threads) {
  RobotRunOptions options;
  options.duration = scenario.robot_run.duration;
  options.control_hz = scenario.robot_run.control_hz;
  options.fixed_debris = scenario.robot_run.debris == DebrisMotion::fixed;
  options.gravity = scenario.settle.gravity;
  options.lost_below = scenario.settle.lost_below;
  options.lost_beyond = scenario.settle.lost_beyond;
  options.threads = threads;
  return options;
}

std::vector<std::string> robot_folders(const ResolvedMission& mission) {
  std::vector<std::string> folders{
      std::filesystem::path(mission.provenance.script.path).parent_path().string()};
  folders.insert(folders.end(), mission.assets.folders.begin(), mission.assets.folders.end());
  return folders;
}

std::vector<MissionRobot> make_robots(const ResolvedMission& mission, RunContext& context) {
  std::vector<MissionRobot> made;
  MeshImporter importer;
  const std::vector<std::string> folders = robot_folders(mission);
  for (std::size_t i = 0; i < mission.scenario.robots.size(); ++i) {
    RobotItem robot = mission.scenario.robots[i];
    if (i < mission.assets.robot_files.size() && !robot.urdf.empty()) robot.urdf = mission.assets.robot_files[i];
    made.push_back(make_mission_robot(robot, folders,
                                      "robots[" + std::to_string(i + 1) + "]", importer));
    check_legs(mission.scenario.robots[i], made.back().model, "robots[" + std::to_string(i + 1) + "]");
    for (const std::string& warning : made.back().warnings) context.warnings.push_back(warning);
    const std::string clash = mission.scenario.robots.size() > 1 ? "" : find_frame_clash(mission.scenario, made.back());
    if (!clash.empty())
      context.warnings.push_back("robots[1]: its link `" + clash + "` has the name of another frame of the mission: in /tf its "
                                 "frames begin with `" + robot_names(mission.scenario.robots)[i] + "/`");
  }
  return made;
}

RobotCommand command_of_leg(const RobotItem& robot, const RobotModel& model, const RobotLeg& leg, double time) {
  RobotCommand command = kind_of(robot).command(model, leg, time);
  ask_leg_joints(model, leg, command);
  return command;
}

RobotController make_leg_controller(const RobotItem& robot, const RobotModel& model) {
  return [robot, &model, still = kind_of(robot).still(robot)](const RobotSense& sense) {
    const auto next = std::upper_bound(robot.drive.begin(), robot.drive.end(), sense.time,
                                       [](double time, const RobotLeg& leg) { return time < leg.t; });
    return command_of_leg(robot, model, next == robot.drive.begin() ? still : *(next - 1), sense.time);
  };
}

RobotController with_mimics(RobotController control, const std::vector<MimicJoint>& mimics) {
  if (mimics.empty()) return control;
  return [control = std::move(control), mimics](const RobotSense& sense) {
    RobotCommand command = control(sense);
    command.joints.resize(sense.state.joints.size());
    for (const MimicJoint& mimic : mimics) {
      const MotorCommand& led = command.joints[std::size_t(mimic.of)];
      const double at = led.mode == MotorMode::position ? led.target
                                                        : sense.state.joints[std::size_t(mimic.of)].position;
      command.joints[std::size_t(mimic.joint)] = {MotorMode::position,
                                                  mimic.multiplier * at + mimic.offset};
    }
    return command;
  };
}

}  // namespace rubble
