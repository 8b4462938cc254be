// The loops of contact_rows.h over speeds and displacements, for either kind of packet. Not for use
// outside kernel/.
#pragma once

#include "kernel/solver/contact_law.h"
#include "kernel/solver/contact_rows.h"
#include "kernel/solver/packets.h"

namespace rubble::contact_sweeps {

// The motions of eight bodies, lane by lane.
template <typename P>
struct Motions {
  Packet3<P> linear, angular;
};

template <typename P>
RUBBLE_INLINE Motions<P> load(const PaddedMotion* v, const std::int32_t* index) {
  const PaddedMotion &b0 = v[index[0]], &b1 = v[index[1]], &b2 = v[index[2]], &b3 = v[index[3]],
                     &b4 = v[index[4]], &b5 = v[index[5]], &b6 = v[index[6]], &b7 = v[index[7]];
  const Columns<P> l = P::gather(b0.linear, b1.linear, b2.linear, b3.linear, b4.linear, b5.linear,
                                 b6.linear, b7.linear);
  const Columns<P> a = P::gather(b0.angular, b1.angular, b2.angular, b3.angular, b4.angular,
                                 b5.angular, b6.angular, b7.angular);
  return {{l.x, l.y, l.z}, {a.x, a.y, a.z}};
}

template <typename P>
RUBBLE_INLINE void save(const Motions<P>& m, PaddedMotion* v, const std::int32_t* index) {
  const EightRows l = P::scatter(m.linear.x, m.linear.y, m.linear.z);
  const EightRows a = P::scatter(m.angular.x, m.angular.y, m.angular.z);
  v[index[0]] = {l.r0, a.r0}, v[index[1]] = {l.r1, a.r1};
  v[index[2]] = {l.r2, a.r2}, v[index[3]] = {l.r3, a.r3};
  v[index[4]] = {l.r4, a.r4}, v[index[5]] = {l.r5, a.r5};
  v[index[6]] = {l.r6, a.r6}, v[index[7]] = {l.r7, a.r7};
}

template <typename P>
RUBBLE_INLINE P relative(const Packet3<P>& direction, const ContactRow& row, const Motions<P>& a,
                         const Motions<P>& b) {
  return dot(direction, b.linear - a.linear) + dot(Packet3<P>(row.arm_b), b.angular) -
         dot(Packet3<P>(row.arm_a), a.angular);
}

// Both sides of a batch: what an impulse does to them.
template <typename P>
struct Sides {
  P inverse_mass_a, inverse_mass_b;
  Motions<P> a, b;

  RUBBLE_INLINE Sides(const ContactBatch& batch, const PaddedMotion* v)
      : inverse_mass_a(batch.inverse_mass_a),
        inverse_mass_b(batch.inverse_mass_b),
        a(load<P>(v, batch.a)),
        b(load<P>(v, batch.b)) {}
  RUBBLE_INLINE void apply(const ContactRow& row, const Packet3<P>& direction, const P& impulse) {
    a.linear -= direction * (impulse * inverse_mass_a);
    a.angular -= Packet3<P>(row.turn_a) * impulse;
    b.linear += direction * (impulse * inverse_mass_b);
    b.angular += Packet3<P>(row.turn_b) * impulse;
  }
  RUBBLE_INLINE void twist(const ContactBatch& batch, const P& impulse) {
    a.angular -= Packet3<P>(batch.twist_a) * impulse;
    b.angular += Packet3<P>(batch.twist_b) * impulse;
  }
  RUBBLE_INLINE void store(const ContactBatch& batch, PaddedMotion* v) const {
    save(a, v, batch.a);
    save(b, v, batch.b);
  }
};

// The impulses of a batch, in registers for as long as it is solved.
template <typename P>
struct Impulses {
  P slide[2], twist, normal[Contact::kMaxPoints];

  RUBBLE_INLINE Impulses(const ContactBatch& batch, const NormalRow* rows)
      : slide{P(batch.slide[0].impulse), P(batch.slide[1].impulse)}, twist(batch.twist_impulse) {
    for (int i = 0; i < batch.rows; ++i) normal[i] = P(rows[i].impulse);
  }
  RUBBLE_INLINE P sum(int rows) const {
    P total{};
    for (int i = 0; i < rows; ++i) total = total + normal[i];
    return total;
  }
};

template <typename P>
RUBBLE_INLINE void solve_friction(const ContactBatch& batch, const P& limit, Impulses<P>& at,
                                  Sides<P>& sides) {
  P wanted[2];
  for (int t = 0; t < 2; ++t) {
    const FrictionRow& f = batch.slide[t];
    wanted[t] = at.slide[t] -
                P(f.row.mass) * relative(Packet3<P>(f.direction), f.row, sides.a, sides.b);
  }
  const P shrink =
      contact_law::shrink_into_cone(limit, wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  for (int t = 0; t < 2; ++t) {
    const FrictionRow& f = batch.slide[t];
    const P next = wanted[t] * shrink;
    sides.apply(f.row, Packet3<P>(f.direction), next - at.slide[t]);
    at.slide[t] = next;
  }
  const P speed = dot(Packet3<P>(batch.normal), sides.b.angular - sides.a.angular);
  const P next = contact_law::clamp_twist(limit, P(batch.radius),
                                          at.twist - P(batch.twist_mass) * speed);
  sides.twist(batch, next - at.twist);
  at.twist = next;
}

// closing: the speed at which each point may close its gap; backwards: from the last point to the first.
template <typename P>
RUBBLE_INLINE void solve_normals(const ContactBatch& batch, const NormalRow* rows, const P* closing,
                                 bool backwards, Impulses<P>& at, Sides<P>& sides) {
  const Packet3<P> normal(batch.normal);
  const P most(batch.most);
  for (int k = 0; k < batch.rows; ++k) {
    const int i = backwards ? batch.rows - 1 - k : k;
    const ContactRow& row = rows[i].row;
    const P speed = relative(normal, row, sides.a, sides.b);
    const P next = contact_law::smaller(
        most, contact_law::solve_normal(at.normal[i], P(row.mass), speed, closing[i]));
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

// What the batch starts the next substep with.
template <typename P>
RUBBLE_INLINE void clamp_accumulated_impulses(ContactBatch& batch, NormalRow* rows, const P& weight,
                              const Impulses<P>& at) {
  P carried{}, pressed(batch.pressed), highest(batch.highest);
  for (int i = 0; i < batch.rows; ++i) {
    NormalRow& n = rows[i];
    pressed = pressed + at.normal[i];
    highest = max(highest, at.normal[i]);
    const P next =
        contact_law::clamp_accumulated_impulses(at.normal[i], P(n.carried), P(n.row.mass), weight);
    next.store(n.impulse);
    next.store(n.carried);
    carried = carried + next;
  }
  pressed.store(batch.pressed);
  highest.store(batch.highest);
  const P limit = P(batch.friction) * carried;
  const P shrink = contact_law::shrink_into_cone(
      limit, at.slide[0] * at.slide[0] + at.slide[1] * at.slide[1]);
  for (int t = 0; t < 2; ++t) (at.slide[t] * shrink).store(batch.slide[t].impulse);
  contact_law::clamp_twist(limit, P(batch.radius), at.twist).store(batch.twist_impulse);
}

template <typename P>
RUBBLE_INLINE void solve_batch(ContactBatch& batch, NormalRow* rows, bool backwards, const P& per_substep,
                               const P& weight, const PaddedMotion* moved, PaddedMotion* v) {
  P closing[Contact::kMaxPoints];
  {
    // A point that is still apart may close its gap within the substep.
    const Motions<P> moved_a = load<P>(moved, batch.a), moved_b = load<P>(moved, batch.b);
    for (int i = 0; i < batch.rows; ++i) {
      const P gap = P(rows[i].gap) +
                    relative(Packet3<P>(batch.normal), rows[i].row, moved_a, moved_b);
      closing[i] = contact_law::closing_speed(gap, per_substep);
    }
  }
  Sides<P> sides(batch, v);
  Impulses<P> at(batch, rows);
  const P friction(batch.friction), before = at.sum(batch.rows);
  // Friction first, against the normal impulses so far; the normals have the last word.
  solve_friction(batch, friction * before, at, sides);
  solve_normals(batch, rows, closing, backwards, at, sides);
  const P pressed = at.sum(batch.rows);
  const auto impact = pressed > before + before * P(kImpactRise);
  if (any(impact)) {
    // Only for the lanes that need it: who shares a batch must not change the result.
    const Impulses<P> first = at;
    const Motions<P> first_a = sides.a, first_b = sides.b;
    solve_friction(batch, friction * pressed, at, sides);
    solve_normals(batch, rows, closing, backwards, at, sides);
    keep_inside(impact, first, batch.rows, at);
    keep_inside(impact, first_a, sides.a);
    keep_inside(impact, first_b, sides.b);
  }
  sides.store(batch, v);
  clamp_accumulated_impulses(batch, rows, weight, at);
}

template <typename P>
RUBBLE_INLINE void solve_velocities(const BatchRange& range, bool backwards, float per_substep,
                                    float weight, const PaddedMotion* moved, PaddedMotion* v) {
  const P wide_per_substep(per_substep), wide_weight(weight);
  for (ContactBatch* batch = range.begin; batch != range.end; ++batch) {
    solve_batch(*batch, range.rows + batch->first_row, backwards, wide_per_substep, wide_weight, moved, v);
  }
}

template <typename P>
RUBBLE_INLINE void warm_start(const BatchRange& range, PaddedMotion* v) {
  for (const ContactBatch* at = range.begin; at != range.end; ++at) {
    const ContactBatch& batch = *at;
    const NormalRow* rows = range.rows + batch.first_row;
    Sides<P> sides(batch, v);
    for (const FrictionRow& f : batch.slide) {
      sides.apply(f.row, Packet3<P>(f.direction), P(f.impulse));
    }
    sides.twist(batch, P(batch.twist_impulse));
    const Packet3<P> normal(batch.normal);
    for (int i = 0; i < batch.rows; ++i) sides.apply(rows[i].row, normal, P(rows[i].impulse));
    sides.store(batch, v);
  }
}

template <typename P>
RUBBLE_INLINE bool begin_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                                const PushTerms& terms, const PaddedMotion* moved) {
  const Motions<P> a = load<P>(moved, batch.a), b = load<P>(moved, batch.b);
  P most{};
  // A tie that yields is left as long as it has become.
  const auto holds = P(batch.most) > P(batch.highest);
  for (int i = 0; i < batch.rows; ++i) {
    const P done = relative(Packet3<P>(batch.normal), rows[i].row, a, b);
    const P gap = P(rows[i].gap) + done + P(terms.slop);
    const P most_now = select(P(-terms.deep) > gap, P(terms.most_deep), P(terms.most));
    const P step = contact_law::smaller(-gap * P(terms.fraction), most_now);
    const P wanted = select(holds, select(P{} > gap, step, -gap), P(-kNoPush));
    (done + wanted).store(pushes[i].target);
    P{}.store(pushes[i].push);
    most = max(most, wanted);
  }
  return any(most > P{});
}

template <typename P>
RUBBLE_INLINE bool solve_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                                PaddedMotion* moved) {
  Motions<P> a = load<P>(moved, batch.a), b = load<P>(moved, batch.b);
  const P share_a(batch.push_share_a), share_b(batch.push_share_b);
  const P mass_a(batch.push_mass_a), mass_b(batch.push_mass_b);
  const Packet3<P> normal(batch.normal);
  P most{};
  for (int i = 0; i < batch.rows; ++i) {
    const ContactRow& row = rows[i].row;
    PushRow& p = pushes[i];
    const P push(p.push), done = relative(normal, row, a, b);
    const P next = max(P{}, push + P(p.mass) * (P(p.target) - done));
    const P change = next - push;
    next.store(p.push);
    most = max(most, next);
    a.linear -= normal * (change * share_a);
    a.angular -= Packet3<P>(row.turn_a) * (change * mass_a);
    b.linear += normal * (change * share_b);
    b.angular += Packet3<P>(row.turn_b) * (change * mass_b);
  }
  save(a, moved, batch.a);
  save(b, moved, batch.b);
  return any(most > P{});
}

}  // namespace rubble::contact_sweeps
