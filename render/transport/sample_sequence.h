// Well spread numbers for the samples of a pixel: the first two dimensions of the Sobol sequence, Owen
// scrambled and shuffled by hashing, a set of its own for each pixel and each use (Burley 2020,
// "Practical Hash-based Owen Scrambling"). A pure function of what it is asked for, so neither threads
// nor the order of tiles can matter.
#pragma once

#include <cstdint>

namespace rubble {

struct SamplePair {
  float x = 0, y = 0;  // in [0, 1)
};

class SampleSequence {
 public:
  SampleSequence() = default;
  SampleSequence(std::uint64_t seed, std::uint32_t pixel);

  // sample: 0, 1, 2, ...; use: which decision the numbers are for. Any 4^k samples in a row from a
  // multiple of 4^k fall one into each of 4^k equal squares.
  SamplePair pair(std::uint32_t sample, std::uint32_t use) const;

 private:
  std::uint32_t key_ = 0;
};

}  // namespace rubble
