// What an impact may do at most. Not for use outside kernel/.
#pragma once

namespace rubble {

// A piece becomes no faster sideways or upwards in one step than the fastest point that touches it was,
// and this much on top: the speed of a plastic impact is within it, what a wedge between two heavy
// pieces may gain beyond it is not. See World::Impl::limit_kicks(). unit: m/s
inline constexpr float kFreeKick = 1.0F;
// Contacts spin a piece no faster than this, unless it turned faster before: then they add this much
// a step at most. Arms are those of the step's start: what turns by more than half a radian in a step
// is pushed where it no longer is, gains spin by it, and passes it on. unit: rad/s
inline constexpr float kFreeSpin = 30.0F, kSpinGain = 3.0F;

}  // namespace rubble
