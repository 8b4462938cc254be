// The loops of contact_rows.h over speeds, for any kind of packet. A batch is done packet
// by packet; `first` is the packet's first lane. Not for use outside kernel/.
#pragma once

#include "kernel/solver/contact_law.h"
#include "kernel/solver/contact_rows.h"
#include "kernel/solver/rows/motion_lanes.h"

namespace rubble::contact_sweeps {

template <typename P>
RUBBLE_INLINE Motions<P> load(const PaddedMotion* v, const std::int32_t* index) {
  Motions<P> m;
  load(v, index, m);
  return m;
}

template <typename P>
RUBBLE_INLINE P relative(const Packet3<P>& direction, const ContactRow& row, int first,
                         const Motions<P>& a, const Motions<P>& b) {
  return dot(direction, b.linear - a.linear) + dot(Packet3<P>(row.arm_b, first), b.angular) -
         dot(Packet3<P>(row.arm_a, first), a.angular);
}

// Both sides of a packet: what an impulse does to them.
template <typename P>
struct Sides {
  int first;
  P inverse_mass_a, inverse_mass_b;
  Motions<P> a, b;

  RUBBLE_INLINE Sides(const ContactBatch& batch, int first_lane, const PaddedMotion* v)
      : first(first_lane),
        inverse_mass_a(batch.inverse_mass_a, first),
        inverse_mass_b(batch.inverse_mass_b, first),
        a(load<P>(v, batch.a + first)),
        b(load<P>(v, batch.b + first)) {}
  RUBBLE_INLINE P speed(const ContactRow& row, const Packet3<P>& direction) const {
    return relative(direction, row, first, a, b);
  }
  RUBBLE_INLINE void apply(const ContactRow& row, const Packet3<P>& direction, const P& impulse) {
    a.linear -= direction * (impulse * inverse_mass_a);
    a.angular -= Packet3<P>(row.turn_a, first) * impulse;
    b.linear += direction * (impulse * inverse_mass_b);
    b.angular += Packet3<P>(row.turn_b, first) * impulse;
  }
  RUBBLE_INLINE void twist(const ContactBatch& batch, const P& impulse) {
    a.angular -= Packet3<P>(batch.twist_a, first) * impulse;
    b.angular += Packet3<P>(batch.twist_b, first) * impulse;
  }
  RUBBLE_INLINE void store(const ContactBatch& batch, PaddedMotion* v) const {
    save(a, v, batch.a + first);
    save(b, v, batch.b + first);
  }
};

// The impulses of a packet, in registers for as long as it is solved.
template <typename P>
struct Impulses {
  P slide[2], twist, normal[Contact::kMaxPoints];

  RUBBLE_INLINE Impulses(const ContactBatch& batch, const NormalRow* rows, int first)
      : slide{P(batch.slide[0].impulse, first), P(batch.slide[1].impulse, first)},
        twist(batch.twist_impulse, first) {
    for (int i = 0; i < batch.rows; ++i) normal[i] = P(rows[i].impulse, first);
  }
  RUBBLE_INLINE P sum(int rows) const {
    P total{};
    for (int i = 0; i < rows; ++i) total = total + normal[i];
    return total;
  }
};

// Slip of the patch about the normal.
template <typename P>
RUBBLE_INLINE P spin(const ContactBatch& batch, const Sides<P>& sides) {
  return dot(Packet3<P>(batch.normal, sides.first), sides.b.angular - sides.a.angular);
}

// Returns 0 for what sticks.
template <typename P>
RUBBLE_INLINE P solve_friction(const ContactBatch& batch, const P& limit, Impulses<P>& at, Sides<P>& sides) {
  const int first = sides.first;
  const P one(1), twist_mass(batch.twist_mass, first), radius(batch.radius, first), inverse(batch.per_radius, first);
  P masses[3], wanted[3];
  for (int t = 0; t < 2; ++t) {
    const FrictionRow& f = batch.slide[t];
    masses[t] = P(f.row.mass, first);
    const P speed = sides.speed(f.row, Packet3<P>(f.direction, first));
    wanted[t] = contact_law::drop_tiny(at.slide[t] - masses[t] * speed, masses[t]);
  }
  masses[2] = twist_mass * inverse * inverse;
  wanted[2] = contact_law::drop_tiny((at.twist - twist_mass * spin(batch, sides)) * inverse, masses[2]);
  const contact_law::Slip<P> slip = contact_law::find_slip(limit, masses, wanted);
  P turning = one;
  if (any(slip.twist > P{})) {  // else all would be divided by 1, or ends as nothing
    for (int t = 0; t < 2; ++t) wanted[t] = wanted[t] / (one + slip.slide * masses[t]);
    turning = one / (one + slip.twist * masses[2]);
  }
  const P slide2 = wanted[0] * wanted[0] + wanted[1] * wanted[1], shrink = contact_law::shrink_into_cone(limit, slide2);
  for (int t = 0; t < 2; ++t) {
    const FrictionRow& f = batch.slide[t];
    const P next = wanted[t] * shrink;
    sides.apply(f.row, Packet3<P>(f.direction, first), next - at.slide[t]);
    at.slide[t] = next;
  }
  // The torque sees what the force has changed.
  const P turned = contact_law::drop_tiny((at.twist - twist_mass * spin(batch, sides)) * turning * inverse, masses[2]);
  const P next = radius * contact_law::clamp_twist(limit, slide2 * (shrink * shrink), turned);
  sides.twist(batch, next - at.twist);
  at.twist = next;
  return slip.slide;
}

// closing: the speed at which each point may close its gap; backwards: from the last point to the first.
template <typename P>
RUBBLE_INLINE void solve_normals(const ContactBatch& batch, const NormalRow* rows, const P* closing,
                                 bool backwards, Impulses<P>& at, Sides<P>& sides) {
  const Packet3<P> normal(batch.normal, sides.first);
  const P most(batch.most, sides.first);
  for (int k = 0; k < batch.rows; ++k) {
    const int i = backwards ? batch.rows - 1 - k : k;
    const ContactRow& row = rows[i].row;
    const P speed = sides.speed(row, normal);
    const P next = contact_law::smaller(
        most, contact_law::solve_normal(at.normal[i], P(row.mass, sides.first), speed, closing[i]));
    sides.apply(row, normal, next - at.normal[i]);
    at.normal[i] = next;
  }
}

// Lanes outside the mask go back to what they were.
template <typename P>
RUBBLE_INLINE void keep_inside(typename P::Mask mask, const Motions<P>& before, Motions<P>& m) {
  const auto pick = [mask](const Packet3<P>& p, const Packet3<P>& q) {
    return Packet3<P>{select(mask, p.x, q.x), select(mask, p.y, q.y), select(mask, p.z, q.z)};
  };
  m = {pick(m.linear, before.linear), pick(m.angular, before.angular)};
}
template <typename P>
RUBBLE_INLINE void keep_inside(typename P::Mask mask, const Impulses<P>& before, int rows,
                               Impulses<P>& at) {
  for (int t = 0; t < 2; ++t) at.slide[t] = select(mask, at.slide[t], before.slide[t]);
  at.twist = select(mask, at.twist, before.twist);
  for (int i = 0; i < rows; ++i) at.normal[i] = select(mask, at.normal[i], before.normal[i]);
}

// What the packet starts the next substep with.
template <typename P>
RUBBLE_INLINE void clamp_accumulated_impulses(ContactBatch& batch, NormalRow* rows, int first,
                                              const P& weight, const Impulses<P>& at) {
  P sum{}, pressed(batch.pressed, first), highest(batch.highest, first);
  for (int i = 0; i < batch.rows; ++i) {
    NormalRow& n = rows[i];
    pressed = pressed + at.normal[i];
    highest = max(highest, at.normal[i]);
    // What the row holds is still what the substep started from.
    const P next = contact_law::clamp_accumulated_impulses(at.normal[i], P(n.impulse, first),
                                                           P(n.row.mass, first), weight);
    next.store(n.impulse, first);
    sum = sum + next;
  }
  pressed.store(batch.pressed, first);
  highest.store(batch.highest, first);
  const P torque = at.twist * P(batch.per_radius, first);
  const P shrink = contact_law::shrink_into_cone(
      P(batch.friction, first) * sum,
      at.slide[0] * at.slide[0] + at.slide[1] * at.slide[1] + torque * torque);
  for (int t = 0; t < 2; ++t) (at.slide[t] * shrink).store(batch.slide[t].impulse, first);
  (at.twist * shrink).store(batch.twist_impulse, first);
}

// The speed at which each point may close its gap: one that is still apart may do so within the substep.
template <typename P>
RUBBLE_INLINE void find_closing_speeds(const ContactBatch& batch, const NormalRow* rows, int first,
                                       const P& per_substep, const PaddedMotion* moved, P* closing) {
  const Motions<P> a = load<P>(moved, batch.a + first), b = load<P>(moved, batch.b + first);
  const Packet3<P> normal(batch.normal, first);
  for (int i = 0; i < batch.rows; ++i) {
    const P gap = P(rows[i].gap, first) + relative(normal, rows[i].row, first, a, b);
    closing[i] = contact_law::closing_speed(gap, per_substep);
  }
}

template <typename P>
RUBBLE_INLINE void solve_packet(ContactBatch& batch, NormalRow* rows, int first, bool backwards,
                                const P& per_substep, const P& weight, const PaddedMotion* moved,
                                PaddedMotion* v) {
  P closing[Contact::kMaxPoints];
  find_closing_speeds(batch, rows, first, per_substep, moved, closing);
  Sides<P> sides(batch, first, v);
  Impulses<P> at(batch, rows, first);
  const P friction(batch.friction, first), owed(batch.owed, first), before = at.sum(batch.rows);
  // Friction first, against the normal impulses so far; the normals have the last word.
  P limit = max(P{}, friction * before + owed), slip = solve_friction(batch, limit, at, sides);
  solve_normals(batch, rows, closing, backwards, at, sides);
  P pressed = at.sum(batch.rows);
  const auto impact = pressed > before + before * P(kImpactRise);
  if (any(impact)) {
    // Only for the lanes that need it: who shares a batch must not change the result.
    const Impulses<P> once = at;
    const Motions<P> once_a = sides.a, once_b = sides.b;
    limit = select(impact, max(P{}, friction * pressed + owed), limit);
    slip = select(impact, solve_friction(batch, limit, at, sides), slip);
    solve_normals(batch, rows, closing, backwards, at, sides);
    keep_inside(impact, once, batch.rows, at);
    keep_inside(impact, once_a, sides.a);
    keep_inside(impact, once_b, sides.b);
    pressed = at.sum(batch.rows);
  }
  select(slip > P{}, owed + friction * pressed - limit, P{}).store(batch.owed, first);
  sides.store(batch, v);
  clamp_accumulated_impulses(batch, rows, first, weight, at);
}

template <typename P>
RUBBLE_INLINE void solve_velocities(const BatchRange& range, bool backwards, float per_substep,
                                    float weight, const PaddedMotion* moved, PaddedMotion* v) {
  const P wide_per_substep(per_substep), wide_weight(weight);
  for (ContactBatch* batch = range.begin; batch != range.end; ++batch) {
    NormalRow* rows = range.rows + batch->first_row;
    for (int first = 0; first < batch->used; first += P::width()) {
      solve_packet(*batch, rows, first, backwards, wide_per_substep, wide_weight, moved, v);
    }
  }
}

template <typename P>
RUBBLE_INLINE void warm_start_packet(const ContactBatch& batch, const NormalRow* rows, int first,
                                     PaddedMotion* v) {
  Sides<P> sides(batch, first, v);
  for (const FrictionRow& f : batch.slide) {
    sides.apply(f.row, Packet3<P>(f.direction, first), P(f.impulse, first));
  }
  sides.twist(batch, P(batch.twist_impulse, first));
  const Packet3<P> normal(batch.normal, first);
  for (int i = 0; i < batch.rows; ++i) sides.apply(rows[i].row, normal, P(rows[i].impulse, first));
  sides.store(batch, v);
}

template <typename P>
RUBBLE_INLINE void warm_start(const BatchRange& range, PaddedMotion* v) {
  for (const ContactBatch* batch = range.begin; batch != range.end; ++batch) {
    const NormalRow* rows = range.rows + batch->first_row;
    for (int first = 0; first < batch->used; first += P::width()) {
      warm_start_packet<P>(*batch, rows, first, v);
    }
  }
}

}  // namespace rubble::contact_sweeps
