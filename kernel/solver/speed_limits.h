// Limits of speeds after impacts, and damping. Not for use outside kernel/.
#pragma once

namespace rubble {

// Ejection limit. A push along a normal n by what moves at V and is much heavier turns the velocity u of a piece into
// u + n (n . (V - u)): these are a sphere that spans from u to V, and friction brings them nearer to V. So a piece at
// rest may be thrown ahead as fast as what strikes it, but sideways half as fast; what squeezes it out faster takes
// further steps. A piece may have stopped first, so the sphere from rest to V counts too; it alone where several
// touch the piece. This much more is allowed. Without this limit, one piece in a thousand leaves the pile at more than
// 8 m/s. unit: m/s
inline constexpr float kFreeKick = 1.0F;
// Rolling resistance begins when a verification of rest has lasted this long. It is not part of Coulomb's law:
// without it, a bent bar on two supports swings for minutes, where a real one rests after seconds. Sliding is
// not damped, so a piece that creeps down a slope does not count as at rest. unit: s
inline constexpr float kPatience = 3;
// From this time of a verification on, rolling resistance has its full strength, and no piece sleeps. It is
// switched off to see what it alone holds, see kernel/world/phases/verification.cpp. unit: s
inline constexpr float kPatienceEnds = 5;
// Largest share of its angular speed that rolling resistance takes from a piece in a step. A larger share
// makes a slow swing creep instead of swinging out. unit: 1
inline constexpr float kLateDamping = 0.05F;
// Only pieces that turn more slowly than this have rolling resistance. unit: rad/s
inline constexpr float kSwingingSpin = 10.0F;
// Lever with which the weight of a piece resists its rotation: the pressure in a contact patch moves to the
// side to which the piece rolls. A piece that is out of balance by less stays; by more, it rolls. unit: m
inline constexpr float kRollingLever = 0.001F;
// Largest angular speed that contacts give a piece. Lever arms are those of the beginning of the step: if a
// piece turns by more than half a radian in a step, the contact acts at a wrong place and adds spin. Not for
// pieces that roll, see kernel/collision/rolling.h, nor for pieces that are struck hard. unit: rad/s
inline constexpr float kFreeSpin = 30.0F;
// A piece that is struck at a closing speed above this may turn at that speed over its radius, which is about what one
// impact gives at most. Pieces of a pile that settles fall more slowly. unit: m/s
inline constexpr float kHardStrike = 10.0F;
// Largest gain of angular speed by contacts in a step, for a piece that turns faster than this limit. unit: rad/s
inline constexpr float kSpinGain = 3.0F;

}  // namespace rubble
