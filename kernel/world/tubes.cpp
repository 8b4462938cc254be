#include "kernel/world/tubes.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// So far a tip that is pushed gives way before the wall holds it: less than any contact sinks in; unit: m.
constexpr double kTipSlack = 0.002;

// The first `laid` links of a grown tube, with base and tip.
Tree cut_tube(const Tree& grown, std::int32_t laid) {
  Tree tree = grown;
  const std::int32_t all = std::int32_t(grown.links.size()) - 2;
  tree.links.erase(tree.links.begin() + 1 + laid, tree.links.end() - 1);
  TreeLink& tip = tree.links.back();
  tip.parent = laid;
  if (laid < all) tip.upper = kNever;  // its next link is laid before it goes too far
  if (laid % 2 == 1) tree.links[std::size_t(laid)].wrinkles_with = -1;
  number_coordinates(tree);
  return tree;
}

// The same tube with a link more or less, which goes on as it was.
Tree cut_anew(const Tree& grown, std::int32_t laid, const Tree& old) {
  Tree tree = cut_tube(grown, laid);
  for (std::size_t i = 0; i < tree.links.size(); ++i) {
    const bool tip = i + 1 == tree.links.size();
    if (!tip && i + 1 >= old.links.size()) continue;  // the new one
    TreeLink& to = tree.links[i];
    const TreeLink shape = to;
    to = tip ? old.links.back() : old.links[i];
    to.parent = shape.parent;
    to.first_q = shape.first_q, to.first_u = shape.first_u;
    to.upper = shape.upper;
    to.wrinkles_with = shape.wrinkles_with;
  }
  return tree;
}

// The reel winds back.
bool retracts(const Tree& tree) { return tree.links.back().motor.speed < 0; }

double mass_of(const Tree& tree, const std::vector<Body>& bodies) {
  double mass = 0;
  for (const TreeLink& link : tree.links) mass += bodies[std::size_t(link.body)].mass;
  return mass;
}

// Of all bends; those of a section at right angles to each other.
double calc_turning(const Tree& tree, const TreeState& state) {
  double sum = 0;
  for (std::size_t i = 1; i + 1 < tree.links.size(); i += 2) {
    const double x = state.q[std::size_t(tree.links[i].first_q)];
    const bool pair = i + 2 < tree.links.size();
    const double y = pair ? state.q[std::size_t(tree.links[i + 1].first_q)] : 0;
    sum += std::sqrt(x * x + y * y);
  }
  return sum;
}

}  // namespace

Tree Tubes::plant(const Tree& all, const EvertingTube& tube) {
  Tree grown = all;
  grown.tube = true;
  for (std::int32_t i = 1; i <= tube.links; ++i) {
    TreeLink& link = grown.links[std::size_t(i)];
    // Each hinge bends for two links; those of the first section for the half of that which is outside.
    link.stiffness = tube.bending_stiffness() / tube.link_length / (i <= 2 ? 1 : 2);
    link.damping = link.stiffness * tube.damping_time;
    link.wrinkling = tube.wrinkling_moment();
    link.wrinkles_with = i % 2 == 0 ? i - 1 : i < tube.links ? i + 1 : -1;
  }
  TreeLink& tip = grown.links.back();
  tip.damping = tube.speed_loss();
  tip.upper = tube.link_length;
  types_.grown_robots.back() = grown;
  for (std::int32_t i = tube.start_links + 1; i <= tube.links; ++i) {
    stow(data_.bodies[std::size_t(grown.links[std::size_t(i)].body)]);
  }
  Tree tree = cut_tube(grown, tube.start_links);
  for (std::size_t i = 1; i < tree.links.size(); ++i) {
    data_.bodies[std::size_t(tree.links[i].body)].link = std::int32_t(i);
  }
  tree.mass = mass_of(tree, data_.bodies);
  return tree;
}

// A link that has not grown: nothing meets it, and it weighs nothing.
void Tubes::stow(Body& body) {
  body.tree = body.link = -1;
  body.mass = 0;
  body.inverse_mass = 0;
  body.inverse_inertia_local = body.inverse_inertia = {};
  body.inertia = {};
  body.linear = body.angular = {};
  body.awake = false;
  body.collider_count = 0;
}

void Tubes::grow() {
  for (std::size_t i = 0; i < data_.robots.size(); ++i) {
    const RobotModel& model = types_.robots[i];
    WorldRobot& robot = data_.robots[i];
    if (!model.tube || data_.trees[robot.tree].links.empty()) continue;
    if (retracts(data_.trees[robot.tree])) {
      wind_back(robot, *model.tube);
      if (robot.reached <= 0 && robot.laid > model.tube->start_links)
        take_link(robot, model, types_.grown_robots[i]);
      set_tip(robot, model);
      carry_stowed(robot, model);
      continue;
    }
    steer_tip(robot, *model.tube);
    if (robot.reached >= model.tube->link_length && robot.laid < model.tube->links) {
      lay_link(robot, model, types_.grown_robots[i]);
    }
    set_tip(robot, model);
    carry_stowed(robot, model);
  }
}

// The hinge behind the tip bends by the wanted curvature as the tip moves on, for two links.
void Tubes::steer_tip(WorldRobot& robot, const EvertingTube& tube) {
  Tree& tree = data_.trees[robot.tree];
  const double at = simbody_.state(robot.tree).q[std::size_t(tree.links.back().first_q)];
  if (at <= robot.reached) return;
  TreeLink& link = tree.links[std::size_t(robot.laid)];
  // Hinges turn about Y and Z in turn; a positive angle about Y bends down.
  const double curvature = robot.laid % 2 == 1 ? -robot.curve_up : robot.curve_left;
  const double grown = std::min(at, tube.link_length) - std::min(robot.reached, tube.link_length);
  link.rest += 2 * curvature * grown;
  robot.reached = at;
}

// The inverse: when the tip has passed the last link, that is in line with the one before it.
void Tubes::wind_back(WorldRobot& robot, const EvertingTube& tube) {
  Tree& tree = data_.trees[robot.tree];
  const double at = simbody_.state(robot.tree).q[std::size_t(tree.links.back().first_q)];
  if (at >= robot.reached) return;
  const double left = std::max(0.0, at);
  if (robot.reached > 0 && left < tube.link_length)
    tree.links[std::size_t(robot.laid)].rest *= left / std::min(robot.reached, tube.link_length);
  robot.reached = robot.laid > tube.start_links ? at : left;
}

void Tubes::lay_link(WorldRobot& robot, const RobotModel& model, const Tree& grown) {
  const double length = model.tube->link_length;
  const Tree& old = data_.trees[robot.tree];
  const TreeState was = simbody_.state(robot.tree);
  const std::int32_t laid = ++robot.laid;
  Tree tree = cut_anew(grown, laid, old);
  TreeState state{std::vector<double>(std::size_t(tree.q_count), 0),
                  std::vector<double>(std::size_t(tree.u_count), 0)};
  std::copy(was.q.begin(), was.q.end() - 1, state.q.begin());
  std::copy(was.u.begin(), was.u.end() - 1, state.u.begin());
  robot.reached -= length;
  state.q.back() = was.q.back() - length;
  state.u.back() = was.u.back();

  const std::int32_t index = robot.first_body + laid;
  Body& body = data_.bodies[std::size_t(index)];
  bodies_.weigh(body);
  body.collider_count = std::int32_t(body.shape->parts.size());
  body.awake = true;
  for (const std::int32_t link : {laid, laid + 1}) {
    Body& of = data_.bodies[std::size_t(tree.links[std::size_t(link)].body)];
    of.tree = robot.tree;
    of.link = link;
  }
  tree.mass = mass_of(tree, data_.bodies);
  trees_.replace(robot.tree, tree, state);
  trees_.mirror_state(robot.tree);
  body.still_pose = body.loose_pose = body.later_pose = body.world_from_com;
  bodies_.each_collider(body, [&](int i) { data_.broad.place(i, BroadPhase::enlarge(data_.colliders[std::size_t(i)].box, {})); });
  pairs_.find_first(index);
}

void Tubes::take_link(WorldRobot& robot, const RobotModel& model, const Tree& grown) {
  const double length = model.tube->link_length;
  const TreeState was = simbody_.state(robot.tree);
  const std::int32_t index = robot.first_body + robot.laid;
  Tree tree = cut_anew(grown, --robot.laid, data_.trees[robot.tree]);
  TreeState state{std::vector<double>(was.q.begin(), was.q.end() - 1),
                  std::vector<double>(was.u.begin(), was.u.end() - 1)};
  robot.reached += length;
  state.q.back() = was.q.back() + length;
  state.u.back() = was.u.back();

  Body& body = data_.bodies[std::size_t(index)];
  pairs_.remove_if([&](const Pair& pair) { return pair.body_a == index || pair.body_b == index; });
  bodies_.each_collider(body, [&](int i) { data_.broad.remove(i); });
  stow(body);
  data_.bodies[std::size_t(tree.links.back().body)].link = robot.laid + 1;
  tree.mass = mass_of(tree, data_.bodies);
  trees_.replace(robot.tree, tree, state);
  // The tip comes back over links that it could touch from afar.
  pairs_.remove_if(
      [&](const Pair& pair) { return pair.body_b != kGround && pairs_.are_joined(pair.body_a, pair.body_b); });
  trees_.mirror_state(robot.tree);
}

void Tubes::set_tip(const WorldRobot& robot, const RobotModel& model) {
  Tree& tree = data_.trees[robot.tree];
  const TreeState state = simbody_.state(robot.tree);
  TreeLink& tip = tree.links.back();
  tip.motor.effort = model.tube->tip_force(calc_tube_length(robot, model), calc_turning(tree, state));
  const bool more = robot.laid > model.tube->start_links;
  tip.lower = !retracts(tree) ? std::max(0.0, robot.reached - kTipSlack) : more ? -model.tube->link_length : 0;
  tip.belt_speed = state.u[std::size_t(tip.first_u)];
}

void Tubes::carry_stowed(const WorldRobot& robot, const RobotModel& model) {
  const Body& tip = data_.bodies[std::size_t(robot.first_body + model.tube->links + 1)];
  const Pose at = tip.world_from_type() * Pose{{}, {-model.tube->link_length, 0, 0}};
  for (std::int32_t i = robot.laid + 1; i <= model.tube->links; ++i) {
    Body& body = data_.bodies[std::size_t(robot.first_body + i)];
    body.world_from_com = {at.rotation, at * body.com_in_type};
    body.rotation = tip.rotation;
  }
}

double calc_tube_length(const WorldRobot& robot, const RobotModel& model) {
  return robot.laid * model.tube->link_length + robot.reached;
}

}  // namespace rubble
