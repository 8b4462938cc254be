// Points by the cell of space that they lie in, to find those near a place.
#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

class PointGrid {
 public:
  explicit PointGrid(float cell) : cell_(cell) {}

  void add(const Vec3f& p, std::uint32_t index) { cells_[key(at(p.x), at(p.y), at(p.z))].push_back(index); }

  // Calls visit(index) for all that lie within `reach` cells of the place's own, and some more, always in
  // the same order.
  template <typename Visit>
  void near(const Vec3f& p, int reach, const Visit& visit) const {
    const int x = at(p.x), y = at(p.y), z = at(p.z);
    for (int k = z - reach; k <= z + reach; ++k)
      for (int j = y - reach; j <= y + reach; ++j)
        for (int i = x - reach; i <= x + reach; ++i) {
          const auto found = cells_.find(key(i, j, k));
          if (found == cells_.end()) continue;
          for (const std::uint32_t index : found->second) visit(index);
        }
  }

 private:
  int at(float x) const { return int(std::floor(x / cell_)); }
  static std::uint64_t key(int x, int y, int z) {
    constexpr std::uint64_t kMask = (1u << 21) - 1;
    return (std::uint64_t(x) & kMask) | (std::uint64_t(y) & kMask) << 21 | (std::uint64_t(z) & kMask) << 42;
  }

  float cell_;  // unit: m
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace rubble
