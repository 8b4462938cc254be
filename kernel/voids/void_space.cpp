#include "kernel/voids/void_space.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/geometry/distance_transform.h"
#include "kernel/model/range_check.h"
#include "kernel/voids/rolling_ball.h"
#include "kernel/voids/solid_voxels.h"

namespace rubble {
namespace {

constexpr double kBytesPerCell = 5.6;    // kind and clearance, some layers, lists of void cells
constexpr double kBytesPerSurface = 40;  // of one cell of a surface, while slabs are joined

std::string format(double value, const char* unit) {
  char text[64];
  std::snprintf(text, sizeof text, "%.4g %s", value, unit);
  return text;
}

bool is_scenery(const SolidPiece& piece, const VoidSpaceOptions& options) {
  const std::vector<int>& types = options.scenery;
  return std::find(types.begin(), types.end(), piece.type) != types.end();
}

// With terrain, the lowest cells are in it. Fines may lie about the pile and do not count.
Aabb find_bounds(const Solids& solids, const VoidSpaceOptions& options) {
  Aabb box;
  for (const SolidPiece& piece : solids.pieces) {
    if (piece.box.empty() || piece.type == kFineType || is_scenery(piece, options)) continue;
    box.include(piece.box.min);
    box.include(piece.box.max);
  }
  if (box.empty()) box.include({0, 0, 0});
  if (options.ground) box.min.z = 0;
  return box;
}

// Around the pieces, with room for the rolling ball; corners at whole multiples of the voxel, so
// that a pile is cut in the same way wherever its edge happens to be.
VoxelGrid make_grid(const Aabb& box, const VoidSpaceOptions& options) {
  const double margin = options.rolling_radius + 3 * options.voxel;
  VoxelGrid grid;
  grid.voxel = options.voxel;
  for (int k = 0; k < 3; ++k) {
    const bool floor = k == 2 && options.ground;
    const double low = std::floor((box.min[k] - (floor ? 0 : margin)) / options.voxel);
    const double high = std::ceil((std::max(box.max[k], box.min[k]) + margin) / options.voxel);
    grid.corner[k] = low * options.voxel;
    grid.size[std::size_t(k)] = int(high - low);
  }
  return grid;
}

double count_cells(const Aabb& box, const VoidSpaceOptions& options) {
  const double margin = options.rolling_radius + 3 * options.voxel;
  const Vec3 size = box.max - box.min;
  const double h = options.voxel;
  return (size.x + 2 * margin) / h * ((size.y + 2 * margin) / h) *
         ((size.z + (options.ground ? 1 : 2) * margin) / h);
}

double estimate(const Solids& solids, const VoidSpaceOptions& options) {
  const Vec3 room = find_bounds(solids, options).max - find_bounds(solids, options).min;
  double area = 0;
  for (const SolidPiece& piece : solids.pieces) {
    if (is_scenery(piece, options)) {
      area += 2 * room.x * room.y;  // about what of it is in the grid
      continue;
    }
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const QueryTriangle& t = solids.triangles[i];
      area += norm(cross(t.b - t.a, t.c - t.a)) / 2;
    }
  }
  const double surface = 2.2 * area / (options.voxel * options.voxel);
  return kBytesPerCell * count_cells(find_bounds(solids, options), options) +
         kBytesPerSurface * surface + double(solids.triangles.size() * sizeof(QueryTriangle));
}

void check_memory(const Solids& solids, const VoidSpaceOptions& options) {
  const double need = estimate(solids, options);
  if (need <= options.memory_limit) return;
  VoidSpaceOptions coarser = options;
  while (estimate(solids, coarser) > options.memory_limit && coarser.voxel < 10) {
    coarser.voxel *= 1.05;
  }
  Diagnostic d;
  d.key = "voxel";
  d.message = "too small for the memory: about " + format(need / (1 << 30), "GiB") + " are needed";
  d.expected = "at most " + format(options.memory_limit / (1 << 30), "GiB");
  d.found = "voxels of " + format(options.voxel, "m");
  d.hint = "use voxels of " + format(coarser.voxel, "m") + " or raise the limit";
  throw InputError(d);
}

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
  Builder(Solids solids, const VoidSpaceOptions& options, const VoidProgress& progress)
      : solids_(std::move(solids)), options_(options), progress_(progress), pool_(options.threads) {
    space_.grid = make_grid(find_bounds(solids_, options), options);
    space_.rolling_radius = options.rolling_radius;
  }

  VoidSpace build() {
    mark_solids();
    report(0.15);
    surface_ = find_surface(space_.grid, solids_, pool_);
    report(0.45);
    measure_clearance();
    surface_ = {};
    solids_ = {};
    report(0.7);
    sweep_outside(space_, options_.ground, pool_);
    report(0.95);
    if (options_.ground) clip_to_ground();
    report(1);
    return std::move(space_);
  }

 private:
  void report(double done) const {
    if (progress_ && !progress_(done)) throw RunError("stopped while looking for voids");
  }

  // Layers of cells, each to one thread.
  template <typename Body>
  void for_each_cell(Body&& body) {
    const std::size_t layer = std::size_t(space_.grid.size[0]) * std::size_t(space_.grid.size[1]);
    pool_.run(space_.grid.size[2], 1, [&](int begin, int end) {
      for (std::size_t i = std::size_t(begin) * layer; i < std::size_t(end) * layer; ++i) body(i);
    });
  }

  void mark_solids() {
    const std::vector<std::uint8_t> solid = fill_solids(space_.grid, solids_, pool_);
    space_.kind.assign(space_.grid.count(), CellKind::free_void);
    for_each_cell([&](std::size_t i) {
      if (solid[i]) space_.kind[i] = CellKind::solid;
    });
  }

  // From the pieces alone; the ground is added when the ball has rolled. Near is what is nearest
  // to the cell itself or, since that was the nearest of surface *cells*, to one beside it.
  // The nearest surface cells are found in the memory of the clearance, which replaces them layer
  // by layer.
  void measure_clearance() {
    const VoxelGrid& grid = space_.grid;
    space_.clearance.resize(grid.count());
    float* const values = space_.clearance.data();
    find_nearest_seeds(grid, surface_.cells, pool_, values);
    const std::size_t row = std::size_t(grid.size[0]), layer = row * std::size_t(grid.size[1]);
    std::vector<std::uint32_t> below(layer), here(layer);
    for (int z = 0; z < grid.size[2]; ++z) {
      const std::size_t first = std::size_t(z) * layer;
      std::memcpy(here.data(), values + first, 4 * layer);
      pool_.run(grid.size[1], 8, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
          for (int x = 0; x < grid.size[0]; ++x) {
            const std::size_t c = std::size_t(x) + row * std::size_t(y);
            NearestTriangle found(solids_, surface_, grid.centre(Cell{x, y, z}));
            found.consider(here[c]);
            if (x > 0) found.consider(here[c - 1]);
            if (x + 1 < grid.size[0]) found.consider(here[c + 1]);
            if (y > 0) found.consider(here[c - row]);
            if (y + 1 < grid.size[1]) found.consider(here[c + row]);
            if (z > 0) found.consider(below[c]);
            if (z + 1 < grid.size[2]) found.consider(seed_at(values, first + layer + c));
            values[first + c] = space_.kind[first + c] == CellKind::solid ? 0 : found.distance();
          }
      });
      std::swap(below, here);
    }
  }

  void clip_to_ground() {
    for_each_cell([&](std::size_t i) {
      const double height = space_.grid.centre(i).z;
      space_.clearance[i] = float(std::min(double(space_.clearance[i]), std::max(0.0, height)));
    });
  }

  Solids solids_;
  const VoidSpaceOptions& options_;
  const VoidProgress& progress_;
  ThreadPool pool_;
  VoidSpace space_;
  VoxelSurface surface_;
};

}  // namespace

void VoidSpaceOptions::validate() const {
  RangeCheck check("");
  check.expect(voxel >= 0.001 && voxel <= 1, "voxel", "0.001 to 1 m", voxel);
  check.expect(rolling_radius >= 2 * voxel && rolling_radius <= 10, "rolling_radius",
               "2 voxels to 10 m", rolling_radius);
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
                          const VoidSpaceOptions& options, const VoidProgress& progress) {
  options.validate();
  Solids solids = place_solids(pile, meshes);
  check_memory(solids, options);
  VoidSpace space = Builder(std::move(solids), options, progress).build();
  space.pile_state = pile.state_hash();
  return space;
}

}  // namespace rubble
