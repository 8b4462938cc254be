#include "app/pipeline/robot_control.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "kernel/base/portable_math.h"
#include "kernel/robot/bundled.h"
#include "kernel/robot/gaits.h"
#include "kernel/robot/odometry.h"
#include "scripting/sandbox/lua_sandbox.h"
#include "scripting/sandbox/script_file.h"
#include "scripting/sandbox/source_map.h"
#include "scripting/schema/schema.h"

namespace rubble {
namespace {

constexpr double kDegree = portable::kPi / 180;
constexpr double kMostTarget = 1e6;  // of what a function may ask of a joint; unit: rad, rad/s, N m

SnakeGait gait_of(const RobotLeg& leg) {
  const double steering = leg.steering_deg * kDegree;
  SnakeGait gait;
  switch (leg.gait) {
    case GaitKind::lateral_undulation:
      gait = lateral_undulation();
      break;
    case GaitKind::sidewinding:
      gait = sidewinding();
      break;
    case GaitKind::rolling:
      gait = rolling();
      break;
    case GaitKind::serpenoid:
      gait = serpenoid(0);
      break;
    case GaitKind::helical_rolling:
      gait = helical_rolling();
      break;
  }
  gait.rate = leg.rate;
  gait.lateral_phase -= leg.phase, gait.vertical_phase -= leg.phase;
  gait.lateral_amplitude *= leg.amplitude;
  gait.vertical_amplitude *= leg.amplitude;
  gait.steering = steering;
  return gait;
}

std::vector<double> in_radians(const std::vector<double>& degrees) {
  std::vector<double> angles;
  for (double angle : degrees) angles.push_back(angle * kDegree);
  return angles;
}

Value vector_value(const Vec3& v) {
  Value list = Value::make_table();
  for (int i = 0; i < 3; ++i) list.items.push_back(Value::make_number(v[i]));
  return list;
}

// What a function returns.
struct Wish {
  double linear = 0, angular = 0;
  Growth growth;
  std::vector<double> flippers, joints, speeds, torques;
};

Schema wish_schema(Wish& wish) {
  Schema k;
  k.value("linear", wish.linear, "Forwards.").between(-5, 5).unit("m/s");
  k.value("angular", wish.angular, "Counter-clockwise.").between(-10, 10).unit("rad/s");
  k.value("growth", wish.growth.speed, "Speed of a vine's tip.").between(-1, 1).unit("m/s");
  k.value("curvature", wish.growth.curve_left, "Of what grows, to the left.").between(-5, 5).unit("1/m");
  k.value("curvature_up", wish.growth.curve_up, "Of what grows, upwards.").between(-5, 5).unit("1/m");
  k.value("flippers", wish.flippers, "Angles of a crawler's.").between(-4, 4).unit("rad");
  k.value("joints", wish.joints, "Positions.").between(-kMostTarget, kMostTarget);
  k.value("speeds", wish.speeds, "Instead of positions.").between(-kMostTarget, kMostTarget);
  k.value("torques", wish.torques, "Instead of positions.").between(-kMostTarget, kMostTarget);
  return k;
}

// A twist for what tracks or wheels drive.
RobotCommand drive_sides(const RobotModel& model, const Twist& twist, const std::vector<double>& flippers) {
  return model.sides.belts ? drive_crawler(model, twist, flippers) : drive_wheels(model, twist);
}

// Motors are numbered among themselves.
void ask_motors(const RobotModel& model, const std::vector<double>& targets, MotorMode mode, RobotCommand& command) {
  command.joints.resize(model.joints.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < model.joints.size() && next < targets.size(); ++i) {
    if (model.joints[i].motor.effort > 0) command.joints[i] = {mode, targets[next++]};
  }
}

void ask_joints(const RobotModel& model, const RobotLeg& leg, RobotCommand& command) {
  if (leg.joint_names.empty()) return ask_motors(model, leg.joints, MotorMode::position, command);
  command.joints.resize(model.joints.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const auto name = std::find(leg.joint_names.begin(), leg.joint_names.end(), model.joints[i].name);
    if (name != leg.joint_names.end())
      command.joints[i] = {MotorMode::position, leg.joints[std::size_t(name - leg.joint_names.begin())]};
  }
}

// key: of the robot. What is named must be there.
void check_joint_names(const RobotItem& robot, const RobotModel& model, const std::string& key) {
  for (std::size_t k = 0; k < robot.drive.size(); ++k)
    for (const std::string& name : robot.drive[k].joint_names)
      find_motor(model, name, key + ".drive[" + std::to_string(k + 1) + "].joint_names");
}

RobotCommand command_of(const Wish& wish, const RobotModel& model) {
  RobotCommand command;
  if (model.sides.any()) command = drive_sides(model, {wish.linear, wish.angular}, wish.flippers);
  if (model.tube) command = drive_vine(model, wish.growth);
  ask_motors(model, wish.joints, MotorMode::position, command);
  ask_motors(model, wish.speeds, MotorMode::velocity, command);
  ask_motors(model, wish.torques, MotorMode::torque, command);
  return command;
}

Value describe_odometry(const OdometryReading& reading) {
  Value odometry = Value::make_table();
  odometry.set("x", Value::make_number(reading.x));
  odometry.set("y", Value::make_number(reading.y));
  odometry.set("yaw", Value::make_number(reading.yaw));
  odometry.set("linear", Value::make_number(reading.linear));
  odometry.set("angular", Value::make_number(reading.angular));
  return odometry;
}

// Of a robot that grows: how long it is, and what its tip meets.
Value describe_vine(const RobotState& state) {
  const RobotState::Link& tip = state.links.back();
  Value vine = Value::make_table();
  vine.set("length", Value::make_number(state.length));
  vine.set("speed", Value::make_number(state.joints.back().speed));
  const Vec3 forwards = tip.world_from_link.rotation.rotate({1, 0, 0});
  vine.set("force", Value::make_number(-dot(tip.contact_force, forwards)));
  vine.set("most_force", Value::make_number(state.tip_force));
  return vine;
}

Value describe_tip(const Pose& world_from_tip) {
  Value tip = Value::make_table();
  tip.set("position", vector_value(world_from_tip.translation));
  tip.set("forwards", vector_value(world_from_tip.rotation.rotate({1, 0, 0})));
  tip.set("left", vector_value(world_from_tip.rotation.rotate({0, 1, 0})));
  tip.set("up", vector_value(world_from_tip.rotation.rotate({0, 0, 1})));
  return tip;
}

// What a robot senses, as a function is told. last: the base's velocity at the call before.
Value describe_sense(const RobotSense& sense, const RobotModel& model, double gravity, Vec3& last,
                     double& last_time) {
  Value table = Value::make_table();
  table.set("t", Value::make_number(sense.time));
  Value joints = Value::make_table();
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].motor.effort <= 0) continue;
    const RobotState::Joint& from = sense.state.joints[i];
    Value joint = Value::make_table();
    joint.set("name", Value::make_text(model.joints[i].name));
    joint.set("position", Value::make_number(from.position));
    joint.set("speed", Value::make_number(from.speed));
    joint.set("torque", Value::make_number(from.torque));
    joints.items.push_back(joint);
  }
  table.set("joints", joints);
  const RobotState::Link& base = sense.state.links[0];
  const Quat to_base = base.world_from_link.rotation.conjugate();
  const double dt = sense.time - last_time;
  const Vec3 acceleration = dt > 0 ? (base.linear - last) * (1 / dt) : Vec3{};
  Value imu = Value::make_table();
  imu.set("gyroscope", vector_value(to_base.rotate(base.angular)));
  imu.set("accelerometer", vector_value(to_base.rotate(acceleration + Vec3{0, 0, gravity})));
  table.set("imu", imu);
  last = base.linear;
  last_time = sense.time;
  Value contacts = Value::make_table();
  for (const RobotContact& c : sense.contacts) {
    Value contact = Value::make_table();
    contact.set("link", Value::make_text(model.links[std::size_t(c.link)].name));
    contact.set("force", Value::make_number(c.force));
    contact.set("normal", vector_value(to_base.rotate(c.normal)));
    contacts.items.push_back(contact);
  }
  table.set("contacts", contacts);
  Value truth = Value::make_table();
  const Vec3 x = base.world_from_link.rotation.rotate({1, 0, 0});
  truth.set("position", vector_value(base.world_from_link.translation));
  truth.set("yaw", Value::make_number(portable::atan2(x.y, x.x)));
  if (model.tube) {
    truth.set("tip", describe_tip(sense.state.links.back().world_from_link));
    table.set("vine", describe_vine(sense.state));
  }
  table.set("truth", truth);
  return table;
}

}  // namespace

std::size_t find_motor(const RobotModel& model, const std::string& name, const std::string& key) {
  std::string all;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].motor.effort <= 0) continue;
    if (model.joints[i].name == name) return i;
    all += (all.empty() ? "one of " : ", ") + model.joints[i].name;
  }
  throw InputError({"", 0, key, "the robot has no joint of this name with a motor",
                    all.empty() ? "no joint: this robot has no motor at a joint" : all, "\"" + name + "\"", ""});
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
    made.push_back(make_mission_robot(mission.scenario.robots[i], folders,
                                      "robots[" + std::to_string(i + 1) + "]", importer));
    check_joint_names(mission.scenario.robots[i], made.back().model, "robots[" + std::to_string(i + 1) + "]");
    for (const std::string& warning : made.back().warnings) context.warnings.push_back(warning);
  }
  return made;
}

RobotController make_leg_controller(const RobotItem& robot, const RobotModel& model) {
  const bool snake = robot.urdf.empty() && robot.model == RobotKind::snake;
  return [robot, model, snake](const RobotSense& sense) {
    RobotLeg still;
    still.amplitude = snake ? 0 : 1;  // without legs it stands straight
    const auto next = std::upper_bound(robot.drive.begin(), robot.drive.end(), sense.time,
                                       [](double time, const RobotLeg& leg) { return time < leg.t; });
    const RobotLeg& now = next == robot.drive.begin() ? still : *(next - 1);
    RobotCommand command;
    if (model.tube) {
      command = drive_vine(model, {now.growth, now.curvature, now.curvature_up});
    } else if (snake) {
      command = calc_gait(model, gait_of(now), sense.time);
    } else {
      command = drive_sides(model, {now.linear, now.angular}, in_radians(now.flippers_deg));
    }
    ask_joints(model, now, command);
    return command;
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

struct ScriptControl::State {
  State(const ResolvedMission& m, const SourceFile& script)
      : mission(m), lines(script.text, "mission"), sandbox(m.scenario.seed, "rubble.mission") {
    std::map<std::string, std::string> included;
    for (const SourceFile& file : m.provenance.included) included[file.path] = file.text;
    sandbox.serve_includes(included);
    run_script(sandbox, script, lines);
  }
  const ResolvedMission& mission;
  SourceMap lines;
  LuaSandbox sandbox;
};

ScriptControl::ScriptControl(const ResolvedMission& mission)
    : state_(std::make_unique<State>(mission, mission.provenance.script)) {}
ScriptControl::~ScriptControl() = default;

RobotController ScriptControl::controller_of(std::size_t robot, const RobotModel& model) {
  State& state = *state_;
  const RobotItem& item = state.mission.scenario.robots[robot];
  const std::string key = "robots[" + std::to_string(robot + 1) + "].control";
  const double gravity = state.mission.scenario.settle.gravity;
  const auto wheels = model.sides.any() ? std::make_shared<WheelOdometry>(model) : nullptr;
  return [&state, item, model, key, gravity, wheels, last = Vec3{}, last_time = 0.0](
             const RobotSense& sense) mutable {
    Value told = describe_sense(sense, model, gravity, last, last_time);
    if (wheels) told.set("odometry", describe_odometry(wheels->update(sense.state, sense.time)));
    const Value answer = state.sandbox.call_controller(item.control, told);
    Wish wish;
    std::vector<Diagnostic> mistakes;
    if (answer.kind != Value::Kind::table) {
      mistakes.push_back({"", 0, "", "what the function returns cannot be followed",
                          "a table such as { linear = 0.3, angular = 0 }", describe(answer), ""});
    } else {
      read_table(wish_schema(wish), answer, mistakes);
    }
    for (Diagnostic& d : mistakes) {
      d.message += ", at t = " + format_number(sense.time) + " s";
      d.key = d.key.empty() ? key : key + ": " + d.key;
      d.file = state.mission.provenance.script.path;
      d.line = state.lines.line_of(key);
    }
    throw_if_any(std::move(mistakes));
    return command_of(wish, model);
  };
}

}  // namespace rubble
