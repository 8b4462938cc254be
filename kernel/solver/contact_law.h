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
template <typename T>
RUBBLE_INLINE T larger(T a, T b) {
  return choose(a > b, a, b);
}
template <typename T>
RUBBLE_INLINE T smaller(T a, T b) {
  return choose(b > a, a, b);
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

// Friction about the normal, of a patch with that mean radius.
template <typename T>
RUBBLE_INLINE T clamp_twist(T limit, T radius, T twist) {
  const T most = limit * radius;
  return smaller(most, larger(-most, twist));
}

// What a substep starts from: an impulse may double from one substep to the next and grow by
// `weight` (a speed) times its mass. Loads build up fast, but the impulse of an impact is not given
// twice. carried: what the substep before started from.
template <typename T>
RUBBLE_INLINE T clamp_accumulated_impulses(T impulse, T carried, T mass, T weight) {
  return smaller(impulse, carried + carried + mass * weight);
}

// The speed at which a gap closes within the substep; none of an overlap.
template <typename T>
RUBBLE_INLINE T closing_speed(T gap, T per_substep) {
  return larger(T{}, gap) * per_substep;
}

// Who gives way when an overlap is undone: all pieces count as equally heavy, so that a light bar is
// cleared from under a heavy slab as fast as any other pair, but the one below as up to ten times as heavy
// as the one above. Otherwise a slab with hundreds of bricks on it is pressed into its support, as each of
// them pushes it as much as the support does. A push moves a body by its share. `up`: the rise of the
// normal, which points from A to B. Only for free pieces: with it, articulated trees gained speed until they
// left the pile.
template <typename T>
struct PushShares {
  T a, b;
};
template <typename T>
RUBBLE_INLINE PushShares<T> find_push_shares(T up) {
  const T one(1), less(0.9F);
  return {one - less * larger(T{}, up), one - less * larger(T{}, -up)};
}

// Where friction acts: at the centre of the points, each with a share by its normal impulse of the
// substep before; the same for all where none is pressed. share = each + per_impulse * impulse.
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
