#include "app/control/script_control.h"

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

// What a function returns: a command, whose joints may have speeds or torques instead of positions.
struct Answer {
  RobotLeg leg;
  std::vector<double> speeds, torques;
};

Schema answer_schema(const RobotKind& kind, const RobotModel& model, Answer& answer) {
  Schema k;
  k.value("linear", answer.leg.linear, "Forwards.").between(-5, 5).unit("m/s");
  k.value("angular", answer.leg.angular, "Counter-clockwise.").between(-10, 10).unit("rad/s");
  if (model.sides.belts) k.value("flippers", answer.leg.flippers, "Angles of a tracked robot's.").between(-4, 4).unit("rad");
  kind.add_answer_keys(answer.leg, k);
  k.value("joints", answer.leg.joints, "Positions.").between(-kMostTarget, kMostTarget);
  k.value("speeds", answer.speeds, "Instead of positions.").between(-kMostTarget, kMostTarget);
  k.value("torques", answer.torques, "Instead of positions.").between(-kMostTarget, kMostTarget);
  return k;
}

RobotCommand command_of(const RobotKind& kind, const Answer& answer, const RobotModel& model) {
  RobotCommand command = kind.answer(model, answer.leg);
  ask_motors(model, answer.leg.joints, MotorMode::position, command);
  ask_motors(model, answer.speeds, MotorMode::velocity, command);
  ask_motors(model, answer.torques, MotorMode::torque, command);
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
  return [&state, robot, item, model, key, gravity, wheels, last = Vec3{}, last_time = 0.0](
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
      const std::pair<const char*, std::size_t> counts[] = {
          {"flippers", answer.leg.flippers.size()}, {"joints", answer.leg.joints.size()},
          {"speeds", answer.speeds.size()}, {"torques", answer.torques.size()}};
      for (const auto& [member, count] : counts)
        if (auto surplus = find_surplus(model, count, member)) mistakes.push_back(std::move(*surplus));
      if (auto unheld = find_unheld(model, {}, answer.leg.joints.size(), "joints")) mistakes.push_back(std::move(*unheld));
    }
    for (Diagnostic& d : mistakes) {
      d.message += ", at t = " + exact_text(std::round(sense.time * 1000) / 1000) + " s";
      d.key = d.key.empty() ? key : key + ": " + d.key;
      if (d.line > 0) continue;
      d.file = state.mission.provenance.script.path;
      d.line = state.lines.line_of(key);
    }
    throw_if_any(std::move(mistakes));
    return command_of(kind_of(item), answer, model);
  };
}

}  // namespace rubble
