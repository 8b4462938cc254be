#include "app/control/robot_control.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>

#include "app/robots/link_sensors.h"
#include "app/robots/robot_log.h"
#include "kernel/base/number_text.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"

namespace rubble {

void ask_motors(const RobotModel& model, const std::vector<double>& targets, const std::vector<std::string>& names,
                MotorMode mode, RobotCommand& command) {
  command.joints.resize(model.joints.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < model.joints.size() && next < targets.size(); ++i) {
    if (names.empty()) {
      if (model.joints[i].motor.effort > 0) command.joints[i] = {mode, targets[next++]};
      continue;
    }
    const auto name = std::find(names.begin(), names.end(), model.joints[i].name);
    if (name != names.end()) command.joints[i] = {mode, targets[std::size_t(name - names.begin())]};
  }
}

namespace {

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

// key: of the robot. What is named must be there, every motor has one value, and nothing that the robot cannot do.
void check_legs(const RobotItem& robot, const RobotModel& model, const std::string& key) {
  for (std::size_t k = 0; k < robot.drive.size(); ++k) {
    const RobotLeg& leg = robot.drive[k];
    const std::string at = key + ".drive[" + std::to_string(k + 1) + "]";
    for (const std::string& name : leg.joint_names) find_motor(model, name, at + ".joint_names");
    if (leg.joint_names.empty())
      if (const auto mistake = find_miscount(model, leg.joints.size(), at + ".joints", kNameSome)) throw InputError(*mistake);
    if (const auto mistake = find_unheld(model, leg.joint_names, leg.joints.size(), at + ".joints")) throw InputError(*mistake);
    if (!model.sides.any() && (leg.linear != 0 || leg.angular != 0))
      throw InputError({"", 0, at + (leg.linear != 0 ? ".linear" : ".angular"), "this robot has neither tracks nor driven wheels",
                        "0", exact_text(leg.linear != 0 ? leg.linear : leg.angular), ""});
    if (!model.sides.belts && !leg.flippers_deg.empty())
      throw InputError({"", 0, at + ".flippers_deg", "this robot has no tracks, and so no flippers", "nothing",
                        std::to_string(leg.flippers_deg.size()) + " angles", ""});
    if (const auto mistake = find_miscount(model, leg.flippers_deg.size(), at + ".flippers_deg")) throw InputError(*mistake);
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

std::optional<Diagnostic> find_miscount(const RobotModel& model, std::size_t values, const std::string& key,
                                        const std::string& hint) {
  std::string names;
  std::size_t motors = 0;
  for (const RobotJoint& joint : model.joints) {
    if (joint.motor.effort <= 0) continue;
    names += (motors++ == 0 ? "" : ", ") + joint.name;
  }
  if (values == 0 || values == motors) return std::nullopt;
  return Diagnostic{"", 0, key, "not as many values as the robot has motors at joints",
                    motors == 0 ? "none: no joint has a motor" : std::to_string(motors) + ": " + names, std::to_string(values),
                    motors == 0 ? "" : hint};
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

namespace {

// Of the first command of `drive` that loses some of its turn; "": none does.
std::string describe_lost_turn(const RobotItem& robot, const RobotModel& model) {
  for (std::size_t k = 0; k < robot.drive.size(); ++k) {
    const std::string lost = describe_lost_turn(model, robot.drive[k].linear, robot.drive[k].angular);
    if (!lost.empty()) return "drive[" + std::to_string(k + 1) + "]: " + lost;
  }
  return "";
}

}  // namespace

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

namespace {

std::vector<std::string> folders_of_robots(const std::string& script, const AssetLibrary& assets) {
  std::vector<std::string> folders{std::filesystem::path(script).parent_path().string()};
  folders.insert(folders.end(), assets.folders.begin(), assets.folders.end());
  return folders;
}

// Their models with checked commands. script: its path.
std::vector<MissionRobot> make_models(const std::vector<RobotItem>& robots, const AssetLibrary& assets, const std::string& script) {
  std::vector<MissionRobot> made;
  MeshImporter importer;
  const std::vector<std::string> folders = folders_of_robots(script, assets);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::string key = "robots[" + std::to_string(i + 1) + "]";
    RobotItem robot = robots[i];
    if (i < assets.robot_files.size() && !robot.urdf.empty()) robot.urdf = assets.robot_files[i];
    made.push_back(make_mission_robot(robot, folders, key, importer));
    check_legs(robots[i], made.back().model, key);
  }
  return made;
}

}  // namespace

std::vector<std::string> robot_folders(const ResolvedMission& mission) {
  return folders_of_robots(mission.provenance.script.path, mission.assets);
}

void check_robot_models(const Scenario& scenario, const AssetLibrary& assets, const SourceFile& script) {
  if (scenario.robots.empty()) return;
  try {
    check_ridden_links(scenario, make_models(scenario.robots, assets, script.path));
  } catch (const InputError& error) {
    std::vector<Diagnostic> mistakes = error.diagnostics();
    locate(mistakes, script.path, SourceMap(script.text, "mission"));
    throw InputError(std::move(mistakes));
  }
}

std::vector<MissionRobot> make_robots(const ResolvedMission& mission, RunContext& context) {
  std::vector<MissionRobot> made = make_models(mission.scenario.robots, mission.assets, mission.provenance.script.path);
  for (std::size_t i = 0; i < made.size(); ++i) {
    for (const std::string& warning : made[i].warnings) context.warnings.push_back(warning);
    const std::string turn = describe_lost_turn(mission.scenario.robots[i], made[i].model);
    if (!turn.empty()) context.warnings.push_back("robots[" + std::to_string(i + 1) + "]." + turn);
    const std::string clash = made.size() > 1 ? "" : find_frame_clash(mission.scenario, made[i]);
    if (!clash.empty())
      context.warnings.push_back("robots[1]: its link `" + clash + "` has the name of another frame of the mission: in /tf its "
                                 "frames begin with `" + robot_names(mission.scenario.robots)[i] + "/`");
  }
  return made;
}

std::string describe_lost_turn(const RobotModel& model, double linear, double angular) {
  const SideDrive& sides = model.sides;
  if (!sides.any() || !sides.steered.empty() || linear == 0 || angular == 0) return "";
  double most = std::numeric_limits<double>::infinity();
  for (const auto* side : {&sides.left, &sides.right})
    for (const int i : *side) {
      const double speed = sides.belts ? model.links[std::size_t(i)].belt_speed_limit
                                       : model.joints[std::size_t(i)].motor.speed * sides.radius;
      if (sides.belts || speed > 0) most = std::min(most, speed);
    }
  const double apart = 0.5 * sides.distance * std::abs(angular), fastest = std::abs(linear) + apart;
  if (fastest <= most) return "";
  return "linear = " + plain_text(linear) + " with angular = " + plain_text(angular) + " asks for " +
         plain_text(std::round(fastest * 1000) / 1000) +
         " m/s on one side, which reaches " + plain_text(most) + " m/s: the robot turns less than `angular` says";
}

RobotCommand command_of_leg(const RobotItem& robot, const RobotModel& model, const RobotLeg& leg, double time) {
  RobotCommand command = kind_of(robot).command(model, leg, time);
  ask_motors(model, leg.joints, leg.joint_names, MotorMode::position, command);
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
