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
// What still trembles when a proof of rest has lasted this long, such as a slab that rocks between two
// supports close together, loses its last speed faster, by up to this share in each step. A slope must
// then be steeper than friction holds by 1 % of gravity, or what slides on it counts as at rest.
inline constexpr float kPatience = 9, kPatienceEnds = 11;              // unit: s
inline constexpr float kLateDamping = 0.2F;                            // unit: 1
inline constexpr float kTremblingSpin = 3.0F, kTremblingSpeed = 0.2F;  // below these; unit: rad/s, m/s
// See World::Impl::limit_kicks().
inline constexpr float kKickShare = 0.4F;
inline constexpr float kFreeKick = 1.0F;  // unit: m/s

}  // namespace rubble
