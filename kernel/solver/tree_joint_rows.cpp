// Rows of a tree's own joints: stops, dry friction, loops.
#include <algorithm>

#include "kernel/multibody/joints/joint.h"
#include "kernel/solver/contact_solver.h"
#include "kernel/solver/tree_contacts.h"

namespace rubble {

void TreeContacts::add_stops(std::int32_t tree) {
  const TreeMotion& m = motion(tree);
  for (std::size_t link = 1; link < m.tree().links.size(); ++link) {
    const TreeLink& l = m.tree().links[link];
    if (l.lower == -kNever && l.upper == kNever) continue;
    JointStop stops[2];
    const double* q = m.q().data() + l.first_q;
    const int count = joint_of(l.mobility).find_stops(l, q, m.stop_margin(l), stops);
    for (int i = 0; i < count; ++i) {
      Item item;
      item.kind = Kind::stop;
      item.sides[0] = link_side(tree, l.parent);
      item.sides[1] = link_side(tree, std::int32_t(link));
      couple_sides(item);
      item.first_row = rows_.size();
      item.rows = 1;
      Spatial force;
      for (int k = 0; k < speed_count(l.mobility); ++k) {
        force.add_scaled(m.pose().duals[std::size_t(l.first_u + k)], stops[i].direction[k]);
      }
      NormalRow n;
      n.row = make_row(item, force * -1.0, force);
      n.gap = stops[i].gap;
      n.push_mass = calc_push_mass(item, n.row);
      rows_.push_back(n);
      items_.push_back(item);
    }
  }
}

void TreeContacts::add_dry_friction(std::int32_t tree) {
  const TreeMotion& m = motion(tree);
  for (std::size_t link = 1; link < m.tree().links.size(); ++link) {
    const TreeLink& l = m.tree().links[link];
    if (l.friction <= 0 || speed_count(l.mobility) == 0) continue;
    Item item;
    item.kind = Kind::dry;
    item.source = std::int32_t(link);
    item.sides[0] = link_side(tree, l.parent);
    item.sides[1] = link_side(tree, std::int32_t(link));
    couple_sides(item);
    item.friction = l.friction * substep_;
    item.first_row = rows_.size();
    item.rows = speed_count(l.mobility);
    for (int k = 0; k < item.rows; ++k) {
      const Spatial& force = m.pose().duals[std::size_t(l.first_u + k)];
      NormalRow n;
      n.row = make_row(item, force * -1.0, force);
      n.row.impulse = l.friction_impulse[k];
      rows_.push_back(n);
    }
    items_.push_back(item);
  }
}

void TreeContacts::add_motors(std::int32_t tree) {
  const TreeMotion& m = motion(tree);
  for (std::size_t link = 1; link < m.tree().links.size(); ++link) {
    const TreeLink& l = m.tree().links[link];
    if (!l.motor.on || speed_count(l.mobility) != 1) continue;
    Item item;
    item.kind = Kind::motor;
    item.source = std::int32_t(link);
    item.sides[0] = link_side(tree, l.parent);
    item.sides[1] = link_side(tree, std::int32_t(link));
    couple_sides(item);
    item.friction = l.motor.effort * substep_;
    item.first_row = rows_.size();
    item.rows = 1;
    const Spatial& force = m.pose().duals[std::size_t(l.first_u)];
    NormalRow n;
    n.row = make_row(item, force * -1.0, force);
    n.row.impulse = l.motor.impulse;
    rows_.push_back(n);
    items_.push_back(item);
  }
}

// The motor's law at the substep's end, where it will have turned by h u more:
//   impulse = h (k (position - q - h u) + c (speed - u) + torque) = wanted - resistance u
// On its way to a position it neither pushes beyond its speed limit nor gives way faster, as far as its effort goes. A
// torque of its own does not drive it beyond the limit; what turns it faster is not braked.
void TreeContacts::solve_motor(Item& item, View& view) {
  const TreeMotion& m = motion(item.sides[1].tree);
  const TreeLink& link = m.tree().links[std::size_t(item.source)];
  const TreeMotor& motor = link.motor;
  Row& row = rows_[item.first_row].row;
  if (row.mass == 0) return;
  const double q = m.q()[std::size_t(link.first_q)], h = substep_;
  const double resistance = h * (motor.damping + h * motor.stiffness);
  const double wanted = h * (motor.stiffness * (motor.position - q) + motor.damping * motor.speed + motor.torque);
  const double speed = row.relative<2>(view);
  const double left = wanted - resistance * speed - row.impulse;
  double next = row.impulse + left / (1 + resistance / row.mass);
  if (motor.speed_limit > 0) {
    const double least = row.impulse + (-motor.speed_limit - speed) * row.mass;
    const double most = row.impulse + (motor.speed_limit - speed) * row.mass;
    if (motor.stiffness > 0)
      next = std::clamp(next, least, most);
    else if (motor.damping == 0)
      next = std::clamp(next, std::min(least, 0.0), std::max(most, 0.0));
  }
  next = std::clamp(next, -item.friction, item.friction);
  row.apply<2>(next - row.impulse, view);
  row.impulse = next;
}

void TreeContacts::store_motor(const Item& item) {
  TreeMotion& m = motion(item.sides[1].tree);
  TreeLink& link = m.tree().links[std::size_t(item.source)];
  const Row& row = rows_[item.first_row].row;
  link.motor.impulse = row.impulse;
  link.motor.mean = row.total / m.step();
}

// What a loop holds: the joint's frame in B along and about the axes of that in A.
void TreeContacts::add_loops(const std::vector<Body>& bodies, std::int32_t tree) {
  const TreeMotion& m = motion(tree);
  for (std::size_t i = 0; i < m.tree().loops.size(); ++i) {
    const TreeLoop& loop = m.tree().loops[i];
    const Joint& joint = joint_of(loop.mobility);
    Item item;
    item.kind = Kind::loop;
    item.source = std::int32_t(i);
    item.sides[0] = link_side(tree, loop.link_a);
    item.sides[1] = link_side(tree, loop.link_b);
    couple_sides(item);
    item.first_row = rows_.size();
    const auto frame = [&](std::int32_t link, const Pose& from_joint) {
      return bodies[std::size_t(m.tree().links[std::size_t(link)].body)].world_from_com *
             from_joint;
    };
    const Pose a = frame(loop.link_a, loop.a_from_joint), b = frame(loop.link_b, loop.b_from_joint);
    const Mat3 axes = a.rotation.matrix();
    const Vec3 apart = b.translation - a.translation;
    const Vec3 point = b.translation - m.pose().reference;
    Quat turn = b.rotation * a.rotation.conjugate();  // in the world
    if (turn.w < 0) turn = {-turn.w, -turn.x, -turn.y, -turn.z};
    const Vec3 twice{2 * turn.x, 2 * turn.y, 2 * turn.z};
    const auto add = [&](const Spatial& force, double gap, double impulse) {
      NormalRow n;
      n.row = make_row(item, force * -1.0, force);
      n.row.impulse = impulse;
      n.gap = gap;
      n.push_mass = calc_push_mass(item, n.row);
      rows_.push_back(n);
      ++item.rows;
    };
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = axes.column(k);
      if (joint.holds_travel(k)) {
        add(force_at(point, axis), dot(axis, apart), loop.force_impulse[k]);
      }
    }
    for (int k = 0; k < 3; ++k) {
      const Vec3 axis = axes.column(k);
      if (joint.holds_turn(k)) add({axis, {}}, dot(axis, twice), loop.torque_impulse[k]);
    }
    items_.push_back(item);
  }
}

}  // namespace rubble
