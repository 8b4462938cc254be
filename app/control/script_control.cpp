#include "app/control/script_control.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/control/robot_control.h"
#include "app/control/sense_tables.h"
#include "app/support/print.h"
#include "kernel/base/number_text.h"
#include "kernel/robot/odometry.h"
#include "scripting/mission.h"
#include "scripting/robots/robot_kind.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

constexpr double kMostTarget = 1e6;  // of what a function may ask of a joint; unit: rad, rad/s, N m

// What a function returns: a command, whose joints may have speeds or torques instead of positions. leg.joint_names are those
// of any of the three.
struct Answer {
  RobotLeg leg;
  std::vector<double> speeds, torques;
};

Schema answer_schema(const RobotKind& kind, const RobotModel& model, Answer& answer) {
  Schema k;
  if (model.sides.any()) {
    k.value("linear", answer.leg.linear, "Forwards.").between(-5, 5).unit("m/s");
    k.value("angular", answer.leg.angular, "Counter-clockwise.").between(-10, 10).unit("rad/s");
  }
  if (model.sides.belts) k.value("flippers", answer.leg.flippers, "Angles of a tracked robot's.").between(-4, 4).unit("rad");
  kind.add_answer_keys(answer.leg, k);
  k.value("joints", answer.leg.joints, "Positions.").between(-kMostTarget, kMostTarget);
  k.value("speeds", answer.speeds, "Instead of positions.").between(-kMostTarget, kMostTarget);
  k.value("torques", answer.torques, "Instead of positions.").between(-kMostTarget, kMostTarget);
  k.value("joint_names", answer.leg.joint_names, "Whose these are.");
  return k;
}

// The lists that ask motors at joints, and are given.
using MotorList = std::pair<const char*, const std::vector<double>*>;
std::vector<MotorList> motor_lists(const Answer& answer) {
  std::vector<MotorList> given;
  for (const MotorList& list : {MotorList{"joints", &answer.leg.joints}, {"speeds", &answer.speeds}, {"torques", &answer.torques}})
    if (!list.second->empty()) given.push_back(list);
  return given;
}

// Of a list of motors, besides its numbers.
void check_motor_list(const RobotModel& model, const MotorList& list, const std::vector<std::string>& names,
                      std::vector<Diagnostic>& mistakes) {
  const auto& [member, values] = list;
  if (names.empty()) {
    if (auto miscount = find_miscount(model, values->size(), member, kNameSome)) mistakes.push_back(std::move(*miscount));
    return;
  }
  if (names.size() != values->size())
    mistakes.push_back({"", 0, "joint_names", "not as many as " + std::string(member), std::to_string(values->size()) + " names",
                        std::to_string(names.size()), ""});
  try {
    for (const std::string& name : names) find_motor(model, name, "joint_names");
  } catch (const InputError& error) {
    mistakes.push_back(error.diagnostics().front());
  }
}

// Whether a twist or the flippers move one of these joints; no names: any joint with a motor. Other members of a kind move all.
bool moves_joints(const RobotModel& model, const std::string& member, const std::vector<std::string>& names) {
  const bool twist = member == "linear" || member == "angular";
  if (!twist) return true;
  if (model.sides.belts) return false;
  const auto named = [&](int joint) {
    return names.empty() || std::find(names.begin(), names.end(), model.joints[std::size_t(joint)].name) != names.end();
  };
  const SideDrive& sides = model.sides;
  return std::any_of(sides.left.begin(), sides.left.end(), named) || std::any_of(sides.right.begin(), sides.right.end(), named) ||
         std::any_of(sides.steered.begin(), sides.steered.end(), [&](const SteeredWheel& wheel) { return named(wheel.joint); });
}

// No motor is asked for two things.
void check_contradictions(const RobotModel& model, const Value& returned, const Answer& answer, std::vector<Diagnostic>& mistakes) {
  const std::vector<MotorList> lists = motor_lists(answer);
  if (lists.empty()) {
    if (!answer.leg.joint_names.empty())
      mistakes.push_back({"", 0, "joint_names", "names joints that are asked for nothing", "`joints`, `speeds` or `torques` as well",
                          "none of them", ""});
    return;
  }
  const std::string list = lists.front().first;
  for (std::size_t i = 1; i < lists.size(); ++i)
    mistakes.push_back({"", 0, lists[i].first, "contradicts " + list, "one of both", "both", ""});
  for (const auto& [member, value] : returned.fields) {
    const bool is_list = member == "joints" || member == "speeds" || member == "torques" || member == "joint_names";
    const bool is_nothing = value.kind == Value::Kind::table && value.is_empty_table();
    if (is_list || is_nothing || !moves_joints(model, member, answer.leg.joint_names)) continue;
    mistakes.push_back({"", 0, list, "contradicts " + member, "one of both", "both", ""});
  }
}

// What the model of the robot has to say against the answer.
void check_answer(const RobotModel& model, const Value& returned, const Answer& answer, std::vector<Diagnostic>& mistakes) {
  if (auto miscount = find_miscount(model, answer.leg.flippers.size(), "flippers")) mistakes.push_back(std::move(*miscount));
  for (const MotorList& list : motor_lists(answer)) check_motor_list(model, list, answer.leg.joint_names, mistakes);
  if (auto unheld = find_unheld(model, answer.leg.joint_names, answer.leg.joints.size(), "joints"))
    mistakes.push_back(std::move(*unheld));
  check_contradictions(model, returned, answer, mistakes);
}

RobotCommand command_of(const RobotKind& kind, const Answer& answer, const RobotModel& model) {
  RobotCommand command = kind.answer(model, answer.leg);
  const std::vector<std::string>& names = answer.leg.joint_names;
  ask_motors(model, answer.leg.joints, names, MotorMode::position, command);
  ask_motors(model, answer.speeds, names, MotorMode::velocity, command);
  ask_motors(model, answer.torques, names, MotorMode::torque, command);
  return command;
}

// What the function prints is shown, also if it fails.
Value call(LuaSandbox& sandbox, int control, const Value& told) {
  const auto show = [&sandbox] {
    for (const std::string& line : sandbox.take_printed()) print_err("%s\n", line.c_str());
  };
  try {
    const Value answer = sandbox.call_controller(control, told);
    show();
    return answer;
  } catch (...) {
    show();
    throw;
  }
}

}  // namespace

struct ScriptControl::State {
  State(const ResolvedMission& m, Tell t, const SourceFile& script)
      : mission(m), tell(std::move(t)), lines(script.text, "mission"), sandbox(m.scenario.seed, "rubble.mission") {
    std::map<std::string, std::string> included;
    for (const SourceFile& file : m.provenance.included) included[file.path] = file.text;
    sandbox.serve_includes(included);
    give_overrides(m.provenance.overrides, sandbox);
    run_script(sandbox, script, lines);
    sandbox.take_printed();  // that was shown when the mission was loaded
  }
  const ResolvedMission& mission;
  Tell tell;
  SourceMap lines;
  LuaSandbox sandbox;
};

ScriptControl::ScriptControl(const ResolvedMission& mission, Tell tell)
    : state_(std::make_unique<State>(mission, std::move(tell), mission.provenance.script)) {}
ScriptControl::~ScriptControl() = default;

RobotController ScriptControl::controller_of(std::size_t robot, const RobotModel& model) {
  State& state = *state_;
  const RobotItem& item = state.mission.scenario.robots[robot];
  const std::string key = "robots[" + std::to_string(robot + 1) + "].control";
  const double gravity = state.mission.scenario.settle.gravity;
  const auto wheels = model.sides.any() ? std::make_shared<WheelOdometry>(model, odometry_noise(state.mission.scenario, robot)) : nullptr;
  return [&state, robot, item, model, key, gravity, wheels, last = Vec3{}, last_time = 0.0, warned = false](
             const RobotSense& sense) mutable {
    Value told = describe_sense(sense, kind_of(item), model, gravity, last, last_time);
    if (wheels) told.set("odometry", describe_odometry(wheels->update(sense.state, sense.time)));
    if (!item.senses.empty()) state.tell(robot, told);
    Answer answer;
    std::vector<Diagnostic> mistakes;
    Value returned;
    try {
      returned = call(state.sandbox, item.control, told);
    } catch (const InputError& error) {
      mistakes = error.diagnostics();
    }
    if (!mistakes.empty()) {
      // What went wrong within the function says where.
    } else if (returned.kind != Value::Kind::table) {
      mistakes.push_back({"", 0, "", "the function returned no valid commands",
                          "a table such as { linear = 0.3, angular = 0 }", describe(returned), ""});
    } else {
      read_table(answer_schema(kind_of(item), model, answer), returned, mistakes);
      if (mistakes.empty()) check_answer(model, returned, answer, mistakes);
    }
    const std::string time = exact_text(std::round(sense.time * 1000) / 1000);
    for (Diagnostic& d : mistakes) {
      d.message += ", at t = " + time + " s";
      d.key = d.key.empty() ? key : key + ": " + d.key;
      if (d.line > 0) continue;
      d.file = state.mission.provenance.script.path;
      d.line = state.lines.line_of(key);
    }
    throw_if_any(std::move(mistakes));
    const std::string lost = warned ? "" : describe_lost_turn(model, answer.leg.linear, answer.leg.angular);
    if (!lost.empty()) print_err("warning: %s: %s, at t = %s s\n", key.c_str(), lost.c_str(), time.c_str());
    warned = warned || !lost.empty();
    return command_of(kind_of(item), answer, model);
  };
}

}  // namespace rubble
