// Counts the ones of a word in place: without an instruction for it compilers call a function.
#pragma once

#include <cstdint>

namespace rubble {

inline unsigned count_ones(std::uint64_t word) {
  word -= word >> 1 & 0x5555555555555555;  // of each two bits
  word = (word & 0x3333333333333333) + (word >> 2 & 0x3333333333333333);  // of each four
  word = (word + (word >> 4)) & 0x0f0f0f0f0f0f0f0f;  // of each byte
  return unsigned(word * 0x0101010101010101 >> 56);
}

}  // namespace rubble
