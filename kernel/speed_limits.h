// What pieces in contact may do at most, and how they lose their last speed. Not for use outside
// kernel/.
#pragma once

namespace rubble {

inline constexpr float kMaximumSpin = 30.0F;   // unit: rad/s
inline constexpr float kMaximumSpeed = 50.0F;  // unit: m/s
// Touching pieces that are slower than this lose a part of their speed in each step, the larger the
// slower they are: grinding of rough surfaces.
inline constexpr float kSlowSpin = 1.0F, kSpinDamping = 0.1F;     // unit: rad/s, 1
inline constexpr float kSlowSpeed = 0.1F, kSpeedDamping = 0.02F;  // unit: m/s, 1
// See World::Impl::limit_kicks().
inline constexpr float kKickShare = 0.4F;
inline constexpr float kFreeKick = 1.0F;  // unit: m/s

}  // namespace rubble
