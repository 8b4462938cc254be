// Piles of any size from the pieces of the standard work.
#pragma once

#include <cstdint>

#include "kernel/model/pile.h"

namespace rubble {

inline constexpr double kStandardFootprint = 10;     // edge of the square of w1; unit: m
inline constexpr int kStandardPiecesPerLayer = 300;  // of w1

// The types of `work` (w0, w1 or w2: they have the same twelve) in the shares and sizes in which
// they were drawn there. `pieces` fall in 4 layers on a square that grows with them, so that the
// pile is as dense and as high as w1. Throws InputError when `work` has other types.
PileSpec make_standard_mix(const Pile& work, int pieces, std::uint64_t seed);

}  // namespace rubble
