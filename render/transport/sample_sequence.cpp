#include "render/transport/sample_sequence.h"

#include <array>

namespace rubble {

namespace {

std::uint32_t mix(std::uint32_t x) {  // a bijection whose every output bit depends on every input bit
  x ^= x >> 16, x *= 0x7feb352du;
  x ^= x >> 15, x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
  x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
  x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
  return __builtin_bswap32(x);
}

// Each bit is flipped as the bits below it say, so that, of reversed numbers, intervals of powers of
// two are swapped: Owen scrambling. Constants: Burley 2020.
std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

// The second dimension is linear over bits: one table for each byte of the index.
using ByteTables = std::array<std::array<std::uint32_t, 256>, 4>;

ByteTables make_tables() {
  std::array<std::uint32_t, 32> columns{};
  std::uint32_t v = 0x80000000u;
  for (std::uint32_t& column : columns) column = v, v ^= v >> 1;
  ByteTables tables{};
  for (std::size_t byte = 0; byte < 4; ++byte)
    for (std::uint32_t value = 0; value < 256; ++value)
      for (std::size_t bit = 0; bit < 8; ++bit)
        if (value >> bit & 1u) tables[byte][value] ^= columns[byte * 8 + bit];
  return tables;
}

std::uint32_t second_dimension(std::uint32_t index) {
  static const ByteTables tables = make_tables();
  return tables[0][index & 255u] ^ tables[1][index >> 8 & 255u] ^ tables[2][index >> 16 & 255u] ^
         tables[3][index >> 24];
}

float to_unit(std::uint32_t x) { return float(x >> 8) * (1.0f / 16777216.0f); }

}  // namespace

SampleSequence::SampleSequence(std::uint64_t seed, std::uint32_t pixel)
    : key_(mix(mix(std::uint32_t(seed) ^ mix(std::uint32_t(seed >> 32))) ^ mix(pixel + 0x9e3779b9u))) {}

SamplePair SampleSequence::pair(std::uint32_t sample, std::uint32_t use) const {
  const std::uint32_t seed = mix(key_ + use * 0x9e3779b9u);
  const std::uint32_t index =
      reverse_bits(scramble_reversed(reverse_bits(sample), seed));  // another order for each use
  const std::uint32_t x = scramble_reversed(index, mix(seed + 1));
  const std::uint32_t y = scramble_reversed(reverse_bits(second_dimension(index)), mix(seed + 2));
  return {to_unit(reverse_bits(x)), to_unit(reverse_bits(y))};
}

}  // namespace rubble
