#include "kernel/solver/contact_rows.h"

#include "kernel/collision/contact.h"
#include "kernel/solver/contact_law.h"

namespace rubble {
namespace {

// The motions of four bodies, lane by lane.
struct WideMotion {
  Wide3 linear, angular;
};

RUBBLE_INLINE WideMotion load(const PaddedMotion* v, const std::int32_t* index) {
  const PaddedMotion &p = v[index[0]], &q = v[index[1]], &r = v[index[2]], &s = v[index[3]];
  Wide lx = p.linear, ly = q.linear, lz = r.linear, lw = s.linear;
  transpose(lx, ly, lz, lw);
  Wide ax = p.angular, ay = q.angular, az = r.angular, aw = s.angular;
  transpose(ax, ay, az, aw);
  return {{lx, ly, lz}, {ax, ay, az}};
}

RUBBLE_INLINE void save(const WideMotion& m, PaddedMotion* v, const std::int32_t* index) {
  Wide p = m.linear.x, q = m.linear.y, r = m.linear.z, s = Wide{};
  transpose(p, q, r, s);
  v[index[0]].linear = p, v[index[1]].linear = q, v[index[2]].linear = r, v[index[3]].linear = s;
  p = m.angular.x, q = m.angular.y, r = m.angular.z, s = Wide{};
  transpose(p, q, r, s);
  v[index[0]].angular = p, v[index[1]].angular = q, v[index[2]].angular = r;
  v[index[3]].angular = s;
}

RUBBLE_INLINE Wide relative(const Wide3& direction, const WideRow& row, const WideMotion& a,
              const WideMotion& b) {
  return dot(direction, b.linear - a.linear) + dot(row.arm_b, b.angular) -
         dot(row.arm_a, a.angular);
}

RUBBLE_INLINE void apply(const ContactBatch& batch, const WideRow& row, const Wide3& direction, Wide impulse,
           WideMotion& a, WideMotion& b) {
  a.linear -= direction * (impulse * batch.inverse_mass_a);
  a.angular -= row.turn_a * impulse;
  b.linear += direction * (impulse * batch.inverse_mass_b);
  b.angular += row.turn_b * impulse;
}

RUBBLE_INLINE void solve_friction(ContactBatch& batch, Wide limit, WideMotion& a, WideMotion& b) {
  Wide wanted[2];
  for (int t = 0; t < 2; ++t) {
    const FrictionRow& f = batch.slide[t];
    wanted[t] = f.impulse - f.row.mass * relative(f.direction, f.row, a, b);
  }
  const Wide shrink =
      contact_law::shrink_into_cone(limit, wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  for (int t = 0; t < 2; ++t) {
    FrictionRow& f = batch.slide[t];
    const Wide next = wanted[t] * shrink;
    apply(batch, f.row, f.direction, next - f.impulse, a, b);
    f.impulse = next;
  }
  const Wide speed = dot(batch.normal, b.angular - a.angular);
  const Wide next = contact_law::clamp_twist(limit, batch.radius,
                                             batch.twist_impulse - batch.twist_mass * speed);
  const Wide change = next - batch.twist_impulse;
  a.angular -= batch.twist_a * change;
  b.angular += batch.twist_b * change;
  batch.twist_impulse = next;
}

RUBBLE_INLINE void solve_normals(ContactBatch& batch, NormalRow* rows, Wide per_substep,
                                 const WideMotion& moved_a, const WideMotion& moved_b,
                                 WideMotion& a, WideMotion& b) {
  for (int i = 0; i < batch.rows; ++i) {
    NormalRow& n = rows[i];
    const Wide speed = relative(batch.normal, n.row, a, b);
    // A point that is still apart may close its gap within the substep.
    const Wide gap = n.gap + relative(batch.normal, n.row, moved_a, moved_b);
    const Wide next = contact_law::solve_normal(n.impulse, n.row.mass, speed,
                                                contact_law::closing_speed(gap, per_substep));
    apply(batch, n.row, batch.normal, next - n.impulse, a, b);
    n.impulse = next;
  }
}

RUBBLE_INLINE WideMotion choose(WideMask mask, const WideMotion& a, const WideMotion& b) {
  const auto pick = [mask](const Wide3& p, const Wide3& q) {
    return Wide3{select(mask, p.x, q.x), select(mask, p.y, q.y), select(mask, p.z, q.z)};
  };
  return {pick(a.linear, b.linear), pick(a.angular, b.angular)};
}

// The impulses of a batch at some moment.
class BatchImpulses {
 public:
  BatchImpulses(const ContactBatch& batch, const NormalRow* rows)
      : slide_{batch.slide[0].impulse, batch.slide[1].impulse}, twist_(batch.twist_impulse) {
    for (int i = 0; i < batch.rows; ++i) normal_[i] = rows[i].impulse;
  }
  void restore_outside(WideMask mask, ContactBatch& batch, NormalRow* rows) const {
    for (int t = 0; t < 2; ++t) {
      batch.slide[t].impulse = select(mask, batch.slide[t].impulse, slide_[t]);
    }
    batch.twist_impulse = select(mask, batch.twist_impulse, twist_);
    for (int i = 0; i < batch.rows; ++i) rows[i].impulse = select(mask, rows[i].impulse, normal_[i]);
  }

 private:
  Wide slide_[2], twist_, normal_[Contact::kMaxPoints];
};

RUBBLE_INLINE Wide sum_impulses(const ContactBatch& batch, const NormalRow* rows) {
  Wide sum{};
  for (int i = 0; i < batch.rows; ++i) sum += rows[i].impulse;
  return sum;
}

}  // namespace

void warm_start(const ContactBatch& batch, const NormalRow* rows, PaddedMotion* v) {
  WideMotion a = load(v, batch.a), b = load(v, batch.b);
  for (const FrictionRow& f : batch.slide) apply(batch, f.row, f.direction, f.impulse, a, b);
  a.angular -= batch.twist_a * batch.twist_impulse;
  b.angular += batch.twist_b * batch.twist_impulse;
  for (int i = 0; i < batch.rows; ++i) {
    apply(batch, rows[i].row, batch.normal, rows[i].impulse, a, b);
  }
  save(a, v, batch.a);
  save(b, v, batch.b);
}

void solve_velocities(ContactBatch& batch, NormalRow* rows, Wide per_substep,
                      const PaddedMotion* moved, PaddedMotion* v) {
  WideMotion a = load(v, batch.a), b = load(v, batch.b);
  const WideMotion moved_a = load(moved, batch.a), moved_b = load(moved, batch.b);
  const Wide before = sum_impulses(batch, rows);
  // Friction first, against the normal impulses so far; the normals have the last word.
  solve_friction(batch, batch.friction * before, a, b);
  solve_normals(batch, rows, per_substep, moved_a, moved_b, a, b);
  const Wide pressed = sum_impulses(batch, rows);
  const WideMask impact = pressed > before + before * splat(kImpactRise);
  if (any(impact)) {
    // Only for the lanes that need it: who shares a batch must not change the result.
    const BatchImpulses impulses(batch, rows);
    const WideMotion first_a = a, first_b = b;
    solve_friction(batch, batch.friction * pressed, a, b);
    solve_normals(batch, rows, per_substep, moved_a, moved_b, a, b);
    impulses.restore_outside(impact, batch, rows);
    a = choose(impact, a, first_a);
    b = choose(impact, b, first_b);
  }
  save(a, v, batch.a);
  save(b, v, batch.b);
}

void carry_over(ContactBatch& batch, NormalRow* rows, Wide weight) {
  Wide carried{};
  for (int i = 0; i < batch.rows; ++i) {
    NormalRow& n = rows[i];
    batch.pressed += n.impulse;
    n.impulse = contact_law::carry_over(n.impulse, n.carried, n.row.mass, weight);
    n.carried = n.impulse;
    carried += n.impulse;
  }
  const Wide limit = batch.friction * carried;
  const Wide s0 = batch.slide[0].impulse, s1 = batch.slide[1].impulse;
  const Wide shrink = contact_law::shrink_into_cone(limit, s0 * s0 + s1 * s1);
  batch.slide[0].impulse = s0 * shrink;
  batch.slide[1].impulse = s1 * shrink;
  batch.twist_impulse = contact_law::clamp_twist(limit, batch.radius, batch.twist_impulse);
}

bool solve_pushes(const ContactBatch& batch, const NormalRow* rows, PushRow* pushes,
                  PaddedMotion* moved) {
  WideMotion a = load(moved, batch.a), b = load(moved, batch.b);
  Wide most{};
  for (int i = 0; i < batch.rows; ++i) {
    const WideRow& row = rows[i].row;
    PushRow& p = pushes[i];
    const Wide done = relative(batch.normal, row, a, b);
    const Wide next = max(Wide{}, p.push + p.mass * (p.target - done));
    const Wide change = next - p.push;
    p.push = next;
    most = max(most, next);
    a.linear -= batch.normal * (change * batch.push_share_a);
    a.angular -= row.turn_a * (change * batch.push_mass_a);
    b.linear += batch.normal * (change * batch.push_share_b);
    b.angular += row.turn_b * (change * batch.push_mass_b);
  }
  save(a, moved, batch.a);
  save(b, moved, batch.b);
  return any(most > 0);
}

Wide calc_moved(const ContactBatch& batch, const WideRow& row, const PaddedMotion* moved) {
  return relative(batch.normal, row, load(moved, batch.a), load(moved, batch.b));
}

}  // namespace rubble
