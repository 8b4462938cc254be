#include "kernel/collision/broad_phase.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kCell = 0.6;          // unit: m; about the size of a piece
constexpr double kEnlarge = 0.03;      // boxes stay as they are while a piece moves by less; unit: m
constexpr std::size_t kBuckets = 1u << 14;
constexpr std::int64_t kLargeCells = 400;  // what covers more cells is kept in a list of its own; unit: cell

}  // namespace

BroadPhase::BroadPhase() : cells_(kBuckets) {}

std::int64_t BroadPhase::Range::cells() const {
  return (max[0] - min[0] + 1) * (max[1] - min[1] + 1) * (max[2] - min[2] + 1);
}

BroadPhase::Range BroadPhase::range_of(const Aabb& box) {
  Range r{};
  for (int i = 0; i < 3; ++i) {
    r.min[i] = std::int64_t(std::floor(std::max(-1e6, box.min[i]) / kCell));
    r.max[i] = std::int64_t(std::floor(std::min(1e6, box.max[i]) / kCell));
  }
  return r;
}

std::size_t BroadPhase::bucket(std::int64_t x, std::int64_t y, std::int64_t z) {
  const std::uint64_t h = std::uint64_t(x) * 73856093u ^ std::uint64_t(y) * 19349663u ^
                          std::uint64_t(z) * 83492791u;
  return std::size_t(h & (kBuckets - 1));
}

int BroadPhase::add() {
  boxes_.emplace_back();
  present_.push_back(0);
  is_large_.push_back(0);
  seen_.push_back(0);
  return int(boxes_.size()) - 1;
}

void BroadPhase::update(int item, const Aabb& tight, const Vec3& motion) {
  if (present_[item]) erase(item);
  const Vec3 grow{kEnlarge, kEnlarge, kEnlarge};
  boxes_[item].min = tight.min - grow + min(motion, Vec3{});
  boxes_[item].max = tight.max + grow + max(motion, Vec3{});
  insert(item);
}

void BroadPhase::remove(int item) {
  if (present_[item]) erase(item);
}

void BroadPhase::insert(int item) {
  present_[item] = 1;
  is_large_[item] = range_of(boxes_[item]).cells() > kLargeCells;
  if (is_large_[item]) {
    large_.push_back(item);
    return;
  }
  for_cells(boxes_[item], [item](std::vector<std::int32_t>& cell) { cell.push_back(item); });
}

void BroadPhase::erase(int item) {
  present_[item] = 0;
  const auto drop = [item](std::vector<std::int32_t>& list) {
    const auto at = std::find(list.begin(), list.end(), item);
    if (at == list.end()) return;
    *at = list.back();
    list.pop_back();
  };
  if (is_large_[item]) return drop(large_);
  for_cells(boxes_[item], drop);
}

}  // namespace rubble
