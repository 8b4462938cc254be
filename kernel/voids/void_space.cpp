#include "kernel/voids/void_space.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/model/range_check.h"
#include "kernel/voids/ball_cover.h"
#include "kernel/voids/clearance_survey.h"
#include "kernel/voids/rolling_ball.h"
#include "kernel/voids/solid_voxels.h"
#include "kernel/voids/void_grids.h"

namespace rubble {
namespace {

// Everything that is worked out on the way to a VoidSpace, from the top down.
class Builder {
 public:
  Builder(Solids solids, const VoidGrids& grids, const VoidSpaceOptions& options, const VoidProgress& progress)
      : solids_(std::move(solids)), grids_(grids), options_(options), progress_(progress), pool_(options.threads) {}

  VoidSpace build() {
    VoidSpace map = make_space(grids_.map);
    if (grids_.is_one()) {
      measure(map, true, 0, 0.7);
      sweep_outside(map, options_.ground, pool_);
      report(0.95);
    } else {
      sweep_by_large_cells(map, 0.25);
      measure(map, !options_.margin, 0.25, 0.95);
    }
    solids_ = {};
    if (options_.ground) clip_to_ground(map);
    if (options_.margin) {
      if (grids_.is_one()) keep_voids(map);
      map = crop_to_pile(std::move(map), *options_.margin);
    }
    report(1);
    return map;
  }

 private:
  void report(double done) const {
    if (progress_ && !progress_(done)) throw RunError("stopped while looking for voids");
  }

  VoidSpace make_space(const VoxelGrid& grid) const {
    VoidSpace space;
    space.grid = grid;
    space.kind = CellKinds(grid.count());
    space.rolling_radius = options_.rolling_radius;
    return space;
  }

  void sweep_by_large_cells(VoidSpace& map, double end) {
    VoidSpace balls = make_space(grids_.ball);
    measure(balls, true, 0, 0.7 * end);
    roll_ball(balls, options_.ground);
    cover_by_balls(balls, map, pool_);
    report(end);
  }

  // Solids, and the clearance from the pieces; the ground is added when the ball has rolled.
  // all: of all cells, else of voids and their borders.
  void measure(VoidSpace& space, bool all, double begin, double end) {
    const auto part = [&](double done) { report(begin + (end - begin) * done); };
    fill_solids(space.grid, solids_, pool_, space.kind);
    part(0.2);
    if (all)
      space.clearance = CellClearance(space.grid.count());
    else
      keep_voids(space);
    measure_clearance(space, solids_, pool_, [&](double done) { part(0.2 + 0.8 * done); });
  }

  void clip_to_ground(VoidSpace& space) {
    const VoxelGrid& grid = space.grid;
    const std::size_t layer = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
    pool_.run(grid.size[2], 1, [&](int begin, int end) {
      for (int z = begin; z < end; ++z) {
        const double height = std::max(0.0, grid.centre(Cell{0, 0, z}).z);
        for (std::size_t i = std::size_t(z) * layer; i < (std::size_t(z) + 1) * layer; ++i)
          space.clearance.set(i, float(std::min(double(space.clearance[i]), height)));
      }
    });
  }

  // Most of a map is outside, where nobody asks for the clearance but at the border of a void.
  static void keep_voids(VoidSpace& space) {
    std::vector<bool> wanted(space.kind.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      if (space.kind[i] != CellKind::free_void) continue;
      wanted[i] = true;
      for_each_neighbour(space.grid, i, [&](std::size_t k) { wanted[k] = wanted[k] || space.kind[k] == CellKind::outside; });
    }
    space.clearance.keep(wanted);
  }

  Solids solids_;
  const VoidGrids& grids_;
  const VoidSpaceOptions& options_;
  const VoidProgress& progress_;
  ThreadPool pool_;
};

}  // namespace

void VoidSpaceOptions::validate() const {
  RangeCheck check("");
  check.expect(voxel >= 0.001 && voxel <= 1, "voxel", "0.001 to 1 m", voxel);
  check.expect(rolling_radius >= 2 * voxel && rolling_radius <= 10, "rolling_radius",
               "2 voxels to 10 m", rolling_radius);
  if (margin) check.expect(*margin >= 0 && *margin <= 100, "margin", "0 to 100 m", *margin);
  check.expect(memory_limit > 0, "memory_limit", "more than 0 bytes", memory_limit);
  check.expect(threads >= 0 && threads <= 1024, "threads", "0 to 1024", threads);
  check.finish();
}

double VoidSpace::volume(CellKind wanted) const {
  return double(kind.count(wanted)) * cell_volume();
}

double VoidSpace::covered_volume() const {
  const std::size_t layer = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  std::vector<char> roofed(layer, 0);
  std::size_t covered = 0;
  for (std::size_t first = kind.size(); first > 0;) {  // from the top down
    first -= layer;
    for (std::size_t c = 0; c < layer; ++c) {
      if (kind[first + c] == CellKind::solid)
        roofed[c] = 1;
      else
        covered += std::size_t(roofed[c]);
    }
  }
  return double(covered) * cell_volume();
}

VoidSpace calc_void_space(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                          const VoidSpaceOptions& options, const VoidProgress& progress) {
  options.validate();
  return calc_void_space(place_solids(pile, meshes), options, progress);
}

VoidSpace calc_void_space(Solids solids, const VoidSpaceOptions& asked, const VoidProgress& progress) {
  asked.validate();
  VoidSpaceOptions options = asked;
  const double fitting = fitting_voxel(solids, asked);
  if (fitting <= asked.coarsest.value_or(asked.voxel)) options.voxel = fitting;
  check_memory(solids, options);
  const VoidGrids grids = plan_grids(solids, options);
  const std::uint64_t pile_state = solids.pile_state;
  VoidSpace space = Builder(std::move(solids), grids, options, progress).build();
  space.pile_state = pile_state;
  return space;
}

}  // namespace rubble
