#include "kernel/voids/void_space.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/geometry/distance_transform.h"
#include "kernel/model/range_check.h"
#include "kernel/voids/solid_voxels.h"

namespace rubble {
namespace {

constexpr double kBytesPerCell = 10.5;   // kind, clearance, a transform, marks of the rolling ball
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
    // What comes now needs as much again.
    surface_ = {};
    solids_ = {};
    report(0.7);
    sweep_outside();
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
  void measure_clearance() {
    const VoxelGrid& grid = space_.grid;
    const auto nearest = find_nearest_seeds(grid, surface_.cells, pool_);
    space_.clearance.assign(grid.count(), 0);
    for_each_cell([&](std::size_t i) {
      if (space_.kind[i] == CellKind::solid) return;
      const Vec3 centre = grid.centre(i);
      double best = 1e12;
      std::uint32_t last = kNoSeed;
      const auto consider = [&](std::size_t k) {
        if (nearest[k] == kNoSeed) return;
        const std::uint32_t triangle = surface_.triangles[nearest[k]];
        if (triangle == last) return;
        last = triangle;
        const Vec3 d = find_closest(solids_.triangles[triangle], centre) - centre;
        best = std::min(best, dot(d, d));
      };
      consider(i);
      for_each_neighbour(grid, i, consider);
      space_.clearance[i] = float(std::sqrt(best));
    });
  }

  // Where the rolling ball's centre may be, reached from the border of the grid; runs of cells along X
  // at a time, since most of the grid is such runs.
  std::vector<std::uint8_t> roll() const {
    const Cell& n = space_.grid.size;
    std::vector<std::uint8_t> reached(space_.grid.count(), 0);
    std::vector<Cell> front;
    const auto drain = [&] {
      while (!front.empty()) {
        const Cell c = front.back();
        front.pop_back();
        fill_run(c, reached, front);
      }
    };
    for (int z = 0; z < n[2]; ++z)
      for (int y = 0; y < n[1]; ++y) {
        const bool whole = y == 0 || y + 1 == n[1] || z + 1 == n[2] || (z == 0 && !options_.ground);
        for (int x = 0; x < n[0]; x += whole ? 1 : std::max(1, n[0] - 1)) {
          front.push_back({x, y, z});
          drain();
        }
      }
    return reached;
  }

  bool is_open(std::size_t i, const std::vector<std::uint8_t>& reached) const {
    return !reached[i] && space_.kind[i] != CellKind::solid &&
           space_.clearance[i] >= float(options_.rolling_radius);
  }

  // Marks the run of open cells along X that a cell is in; the runs beside it go to the front.
  void fill_run(const Cell& c, std::vector<std::uint8_t>& reached, std::vector<Cell>& front) const {
    const VoxelGrid& grid = space_.grid;
    const std::size_t row = grid.index({0, c[1], c[2]});
    if (!is_open(row + std::size_t(c[0]), reached)) return;
    int first = c[0], last = c[0];
    while (first > 0 && is_open(row + std::size_t(first) - 1, reached)) --first;
    while (last + 1 < grid.size[0] && is_open(row + std::size_t(last) + 1, reached)) ++last;
    for (int x = first; x <= last; ++x) reached[row + std::size_t(x)] = 1;
    for (const auto& [dy, dz] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
      const Cell start{first, c[1] + dy, c[2] + dz};
      if (!grid.contains(start)) continue;
      const std::size_t beside = grid.index(start) - std::size_t(first);
      bool inside = false;
      for (int x = first; x <= last; ++x) {
        const bool open = is_open(beside + std::size_t(x), reached);
        if (open && !inside) front.push_back({x, start[1], start[2]});
        inside = open;
      }
    }
  }

  // The cells of a region that have a neighbour which is not of it, in the order of their numbers.
  std::vector<Cell> find_edge(const std::vector<std::uint8_t>& region) {
    const Cell& n = space_.grid.size;
    const std::size_t row = std::size_t(n[0]), layer = row * std::size_t(n[1]);
    std::vector<std::vector<Cell>> edges;
    edges.resize(std::size_t(n[2]));
    pool_.run(n[2], 1, [&](int begin, int end) {
      for (int z = begin; z < end; ++z) {
        std::size_t i = std::size_t(z) * layer;
        for (int y = 0; y < n[1]; ++y)
          for (int x = 0; x < n[0]; ++x, ++i) {
            if (!region[i]) continue;
            const bool inner = (x == 0 || region[i - 1]) && (x + 1 == n[0] || region[i + 1]) &&
                               (y == 0 || region[i - row]) && (y + 1 == n[1] || region[i + row]) &&
                               (z == 0 || region[i - layer]) && (z + 1 == n[2] || region[i + layer]);
            if (!inner) edges[std::size_t(z)].push_back({x, y, z});
          }
      }
    });
    std::vector<Cell> all;
    for (const std::vector<Cell>& edge : edges) all.insert(all.end(), edge.begin(), edge.end());
    return all;
  }

  // Cells that the ball covers in one of its places. One voxel is added to its radius, because the
  // centres of cells stand off the surface that it touches by up to that.
  void sweep_outside() {
    const VoxelGrid& grid = space_.grid;
    const std::vector<std::uint8_t> reached = roll();
    const std::vector<Cell> edge = find_edge(reached);
    const auto nearest = find_nearest_seeds(grid, edge, pool_);
    const double reach = options_.rolling_radius / grid.voxel + 1;
    for_each_cell([&](std::size_t i) {
      if (space_.kind[i] == CellKind::solid) return;
      bool outside = reached[i] != 0;
      if (!outside && nearest[i] != kNoSeed) {
        const Cell cell = grid.cell(i), &seed = edge[nearest[i]];
        double square = 0;
        for (std::size_t k = 0; k < 3; ++k)
          square += double(seed[k] - cell[k]) * (seed[k] - cell[k]);
        outside = square < reach * reach;
      }
      if (outside) space_.kind[i] = CellKind::outside;
    });
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
  check.expect(rolling_radius >= 2 * voxel && rolling_radius <= 10, "rolling_radius", "2 voxels to 10 m",
               rolling_radius);
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
