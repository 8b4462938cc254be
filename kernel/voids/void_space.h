// The space in and around a pile, cell by cell: what is solid, what is outside, what is void, and
// how far everything is from the nearest surface.
//
// Outside is what a ball of `rolling_radius` sweeps that comes from the sky and may go wherever it
// does not touch a piece; the ground does not hold it up, only its centre stays above. Void is the
// rest of the free space: the cavities, channels and clefts of a probe-in, probe-out method (Voss
// and Gerstein 2010, "3V: cavity, channel and cleft volume calculator and extractor").
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/pile_state.h"
#include "kernel/geometry/voxel_grid.h"

namespace rubble {

// What is outside, wherever it is not said otherwise: what a ball of this radius reaches. As the ground
// does not hold the ball up, one of 1 m gets below a slab that leans on a wall 2 m high; unit: m
inline constexpr double kOutsideRadius = 2;
// The one rule of `rubble voids` and of rubble.find_void: as asked, but never less than twice the
// radius of the largest robot, for which everything would be outside otherwise; unit: m
inline double outside_radius_for(double asked, double largest_robot) {
  return asked > 2 * largest_robot ? asked : 2 * largest_robot;
}

struct VoidSpaceOptions {
  double voxel = 0.02;                    // unit: m; range: 0.001 to 1
  double rolling_radius = kOutsideRadius;  // unit: m; range: 2 voxels to 10 m
  bool ground = true;                     // the plane z = 0 is a surface, below it all is solid
  // Types that are solid, but around which no voids are looked for: terrain. The map is around the
  // other pieces.
  std::vector<int> scenery{};
  double memory_limit = 4.0 * (1 << 30);  // unit: byte
  int threads = 0;                        // 0: all processors; the result does not depend on it

  void validate() const;  // throws InputError naming the field
};

enum class CellKind : std::uint8_t { outside, free_void, solid };

struct VoidSpace {
  VoxelGrid grid;              // numbers the cells of the two lists below
  std::vector<CellKind> kind;  // one a cell
  // From the centre of a cell to the surface, 0 in solids: the exact distance to a triangle that
  // is the nearest one, or in rare places one beside it that is less than half a voxel farther.
  // Never too small; unit: m.
  std::vector<float> clearance;
  double rolling_radius = kOutsideRadius;  // as asked; unit: m
  std::uint64_t pile_state = 0;            // PileState::state_hash() of the pile that it is of

  double cell_volume() const { return grid.voxel * grid.voxel * grid.voxel; }  // unit: m3
  double volume(CellKind wanted) const;                                        // unit: m3
  // Free space that has something solid straight above it, whether the ball reaches it or not: what lies
  // under a roof. unit: m3
  double covered_volume() const;
};

// done: 0 to 1. Return false to stop; RunError is thrown then.
using VoidProgress = std::function<bool(double done)>;

// meshes: by type index, at scale 1. Throws InputError when the memory limit would not do, with the
// voxel that would.
VoidSpace calc_void_space(const PileState& pile, const std::vector<const TriangleMesh*>& meshes,
                          const VoidSpaceOptions& options = {}, const VoidProgress& progress = {});

// The part of it that holds everything solid or void, and as much around that as asked (unit: m; at
// least a voxel). The rolling ball needs more room than that; voids need no more: find_voids() gives
// the same for both, in less memory. A way through the outside has less room to go round.
VoidSpace crop_to_pile(const VoidSpace& space, double margin);

}  // namespace rubble
