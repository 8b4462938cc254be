// Sets that are joined: which of n things are connected, also through others (union by lowest number, path halving).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace rubble {

class DisjointSets {
 public:
  // Each of `count` things is alone.
  void reset(std::size_t count) {
    parent_.resize(count);
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  void join(std::int32_t a, std::int32_t b) {
    a = find(a), b = find(b);
    parent_[std::size_t(std::max(a, b))] = std::min(a, b);
  }
  // The lowest number of the set that `i` is in.
  std::int32_t find(std::int32_t i) {
    while (parent_[std::size_t(i)] != i) {
      parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
      i = parent_[std::size_t(i)];
    }
    return i;
  }

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace rubble
