// The contact law, once: what an impulse at a contact may be. For double, for float, and for packets
// of lanes. Not for use outside kernel/.
#pragma once

#include <cmath>

#include "kernel/solver/wide.h"

namespace rubble::contact_law {

// The operations that packets have, for single numbers.
template <typename T>
inline constexpr bool kIsNumber = false;
template <>
inline constexpr bool kIsNumber<float> = true;
template <>
inline constexpr bool kIsNumber<double> = true;

// condition: a truth value, or a mask of lanes.
template <typename Condition, typename T>
RUBBLE_INLINE T choose(Condition condition, T a, T b) {
  if constexpr (kIsNumber<T>) {
    return condition ? a : b;
  } else {
    return select(condition, a, b);
  }
}
// The second of two that are equal, as the instructions for packets return it.
template <typename T>
RUBBLE_INLINE T larger(T a, T b) {
  if constexpr (kIsNumber<T>) {
    return a > b ? a : b;
  } else {
    return max(a, b);
  }
}
template <typename T>
RUBBLE_INLINE T smaller(T a, T b) {
  if constexpr (kIsNumber<T>) {
    return b > a ? a : b;
  } else {
    return min(a, b);
  }
}
template <typename T>
RUBBLE_INLINE T root(T a) {
  if constexpr (kIsNumber<T>) {
    return std::sqrt(a);
  } else {
    return sqrt(a);
  }
}

// Signorini: a contact pushes only, and only where it would be closed at the substep's end. `speed`
// of parting; `allowed`: the speed at which what is left of the gap closes within the substep.
template <typename T>
RUBBLE_INLINE T solve_normal(T impulse, T mass, T speed, T allowed) {
  return larger(T{}, impulse - mass * (speed + allowed));
}

// Coulomb: how much a friction impulse of the given squared length must shrink to lie in the cone.
// limit: the coefficient times the normal impulse.
template <typename T>
RUBBLE_INLINE T shrink_into_cone(T limit, T length2) {
  const auto outside = length2 > limit * limit;
  const T length = root(choose(outside, length2, T(1)));
  return choose(outside, limit / length, T(1));
}

// A contact at one point carries on a patch too: a corner of concrete is crushed, at 30 MPa, to a disc of
// this radius by 100 N. Without it nothing stops a piece that turns about the line through the two points
// that hold it. unit: m
inline constexpr float kPatchRadius = 0.001F;

// The friction impulse on the edge of the cone that opposes what slip is left. sticking: the impulse,
// outside the cone, that would leave no slip; matrix: J M^-1 J^T of the two tangents (00, 01, 11). Where
// that is far from a multiple of 1, as at the ends of a robot's tracks, sticking itself points elsewhere.
// The slip that an impulse x leaves is K (x - sticking); it is against x where (K + s) x = K sticking
// for a number s > 0, found by Newton's method on the length of x (More and Sorensen 1983).
inline void solve_slide(const double* matrix, double limit, const double* sticking, double* x) {
  // Newton's method on 1 / length converges in two to four steps; what is left is scaled away; unit: 1
  constexpr int kMostSteps = 8;
  // Lengths that differ from the limit by less than this share of it count as equal; unit: 1
  constexpr double kClose = 1e-6;
  const double k00 = matrix[0], k01 = matrix[1], k11 = matrix[2];
  const double b0 = k00 * sticking[0] + k01 * sticking[1], b1 = k01 * sticking[0] + k11 * sticking[1];
  double s = 0, x0 = sticking[0], x1 = sticking[1], length = std::sqrt(x0 * x0 + x1 * x1);
  for (int i = 0; i < kMostSteps && length > limit * (1 + kClose) && limit > 0; ++i) {
    const double d00 = k00 + s, d11 = k11 + s, inverse = 1 / (d00 * d11 - k01 * k01);
    const double y = (d11 * x0 * x0 - 2 * k01 * x0 * x1 + d00 * x1 * x1) * inverse;
    s += length * length / y * (length - limit) / limit;
    const double e00 = k00 + s, e11 = k11 + s, next = 1 / (e00 * e11 - k01 * k01);
    x0 = (e11 * b0 - k01 * b1) * next, x1 = (e00 * b1 - k01 * b0) * next;
    length = std::sqrt(x0 * x0 + x1 * x1);
  }
  const double shrink = length > limit ? limit / length : 1;
  x[0] = x0 * shrink, x[1] = x1 * shrink;
}

// Friction about the normal that remains for a sliding patch, on the ellipsoid of both (Howe and Cutkosky 1996), as the
// limit of a patch that only turns.
inline double left_for_twist(double limit, const double* slide) {
  const double left2 = limit * limit - slide[0] * slide[0] - slide[1] * slide[1];
  return left2 > 0 ? std::sqrt(left2) : 0;
}

// Friction about the normal, of a patch with that mean radius.
template <typename T>
RUBBLE_INLINE T clamp_twist(T limit, T radius, T twist) {
  const T most = limit * radius;
  return smaller(most, larger(-most, twist));
}

// Warm start of a substep: an impulse may double from one substep to the next, plus `weight` (a speed) times its mass. So
// loads build up fast, but the impulse of an impact is not applied twice. carried: warm start of the previous substep.
template <typename T>
RUBBLE_INLINE T clamp_accumulated_impulses(T impulse, T carried, T mass, T weight) {
  return smaller(impulse, carried + carried + mass * weight);
}

// The speed at which a gap closes within the substep; none of an overlap.
template <typename T>
RUBBLE_INLINE T closing_speed(T gap, T per_substep) {
  return larger(T{}, gap) * per_substep;
}

// Shares by which two pieces are displaced to remove an overlap. All pieces count as equally heavy, so a light bar under a
// heavy slab is freed as fast as any other pair. But the lower piece counts as up to ten times as heavy as the upper one.
// Otherwise hundreds of bricks would press a slab into its support, because each of them pushes as much as the support.
// `up`: vertical component of the normal from A to B. For free pieces only: articulated trees would gain speed.
template <typename T>
struct PushShares {
  T a, b;
};
template <typename T>
RUBBLE_INLINE PushShares<T> find_push_shares(T up) {
  const T one(1), less(0.9F);
  return {one - less * larger(T{}, up), one - less * larger(T{}, -up)};
}

// Centre of friction: the mean of the points, weighted by their normal impulses of the previous substep, or equally if
// there are none. share = each + per_impulse * impulse.
template <typename T>
struct CentreShares {
  T each, per_impulse;
};
template <typename T>
RUBBLE_INLINE CentreShares<T> find_centre_shares(T total, T count) {
  const auto pressed = total > T{};
  const T inverse = T(1) / choose(pressed, total, count);
  return {choose(pressed, T{}, inverse), choose(pressed, inverse, T{})};
}

}  // namespace rubble::contact_law
