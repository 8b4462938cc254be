#include "kernel/voids/solid_voxels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/geometry/fine_shapes.h"

namespace rubble {
namespace {

// From a cell's centre to its corners, in cells, and a little for rounding.
constexpr double kReach = 0.8661;
constexpr int kSlab = 8;  // layers of cells that are searched at a time

// The cells whose centres may be within a margin of a box, cut to the grid.
CellBox find_range(const VoxelGrid& grid, const Aabb& box, double margin) {
  CellBox range{};
  for (int k = 0; k < 3; ++k) {
    const double low = (box.min[k] - margin - grid.corner[k]) / grid.voxel - 0.5;
    const double high = (box.max[k] + margin - grid.corner[k]) / grid.voxel - 0.5;
    range.first[std::size_t(k)] = std::max(0, int(std::ceil(low)));
    range.last[std::size_t(k)] = std::min(grid.size[std::size_t(k)] - 1, int(std::floor(high)));
  }
  return range;
}

CellBox cut(CellBox range, const CellBox& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    range.first[k] = std::max(range.first[k], box.first[k]);
    range.last[k] = std::min(range.last[k], box.last[k]);
  }
  return range;
}

Aabb bounds(const QueryTriangle& t) {
  Aabb box;
  for (const Vec3& corner : {t.a, t.b, t.c}) box.include(corner);
  return box;
}

// Twice the signed area of a triangle seen along z.
double cross_xy(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// One piece's columns: how often its surface is crossed upwards, less downwards, below each cell.
class Columns {
 public:
  Columns(const VoxelGrid& grid, const CellBox& range)
      : grid_(grid),
        range_(range),
        width_(range.last[0] - range.first[0] + 1),
        depth_(range.last[1] - range.first[1] + 1),
        height_(range.last[2] - range.first[2] + 2),  // and one for what is above all cells
        turns_(std::size_t(width_) * std::size_t(depth_) * std::size_t(height_), 0) {}

  void add(const QueryTriangle& t) {
    const CellBox r = find_range(grid_, bounds(t), 0.001 * grid_.voxel);
    for (int y = std::max(r.first[1], range_.first[1]); y <= std::min(r.last[1], range_.last[1]);
         ++y) {
      for (int x = std::max(r.first[0], range_.first[0]); x <= std::min(r.last[0], range_.last[0]);
           ++x) {
        add_column(t, x, y);
      }
    }
  }

  // Marks the cells around which the surface is wound.
  void mark(CellKinds& kind) const {
    for (int y = 0; y < depth_; ++y) {
      for (int x = 0; x < width_; ++x) mark_column(x, y, kind);
    }
  }

 private:
  std::size_t at(int x, int y, int z) const {
    return std::size_t(z) +
           std::size_t(height_) * (std::size_t(x) + std::size_t(width_) * std::size_t(y));
  }

  // The column is moved off the cells' centres by a hair, so that it meets no edge of a mesh whose
  // corners are round numbers.
  void add_column(const QueryTriangle& t, int x, int y) {
    Vec3 p = grid_.centre(Cell{x, y, 0});
    p.x += 1.37e-7 * grid_.voxel;
    p.y += 2.61e-7 * grid_.voxel;
    const double u = cross_xy(t.b, t.c, p), v = cross_xy(t.c, t.a, p), w = cross_xy(t.a, t.b, p);
    const bool up = u > 0 && v > 0 && w > 0, down = u < 0 && v < 0 && w < 0;
    if (!up && !down) return;
    const double z = (t.a.z * u + t.b.z * v + t.c.z * w) / (u + v + w);
    const double cell = std::ceil((z - grid_.corner.z) / grid_.voxel - 0.5);
    const int above = std::clamp(int(cell) - range_.first[2], 0, height_ - 1);
    turns_[at(x - range_.first[0], y - range_.first[1], above)] += up ? -1 : 1;
  }

  void mark_column(int x, int y, CellKinds& kind) const {
    int total = 0;
    for (int z = 0; z < height_; ++z) total += turns_[at(x, y, z)];
    if (total != 0) return;  // an open mesh: the faces do not pair up here
    int inside = 0;
    for (int z = 0; z + 1 < height_; ++z) {
      inside += turns_[at(x, y, z)];
      if (inside == 0) continue;
      const Cell cell{x + range_.first[0], y + range_.first[1], z + range_.first[2]};
      kind.set(grid_.index(cell), CellKind::solid);  // several pieces may fill one cell at once
    }
  }

  const VoxelGrid& grid_;
  const CellBox range_;
  const int width_, depth_, height_;
  std::vector<std::int16_t> turns_;
};

// The nearest points found so far in some layers of a box.
class SurfaceSlab {
 public:
  // first, last: layers of the grid, inclusive
  SurfaceSlab(const VoxelGrid& grid, const CellBox& box, int first, int last)
      : grid_(grid),
        box_(box),
        slab_{{box.first[0], box.first[1], first}, {box.last[0], box.last[1], last}},
        own_(slab_.grid()),
        distance_(own_.count(), kFar),
        nearest_(own_.count()) {}

  void add(const QueryTriangle& t, std::uint32_t number) {
    const CellBox r = cut(find_range(grid_, bounds(t), kReach * grid_.voxel), slab_);
    for (int z = r.first[2]; z <= r.last[2]; ++z)
      for (int y = r.first[1]; y <= r.last[1]; ++y)
        for (int x = r.first[0]; x <= r.last[0]; ++x) add(t, number, {x, y, z});
  }

  void append_to(VoxelSurface& surface) const {
    for (std::size_t i = 0; i < distance_.size(); ++i) {
      if (distance_[i] == kFar) continue;
      Cell cell = own_.cell(i);
      cell[2] += slab_.first[2] - box_.first[2];
      surface.cells.push_back(cell);
      surface.triangles.push_back(nearest_[i]);
    }
  }

 private:
  static constexpr float kFar = 1e30f;

  void add(const QueryTriangle& t, std::uint32_t number, const Cell& cell) {
    const Vec3 centre = grid_.centre(cell);
    const Vec3 d = find_closest(t, centre) - centre;
    const double limit = kReach * grid_.voxel;
    const double distance = dot(d, d);
    if (distance > limit * limit) return;
    const std::size_t i = own_.index({cell[0] - slab_.first[0], cell[1] - slab_.first[1], cell[2] - slab_.first[2]});
    if (!(float(distance) < distance_[i])) return;
    distance_[i] = float(distance);
    nearest_[i] = number;
  }

  const VoxelGrid& grid_;
  const CellBox& box_;
  const CellBox slab_;
  const VoxelGrid own_;  // of the slab
  std::vector<float> distance_;
  std::vector<std::uint32_t> nearest_;
};

// A triangle that passes through cells of a box, and the layers of these.
struct NearTriangle {
  std::uint32_t number;
  int first, last;  // inclusive
};

std::vector<NearTriangle> find_near(const VoxelGrid& grid, const CellBox& box, const Solids& solids) {
  std::vector<NearTriangle> near;
  for (const SolidPiece& piece : solids.pieces) {
    if (cut(find_range(grid, piece.box, kReach * grid.voxel), box).empty()) continue;
    for (std::size_t t = piece.first; t < piece.last; ++t) {
      const CellBox r = cut(find_range(grid, bounds(solids.triangle(t)), kReach * grid.voxel), box);
      if (!r.empty()) near.push_back({std::uint32_t(t), r.first[2], r.last[2]});
    }
  }
  return near;
}

void add_solid(const TriangleMesh& mesh, const Pose& world_from_body, double scale, int type, Solids& result) {
  SolidPiece piece;
  piece.type = type;
  const std::uint32_t first = std::uint32_t(result.corners.size());
  for (const Vec3f& p : mesh.positions) {
    result.corners.push_back(world_from_body * (Vec3(p) * scale));
    piece.box.include(result.corners.back());
  }
  piece.first = result.triangles.size();
  for (const auto& t : mesh.triangles) result.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  piece.last = result.triangles.size();
  result.pieces.push_back(piece);
}

// visit(mesh, world_from_body, scale, type): of each piece that is there, then of each heap of fines.
template <typename Visit>
void for_each_solid(const PileState& pile, const std::vector<const TriangleMesh*>& meshes, const Visit& visit) {
  for (const PieceState& state : pile.pieces) {
    if (state.status == PieceStatus::lost) continue;
    const std::size_t type = std::size_t(state.type);
    if (state.type < 0 || type >= meshes.size() || meshes[type] == nullptr) {
      throw std::invalid_argument("place_solids: a piece without a mesh");
    }
    visit(*meshes[type], state.world_from_body, state.scale, state.type);
  }
  for (const FineHeap& heap : pile.fines.heaps()) visit(heap.mesh, world_from_host(pile, heap.host), 1.0, kFineType);
}

}  // namespace

Solids place_solids(const PileState& pile, const std::vector<const TriangleMesh*>& meshes) {
  Solids result;
  result.pile_state = pile.state_hash();
  std::size_t corners = 0, triangles = 0;
  for_each_solid(pile, meshes, [&](const TriangleMesh& mesh, const Pose&, double, int) {
    corners += mesh.positions.size(), triangles += mesh.triangles.size();
  });
  result.corners.reserve(corners), result.triangles.reserve(triangles);
  for_each_solid(pile, meshes, [&](const TriangleMesh& mesh, const Pose& world_from_body, double scale, int type) {
    add_solid(mesh, world_from_body, scale, type, result);
  });
  return result;
}

void fill_solids(const VoxelGrid& grid, const Solids& solids, ThreadPool& pool, CellKinds& kind) {
  pool.run(int(solids.pieces.size()), 4, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const SolidPiece& piece = solids.pieces[std::size_t(i)];
      const CellBox range = find_range(grid, piece.box, 0);
      if (range.empty()) continue;
      Columns columns(grid, range);
      for (std::size_t t = piece.first; t < piece.last; ++t) columns.add(solids.triangle(t));
      columns.mark(kind);
    }
  });
}

VoxelSurface find_surface(const VoxelGrid& grid, const CellBox& box, const Solids& solids, ThreadPool& pool) {
  std::vector<NearTriangle> near = find_near(grid, box, solids);
  const int slabs = (box.last[2] - box.first[2]) / kSlab + 1;
  std::vector<VoxelSurface> parts{std::size_t(slabs)};
  pool.run(slabs, 1, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const int first = box.first[2] + i * kSlab, last = std::min(box.last[2], first + kSlab - 1);
      SurfaceSlab slab(grid, box, first, last);
      for (const NearTriangle& t : near)
        if (t.first <= last && t.last >= first) slab.add(solids.triangle(t.number), t.number);
      slab.append_to(parts[std::size_t(i)]);
    }
  });
  std::vector<NearTriangle>().swap(near);
  VoxelSurface result;
  std::size_t count = 0;
  for (const VoxelSurface& part : parts) count += part.cells.size();
  result.cells.reserve(count), result.triangles.reserve(count);
  for (VoxelSurface& part : parts) {
    result.cells.insert(result.cells.end(), part.cells.begin(), part.cells.end());
    result.triangles.insert(result.triangles.end(), part.triangles.begin(), part.triangles.end());
    part = {};
  }
  return result;
}

}  // namespace rubble
