// A settled pile as a file: pile.bin. Loading gives the saved bits.
//
// In the envelope of io/base/sealed_file.h, kind "RUBPILE\n":
//   u32 count of types, each u32 length + UTF-8 name;
//   i64 steps, f64 simulated s, u8 settled, i32 layers_at_limit, i32 lost;
//   u64 count of pieces, each: i32 type, i32 layer, f64 scale, f64 rotation w x y z,
//       f64 translation x y z, f64 linear velocity x y z, f64 angular velocity x y z, u8 status;
//   u32 count of joints, each: i32 parent, i32 child, u8 kind, the poses of the joint in the frames
//       of the two pieces, f64 rotation w x y z and translation x y z each, f64 rest, f64 rest
//       rotation w x y z;
//   of a pile with a building, since version 3: i32 its first piece, i32 count of its pieces;
//       u32 count of rigid bodies of several pieces, each u32 count, then i32 pieces, ascending;
//       u32 count of ties, each: i32 pieces a and b (-1: the ground), f64 anchor in a and in b x y z each,
//       f64 length, f64 strength, f64 stretch that is left, f64 bending moment;
//   since version 4, what is carried at rest: f32 force of each tie (N); u32 count of loads of contacts, each: i32 piece,
//       i32 the other piece (-1: the ground), f32 point x y z (m, in the world), f32 force on the piece x y z (N)
// A building of version 3 is laid without loads: what is wedged in it may come down. Piles without a building have version 2. So have
// older piles with buildings: they can be drawn and measured, but their pieces cannot move again.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/model/pile_state.h"

namespace rubble {

inline constexpr std::uint32_t kPileStateVersion = 4;  // the newest

// Throws RunError when the file cannot be written.
void save_pile_state(const PileState& state, const std::string& path);

// Throws InputError for a missing, foreign, truncated or altered file, another version, or a number that is not
// finite.
PileState load_pile_state(const std::string& path);

}  // namespace rubble
