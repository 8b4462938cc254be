#include "app/search/exploration_map.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kAround = 0.5;  // the pile is mapped, too; unit: m

}  // namespace

ExplorationMap::ExplorationMap(const SearchBriefing& briefing) : radius_(briefing.rules.radius) {
  grid_.voxel = kVoxel;
  grid_.corner = briefing.bounds.min - Vec3{kAround, kAround, 0};
  grid_.corner.z = 0;
  const Vec3 size = briefing.bounds.max - grid_.corner + Vec3{kAround, kAround, kAround};
  for (int k = 0; k < 3; ++k) grid_.size[std::size_t(k)] = std::max(1, int(std::ceil(size[k] / kVoxel)));
  state_.assign(grid_.count(), kUnknown);
  near_solid_.assign(grid_.count(), 0);
  // Too near to the ground, which is outside of the grid.
  for (std::size_t i = 0; i < near_solid_.size(); ++i) near_solid_[i] = grid_.centre(i).z < radius_ + 0.5 * kVoxel;
}

std::size_t ExplorationMap::find(const Vec3& place) const {
  Cell cell = grid_.find_cell(place);
  for (std::size_t k = 0; k < 3; ++k) cell[k] = std::clamp(cell[k], 0, grid_.size[k] - 1);
  return grid_.index(cell);
}

template <typename Visit>
void ExplorationMap::for_each_within(const Cell& c, double reach, const Visit& visit) const {
  const int cells = int(std::ceil(reach / kVoxel - 1e-9));
  for (int z = c[2] - cells; z <= c[2] + cells; ++z)
    for (int y = c[1] - cells; y <= c[1] + cells; ++y)
      for (int x = c[0] - cells; x <= c[0] + cells; ++x)
        if (grid_.contains({x, y, z})) visit(grid_.index({x, y, z}));
}

void ExplorationMap::set(const Cell& cell, State state) {
  if (!grid_.contains(cell)) return;
  State& now = state_[grid_.index(cell)];
  const int more = (state == kSolid) - (now == kSolid);
  now = state;
  if (more == 0) return;
  const double reach = radius_ + 0.5 * kVoxel;
  for_each_within(cell, reach, [&](std::size_t i) {
    if (distance(grid_.centre(i), grid_.centre(cell)) < reach) near_solid_[i] = std::uint16_t(near_solid_[i] + more);
  });
}

void ExplorationMap::set_free_if_unknown(const Cell& cell) {
  if (!grid_.contains(cell)) return;
  State& now = state_[grid_.index(cell)];
  if (now == kUnknown) now = kFree;
}

void ExplorationMap::add_body(const Vec3& place) {
  for_each_within(grid_.find_cell(place), radius_ + kVoxel, [&](std::size_t i) {
    if (distance(grid_.centre(i), place) < radius_ && state_[i] == kUnknown) state_[i] = kFree;
  });
}

bool ExplorationMap::borders_unknown(std::size_t cell) const {
  bool borders = false;
  for_each_neighbour(grid_, cell, [&](std::size_t k) { borders = borders || state_[k] == kUnknown; });
  return borders;
}

bool ExplorationMap::has_roof(std::size_t cell) const {
  const std::size_t layer = std::size_t(grid_.size[0]) * std::size_t(grid_.size[1]);
  for (std::size_t k = cell; k < state_.size(); k += layer)
    if (state_[k] == kSolid) return true;
  return false;
}

}  // namespace rubble
