#include "app/search/exploration_map.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/voids/occupancy_octree.h"

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

namespace {

constexpr double kMapped = 5;     // of a ray; unit: m
constexpr int kStride = 2;        // of the pixels that are mapped, each way
constexpr double kInside = 1e-3;  // a ray ends so far behind the surface, in the cell that is solid; unit: m

// visit: each mapped pixel's ray in the world, with its length to the surface.
template <typename Visit>
void for_each_ray(const SearchObservation& seen, const SearchRules& rules, const DepthRays& rays, const Visit& visit) {
  const Pose body = seen.pose.world_from_body();
  for (int v = 0; v < rules.height; v += kStride)
    for (int u = 0; u < rules.width; u += kStride) {
      const auto pixel = std::size_t(v) * std::size_t(rules.width) + std::size_t(u);
      visit(body.translation, body.rotation.rotate(rays.direction(pixel)), double(seen.depth[pixel]) / rays.cosine(pixel));
    }
}

void mark_ray(const Vec3& from, const Vec3& along, double range, ExplorationMap& map) {
  constexpr double kVoxel = ExplorationMap::kVoxel;
  const double end = std::min(range - 0.5 * kVoxel, kMapped);
  for (double d = 0.25 * kVoxel; d < end; d += 0.5 * kVoxel) map.set_free_if_unknown(map.grid().find_cell(from + along * d));
  if (range <= kMapped) map.set(map.grid().find_cell(from + along * (range + kInside)), ExplorationMap::kSolid);
}

}  // namespace

DepthMapping make_ray_mapping(const SearchRules& rules) {
  return [rules, rays = DepthRays(search_camera(rules), rules.max_range)](const SearchObservation& seen, ExplorationMap& map) {
    for_each_ray(seen, rules, rays, [&](const Vec3& from, const Vec3& along, double range) { mark_ray(from, along, range, map); });
  };
}

// The tree's cells are those of the map: it is fed in the map's frame.
DepthMapping make_octomap_mapping(const SearchRules& rules) {
  const auto tree = std::make_shared<OccupancyOctree>(ExplorationMap::kVoxel);
  return [rules, tree, rays = DepthRays(search_camera(rules), rules.max_range)](const SearchObservation& seen,
                                                                                ExplorationMap& map) {
    const Vec3 corner = map.grid().corner;
    std::vector<Vec3> ends;
    for_each_ray(seen, rules, rays, [&](const Vec3& from, const Vec3& along, double range) {
      ends.push_back(from + along * (std::min(range, 2 * kMapped) + kInside) - corner);
    });
    for (const OccupancyOctree::Change& change : tree->insert(seen.pose.position - corner, ends, kMapped))
      map.set(change.cell, change.occupied ? ExplorationMap::kSolid : ExplorationMap::kFree);
  };
}

}  // namespace rubble
