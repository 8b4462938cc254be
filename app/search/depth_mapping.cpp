#include "app/search/depth_mapping.h"

#include <algorithm>
#include <memory>

#include "io/voids/occupancy_octree.h"

namespace rubble {
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
