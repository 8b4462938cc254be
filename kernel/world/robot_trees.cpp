#include "kernel/world/robot_trees.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

// Farther apart than any two points of a contact; unit: m.
constexpr float kFar = 1e30F;

void check_number(double value, const std::string& key) {
  if (std::isfinite(value)) return;
  throw InputError({"", 0, key, "not a number that a motor can follow", "a finite number",
                    brief_text(value), "look at what the controller computes"});
}

void set_motor(const RobotJoint& joint, const MotorCommand& command, TreeMotor& motor) {
  motor.on = joint.motor.effort > 0 && command.mode != MotorMode::off;
  motor.effort = joint.motor.effort;
  motor.speed_limit = joint.motor.speed;
  motor.stiffness = motor.damping = motor.position = motor.speed = motor.torque = 0;
  const double most = joint.motor.speed > 0 ? joint.motor.speed : kNever;
  switch (command.mode) {
    case MotorMode::off:
      motor.impulse = motor.mean = 0;
      break;
    case MotorMode::torque:
      motor.torque = std::clamp(command.target, -motor.effort, motor.effort);
      break;
    case MotorMode::velocity:
      motor.damping = joint.motor.damping;
      motor.speed = std::clamp(command.target, -most, most);
      break;
    case MotorMode::position:
      motor.stiffness = joint.motor.stiffness;
      motor.damping = joint.motor.damping;
      motor.position = std::clamp(command.target, joint.lower, joint.upper);
      break;
  }
}

}  // namespace

int RobotTrees::add(const RobotModel& model, const Pose& world_from_base) {
  const std::string key = "robots[" + std::to_string(types_.robots.size() + 1) + "]";
  validate(model, key);
  const int first_type = int(types_.pieces.size()), first = int(data_.bodies.size());
  for (const PieceType& type : make_link_types(model)) {
    types_.shapes.push_back(compile_shape(type, key + "." + type.name));
    types_.pieces.push_back(type);
  }
  NewPiece piece;
  piece.placement.world_from_body = {normalized(world_from_base.rotation), world_from_base.translation};
  piece.placement.fixed = model.fixed_base || model.tube;  // what grows is staked to the ground
  Tree tree = trees_.make(make_assembly(model, first_type), piece);
  tree.driven = true;
  std::vector<double> starts;
  for (const RobotJoint& joint : model.joints) {
    if (joint.kind != JointKind::weld) starts.push_back(joint.start);
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    tree.links[i].belt_axis = model.links[i].belt_axis;
    tree.links[i].eversion_axis = model.links[i].eversion_axis;
  }
  data_.robots.push_back({std::int32_t(data_.trees.size()), first});
  types_.robots.push_back(model);
  types_.grown_robots.emplace_back();
  if (model.tube) {
    data_.robots.back().laid = model.tube->start_links;
    tree = tubes_.plant(tree, *model.tube);
    starts.clear();
  }
  trees_.start(tree, piece, starts);
  pairs_.introduce(first);
  if (model.tube) tubes_.carry_stowed(data_.robots.back(), model);
  if (piece.placement.fixed) wake_neighbours(first);
  return int(data_.robots.size()) - 1;
}

void RobotTrees::set_command(int number, const RobotCommand& command) {
  const RobotModel& model = types_.robots[std::size_t(number)];
  WorldRobot& robot = data_.robots[std::size_t(number)];
  std::vector<TreeLink>& links = data_.trees[robot.tree].links;
  if (links.empty()) return;  // lost
  const std::string key = "robots[" + std::to_string(number + 1) + "]";
  for (std::size_t i = 0; i < std::min(command.joints.size(), model.joints.size()); ++i) {
    check_number(command.joints[i].target, key + "." + model.joints[i].name);
  }
  for (std::size_t i = 0; i < std::min(command.belts.size(), model.links.size()); ++i) {
    check_number(command.belts[i], key + "." + model.links[i].name);
  }
  check_number(command.curve_left, key + ".curve_left");
  check_number(command.curve_up, key + ".curve_up");
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const MotorCommand wanted = i < command.joints.size() ? command.joints[i] : MotorCommand{};
    const Body& body = data_.bodies[std::size_t(robot.first_body + model.joints[i].child)];
    if (body.tree < 0) continue;  // it has not grown
    set_motor(model.joints[i], wanted, data_.trees[body.tree].links[std::size_t(body.link)].motor);
  }
  if (model.tube) {
    robot.curve_left = command.curve_left, robot.curve_up = command.curve_up;
    return tubes_.set_tip(robot, model);
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    const double most = norm(model.links[i].belt_axis) > 0 ? model.links[i].belt_speed_limit : 0;
    const double wanted = i < command.belts.size() ? command.belts[i] : 0;
    links[i].belt_speed = std::clamp(wanted, -most, most);
  }
}

// What sleeps against an immovable base would not be found to overlap it.
void RobotTrees::wake_neighbours(std::int32_t body) {
  for (const Pair& pair : data_.pairs) {
    if (pair.body_a == body && pair.body_b != kGround) waking_.wake(pair.body_b);
    if (pair.body_b == body) waking_.wake(pair.body_a);
  }
}

// Of a link of the model; none: it has not grown.
const TreeLink* RobotTrees::find_link(const WorldRobot& robot, int link) const {
  const Body& body = data_.bodies[std::size_t(robot.first_body + link)];
  if (body.tree < 0) return nullptr;
  return &data_.trees[body.tree].links[std::size_t(body.link)];
}

bool RobotTrees::is_of_robot(const Contact& contact, const WorldRobot& robot) const {
  if (data_.bodies[contact.body_a].tree == robot.tree) return true;
  return contact.body_b != kGround && data_.bodies[contact.body_b].tree == robot.tree;
}

RobotState RobotTrees::state(int number) const {
  const WorldRobot& robot = data_.robots[std::size_t(number)];
  const RobotModel& model = types_.robots[std::size_t(number)];
  const TreeState state = simbody_.state(robot.tree);
  RobotState result;
  result.lost = data_.trees[robot.tree].links.empty();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Body& body = data_.bodies[robot.first_body + int(i)];
    RobotState::Link link;
    link.world_from_link = body.world_from_type();
    if (const TreeLink* found = find_link(robot, int(i))) {
      const TreeLink& from = *found;
      link.angular = from.angular;
      link.linear =
          from.linear + cross(from.angular, link.world_from_link.translation - body.world_from_com.translation);
      link.contact_force = from.loads.contact_force;
      link.contact_moment = from.loads.contact_moment;
      link.belt_speed = from.belt_speed;
    }
    result.links.push_back(link);
  }
  for (const RobotJoint& of : model.joints) {
    RobotState::Joint joint;
    if (const TreeLink* found = find_link(robot, of.child)) {
      const TreeLink& from = *found;
      if (of.kind != JointKind::weld) {
        joint.position = state.q[std::size_t(from.first_q)];
        joint.speed = state.u[std::size_t(from.first_u)];
      }
      joint.torque = from.motor.mean;
      joint.work = from.motor.work;
      joint.load_force = from.loads.joint_force;
      joint.load_moment = from.loads.joint_moment;
    }
    result.joints.push_back(joint);
  }
  if (model.tube && !result.lost) {
    result.length = result.joints.back().position = calc_tube_length(robot, model);
    result.tip_force = find_link(robot, int(model.lead()))->motor.effort;
  }
  return result;
}

std::vector<RobotContact> RobotTrees::contacts(int number) const {
  const WorldRobot& robot = data_.robots[std::size_t(number)];
  std::vector<RobotContact> result;
  for (std::size_t i = 0; i < data_.pairs.size(); ++i) {
    const Contact& contact = data_.contacts[i];
    if (!data_.pairs[i].live || !is_of_robot(contact, robot)) continue;
    const bool first = data_.bodies[contact.body_a].tree == robot.tree;
    float pressed = 0, separation = kFar;
    Vec3 point;
    for (int k = 0; k < contact.count; ++k) {
      const ContactPoint& p = contact.points[k];
      point += Vec3(first ? p.from_a : p.from_b) * double(p.normal_impulse);
      pressed += p.normal_impulse;
      separation = std::min(separation, p.separation);
    }
    if (contact.pressed <= 0 && separation >= 0) continue;
    const ContactPoint& one = contact.points[0];
    point = pressed > 0 ? point * (1 / double(pressed)) : Vec3(first ? one.from_a : one.from_b);
    const std::int32_t index = first ? contact.body_a : contact.body_b;
    const Body& link = data_.bodies[std::size_t(index)];
    RobotContact c;
    c.link = index - robot.first_body;
    c.piece = first ? contact.body_b : contact.body_a;
    c.point = link.world_from_com.translation + point;
    c.normal = Vec3(contact.normal) * (first ? -1.0 : 1.0);
    c.separation = double(separation);
    c.force = double(contact.pressed) / settings_.options.step;
    result.push_back(c);
  }
  std::sort(result.begin(), result.end(), [](const RobotContact& a, const RobotContact& b) {
    return std::tie(a.link, a.piece, a.point.x, a.point.y, a.point.z) <
           std::tie(b.link, b.piece, b.point.x, b.point.y, b.point.z);
  });
  return result;
}

}  // namespace rubble
