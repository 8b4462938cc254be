#include "kernel/voids/void_space.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/geometry/distance_transform.h"
#include "kernel/model/range_check.h"
#include "kernel/voids/ball_cover.h"
#include "kernel/voids/rolling_ball.h"
#include "kernel/voids/solid_voxels.h"
#include "kernel/voids/void_grids.h"

namespace rubble {
namespace {

// Of some triangles of a surface the distance to the nearest.
class NearestTriangle {
 public:
  NearestTriangle(const Solids& solids, const VoxelSurface& surface, const Vec3& from)
      : solids_(solids), surface_(surface), from_(from) {}

  void consider(std::uint32_t seed) {  // number of a surface cell
    if (seed == kNoSeed) return;
    const std::uint32_t triangle = surface_.triangles[seed];
    if (triangle == last_) return;
    last_ = triangle;
    const Vec3 d = find_closest(solids_.triangles[triangle], from_) - from_;
    square_ = std::min(square_, dot(d, d));
  }
  float distance() const { return float(std::sqrt(square_)); }

 private:
  const Solids& solids_;
  const VoxelSurface& surface_;
  const Vec3 from_;
  std::uint32_t last_ = kNoSeed;
  double square_ = 1e12;
};

// Everything that is worked out on the way to a VoidSpace, from the top down.
class Builder {
 public:
  Builder(Solids solids, const VoidGrids& grids, const VoidSpaceOptions& options, const VoidProgress& progress)
      : solids_(std::move(solids)), grids_(grids), options_(options), progress_(progress), pool_(options.threads) {}

  VoidSpace build() {
    VoidSpace map = make_space(grids_.map);
    if (grids_.is_one()) {
      measure(map, 0, 0.7);
      solids_ = {};
      sweep_outside(map, options_.ground, pool_);
      report(0.95);
    } else {
      sweep_by_large_cells(map, 0.25);
      measure(map, 0.25, 0.95);
    }
    if (options_.ground) clip_to_ground(map);
    if (options_.margin) {
      map = crop_to_pile(std::move(map), *options_.margin);
      keep_voids(map);
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
    space.kind.assign(grid.count(), CellKind::free_void);
    space.rolling_radius = options_.rolling_radius;
    return space;
  }

  void sweep_by_large_cells(VoidSpace& map, double end) {
    VoidSpace balls = make_space(grids_.ball);
    measure(balls, 0, 0.7 * end);
    roll_ball(balls, options_.ground);
    cover_by_balls(balls, map, pool_);
    report(end);
  }

  // Solids, and the clearance from the pieces.
  void measure(VoidSpace& space, double begin, double end) {
    const auto part = [&](double done) { report(begin + (end - begin) * done); };
    fill_solids(space.grid, solids_, pool_, space.kind);
    part(0.2);
    const VoxelSurface surface = find_surface(space.grid, solids_, pool_);
    part(0.6);
    measure_clearance(space, surface);
    part(1);
  }

  // From the pieces alone; the ground is added when the ball has rolled. Near is what is nearest
  // to the cell itself or, since that was the nearest of surface *cells*, to one beside it.
  // The nearest surface cells are found in the memory of the clearance, which replaces them layer
  // by layer.
  void measure_clearance(VoidSpace& space, const VoxelSurface& surface) {
    const VoxelGrid& grid = space.grid;
    float* const values = space.clearance.of_all(grid.count()).data();
    find_nearest_seeds(grid, surface.cells, pool_, values);
    const std::size_t row = std::size_t(grid.size[0]), layer = row * std::size_t(grid.size[1]);
    std::vector<std::uint32_t> below(layer), here(layer);
    for (int z = 0; z < grid.size[2]; ++z) {
      const std::size_t first = std::size_t(z) * layer;
      std::memcpy(here.data(), values + first, 4 * layer);
      pool_.run(grid.size[1], 8, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
          for (int x = 0; x < grid.size[0]; ++x) {
            const std::size_t c = std::size_t(x) + row * std::size_t(y);
            if (space.kind[first + c] == CellKind::solid) {
              values[first + c] = 0;
              continue;
            }
            NearestTriangle found(solids_, surface, grid.centre(Cell{x, y, z}));
            found.consider(here[c]);
            if (x > 0) found.consider(here[c - 1]);
            if (x + 1 < grid.size[0]) found.consider(here[c + 1]);
            if (y > 0) found.consider(here[c - row]);
            if (y + 1 < grid.size[1]) found.consider(here[c + row]);
            if (z > 0) found.consider(below[c]);
            if (z + 1 < grid.size[2]) found.consider(seed_at(values, first + layer + c));
            values[first + c] = found.distance();
          }
      });
      std::swap(below, here);
    }
  }

  void clip_to_ground(VoidSpace& space) {
    const VoxelGrid& grid = space.grid;
    const std::size_t layer = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
    std::vector<float>& values = space.clearance.of_all(grid.count());
    pool_.run(grid.size[2], 1, [&](int begin, int end) {
      for (int z = begin; z < end; ++z) {
        const double height = std::max(0.0, grid.centre(Cell{0, 0, z}).z);
        for (std::size_t i = std::size_t(z) * layer; i < (std::size_t(z) + 1) * layer; ++i)
          values[i] = float(std::min(double(values[i]), height));
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
  return double(std::count(kind.begin(), kind.end(), wanted)) * cell_volume();
}

double VoidSpace::covered_volume() const {
  const std::size_t layer = std::size_t(grid.size[0]) * std::size_t(grid.size[1]);
  std::vector<bool> roofed(layer, false);
  std::size_t covered = 0;
  for (std::size_t i = kind.size(); i-- > 0;) {  // from the top down
    if (kind[i] == CellKind::solid)
      roofed[i % layer] = true;
    else
      covered += roofed[i % layer];
  }
  return double(covered) * cell_volume();
}

VoidSpace calc_void_space(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                          const VoidSpaceOptions& asked, const VoidProgress& progress) {
  asked.validate();
  Solids solids = place_solids(pile, meshes);
  VoidSpaceOptions options = asked;
  if (const double fitting = fitting_voxel(solids, asked); fitting <= asked.coarsest.value_or(asked.voxel)) options.voxel = fitting;
  check_memory(solids, options);
  const VoidGrids grids = plan_grids(solids, options);
  VoidSpace space = Builder(std::move(solids), grids, options, progress).build();
  space.pile_state = pile.state_hash();
  return space;
}

}  // namespace rubble
