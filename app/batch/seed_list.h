// Lists of seeds as a person writes them: "1..1000", "3,5,9", "1..10,20..30".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble {

// In ascending order, each once. Throws InputError, naming `key`, for anything else, an empty list,
// a seed above 2^63 - 1, or more than ten million.
std::vector<std::uint64_t> parse_seeds(const std::string& text, const std::string& key);

// One of several equal parts of the work: I of N, 1-based.
struct Shard {
  int index = 1, count = 1;  // this part of that many; range: 1 to count
  // By the seed itself, so that it does not matter how the list was written.
  bool has(std::uint64_t seed) const { return int(seed % std::uint64_t(count)) + 1 == index; }
};

// "3/8". Throws InputError.
Shard parse_shard(const std::string& text);

}  // namespace rubble
