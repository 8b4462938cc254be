// Which cells a pile fills, and where exactly its surface is.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/base/parallel.h"
#include "kernel/model/pile_state.h"
#include "kernel/queries/query_triangle.h"
#include "kernel/geometry/voxel_grid.h"
#include "kernel/voids/cell_box.h"
#include "kernel/voids/void_space.h"

namespace rubble {

inline constexpr int kFineType = -1;

// A piece's part of all triangles.
struct SolidPiece {
  std::size_t first = 0, last = 0;  // [first, last)
  Aabb box;                         // of its triangles, in the world; unit: m
  int type = 0;                     // index into the pile's types; kFineType: a heap of fines
};

// The pieces of a pile in the world, but for the lost ones, and then its fines.
struct Solids {
  std::vector<Vec3> corners;                            // in the world; unit: m
  std::vector<std::array<std::uint32_t, 3>> triangles;  // of all pieces; indices of corners
  std::vector<SolidPiece> pieces;                       // that count as solid
  std::uint64_t pile_state = 0;                         // PileState::state_hash()

  QueryTriangle triangle(std::size_t i) const {
    const auto& t = triangles[i];
    return {corners[t[0]], corners[t[1]], corners[t[2]]};
  }
};

// Throws std::invalid_argument for a piece without a mesh.
Solids place_solids(const PileState& pile, const std::vector<const TriangleMesh*>& meshes);

// Marks each cell whose centre is inside a piece. Of a mesh that is not closed, only columns of
// cells count along which its faces pair up; its surface counts in any case (find_surface). kind: one a cell.
void fill_solids(const VoxelGrid& grid, const Solids& solids, ThreadPool& pool, CellKinds& kind);

// Every cell of a box that a surface passes through, and the triangle that is nearest to the cell's centre.
struct VoxelSurface {
  std::vector<Cell> cells;               // from the first of the box; ascending by index
  std::vector<std::uint32_t> triangles;  // index into Solids::triangles
};
VoxelSurface find_surface(const VoxelGrid& grid, const CellBox& box, const Solids& solids, ThreadPool& pool);

}  // namespace rubble
