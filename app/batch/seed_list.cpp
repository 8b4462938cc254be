#include "app/batch/seed_list.h"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr std::uint64_t kMostSeeds = 10'000'000;
constexpr std::uint64_t kLargestSeed = std::uint64_t(INT64_MAX);

bool parse_number(const std::string& text, std::uint64_t& number) {
  const char* const end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  return read.ec == std::errc() && read.ptr == end;
}

bool parse_range(const std::string& text, std::uint64_t& first, std::uint64_t& last) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) return parse_number(text, first) && parse_number(text, last);
  return parse_number(text.substr(0, dots), first) && parse_number(text.substr(dots + 2), last);
}

}  // namespace

std::vector<std::uint64_t> parse_seeds(const std::string& text, const std::string& key) {
  const auto fail = [&] {
    throw InputError({"", 0, key, "not a list of seeds",
                      "numbers and ranges such as 1..1000 or 3,5,9", "\"" + text + "\"", ""});
  };
  std::vector<std::uint64_t> seeds;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ',');) {
    std::uint64_t first = 0, last = 0;
    if (!parse_range(part, first, last) || first > last || last > kLargestSeed) fail();
    if (last - first >= kMostSeeds - seeds.size()) fail();
    for (std::uint64_t seed = first; seed <= last; ++seed) seeds.push_back(seed);
  }
  if (seeds.empty()) fail();
  std::sort(seeds.begin(), seeds.end());
  seeds.erase(std::unique(seeds.begin(), seeds.end()), seeds.end());
  return seeds;
}

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  std::uint64_t index = 0, count = 0;
  if (slash == std::string::npos || !parse_number(text.substr(0, slash), index) ||
      !parse_number(text.substr(slash + 1), count) || index < 1 || index > count || count > 1000000)
    throw InputError({"", 0, "--shard", "not a part of a whole", "I/N with 1 <= I <= N, as in 3/8",
                      "\"" + text + "\"", ""});
  return {int(index), int(count)};
}

}  // namespace rubble
