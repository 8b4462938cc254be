// Which piles are for training, which for validation, which for testing: by the seed alone, so that every
// run of a seed is in the same split, whatever else it varies, and a larger batch moves none.
//
//   n = first 8 hexadecimal digits of SHA-256("rubble split SEED"), as a number, modulo 100
//   n < train: train;  n < train + val: val;  else: test
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace rubble {

inline constexpr std::array<const char*, 3> kSplits{"train", "val", "test"};

// In percent, on average over many seeds; range of each: 0 to 100, sum 100.
struct SplitShares {
  int train = 80, val = 10, test = 10;

  std::array<int, 3> as_list() const { return {train, val, test}; }  // in the order of kSplits
};

// "80,10,10". Throws InputError naming --splits.
SplitShares parse_shares(const std::string& text);

// An index into kSplits.
int split_of(std::uint64_t seed, const SplitShares& shares);

// The rule in words, for a card; Markdown.
std::string describe_rule(const SplitShares& shares);

// The section of a card about a single run.
std::string describe_split(std::uint64_t seed, const SplitShares& shares);

}  // namespace rubble
