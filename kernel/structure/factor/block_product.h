// Products of 6 x 6 blocks, in which a factorization spends its time.
#pragma once

#include <array>

namespace rubble {

using Block6 = std::array<double, 36>;  // row by row
using Six = std::array<double, 6>;

// target -= a b
using SubtractProduct = void (*)(Block6& target, const Block6& a, const Block6& b);

// On two numbers at a time, as every x86-64 and arm64 does.
SubtractProduct portable_subtract_product();
// The widest that this machine has; the same operations on the same numbers, so the same bits.
SubtractProduct best_subtract_product();

}  // namespace rubble
