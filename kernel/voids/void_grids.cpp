#include "kernel/voids/void_grids.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "kernel/base/error.h"

namespace rubble {
namespace {

constexpr double kLeastCells = 32;         // of the ball's radius
constexpr double kMostCells = 4294967294;  // that 32 bits number
constexpr double kBytesPerCell = 5.6;      // kind and clearance, some layers, lists of void cells
constexpr double kBytesPerSurface = 40;    // of one cell of a surface, while slabs are joined

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

// Corners are at whole multiples of the voxel, so that a pile is cut in the same way wherever its edge happens to be.
VoxelGrid make_grid(const Aabb& box, double margin, double voxel, bool ground) {
  VoxelGrid grid;
  grid.voxel = voxel;
  for (int k = 0; k < 3; ++k) {
    const bool floor = k == 2 && ground;
    const double low = std::floor((box.min[k] - (floor ? 0 : margin)) / voxel);
    const double high = std::ceil((std::max(box.max[k], box.min[k]) + margin) / voxel);
    grid.corner[k] = low * voxel;
    grid.size[std::size_t(k)] = int(std::min(high - low, 1e9));
  }
  return grid;
}

double count_cells(const VoxelGrid& grid) {
  return double(grid.size[0]) * double(grid.size[1]) * double(grid.size[2]);
}

// All voids are within the hull of the pieces. With terrain, what is nearest to a cell of theirs may be beyond.
bool keeps_all(const Solids& solids, const VoidSpaceOptions& options) {
  return !options.margin || std::any_of(solids.pieces.begin(), solids.pieces.end(),
                                        [&](const SolidPiece& piece) { return is_scenery(piece, options); });
}

// With the fines that lie about, as far as there is room for the ball.
Aabb with_fines(Aabb box, const Aabb& room, const Solids& solids) {
  for (const SolidPiece& piece : solids.pieces) {
    if (piece.type != kFineType || piece.box.empty()) continue;
    for (int k = 0; k < 3; ++k) {
      box.min[k] = std::min(box.min[k], std::clamp(piece.box.min[k], room.min[k], room.max[k]));
      box.max[k] = std::max(box.max[k], std::clamp(piece.box.max[k], room.min[k], room.max[k]));
    }
  }
  return box;
}

// Of all surfaces that are in the room of the pieces; unit: m2
double count_area(const Solids& solids, const VoidSpaceOptions& options) {
  const Aabb box = find_bounds(solids, options);
  const Vec3 room = box.max - box.min;
  double area = 0;
  for (const SolidPiece& piece : solids.pieces) {
    if (is_scenery(piece, options)) {
      area += 2 * room.x * room.y;  // about what of it is in the grid
      continue;
    }
    for (std::size_t i = piece.first; i < piece.last; ++i) {
      const QueryTriangle t = solids.triangle(i);
      area += norm(cross(t.b - t.a, t.c - t.a)) / 2;
    }
  }
  return area;
}

// unit: byte
double estimate(const Solids& solids, const VoidSpaceOptions& options) {
  const VoidGrids grids = plan_grids(solids, options);
  const double area = count_area(solids, options);
  const auto need = [&](const VoxelGrid& grid) {
    return kBytesPerCell * count_cells(grid) + kBytesPerSurface * 2.2 * area / (grid.voxel * grid.voxel);
  };
  const double both = grids.is_one() ? 0 : need(grids.ball) + count_cells(grids.map);
  return std::max(need(grids.map), both) + double(solids.triangles.size() * sizeof(QueryTriangle));
}

}  // namespace

VoidGrids plan_grids(const Solids& solids, const VoidSpaceOptions& options) {
  const double h = options.voxel, radius = options.rolling_radius;
  const double ball = h * std::max(1.0, std::floor(radius / (kLeastCells * h)));
  const Aabb box = find_bounds(solids, options);
  VoidGrids grids;
  grids.ball = make_grid(box, radius + 3 * ball, ball, options.ground);
  if (ball == h) {
    grids.map = grids.ball;
    return grids;
  }
  const double margin = radius + 3 * h;
  if (keeps_all(solids, options)) {
    grids.map = make_grid(box, margin, h, options.ground);
    return grids;
  }
  const Vec3 around(margin, margin, margin);
  Aabb room{box.min - around, box.max + around};
  if (options.ground) room.min.z = box.min.z;
  grids.map = make_grid(with_fines(box, room, solids), std::min(margin, *options.margin + 3 * h), h, options.ground);
  return grids;
}

double fitting_voxel(const Solids& solids, const VoidSpaceOptions& options) {
  VoidSpaceOptions coarser = options;
  const auto fits = [&] {
    return estimate(solids, coarser) <= coarser.memory_limit && count_cells(plan_grids(solids, coarser).map) <= kMostCells;
  };
  while (!fits() && coarser.voxel < 10) coarser.voxel *= 1.05;
  return coarser.voxel;
}

void check_memory(const Solids& solids, const VoidSpaceOptions& options) {
  const double fitting = fitting_voxel(solids, options);
  if (fitting <= options.voxel) return;
  const double need = estimate(solids, options);
  Diagnostic d;
  d.key = "voxel";
  if (need <= options.memory_limit) {
    d.message = "too small for this pile: its map has more cells than 32 bits number";
    d.expected = "at most 4,294,967,294 cells";
    d.found = "voxels of " + format(options.voxel, "m");
    d.hint = "use voxels of " + format(fitting, "m");
    throw InputError(d);
  }
  d.message = "too small for the memory: about " + format(need / (1 << 30), "GiB") + " are needed";
  d.expected = "at most " + format(options.memory_limit / (1 << 30), "GiB");
  d.found = "voxels of " + format(options.voxel, "m");
  d.hint = "use voxels of " + format(fitting, "m") + " or raise the limit";
  throw InputError(d);
}

}  // namespace rubble
