#include "kernel/contact_solver.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// Two unit vectors across a normal; the same for the same normal.
void make_tangents(const Vec3f& n, Vec3f tangent[2]) {
  tangent[0] = std::abs(n.x) < 0.57735F ? normalized(cross(n, Vec3f{1, 0, 0}))
                                        : normalized(cross(n, Vec3f{0, 1, 0}));
  tangent[1] = cross(n, tangent[0]);
}

float relative_speed(const Vec3f& direction, const Vec3f& arm_a, const Vec3f& arm_b,
                     const Motion& a, const Motion& b) {
  return dot(direction, b.linear - a.linear) + dot(arm_b, b.angular) - dot(arm_a, a.angular);
}

}  // namespace

void ContactSolver::prepare(const SolverSettings& settings, const std::vector<Body>& bodies,
                            const Contact& contact, int index, Constraint& c) const {
  static const Body kImmovable{};
  const Body& a = bodies[contact.body_a];
  const Body& b = contact.body_b == kGround ? kImmovable : bodies[contact.body_b];
  c.contact = index;
  c.a = contact.body_a;
  c.b = contact.body_b == kGround ? contact.body_a : contact.body_b;
  const Mat3f none{};
  const Mat3f& inertia_a = a.awake ? a.inverse_inertia : none;
  const Mat3f& inertia_b = b.awake ? b.inverse_inertia : none;
  c.inverse_mass_a = a.awake ? a.inverse_mass : 0;
  c.inverse_mass_b = b.awake ? b.inverse_mass : 0;
  c.friction = contact.friction;
  c.normal = contact.normal;
  c.count = contact.count;
  make_tangents(c.normal, c.tangent);

  const auto make_row = [&](Row& row, const Vec3f& direction, const Vec3f& from_a,
                            const Vec3f& from_b) {
    row.arm_a = cross(from_a, direction);
    row.arm_b = cross(from_b, direction);
    row.turn_a = inertia_a * row.arm_a;
    row.turn_b = inertia_b * row.arm_b;
    row.mass = 1 / (c.inverse_mass_a + c.inverse_mass_b + dot(row.arm_a, row.turn_a) +
                    dot(row.arm_b, row.turn_b));
  };
  Vec3f middle_a, middle_b;
  for (int i = 0; i < c.count; ++i) {
    const ContactPoint& p = contact.points[i];
    make_row(c.points[i], c.normal, p.from_a, p.from_b);
    c.points[i].gap = p.separation - settings.rest_gap;
    c.points[i].impulse = c.points[i].carried = p.normal_impulse;
    middle_a += p.from_a;
    middle_b += p.from_b;
  }
  const float share = 1.0F / float(c.count);
  middle_a *= share;
  middle_b *= share;
  for (int t = 0; t < 2; ++t) {
    make_row(c.slide[t], c.tangent[t], middle_a, middle_b);
    c.slide[t].impulse = dot(c.tangent[t], contact.friction_impulse);
  }
  c.pressed = 0;
  c.radius = 0;
  for (int i = 0; i < c.count; ++i) c.radius += norm(contact.points[i].from_a - middle_a);
  c.radius *= share;
  c.twist_a = inertia_a * c.normal;
  c.twist_b = inertia_b * c.normal;
  const float twist = dot(c.normal, c.twist_a + c.twist_b);
  c.twist_mass = c.count > 1 && twist > 0 ? 1 / twist : 0;
  c.twist_impulse = contact.twist_impulse;
}

void ContactSolver::warm_start(const Constraint& c, std::vector<Motion>& v) {
  Vec3f push = c.tangent[0] * c.slide[0].impulse + c.tangent[1] * c.slide[1].impulse;
  Vec3f turn_a = c.twist_a * c.twist_impulse, turn_b = c.twist_b * c.twist_impulse;
  for (int t = 0; t < 2; ++t) {
    turn_a += c.slide[t].turn_a * c.slide[t].impulse;
    turn_b += c.slide[t].turn_b * c.slide[t].impulse;
  }
  for (int i = 0; i < c.count; ++i) {
    push += c.normal * c.points[i].impulse;
    turn_a += c.points[i].turn_a * c.points[i].impulse;
    turn_b += c.points[i].turn_b * c.points[i].impulse;
  }
  v[c.a].linear -= push * c.inverse_mass_a;
  v[c.a].angular -= turn_a;
  v[c.b].linear += push * c.inverse_mass_b;
  v[c.b].angular += turn_b;
}

// What the next substep starts from. An impulse may double from one substep to the next, and grow by
// its own weight: loads build up fast, but the impulse of an impact is not given twice.
void ContactSolver::carry_over(Constraint& c, float weight) {
  float pressed = 0;
  for (int i = 0; i < c.count; ++i) {
    Row& row = c.points[i];
    c.pressed += row.impulse;
    row.impulse = std::min(row.impulse, 2 * row.carried + row.mass * weight);
    row.carried = row.impulse;
    pressed += row.impulse;
  }
  const float limit = c.friction * pressed;
  const float s0 = c.slide[0].impulse, s1 = c.slide[1].impulse;
  const float length2 = s0 * s0 + s1 * s1;
  if (length2 > limit * limit) {
    const float shrink = limit / std::sqrt(length2);
    c.slide[0].impulse *= shrink;
    c.slide[1].impulse *= shrink;
  }
  const float most = limit * c.radius;
  c.twist_impulse = std::min(most, std::max(-most, c.twist_impulse));
}

void ContactSolver::solve_velocity(Constraint& c, float per_substep, const std::vector<Motion>& d,
                                   std::vector<Motion>& v) {
  Motion a = v[c.a];
  Motion b = c.a == c.b ? Motion{} : v[c.b];
  const Motion& moved_a = d[c.a];
  const Motion moved_b = c.a == c.b ? Motion{} : d[c.b];
  const auto apply = [&](const Row& row, const Vec3f& direction, float impulse) {
    a.linear -= direction * (impulse * c.inverse_mass_a);
    a.angular -= row.turn_a * impulse;
    b.linear += direction * (impulse * c.inverse_mass_b);
    b.angular += row.turn_b * impulse;
  };
  float pressed = 0;
  for (int i = 0; i < c.count; ++i) pressed += c.points[i].impulse;

  // Friction first, against the normal impulses so far; the normals have the last word.
  const float limit = c.friction * pressed;
  float wanted[2];
  for (int t = 0; t < 2; ++t) {
    const Row& row = c.slide[t];
    const float speed = relative_speed(c.tangent[t], row.arm_a, row.arm_b, a, b);
    wanted[t] = row.impulse - row.mass * speed;
  }
  const float length2 = wanted[0] * wanted[0] + wanted[1] * wanted[1];
  const float shrink = length2 > limit * limit ? limit / std::sqrt(length2) : 1.0F;
  for (int t = 0; t < 2; ++t) {
    const float next = wanted[t] * shrink;
    apply(c.slide[t], c.tangent[t], next - c.slide[t].impulse);
    c.slide[t].impulse = next;
  }
  if (c.twist_mass > 0) {
    const float most = limit * c.radius;
    const float speed = dot(c.normal, b.angular - a.angular);
    const float next = std::min(most, std::max(-most, c.twist_impulse - c.twist_mass * speed));
    const float change = next - c.twist_impulse;
    a.angular -= c.twist_a * change;
    b.angular += c.twist_b * change;
    c.twist_impulse = next;
  }
  for (int i = 0; i < c.count; ++i) {
    Row& row = c.points[i];
    const float speed = relative_speed(c.normal, row.arm_a, row.arm_b, a, b);
    // A point that is still apart may close its gap within the substep.
    const float gap = row.gap + relative_speed(c.normal, row.arm_a, row.arm_b, moved_a, moved_b);
    const float allowed = std::max(0.0F, gap) * per_substep;
    const float next = std::max(0.0F, row.impulse - row.mass * (speed + allowed));
    apply(row, c.normal, next - row.impulse);
    row.impulse = next;
  }
  v[c.a] = a;
  if (c.a != c.b) v[c.b] = b;
}

// Works on displacements: n . (d_b - d_a) >= target for every point, by pushing only. All movable
// bodies count as equally heavy, so that a light bar is cleared from under a heavy slab as fast as
// any other pair.
void ContactSolver::solve_positions(const SolverSettings& settings,
                                    const std::vector<Body>& bodies,
                                    std::vector<Motion>& displacements) {
  pushes_.clear();
  float worst = 0;
  for (const Constraint& c : constraints_) {
    const Motion b = c.a == c.b ? Motion{} : displacements[c.b];
    const float mass_a = c.inverse_mass_a > 0 ? float(bodies[c.a].mass) : 0;
    const float mass_b = c.inverse_mass_b > 0 ? float(bodies[c.b].mass) : 0;
    for (int i = 0; i < c.count; ++i) {
      const Row& row = c.points[i];
      const float moved = relative_speed(c.normal, row.arm_a, row.arm_b, displacements[c.a], b);
      const float gap = row.gap + moved + settings.slop;
      PushRow push;
      push.mass = 1 / ((mass_a > 0 ? 1.0F : 0.0F) + (mass_b > 0 ? 1.0F : 0.0F) +
                       mass_a * dot(row.arm_a, row.turn_a) + mass_b * dot(row.arm_b, row.turn_b));
      const float wanted =
          gap < 0 ? std::min(-gap * settings.position_fraction, settings.maximum_push) : -gap;
      push.target = moved + wanted;
      worst = std::max(worst, wanted);
      pushes_.push_back(push);
    }
  }
  if (worst <= 0) return;
  for (int iteration = 0; iteration < settings.position_iterations; ++iteration) {
    std::size_t at = 0;
    for (const Constraint& c : constraints_) {
      Motion& a = displacements[c.a];
      Motion ground;
      Motion& b = c.a == c.b ? ground : displacements[c.b];
      const float mass_a = c.inverse_mass_a > 0 ? float(bodies[c.a].mass) : 0;
      const float mass_b = c.inverse_mass_b > 0 ? float(bodies[c.b].mass) : 0;
      for (int i = 0; i < c.count; ++i, ++at) {
        const Row& row = c.points[i];
        PushRow& push = pushes_[at];
        const float moved = relative_speed(c.normal, row.arm_a, row.arm_b, a, b);
        const float next = std::max(0.0F, push.push + push.mass * (push.target - moved));
        const float change = next - push.push;
        if (change == 0) continue;
        push.push = next;
        if (mass_a > 0) a.linear -= c.normal * change;
        a.angular -= row.turn_a * (change * mass_a);
        if (mass_b > 0) b.linear += c.normal * change;
        b.angular += row.turn_b * (change * mass_b);
      }
    }
  }
}

void ContactSolver::store(const Constraint& c, Contact& contact) {
  for (int i = 0; i < c.count; ++i) contact.points[i].normal_impulse = c.points[i].impulse;
  contact.friction_impulse =
      c.tangent[0] * c.slide[0].impulse + c.tangent[1] * c.slide[1].impulse;
  contact.twist_impulse = c.twist_impulse;
  contact.pressed = c.pressed;
}

void ContactSolver::solve(const SolverSettings& settings, const std::vector<Body>& bodies,
                          const std::vector<std::int32_t>& order, std::vector<Contact>& contacts,
                          std::vector<Motion>& velocities, std::vector<Motion>& displacements) {
  constraints_.resize(order.size());
  std::vector<std::uint8_t> seen(bodies.size(), 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    prepare(settings, bodies, contacts[order[i]], order[i], constraints_[i]);
    for (std::int32_t body : {constraints_[i].a, constraints_[i].b}) {
      seen[body] = bodies[body].awake;
    }
  }
  moving_.clear();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (seen[i]) moving_.push_back(std::int32_t(i));
  }
  const float h = settings.step / float(settings.substeps);
  for (int substep = 0; substep < settings.substeps; ++substep) {
    for (std::int32_t i : moving_) velocities[i].linear.z -= settings.gravity * h;
    for (const Constraint& c : constraints_) warm_start(c, velocities);
    for (int iteration = 0; iteration < settings.velocity_iterations; ++iteration) {
      for (Constraint& c : constraints_) solve_velocity(c, 1 / h, displacements, velocities);
    }
    for (Constraint& c : constraints_) carry_over(c, settings.gravity * h);
    for (std::int32_t i : moving_) {
      displacements[i].linear += velocities[i].linear * h;
      displacements[i].angular += velocities[i].angular * h;
    }
  }
  solve_positions(settings, bodies, displacements);
  for (const Constraint& c : constraints_) store(c, contacts[c.contact]);
}

}  // namespace rubble
