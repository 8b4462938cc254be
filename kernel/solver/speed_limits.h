// What an impact may do at most. Not for use outside kernel/.
#pragma once

namespace rubble {

// A piece squeezed out from under a heavy one becomes faster sideways or upwards by this much in a step
// at most, or by as much as brings it to this share of the speed of the fastest point that touches it; and
// never faster than that point by more than the former. A plastic impact that needs more takes two or
// three steps. Without it one piece in a thousand leaves the pile at more than 8 m/s.
inline constexpr float kFreeKick = 1.0F;   // unit: m/s
inline constexpr float kKickShare = 0.4F;  // unit: 1
// Rolling resistance, which Coulomb's law lacks: a bent bar on two supports swings for minutes, where a
// real one is still after seconds. Once a verification of rest has lasted this long, what turns more slowly
// than this loses up to this share of its spin in each step: less than would make a slow swing creep. Sliding
// is not damped: what creeps down a slope does not count as at rest. Nothing is damped outside a verification.
inline constexpr float kPatience = 3, kPatienceEnds = 5;  // unit: s
inline constexpr float kLateDamping = 0.05F;              // unit: 1
inline constexpr float kSwingingSpin = 10.0F;             // unit: rad/s
// And its weight gives a torque with this lever against its spin: the patch of a contact, whose pressure
// moves to the side that a piece rolls to. What is out of balance by less stays; by more, it rolls. unit: m
inline constexpr float kRollingLever = 0.001F;
// Contacts spin a piece no faster than this, unless it turned faster before: then they add this much
// a step at most. Arms are those of the step's start: what turns by more than half a radian in a step
// is pushed where it no longer is, gains spin by it, and passes it on. Not for what rolls, see
// kernel/collision/rolling.h. unit: rad/s
inline constexpr float kFreeSpin = 30.0F, kSpinGain = 3.0F;

}  // namespace rubble
