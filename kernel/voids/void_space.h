// Classifies the space in and around a pile, cell by cell, as solid, outside or void, with the distance to the nearest
// surface.
//
// Outside is the space that a ball of `rolling_radius` sweeps. The ball comes from the sky and moves wherever it
// touches no piece. The ground does not stop the ball; only its centre stays above. In a map of voxels smaller than 1/64 of
// its radius the ball rolls over larger ones, of up to 1/32. Void is the rest of the free space: the cavities, channels
// and clefts of a probe-in, probe-out method (Voss and Gerstein 2010, "3V: cavity, channel and cleft volume calculator
// and extractor").
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile_state.h"
#include "kernel/geometry/voxel_grid.h"
#include "kernel/voids/cell_clearance.h"
#include "kernel/voids/cell_kinds.h"

namespace rubble {

// Default radius of the ball that defines the outside. The ground does not stop the ball, so a ball of 1 m would pass
// below a slab that leans on a wall 2 m high; unit: m
inline constexpr double kOutsideRadius = 2;
// The rule of `rubble voids` and rubble.find_void: the requested radius, but at least twice the radius of the largest
// robot. With a smaller ball, everything would be outside for this robot; unit: m
inline double outside_radius_for(double asked, double largest_robot) {
  return asked > 2 * largest_robot ? asked : 2 * largest_robot;
}

struct VoidSpaceOptions {
  double voxel = 0.02;                    // unit: m; range: 0.001 to 1
  double rolling_radius = kOutsideRadius;  // unit: m; range: 2 voxels to 10 m
  bool ground = true;                     // the plane z = 0 is a surface with solid below
  // Of the outside that the map keeps around all solid and void cells; nothing: what the ball needs, so that paths
  // lead through the outside, too. Voids are the same with less memory; no path leads through the outside then;
  // unit: m; range: 0 to 100
  std::optional<double> margin;
  // Solid types that do not extend the map: terrain. The map surrounds the other pieces.
  std::vector<int> scenery{};
  double memory_limit = 4.0 * (1 << 30);  // unit: byte
  // Where the memory limit is too small for `voxel`, the smallest voxel that fits, up to this; nothing: refused. The grid tells which
  // it is; unit: m
  std::optional<double> coarsest{};
  int threads = 0;                        // 0: all processors; the result does not depend on it

  void validate() const;  // throws InputError naming the field
};

struct VoidSpace {
  VoxelGrid grid;              // numbers the cells of the two lists below
  CellKinds kind;              // of each cell
  // Distance from the centre of a cell to the surface; 0 in solids. It is the exact distance to the nearest triangle,
  // or in rare cases to a triangle beside it that is less than half a voxel farther. Never too small. With
  // VoidSpaceOptions::margin 0 also in cells outside that share no face with a void; unit: m.
  CellClearance clearance;
  double rolling_radius = kOutsideRadius;  // as requested; unit: m
  std::uint64_t pile_state = 0;            // PileState::state_hash() of the pile

  double cell_volume() const { return grid.voxel * grid.voxel * grid.voxel; }  // unit: m3
  double volume(CellKind wanted) const;                                        // unit: m3
  // Volume of free space with a solid vertically above it, whether it is outside or void. unit: m3
  double covered_volume() const;
};

// done: 0 to 1. Return false to stop; RunError is thrown then.
using VoidProgress = std::function<bool(double done)>;

// meshes: by type index, at scale 1. Throws InputError when the memory limit is too small; the error states a voxel
// size that fits.
VoidSpace calc_void_space(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                          const VoidSpaceOptions& options = {}, const VoidProgress& progress = {});

// The same of place_solids(), so that neither the pile nor the meshes must stay in memory.
struct Solids;
VoidSpace calc_void_space(Solids solids, const VoidSpaceOptions& options, const VoidProgress& progress = {});

// Reduces the space to all solid and void cells with a margin (unit: m; at least a voxel). The rolling ball needs more
// room; voids do not: find_voids() gives the same result with less memory. Paths through the outside have less room.
VoidSpace crop_to_pile(VoidSpace space, double margin);

}  // namespace rubble
