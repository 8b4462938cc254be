#include "app/card/splits.h"

#include <charconv>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"

namespace rubble {

SplitShares parse_shares(const std::string& text) {
  std::array<int, 3> shares{-1, -1, -1};
  const char *at = text.data(), *const end = at + text.size();
  bool good = true;
  for (std::size_t i = 0; i < 3 && good; ++i) {
    if (i > 0) good = at != end && *at++ == ',';
    const auto read = std::from_chars(at, end, shares[i]);
    good = good && read.ec == std::errc() && shares[i] >= 0 && shares[i] <= 100;
    at = read.ptr;
  }
  if (!good || at != end || shares[0] + shares[1] + shares[2] != 100)
    throw InputError({"", 0, "--splits", "not shares of a dataset",
                      "three whole numbers of percent whose sum is 100, as in 80,10,10", text, ""});
  return {shares[0], shares[1], shares[2]};
}

int split_of(std::uint64_t seed, const SplitShares& shares) {
  const std::string digits = sha256("rubble split " + std::to_string(seed)).substr(0, 8);
  const int n = int(std::stoul(digits, nullptr, 16) % 100);
  return n < shares.train ? 0 : n < shares.train + shares.val ? 1 : 2;
}

std::string describe_rule(const SplitShares& s) {
  const int val = s.train + s.val;
  return "The split follows from the seed alone: n is the number that the first 8 hexadecimal digits of SHA-256 of "
         "`rubble split SEED` write, modulo 100; `train` if n < " + std::to_string(s.train) + ", `val` if n < " +
         std::to_string(val) + ", else `test`. So no pile is in two splits, and more seeds move none.\n";
}

std::string describe_split(std::uint64_t seed, const SplitShares& shares) {
  return "## Split\n\nSeed " + std::to_string(seed) + " is of `" + kSplits[std::size_t(split_of(seed, shares))] +
         "`. " + describe_rule(shares);
}

}  // namespace rubble
