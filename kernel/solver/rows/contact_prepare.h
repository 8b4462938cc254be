// Filling the rows of contact_rows.h from contacts and bodies, for any kind of packet: `first` is the
// packet's first lane. Not for use outside kernel/.
#pragma once

#include <cstddef>
#include <cstring>

#include "kernel/solver/contact_law.h"
#include "kernel/solver/contact_rows.h"
#include "kernel/solver/friction_axes.h"
#include "kernel/solver/rows/packets.h"

namespace rubble::contact_prepare {

// One side of a batch.
template <typename P>
struct Side {
  Packet3<P> row0, row1, row2;  // of the inverse inertia in the world
  P inverse_mass, mass, share;

  RUBBLE_INLINE Side(const BodyTerms* terms, const std::int32_t* index) {
    const auto gather = [&](float (BodyTerms::*numbers)[3]) __attribute__((always_inline)) {
      return P::gather([&](int i) __attribute__((always_inline)) {
        return load_quad(terms[index[i]].*numbers);
      });
    };
    const Columns<P> first = gather(&BodyTerms::row0), second = gather(&BodyTerms::row1),
                     third = gather(&BodyTerms::row2);
    row0 = {first.x, first.y, first.z}, inverse_mass = first.w;
    row1 = {second.x, second.y, second.z}, mass = second.w;
    row2 = {third.x, third.y, third.z}, share = third.w;
  }
  RUBBLE_INLINE Packet3<P> turn(const Packet3<P>& arm) const {
    return Packet3<P>{dot(row0, arm), dot(row1, arm), dot(row2, arm)} * share;
  }
};

// The angular part of a row.
template <typename P>
struct Turns {
  Packet3<P> arm_a, arm_b, turn_a, turn_b;

  RUBBLE_INLINE Turns(const Side<P>& a, const Side<P>& b, const Packet3<P>& direction,
                      const Packet3<P>& from_a, const Packet3<P>& from_b)
      : arm_a(cross(from_a, direction)),
        arm_b(cross(from_b, direction)),
        turn_a(a.turn(arm_a)),
        turn_b(b.turn(arm_b)) {}
};

// The angular parts of J M^-1 J^T of the two sides.
template <typename P>
struct Around {
  P a, b;
};

// Stores a row.
template <typename P>
RUBBLE_INLINE Around<P> store(const Turns<P>& turns, const Side<P>& a, const Side<P>& b,
                      typename P::Mask used, int first, ContactRow& row) {
  turns.arm_a.store(row.arm_a, first);
  turns.arm_b.store(row.arm_b, first);
  turns.turn_a.store(row.turn_a, first);
  turns.turn_b.store(row.turn_b, first);
  const Around<P> around{dot(turns.arm_a, turns.turn_a), dot(turns.arm_b, turns.turn_b)};
  const P mass = P(1) / (a.inverse_mass + b.inverse_mass + around.a + around.b);
  select(used, mass, P{}).store(row.mass, first);
  return around;
}

// J M^-1 J^T of two rows across each other.
template <typename P>
RUBBLE_INLINE P couple(const Turns<P>& s, const Turns<P>& t) {
  return dot(s.arm_a, t.turn_a) + dot(s.arm_b, t.turn_b);
}

RUBBLE_INLINE Quad read_quad(const void* from, int index) {
  Quad q;
  std::memcpy(&q, static_cast<const char*>(from) + index * int(sizeof q), sizeof q);
  return q;
}

// The points of that number of the contacts in the lanes.
template <typename P>
struct Points {
  Packet3<P> from_a, from_b;
  P separation, impulse;

  RUBBLE_INLINE Points(const Contact* const* contact, int point) {
    static_assert(offsetof(ContactPoint, normal_impulse) == 7 * sizeof(float),
                  "eight numbers in a row");
    const auto half = [&](int which) __attribute__((always_inline)) {
      return P::gather([&](int i) __attribute__((always_inline)) {
        return read_quad(&contact[i]->points[point], which);
      });
    };
    const Columns<P> c = half(0), d = half(1);
    from_a = {c.x, c.y, c.z};
    from_b = {c.w, d.x, d.y};
    separation = d.z, impulse = d.w;
  }
};

// Four numbers of each contact, from `offset` on.
template <typename P>
RUBBLE_INLINE Columns<P> gather(const Contact* const* contact, std::size_t offset) {
  return P::gather([&](int i) __attribute__((always_inline)) {
    return read_quad(reinterpret_cast<const char*>(contact[i]) + offset, 0);
  });
}

// Two unit vectors across a normal; the same for the same normal.
template <typename P>
RUBBLE_INLINE void make_tangents(const Packet3<P>& n, Packet3<P>* tangent) {
  const P zero{}, one(1);
  const auto upright = P(0.57735F) > select(n.x > zero, n.x, -n.x);
  const Packet3<P> across =
      cross(n, Packet3<P>{select(upright, one, zero), select(upright, zero, one), zero});
  tangent[0] = across * (one / sqrt(dot(across, across)));
  tangent[1] = cross(n, tangent[0]);
}

template <typename P>
RUBBLE_INLINE void prepare_friction(const Side<P>& a, const Side<P>& b, const Packet3<P>& middle_a,
                                    const Packet3<P>& middle_b, const Packet3<P>& impulse,
                                    const Packet3<P>& normal, typename P::Mask used, int first,
                                    ContactBatch& batch) {
  Packet3<P> tangent[2];
  make_tangents(normal, tangent);
  Turns<P> s(a, b, tangent[0], middle_a, middle_b), t(a, b, tangent[1], middle_a, middle_b);
  // Neither row shall feel the other's impulse.
  const PlaneTurn<P> turn = find_friction_axes(couple(s, s), couple(s, t), couple(t, t));
  turn.apply(tangent[0], tangent[1]);
  turn.apply(s.arm_a, t.arm_a);
  turn.apply(s.arm_b, t.arm_b);
  turn.apply(s.turn_a, t.turn_a);
  turn.apply(s.turn_b, t.turn_b);
  store(s, a, b, used, first, batch.slide[0].row);
  store(t, a, b, used, first, batch.slide[1].row);
  for (int k = 0; k < 2; ++k) {
    tangent[k].store(batch.slide[k].direction, first);
    dot(tangent[k], impulse).store(batch.slide[k].impulse, first);
  }
}

// How a contact that has carried nothing yet will be loaded: the impulses that stop two pieces which approach each other
// without turning. Returns their sum.
template <typename P>
RUBBLE_INLINE P find_first_loads(const ContactBatch& batch, int first, const P& inverse_mass, const NormalRow* rows,
                                 P* loads) {
  P sum{};
  Packet3<P> turn_a{}, turn_b{};
  for (int i = 0; i < batch.rows; ++i) loads[i] = P{};
  for (int sweep = 0; sweep < contact_law::kLoadSweeps; ++sweep) {
    for (int k = 0; k < batch.rows; ++k) {
      const int i = sweep % 2 == 0 ? k : batch.rows - 1 - k;
      const ContactRow& row = rows[i].row;
      const P speed = inverse_mass * sum + dot(Packet3<P>(row.arm_a, first), turn_a) +
                      dot(Packet3<P>(row.arm_b, first), turn_b) - P(1);
      const P next = max(P{}, loads[i] - P(row.mass, first) * speed), change = next - loads[i];
      loads[i] = next, sum = sum + change;
      turn_a += Packet3<P>(row.turn_a, first) * change;
      turn_b += Packet3<P>(row.turn_b, first) * change;
    }
  }
  return sum;
}

template <typename P>
RUBBLE_INLINE void prepare_packet(ContactBatch& batch, int first, const Contact* contacts,
                                  const BodyTerms* terms, float rest_gap, NormalRow* rows,
                                  PushRow* pushes) {
  static_assert(offsetof(Contact, friction) == offsetof(Contact, normal) + sizeof(Vec3f) &&
                    offsetof(Contact, twist_impulse) ==
                        offsetof(Contact, friction_impulse) + sizeof(Vec3f),
                "each vector and its number in a row");
  const Contact* contact[P::width()];
  // A line that rolls is taken as its two ends: beside gyroscopic torques, an even line lets a fast drum wobble.
  const float spread = contact_law::mean_radius_share(batch.rows);
  Lanes in_use, most, shares_of_radius;
  for (int i = 0; i < P::width(); ++i) {
    // Lanes not in use compute with the first contact, and their rows weigh nothing.
    const std::int32_t index = batch.contact[first + i];
    contact[i] = &contacts[index >= 0 ? index : batch.contact[0]];
    in_use[i] = index >= 0 ? 1.0F : 0.0F;
    most[i] = contact[i]->most;
    shares_of_radius[i] = contact[i]->rolls_a || contact[i]->rolls_b ? 1.0F : spread;
  }
  const P one(1), zero{};
  const auto used = P(in_use, 0) > zero;
  const Side<P> a(terms, batch.a + first), b(terms, batch.b + first);
  const Columns<P> across = gather<P>(contact, offsetof(Contact, normal));
  const Columns<P> along = gather<P>(contact, offsetof(Contact, friction_impulse));
  const Packet3<P> normal{across.x, across.y, across.z};
  const Packet3<P> friction_impulse{along.x, along.y, along.z};
  const auto push = contact_law::find_push_shares(normal.z);
  const P share_a = select(a.mass > zero, push.a, zero), mass_a = push.a * a.mass;
  const P share_b = select(b.mass > zero, push.b, zero), mass_b = push.b * b.mass;
  P total{}, loads[Contact::kMaxPoints];
  for (int i = 0; i < batch.rows; ++i) {
    const Points<P> p(contact, i);
    const Turns<P> turns(a, b, normal, p.from_a, p.from_b);
    NormalRow& n = rows[i];
    const Around<P> around = store(turns, a, b, used, first, n.row);
    const P push_mass =
        one / (share_a + mass_a * around.a + share_b + mass_b * around.b);
    select(used, push_mass, zero).store(pushes[i].mass, first);
    (p.separation - P(rest_gap)).store(n.gap, first);
    const P impulse = select(used, p.impulse, zero);
    impulse.store(n.impulse, first);
    loads[i] = impulse;
    total = total + impulse;
  }
  const auto is_new = zero >= select(used, total, one);
  if (any(is_new)) {
    P first_loads[Contact::kMaxPoints];
    const P sum = find_first_loads(batch, first, a.inverse_mass + b.inverse_mass, rows, first_loads);
    for (int i = 0; i < batch.rows; ++i) loads[i] = select(is_new, first_loads[i], loads[i]);
    total = select(is_new, sum, total);
  }
  const P count(float(batch.rows));
  const auto shares = contact_law::find_centre_shares(total, count);
  Packet3<P> middle_a{}, middle_b{};
  for (int i = 0; i < batch.rows; ++i) {
    const Points<P> p(contact, i);
    const P share = shares.each + shares.per_impulse * loads[i];
    middle_a += p.from_a * share;
    middle_b += p.from_b * share;
  }
  P radius{};
  for (int i = 0; i < batch.rows; ++i) {
    const Points<P> p(contact, i);
    const Packet3<P> from = p.from_a - middle_a;
    radius = radius + sqrt(dot(from, from)) * (shares.each + shares.per_impulse * loads[i]);
  }
  prepare_friction(a, b, middle_a, middle_b, friction_impulse, normal, used, first, batch);
  const Packet3<P> twist_a = a.turn(normal), twist_b = b.turn(normal);
  const P twist = dot(normal, twist_a + twist_b);
  const P twist_mass = select(twist > zero, one / twist, zero);
  select(used, twist_mass, zero).store(batch.twist_mass, first);
  select(used, along.w, zero).store(batch.twist_impulse, first);
  select(used, across.w, zero).store(batch.friction, first);
  radius = max(radius * P(shares_of_radius, 0), P(contact_law::kPatchRadius));
  radius.store(batch.radius, first);
  (one / radius).store(batch.per_radius, first);
  normal.store(batch.normal, first);
  twist_a.store(batch.twist_a, first);
  twist_b.store(batch.twist_b, first);
  a.inverse_mass.store(batch.inverse_mass_a, first);
  b.inverse_mass.store(batch.inverse_mass_b, first);
  share_a.store(batch.push_share_a, first);
  share_b.store(batch.push_share_b, first);
  mass_a.store(batch.push_mass_a, first);
  mass_b.store(batch.push_mass_b, first);
  zero.store(batch.owed, first);
  zero.store(batch.pressed, first);
  zero.store(batch.highest, first);
  P(most, 0).store(batch.most, first);
}

template <typename P>
RUBBLE_INLINE void prepare(const BatchRange& range, const Contact* contacts,
                           const BodyTerms* terms, float rest_gap) {
  for (ContactBatch* batch = range.begin; batch != range.end; ++batch) {
    for (int first = 0; first < batch->used; first += P::width()) {
      prepare_packet<P>(*batch, first, contacts, terms, rest_gap, range.rows + batch->first_row,
                        range.pushes + batch->first_row);
    }
  }
}

}  // namespace rubble::contact_prepare
