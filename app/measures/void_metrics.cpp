#include "app/measures/void_metrics.h"

#include <algorithm>

#include "kernel/voids/void_map.h"

namespace rubble {
namespace {

VoidMap make_map(const VoidScenario& voids, const PileState& pile, const AssetLibrary& assets,
                 int threads, const std::function<bool(double done)>& progress) {
  const std::vector<const TriangleMesh*> meshes = assets.finest_meshes();
  VoidSpaceOptions options;
  options.voxel = voids.voxel;
  options.rolling_radius = std::max(options.rolling_radius, 2 * voids.radius);
  options.scenery = assets.terrain();
  options.threads = threads;
  VoidSpace space =
      calc_void_space(pile, meshes, options, [&](double done) { return progress(0.7 * done); });
  return find_voids(std::move(space), {voids.radius},
                    [&](double done) { return progress(0.7 + 0.3 * done); });
}

}  // namespace

void add_void_metrics(const VoidScenario& voids, const PileState& pile, const AssetLibrary& assets,
                      int threads, const std::function<bool(double done)>& progress,
                      Metrics& metrics) {
  const VoidMap map = make_map(voids, pile, assets, threads, progress);
  const RobotVoids& robot = map.robots.front();
  double deepest = 0, way_in = 0;
  for (const Void& v : robot.voids) {
    deepest = std::max(deepest, v.depth);
    way_in = std::max(way_in, v.path_length);
  }
  metrics["void_volume_m3"] = map.void_volume;
  metrics["void_covered_m3"] = map.covered_volume;
  metrics["void_robot_m3"] = robot.volume;
  metrics["void_reachable_m3"] = robot.reachable_volume;
  metrics["void_count"] = double(robot.voids.size());
  metrics["void_depth_m"] = deepest;
  metrics["void_way_in_m"] = way_in;
}

}  // namespace rubble
