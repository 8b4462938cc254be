// Robots in the world: trees with motors and belts.
#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/error.h"
#include "kernel/world/world_impl.h"

namespace rubble {
namespace {

// A sleeper wakes when a robot presses on it with this share of its weight; unit: 1.
constexpr float kRobotTouch = 0.001F;
// So many contacts away from a robot nothing that is awake falls asleep.
constexpr int kPushedContacts = 3;
// Farther apart than any two points of a contact; unit: m.
constexpr float kFar = 1e30F;

void check_number(double value, const std::string& key) {
  if (std::isfinite(value)) return;
  throw InputError({"", 0, key, "not a number that a motor can follow", "a finite number",
                    std::to_string(value), "look at what the controller computes"});
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

int World::Impl::add_robot(const RobotModel& model, const Pose& world_from_base) {
  const std::string key = "robots[" + std::to_string(robots.size()) + "]";
  validate(model, key);
  const int first_type = int(types.size()), first = int(data.bodies.size());
  for (const PieceType& type : make_link_types(model)) {
    shapes.push_back(compile_shape(type, key + "." + type.name));
    types.push_back(type);
  }
  NewPiece piece;
  piece.placement.world_from_body = {normalized(world_from_base.rotation),
                                     world_from_base.translation};
  piece.placement.fixed = model.tube.has_value();  // what grows is staked to the ground
  Tree tree = make_tree(make_assembly(model, first_type), piece);
  tree.driven = true;
  std::vector<double> starts;
  for (const RobotJoint& joint : model.joints) {
    if (joint.kind != JointKind::weld) starts.push_back(joint.start);
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    tree.links[i].belt_axis = model.links[i].belt_axis;
    tree.links[i].eversion_axis = model.links[i].eversion_axis;
  }
  data.robots.push_back({std::int32_t(data.trees.size()), first});
  robots.push_back(model);
  grown_robots.emplace_back();
  if (model.tube) {
    data.robots.back().laid = model.tube->start_links;
    tree = plant_tube(tree, *model.tube);
    starts.clear();
  }
  start_tree(tree, piece, starts);
  introduce(first);
  if (model.tube) {
    carry_stowed(data.robots.back(), model);
    wake_neighbours(first);
  }
  return int(data.robots.size()) - 1;
}

void World::Impl::set_command(int number, const RobotCommand& command) {
  const RobotModel& model = robots[std::size_t(number)];
  WorldRobot& robot = data.robots[std::size_t(number)];
  std::vector<TreeLink>& links = data.trees[robot.tree].links;
  if (links.empty()) return;  // lost
  const std::string key = "robots[" + std::to_string(number) + "]";
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
    TreeLink* link = find_link(robot, model.joints[i].child);
    if (link != nullptr) set_motor(model.joints[i], wanted, link->motor);
  }
  if (model.tube) {
    robot.curve_left = command.curve_left, robot.curve_up = command.curve_up;
    return set_tip(robot, model);
  }
  for (std::size_t i = 0; i < links.size(); ++i) {
    const double most = norm(model.links[i].belt_axis) > 0 ? model.links[i].belt_speed_limit : 0;
    const double wanted = i < command.belts.size() ? command.belts[i] : 0;
    links[i].belt_speed = std::clamp(wanted, -most, most);
  }
}

// What sleeps against an immovable base would not be found to overlap it.
void World::Impl::wake_neighbours(std::int32_t body) {
  for (const Pair& pair : data.pairs) {
    if (pair.body_a == body && pair.body_b != kGround) wake(pair.body_b);
    if (pair.body_b == body) wake(pair.body_a);
  }
}

// Of a link of the model; none: it has not grown.
TreeLink* World::Impl::find_link(const WorldRobot& robot, int link) {
  const Body& body = data.bodies[std::size_t(robot.first_body + link)];
  if (body.tree < 0) return nullptr;
  return &data.trees[body.tree].links[std::size_t(body.link)];
}

bool World::Impl::is_driven(std::int32_t body) const {
  if (body == kGround || data.bodies[body].tree < 0) return false;
  return data.trees[data.bodies[body].tree].driven;
}

// Whether one side is a robot that presses on the other, a movable piece.
bool World::Impl::touches_robot(const Contact& contact) const {
  if (data.robots.empty() || contact.body_b == kGround) return false;
  const bool a = is_driven(contact.body_a), b = is_driven(contact.body_b);
  if (a == b) return false;
  const Body& piece = data.bodies[a ? contact.body_b : contact.body_a];
  return contact.pressed > kRobotTouch * float(piece.mass * options.gravity * options.step);
}

// Falling asleep takes what speed is left: not from what a robot pushes, nor from what that pushes.
void World::Impl::stay_awake_near_robots() {
  if (data.robots.empty()) return;
  std::vector<std::uint8_t> ring(data.bodies.size(), 0);
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = is_driven(std::int32_t(i)) ? 1 : 0;
  for (int k = 1; k <= kPushedContacts; ++k) {
    for (std::int32_t index : active) {
      const Contact& contact = data.contacts[index];
      if (contact.body_b == kGround || contact.pressed <= 0) continue;
      std::uint8_t &a = ring[std::size_t(contact.body_a)], &b = ring[std::size_t(contact.body_b)];
      if (a == k && b == 0) b = std::uint8_t(k + 1);
      if (b == k && a == 0) a = std::uint8_t(k + 1);
    }
  }
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (ring[i] > 0) slept[i] = 0;
  }
}

bool World::Impl::is_of_robot(const Contact& contact, const WorldRobot& robot) const {
  if (data.bodies[contact.body_a].tree == robot.tree) return true;
  return contact.body_b != kGround && data.bodies[contact.body_b].tree == robot.tree;
}

void World::set_step(double step, int substeps) {
  Impl& w = *impl_;
  if (!(step >= 1e-3 && step <= 1.0 / 30 + 1e-12)) {
    throw InputError({"", 0, "step", "out of range", "1/1000 to 1/30 s", std::to_string(step), ""});
  }
  if (substeps < 1 || substeps > 64) {
    throw InputError(
        {"", 0, "substeps", "out of range", "1 to 64", std::to_string(substeps), ""});
  }
  const float longer = float(step / w.options.step);
  for (Body& body : w.data.bodies) {
    body.load *= longer;
    body.lost_support *= longer;
  }
  for (Contact& contact : w.data.contacts) contact.rest_pressed *= longer;
  for (Tie& tie : w.data.ties) tie.contact.rest_pressed *= longer;
  w.options.step = step;
  w.solver_settings.step = w.narrow_settings.step = float(step);
  w.solver_settings.substeps = substeps;
}

int World::add_robot(const RobotModel& model, const Pose& world_from_base) {
  return impl_->add_robot(model, world_from_base);
}
int World::robot_count() const { return int(impl_->data.robots.size()); }
int World::robot_piece(int robot) const {
  return impl_->data.robots[std::size_t(robot)].first_body;
}
const RobotModel& World::robot_model(int robot) const {
  return impl_->robots[std::size_t(robot)];
}
void World::set_command(int robot, const RobotCommand& command) {
  impl_->set_command(robot, command);
}

RobotState World::robot_state(int number) const {
  const Impl& w = *impl_;
  const WorldRobot& robot = w.data.robots[std::size_t(number)];
  const RobotModel& model = w.robots[std::size_t(number)];
  const TreeState state = w.simbody_trees.state(robot.tree);
  RobotState result;
  result.lost = w.data.trees[robot.tree].links.empty();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Body& body = w.data.bodies[robot.first_body + int(i)];
    RobotState::Link link;
    link.world_from_link = body.world_from_type();
    if (const TreeLink* found = impl_->find_link(robot, int(i))) {
      const TreeLink& from = *found;
      link.angular = from.angular;
      link.linear = from.linear +
                    cross(from.angular, link.world_from_link.translation -
                                            body.world_from_com.translation);
      link.contact_force = from.loads.contact_force;
      link.contact_moment = from.loads.contact_moment;
      link.belt_speed = from.belt_speed;
    }
    result.links.push_back(link);
  }
  for (const RobotJoint& of : model.joints) {
    RobotState::Joint joint;
    if (const TreeLink* found = impl_->find_link(robot, of.child)) {
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
    result.length = result.joints.back().position = w.tube_length(robot, model);
    result.tip_force = impl_->find_link(robot, int(model.lead()))->motor.effort;
  }
  return result;
}

std::vector<RobotContact> World::robot_contacts(int number) const {
  const Impl& w = *impl_;
  const WorldRobot& robot = w.data.robots[std::size_t(number)];
  std::vector<RobotContact> result;
  for (std::size_t i = 0; i < w.data.pairs.size(); ++i) {
    const Contact& contact = w.data.contacts[i];
    if (!w.data.pairs[i].live || !w.is_of_robot(contact, robot)) continue;
    const bool first = w.data.bodies[contact.body_a].tree == robot.tree;
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
    const Body& link = w.data.bodies[std::size_t(index)];
    RobotContact c;
    c.link = index - robot.first_body;
    c.piece = first ? contact.body_b : contact.body_a;
    c.point = link.world_from_com.translation + point;
    c.normal = Vec3(contact.normal) * (first ? -1.0 : 1.0);
    c.separation = double(separation);
    c.force = double(contact.pressed) / w.options.step;
    result.push_back(c);
  }
  std::sort(result.begin(), result.end(), [](const RobotContact& a, const RobotContact& b) {
    return std::tie(a.link, a.piece, a.point.x, a.point.y, a.point.z) <
           std::tie(b.link, b.piece, b.point.x, b.point.y, b.point.z);
  });
  return result;
}

}  // namespace rubble
