#include "io/voids/occupancy_octree.h"

#include <octomap/octomap.h>

#include <algorithm>

namespace rubble {
namespace {

constexpr int kMiddle = 1 << 15;  // the key of the cell that begins at the origin

octomap::point3d to_point(const Vec3& p) { return {float(p.x), float(p.y), float(p.z)}; }

}  // namespace

struct OccupancyOctree::Impl {
  octomap::OcTree tree;
};

OccupancyOctree::OccupancyOctree(double voxel) : impl_(new Impl{octomap::OcTree(voxel)}) {
  impl_->tree.enableChangeDetection(true);
}

OccupancyOctree::~OccupancyOctree() = default;

std::vector<OccupancyOctree::Change> OccupancyOctree::insert(const Vec3& origin, const std::vector<Vec3>& points,
                                                             double max_range) {
  octomap::OcTree& tree = impl_->tree;
  octomap::Pointcloud cloud;
  cloud.reserve(points.size());
  for (const Vec3& p : points) cloud.push_back(to_point(p));
  tree.insertPointCloud(cloud, to_point(origin), max_range);
  std::vector<Change> changes;
  for (auto it = tree.changedKeysBegin(); it != tree.changedKeysEnd(); ++it) {
    const octomap::OcTreeKey& key = it->first;
    changes.push_back({{int(key[0]) - kMiddle, int(key[1]) - kMiddle, int(key[2]) - kMiddle},
                       tree.isNodeOccupied(tree.search(key))});
  }
  tree.resetChangeDetection();
  std::sort(changes.begin(), changes.end(), [](const Change& a, const Change& b) { return a.cell < b.cell; });
  return changes;
}

}  // namespace rubble
