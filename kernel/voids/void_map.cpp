#include "kernel/voids/void_map.h"

#include <algorithm>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/parallel.h"

namespace rubble {
namespace {

void check_radii(const VoxelGrid& grid, const std::vector<double>& radii) {
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (radii[i] >= grid.voxel && radii[i] <= 100) continue;
    Diagnostic d;
    d.key = "radius[" + std::to_string(i + 1) + "]";
    d.message = "cannot be told apart on this grid";
    d.expected = "at least a voxel, " + brief_text(grid.voxel) + " m, and at most 100 m";
    d.found = brief_text(radii[i]) + " m";
    d.hint = "ask for smaller voxels";
    throw InputError(d);
  }
}

VoidGraph make_graph(const VoidSpace& space, const std::vector<double>& radii) {
  const double smallest = *std::min_element(radii.begin(), radii.end());
  return find_graph(space, smallest, std::max(2 * space.grid.voxel, 0.2 * smallest));
}

}  // namespace

VoidMap find_voids(VoidSpace space, const std::vector<double>& radii,
                   const VoidProgress& progress) {
  check_radii(space.grid, radii);
  const auto report = [&](double done) {
    if (progress && !progress(done)) throw RunError("stopped while looking for voids");
  };
  VoidMap map;
  // Each takes memory of its own while it is at work, so those of a map that is kept small come one after the other.
  const int threads = space.clearance.is_sparse() ? 1 : 2;
  const auto find_places = [&] {
    if (!radii.empty()) map.graph = make_graph(space, radii);
    for (std::size_t i = 0; i < radii.size(); ++i) {
      if (threads == 1) report(0.2 + 0.4 * double(i) / double(radii.size()));
      map.robots.push_back(find_robot_voids(space, radii[i], 0));
    }
    if (threads == 1) report(0.6);
  };
  parallel_for(2, threads, [&](std::size_t i) { i == 0 ? find_places() : void(map.widest = find_widest_paths(space)); });
  for (RobotVoids& robot : map.robots) add_bottlenecks(space, map.widest, robot);
  map.void_volume = space.volume(CellKind::free_void);
  map.covered_volume = space.covered_volume();
  map.solid_volume = space.volume(CellKind::solid);
  map.space = std::move(space);
  report(1);
  return map;
}

}  // namespace rubble
