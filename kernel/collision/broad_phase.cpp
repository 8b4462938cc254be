#include "kernel/collision/broad_phase.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kEnlarge = 0.03;  // boxes stay as they are while a piece moves by less; unit: m
constexpr std::size_t kFineBuckets = 1u << 14, kCoarseBuckets = 1u << 12;
constexpr double kMostFine = 64;    // what covers more cells of the fine grid goes into a coarser one; unit: cell
constexpr double kMostCoarse = 12;   // likewise of those, so that an item is about as large as a cell; unit: cell
constexpr std::size_t kFewLarge = 32;  // so many are looked through without a grid

}  // namespace

BroadPhase::BroadPhase() : fine_(kFineBuckets) {}

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
  if (range_of(box, kCell).cells() <= kMostFine) return kFine;
  for (int level = 0; level < kCoarse; ++level)
    if (range_of(box, kCoarseCells[level]).cells() <= kMostCoarse) return std::uint8_t(level);
  return kNoGrid;
}

int BroadPhase::add() {
  boxes_.emplace_back();
  present_.push_back(0);
  levels_.push_back(kFine);
  places_.push_back(0);
  seen_.push_back(0);
  return int(boxes_.size()) - 1;
}

Aabb BroadPhase::update(int item, const Aabb& tight, const Vec3& motion) {
  Aabb before;
  if (present_[item]) before = boxes_[item], erase(item);
  const Vec3 grow{kEnlarge, kEnlarge, kEnlarge};
  boxes_[item].min = tight.min - grow + min(motion, Vec3{});
  boxes_[item].max = tight.max + grow + max(motion, Vec3{});
  insert(item);
  return before;
}

void BroadPhase::remove(int item) {
  if (present_[item]) erase(item);
}

void BroadPhase::insert(int item) {
  present_[item] = 1;
  const Aabb& box = boxes_[item];
  const std::uint8_t level = levels_[item] = choose_level(box);
  const auto put = [item](Bucket& bucket) { bucket.push_back(item); };
  if (level == kFine) return ++small_count_, for_cells(fine_, kCell, box, put);
  places_[item] = std::int32_t(large_.size());
  large_.push_back(item);
  if (level == kNoGrid) return put(boundless_);
  if (coarse_[level].empty()) coarse_[level].resize(kCoarseBuckets);
  for_cells(coarse_[level], kCoarseCells[level], box, put);
}

void BroadPhase::erase(int item) {
  present_[item] = 0;
  const auto drop = [item](Bucket& bucket) {
    const auto at = std::find(bucket.begin(), bucket.end(), item);
    if (at == bucket.end()) return;
    *at = bucket.back();
    bucket.pop_back();
  };
  const std::uint8_t level = levels_[item];
  if (level == kFine) return --small_count_, for_cells(fine_, kCell, boxes_[item], drop);
  const std::int32_t last = large_.back();
  large_[places_[item]] = last, places_[last] = places_[item];
  large_.pop_back();
  if (level == kNoGrid) return drop(boundless_);
  for_cells(coarse_[level], kCoarseCells[level], boxes_[item], drop);
}

void BroadPhase::add_found(const Bucket& items, const Aabb& box) {
  for (std::int32_t other : items)
    if (is_new(other) && overlap(box, boxes_[other])) found_.push_back(other);
}

// In the order of their list, whatever finds them.
const BroadPhase::Bucket& BroadPhase::find_large(int item) {
  const Aabb& box = boxes_[item];
  found_.clear();
  bool by_grid = large_.size() > kFewLarge;
  for (const double cell : kCoarseCells) by_grid = by_grid && range_of(box, cell).cells() < double(large_.size());
  if (!by_grid) {
    add_found(large_, box);
    return found_;
  }
  for (int level = 0; level < kCoarse; ++level)
    if (!coarse_[level].empty())
      for_cells(coarse_[level], kCoarseCells[level], box, [&](const Bucket& bucket) { add_found(bucket, box); });
  add_found(boundless_, box);
  std::sort(found_.begin(), found_.end(), [this](std::int32_t a, std::int32_t b) { return places_[a] < places_[b]; });
  return found_;
}

// By number.
const BroadPhase::Bucket& BroadPhase::find_small(int item) {
  const Aabb& box = boxes_[item];
  found_.clear();
  if (small_count_ == 0) return found_;
  if (range_of(box, kCell).cells() < double(boxes_.size())) {
    for_cells(fine_, kCell, box, [&](const Bucket& bucket) { add_found(bucket, box); });
    std::sort(found_.begin(), found_.end());
    return found_;
  }
  for (std::int32_t other = 0; other < std::int32_t(boxes_.size()); ++other)
    if (present_[other] && levels_[other] == kFine && overlap(box, boxes_[other])) found_.push_back(other);
  return found_;
}

}  // namespace rubble
