#include "kernel/collision/broad_phase.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kEnlarge = 0.03;  // boxes stay as they are while a piece moves by less; unit: m
constexpr std::size_t kFineBuckets = 1u << 14, kCoarseBuckets = 1u << 12;
// What covers more cells of a grid goes into a coarser one. In those an item is about as large as a cell; unit: cell
constexpr double kMostFine = 64, kMostCoarse = 12;

}  // namespace

double BroadPhase::Range::cells() const {
  return double(max[0] - min[0] + 1) * double(max[1] - min[1] + 1) * double(max[2] - min[2] + 1);
}

BroadPhase::Range BroadPhase::range_of(const Aabb& box, double cell) {
  Range r{};
  for (int i = 0; i < 3; ++i) {
    r.min[i] = std::int64_t(std::floor(std::max(-1e6, box.min[i]) / cell));
    r.max[i] = std::int64_t(std::floor(std::min(1e6, box.max[i]) / cell));
  }
  return r;
}

std::size_t BroadPhase::hash(std::int64_t x, std::int64_t y, std::int64_t z) {
  return std::size_t(std::uint64_t(x) * 73856093u ^ std::uint64_t(y) * 19349663u ^ std::uint64_t(z) * 83492791u);
}

std::uint8_t BroadPhase::choose_level(const Aabb& box) {
  int level = 0;
  while (level < kGrids && range_of(box, kCells[level]).cells() > (level == 0 ? kMostFine : kMostCoarse)) ++level;
  return std::uint8_t(level);
}

int BroadPhase::add() {
  boxes_.emplace_back();
  present_.push_back(0);
  levels_.push_back(kGrids);
  return int(boxes_.size()) - 1;
}

Aabb BroadPhase::enlarge(const Aabb& tight, const Vec3& motion) {
  const Vec3 grow{kEnlarge, kEnlarge, kEnlarge};
  return {tight.min - grow + min(motion, Vec3{}), tight.max + grow + max(motion, Vec3{})};
}

void BroadPhase::place(int item, const Aabb& box) {
  remove(item);
  boxes_[item] = box;
  insert(item);
}

void BroadPhase::find(int item, std::vector<std::int32_t>& found) const {
  // What covers several cells is found in each of them. Of any world: marks of another search are never this one's.
  thread_local std::vector<std::uint64_t> seen;
  thread_local std::uint64_t search = 0;
  if (seen.size() < boxes_.size()) seen.resize(boxes_.size());
  ++search;
  found.clear();
  const Aabb box = boxes_[item];
  const auto consider = [&](std::int32_t other) {
    if (seen[other] == search) return;
    seen[other] = search;
    if (overlap(box, boxes_[other])) found.push_back(other);
  };
  seen[item] = search;
  for (int level = 0; level < kGrids; ++level) {
    if (counts_[level] == 0) continue;
    const Range range = range_of(box, kCells[level]);
    if (range.cells() < double(boxes_.size())) {
      for_cells(grids_[level], range, [&](const Bucket& bucket) {
        for (const std::int32_t other : bucket) consider(other);
      });
      continue;
    }
    for (std::int32_t other = 0; other < std::int32_t(boxes_.size()); ++other) {
      if (present_[other] && levels_[other] == level) consider(other);
    }
  }
  for (const std::int32_t other : boundless_) consider(other);
  std::sort(found.begin(), found.end());
}

void BroadPhase::remove(int item) {
  if (present_[item]) erase(item);
  boxes_[item] = {};
}

void BroadPhase::insert(int item) {
  present_[item] = 1;
  const int level = levels_[item] = choose_level(boxes_[item]);
  if (level == kGrids) return boundless_.push_back(item);
  if (grids_[level].empty()) grids_[level].resize(level == 0 ? kFineBuckets : kCoarseBuckets);
  ++counts_[level];
  for_cells(grids_[level], range_of(boxes_[item], kCells[level]), [item](Bucket& bucket) { bucket.push_back(item); });
}

void BroadPhase::erase(int item) {
  present_[item] = 0;
  const auto drop = [item](Bucket& bucket) {
    const auto at = std::find(bucket.begin(), bucket.end(), item);
    if (at == bucket.end()) return;
    *at = bucket.back();
    bucket.pop_back();
  };
  const int level = levels_[item];
  if (level == kGrids) return drop(boundless_);
  --counts_[level];
  for_cells(grids_[level], range_of(boxes_[item], kCells[level]), drop);
}

}  // namespace rubble
