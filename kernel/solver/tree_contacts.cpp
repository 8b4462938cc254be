#include "kernel/solver/tree_contacts.h"

#include <algorithm>
#include <cmath>

#include "kernel/solver/contact_solver.h"

namespace rubble {
namespace {

// Below this speed of its mean particle, what pushes undo of a tree's speed is dropped.
constexpr double kSlowSpeed = 0.2;  // unit: m/s

double shrink_to(double limit, double length2) {
  return length2 > limit * limit ? limit / std::sqrt(length2) : 1;
}

}  // namespace

void TreeContacts::load(const Item& item, const PaddedMotion* free, bool displacements,
                        View& view) const {
  for (int s = 0; s < 2; ++s) {
    const Side& side = item.sides[s];
    view.x[s] = view.local[s];
    if (side.tree >= 0) {
      TreeMotion& motion = (*trees_.motions)[std::size_t(side.tree)];
      view.x[s] = displacements ? motion.moved.data() : motion.u();
    } else if (side.number >= 0) {
      const PaddedMotion& m = free[side.number];
      for (int i = 0; i < 3; ++i) {
        view.local[s][i] = double(m.linear[i]), view.local[s][3 + i] = double(m.angular[i]);
      }
    }
  }
}

void TreeContacts::save(const Item& item, const View& view, PaddedMotion* free) {
  for (int s = 0; s < 2; ++s) {
    if (item.sides[s].number < 0) continue;
    PaddedMotion& m = free[item.sides[s].number];
    const double* x = view.local[s];
    m.linear = Wide{float(x[0]), float(x[1]), float(x[2]), 0};
    m.angular = Wide{float(x[3]), float(x[4]), float(x[5]), 0};
  }
}

double TreeContacts::relative(const Item& item, const Row& row, const View& view) const {
  double sum = 0;
  const double* at = coefficients_.data() + row.first;
  for (int s = 0; s < 2; ++s) {
    for (int k = 0; k < item.sides[s].size; ++k) sum += at[k] * view.x[s][k];
    at += 2 * item.sides[s].size;
  }
  return sum;
}

void TreeContacts::apply(const Item& item, const Row& row, double impulse, View& view) const {
  const double* at = coefficients_.data() + row.first;
  for (int s = 0; s < 2; ++s) {
    const int n = item.sides[s].size;
    for (int k = 0; k < n; ++k) view.x[s][k] += at[n + k] * impulse;
    at += 2 * n;
  }
}

void TreeContacts::push(const Item& item, const Row& row, double impulse, View& view) const {
  const double* at = coefficients_.data() + row.first;
  for (int s = 0; s < 2; ++s) {
    const int n = item.sides[s].size;
    const double weighted = impulse * item.sides[s].push_weight;
    for (int k = 0; k < n; ++k) view.x[s][k] += at[n + k] * weighted;
    at += 2 * n;
  }
}

void TreeContacts::solve_friction(Item& item, double limit, View& view) {
  double wanted[2];
  for (int t = 0; t < 2; ++t) {
    const Row& row = item.slide[t];
    wanted[t] = row.impulse - row.mass * relative(item, row, view);
  }
  const double shrink = shrink_to(limit, wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  for (int t = 0; t < 2; ++t) {
    Row& row = item.slide[t];
    const double next = wanted[t] * shrink;
    apply(item, row, next - row.impulse, view);
    row.impulse = next;
  }
  Row& twist = item.twist;
  const double most = limit * item.radius;
  const double free = twist.impulse - twist.mass * relative(item, twist, view);
  const double next = std::min(most, std::max(-most, free));
  apply(item, twist, next - twist.impulse, view);
  twist.impulse = next;
}

// As carry_over() of contact_rows.h; the totals are kept for the loads of joints.
void TreeContacts::carry_over(Item& item, double weight) {
  double carried = 0;
  for (int i = 0; i < item.rows; ++i) {
    NormalRow& n = rows_[item.first_row + std::size_t(i)];
    n.row.total += n.row.impulse;
    n.row.impulse = std::min(n.row.impulse, n.carried + n.carried + n.row.mass * weight);
    n.carried = n.row.impulse;
    carried += n.row.impulse;
  }
  if (item.contact < 0) return;
  const double limit = item.friction * carried, most = limit * item.radius;
  for (Row* row : {&item.slide[0], &item.slide[1], &item.twist}) row->total += row->impulse;
  const double s0 = item.slide[0].impulse, s1 = item.slide[1].impulse;
  const double shrink = shrink_to(limit, s0 * s0 + s1 * s1);
  item.slide[0].impulse = s0 * shrink;
  item.slide[1].impulse = s1 * shrink;
  item.twist.impulse = std::min(most, std::max(-most, item.twist.impulse));
}

void TreeContacts::begin_substep(PaddedMotion* speeds, bool first, double weight) {
  for (std::int32_t tree : trees_.trees) (*trees_.motions)[std::size_t(tree)].add_forces();
  for (Item& item : items_) {
    if (!first) carry_over(item, weight);
    View view;
    load(item, speeds, false, view);
    if (item.contact >= 0) {
      for (const Row* row : {&item.slide[0], &item.slide[1], &item.twist}) {
        apply(item, *row, row->impulse, view);
      }
    }
    for (int i = 0; i < item.rows; ++i) {
      const Row& row = rows_[item.first_row + std::size_t(i)].row;
      apply(item, row, row.impulse, view);
    }
    save(item, view, speeds);
  }
}

void TreeContacts::solve_normals(Item& item, double per_substep, const View& moved, View& view) {
  for (int i = 0; i < item.rows; ++i) {
    NormalRow& n = rows_[item.first_row + std::size_t(i)];
    const double gap = n.gap + relative(item, n.row, moved);
    const double allowed = std::max(0.0, gap) * per_substep;
    const double speed = relative(item, n.row, view);
    const double next = std::max(0.0, n.row.impulse - n.row.mass * (speed + allowed));
    apply(item, n.row, next - n.row.impulse, view);
    n.row.impulse = next;
  }
}

double TreeContacts::sum_impulses(const Item& item) const {
  double sum = 0;
  for (int i = 0; i < item.rows; ++i) sum += rows_[item.first_row + std::size_t(i)].row.impulse;
  return sum;
}

void TreeContacts::solve_velocities(double per_substep, const PaddedMotion* moved,
                                    PaddedMotion* speeds) {
  for (Item& item : items_) {
    View view, displaced;
    load(item, speeds, false, view);
    load(item, moved, true, displaced);
    double pressed = sum_impulses(item);
    for (int round = 0; round < kMostRounds; ++round) {
      if (item.contact >= 0) solve_friction(item, item.friction * pressed, view);
      solve_normals(item, per_substep, displaced, view);
      const double before = pressed;
      pressed = sum_impulses(item);
      if (item.contact < 0 || pressed <= before + before * double(kImpactRise)) break;
    }
    save(item, view, speeds);
  }
}

void TreeContacts::end_substep() {
  for (std::int32_t tree : trees_.trees) (*trees_.motions)[std::size_t(tree)].move();
}

void TreeContacts::end_substeps(double weight) {
  for (Item& item : items_) carry_over(item, weight);
}

bool TreeContacts::begin_pushes(const SolverSettings& settings, const PaddedMotion* moved) {
  for (std::int32_t tree : trees_.trees) {
    TreeMotion& motion = (*trees_.motions)[std::size_t(tree)];
    motion.before_push = motion.moved;
  }
  bool any = false;
  for (Item& item : items_) {
    View view;
    load(item, moved, true, view);
    for (int i = 0; i < item.rows; ++i) {
      NormalRow& n = rows_[item.first_row + std::size_t(i)];
      const double done = relative(item, n.row, view);
      const double gap = n.gap + done + double(settings.slop);
      const double wanted = gap < 0 ? std::min(-gap * double(settings.position_fraction),
                                               double(settings.maximum_push))
                                    : -gap;
      n.push_target = done + wanted;
      n.push = 0;
      any = any || wanted > 0;
    }
  }
  return any;
}

void TreeContacts::solve_pushes(PaddedMotion* moved) {
  for (Item& item : items_) {
    View view;
    load(item, moved, true, view);
    for (int i = 0; i < item.rows; ++i) {
      NormalRow& n = rows_[item.first_row + std::size_t(i)];
      const double done = relative(item, n.row, view);
      const double next = std::max(0.0, n.push + n.push_mass * (n.push_target - done));
      push(item, n.row, next - n.push, view);
      n.push = next;
    }
    save(item, view, moved);
  }
}

// As for free pieces, in the metric of the tree's kinetic energy.
void TreeContacts::drop_opposed_speeds(double step) {
  for (std::int32_t tree : trees_.trees) {
    (*trees_.motions)[std::size_t(tree)].drop_opposed_speed(step, kSlowSpeed);
  }
}

void TreeContacts::store(const std::vector<Body>& bodies, std::vector<Contact>& contacts) {
  for (const Item& item : items_) {
    if (item.contact < 0) continue;
    Contact& contact = contacts[std::size_t(item.contact)];
    double pressed = 0;
    Vec3 torque_a, torque_b, force;
    const auto add = [&](const Vec3& f, const Vec3& from_a, const Vec3& from_b) {
      force += f, torque_a += cross(from_a, f), torque_b += cross(from_b, f);
    };
    for (int i = 0; i < item.rows; ++i) {
      const Row& row = rows_[item.first_row + std::size_t(i)].row;
      ContactPoint& p = contact.points[i];
      p.normal_impulse = float(row.impulse);
      pressed += row.total;
      add(item.normal * row.total, Vec3(p.from_a), Vec3(p.from_b));
    }
    Vec3 friction;
    for (int t = 0; t < 2; ++t) {
      friction += item.tangents[t] * item.slide[t].impulse;
      add(item.tangents[t] * item.slide[t].total, item.middle_a, item.middle_b);
    }
    const Vec3 twist = item.normal * item.twist.total;
    torque_a += twist, torque_b += twist;
    contact.friction_impulse = Vec3f(friction);
    contact.twist_impulse = float(item.twist.impulse);
    contact.pressed = float(pressed);
    give(bodies, contact.body_a, torque_a * -1.0, force * -1.0);
    give(bodies, contact.body_b, torque_b, force);
  }
}

void TreeContacts::give(const std::vector<Body>& bodies, std::int32_t index, const Vec3& torque,
                        const Vec3& force) {
  if (index == kGround) return;
  const Body& body = bodies[std::size_t(index)];
  if (body.awake && body.tree >= 0) {
    (*trees_.motions)[std::size_t(body.tree)].add_impulse(body.link, torque, force);
  }
}

}  // namespace rubble
