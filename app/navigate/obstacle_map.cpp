#include "app/navigate/obstacle_map.h"

#include <algorithm>
#include <cmath>

#include "kernel/voids/cell_walk.h"

namespace rubble {
namespace {

// Evidence: of an echo or a scan with one, of a scan that saw through, and beyond what makes a cell occupied.
constexpr int kHit = 2, kPass = 1, kMostBeyond = 8;
constexpr double kNotPassed = 0.1;  // before an echo, as ranges are noisy; unit: m

}  // namespace

ObstacleMap::ObstacleMap(const Aabb& bounds, double voxel, int hits)
    : occupied_(std::uint8_t(kHit * std::clamp(hits, 1, 100))) {
  grid_.voxel = voxel;
  grid_.corner = bounds.min;
  for (int k = 0; k < 3; ++k)
    grid_.size[std::size_t(k)] = std::max(1, int(std::ceil((bounds.max[k] - bounds.min[k]) / voxel)));
  seen_.assign(grid_.count(), 0);
}

void ObstacleMap::add(const Vec3& point) {
  const Cell cell = grid_.find_cell(point);
  if (!grid_.contains(cell)) return;
  std::uint8_t& seen = seen_[grid_.index(cell)];
  seen = std::uint8_t(std::min(seen + kHit, occupied_ + kMostBeyond));
}

void ObstacleMap::touch(std::size_t cell, Now how) {
  if (now_[cell] == Now::untouched) touched_.push_back(std::uint32_t(cell));
  now_[cell] = std::max(now_[cell], how);
}

void ObstacleMap::add_scan(const Vec3& sensor, const std::vector<Vec3>& echoes) {
  now_.resize(grid_.count(), Now::untouched);
  for (const Vec3& echo : echoes) {
    const Cell cell = grid_.find_cell(echo);
    if (grid_.contains(cell)) touch(grid_.index(cell), Now::hit);
    const double range = distance(sensor, echo);
    if (!(range > kNotPassed)) continue;
    walk_cells(grid_, sensor, (echo - sensor) * (1 / range), range - kNotPassed, [this](std::size_t passed) {
      touch(passed, Now::passed);
      return true;
    });
  }
  for (const std::uint32_t cell : touched_) {
    const int seen = seen_[cell] + (now_[cell] == Now::hit ? kHit : -kPass);
    seen_[cell] = std::uint8_t(std::clamp(seen, 0, occupied_ + kMostBeyond));
    now_[cell] = Now::untouched;
  }
  touched_.clear();
}

bool ObstacleMap::is_occupied(const Vec3& point) const {
  const Cell cell = grid_.find_cell(point);
  return grid_.contains(cell) && seen_[grid_.index(cell)] >= occupied_;
}

VoxelGrid ObstacleMap::flat_grid() const {
  VoxelGrid flat = grid_;
  flat.size[2] = 1;
  return flat;
}

std::vector<Cell> ObstacleMap::find_columns(double lowest, double highest) const {
  const int first = std::max(0, grid_.find_cell({0, 0, lowest})[2]);
  const int last = std::min(grid_.size[2] - 1, grid_.find_cell({0, 0, highest})[2]);
  std::vector<Cell> columns;
  for (int y = 0; y < grid_.size[1]; ++y)
    for (int x = 0; x < grid_.size[0]; ++x)
      for (int z = first; z <= last; ++z)
        if (seen_[grid_.index({x, y, z})] >= occupied_) {
          columns.push_back({x, y, 0});
          break;
        }
  return columns;
}

std::vector<Vec3> ObstacleMap::find_around(const Vec3& place, double reach, double lowest, double highest) const {
  Cell first = grid_.find_cell({place.x - reach, place.y - reach, lowest});
  Cell last = grid_.find_cell({place.x + reach, place.y + reach, highest});
  for (std::size_t k = 0; k < 3; ++k) {
    first[k] = std::max(first[k], 0);
    last[k] = std::min(last[k], grid_.size[k] - 1);
  }
  std::vector<Vec3> found;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        if (seen_[grid_.index({x, y, z})] >= occupied_) found.push_back(grid_.centre({x, y, z}));
  return found;
}

}  // namespace rubble
