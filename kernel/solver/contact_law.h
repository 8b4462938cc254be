// The contact law, once: what an impulse at a contact may be. For double, for float, and for packets
// of lanes. Not for use outside kernel/.
#pragma once

#include <cmath>
#include <type_traits>

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
template <typename Condition>
RUBBLE_INLINE bool is_any(Condition condition) {
  if constexpr (std::is_same_v<Condition, bool>) {
    return condition;
  } else {
    return any(condition);
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

// An impulse that changes no speed by more than this counts as none. What dies away would halve, sweep after sweep,
// until it is subnormal, and some processors take a hundred times longer for subnormal numbers. Gravity gives 40 million
// times as much in a substep. unit: m/s
inline constexpr float kTinySpeed = 1e-9F;
template <typename T>
RUBBLE_INLINE T drop_tiny(T impulse, T mass) {
  return choose(larger(impulse, -impulse) > mass * T(kTinySpeed), impulse, T{});
}

// Signorini: a contact pushes only, and only where it would be closed at the substep's end. `speed`
// of parting; `allowed`: the speed at which what is left of the gap closes within the substep.
template <typename T>
RUBBLE_INLINE T solve_normal(T impulse, T mass, T speed, T allowed) {
  const T next = impulse - mass * (speed + allowed);
  return choose(next > mass * T(kTinySpeed), next, T{});
}

// Coulomb: how much a friction impulse of the given squared length must shrink to lie in the cone.
// limit: the coefficient times the normal impulse.
template <typename T>
RUBBLE_INLINE T shrink_into_cone(T limit, T length2) {
  const auto outside = length2 > limit * limit;
  const T length = root(choose(outside, length2, T(1)));
  return choose(outside, limit / length, T(1));
}

// Friction of a patch that slides and turns is one law: the force (two components) and the torque about the normal,
// divided by the patch's mean radius, lie in a ball whose radius is the coefficient times the normal impulse, and
// oppose the slip of the patch (limit surface: Goyal, Ruina and Papadopoulos 1991; an ellipsoid: Howe and Cutkosky
// 1996). So what slides fast turns almost freely, and what spins slides far. Three numbers describe it: two along the
// tangents, the third about the normal, a force at the mean radius.

// A contact at one point carries on a patch too: a corner of concrete is crushed, at 30 MPa, to a disc of
// this radius by 100 N. Without it nothing stops a piece that turns about the line through the two points
// that hold it. unit: m
inline constexpr float kPatchRadius = 0.001F;

// The mean radius of a patch under even pressure as a share of that of its corners: the integral of the distance from
// the centre over a line, a regular triangle, a square and a pentagon. A contact keeps at most six points, so six of
// them may stand for a round patch as well: between a hexagon (0.608) and a disc (2/3). unit: 1
inline float mean_radius_share(int points) {
  constexpr float kShares[] = {1, 1, 0.5F, 0.460F, 0.541F, 0.583F, 0.637F};
  return kShares[points < 6 ? points : 6];
}

// Sweeps over a new contact's points that find how it will be loaded, there and back twice: a flat box then slides
// without turning, wherever its centre of mass is. unit: 1
inline constexpr int kLoadSweeps = 4;

// Slip of a patch over the impulse that it leaves; unit: 1/kg.
template <typename T>
struct Slip {
  T slide{}, twist{};
};

// Where the friction impulse that would leave no slip lies outside the ball, what is left of the slip opposes the
// impulse x on the sphere: K (x - sticking) = -s x for a number s > 0, and K = J M^-1 J^T is diagonal here. Newton's
// method on 1 / |x| (More and Sorensen 1983) finds s; inside, no slip is left. masses: 1 / K; one of zero holds nothing.
//
// An ellipsoid has too much force where a patch mainly spins and too much torque where it mainly slides. For a disc under
// even pressure the force on a spinning patch is v / (w R) of the limit and the torque on a sliding one w R / (4 v) of
// limit times R, where the ellipsoid has 3/2 and 16/9 of these. Force and torque are corrected by factors that
// are right at both ends and within 6 % between them; for a square they are the same within 3 %.
template <typename T>
RUBBLE_INLINE Slip<T> find_slip(T limit, const T* masses, const T* sticking) {
  // The first step is exact where all masses are equal, or much slip is left; the remainder is scaled away.
  constexpr int kSteps = 2;
  // Slip times mass where next to nothing presses: directions no longer change, and the products of what is left are
  // normal numbers, see kTinySpeed. unit: 1
  constexpr float kMostSlip = 1e4F;
  constexpr float kLeastMass = 1e-10F;  // against a division by none; unit: kg
  constexpr float kNothing = 1e-30F;  // squares of impulses below this count as zero; unit: N2 s2
  const T zero{}, one(1);
  const auto slides = sticking[0] * sticking[0] + sticking[1] * sticking[1] + sticking[2] * sticking[2] > limit * limit;
  if (!is_any(slides)) return {};
  // Where nothing presses all slips and nothing turns: the impulse is none.
  if (!is_any(choose(slides, limit, zero) > zero)) return {choose(slides, one, zero), zero};
  const T most_slip = T(kMostSlip) / larger(T(kLeastMass), larger(masses[0], larger(masses[1], masses[2])));
  T s{}, slide2{}, twist2{};
  for (int i = 0;; ++i) {
    T fall{}, x2[3];
    for (int k = 0; k < 3; ++k) {
      const T share = i == 0 ? one : one / (one + s * masses[k]), x = sticking[k] * share;
      x2[k] = x * x;
      fall = fall + x2[k] * masses[k] * share;
    }
    slide2 = x2[0] + x2[1], twist2 = x2[2];
    if (i == kSteps) break;
    const T slope = fall * limit, length2 = slide2 + twist2;
    const auto is_held = slope > zero;
    const T most = choose(length2 > limit * limit, most_slip, zero);
    const T step = choose(is_held, length2 * (root(length2) - limit) / choose(is_held, slope, one), most);
    s = smaller(most_slip, s + larger(zero, step));
  }
  const T length2 = slide2 + twist2, per_length2 = one / choose(length2 > T(kNothing), length2, one);
  const T slid = slide2 * per_length2, turned = twist2 * per_length2;  // shares of the slip, squared
  const T slid2 = slid * slid, sum = slid2 + T(81.0F / 16) * (turned * turned);  // R is 3/2 of the mean radius
  const T rim = choose(sum > zero, sum, one), swept = slid2 / rim;     // swept: 0: it spins, 1: it slides
  return {s * root(root(rim)), s / (one - T(7.0F / 16) * swept)};
}

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

// What is left for the torque beside a force of that squared length.
template <typename T>
RUBBLE_INLINE T clamp_twist(T limit, T slide2, T twist) {
  const T most = root(larger(T{}, limit * limit - slide2));
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
