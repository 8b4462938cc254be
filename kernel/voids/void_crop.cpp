#include <algorithm>
#include <cmath>

#include "kernel/voids/void_space.h"

namespace rubble {
namespace {

struct CellBox {
  Cell first{1 << 30, 1 << 30, 1 << 30}, last{-1, -1, -1};  // inclusive; empty where last is -1
};

// All that is not outside.
CellBox find_box(const VoidSpace& space) {
  CellBox box;
  std::size_t i = 0;
  for (int z = 0; z < space.grid.size[2]; ++z)
    for (int y = 0; y < space.grid.size[1]; ++y)
      for (int x = 0; x < space.grid.size[0]; ++x, ++i) {
        if (space.kind[i] == CellKind::outside) continue;
        const Cell c{x, y, z};
        for (std::size_t k = 0; k < 3; ++k) {
          box.first[k] = std::min(box.first[k], c[k]);
          box.last[k] = std::max(box.last[k], c[k]);
        }
      }
  return box;
}

}  // namespace

VoidSpace crop_to_pile(VoidSpace space, double margin) {
  CellBox box = find_box(space);
  if (box.last[0] < 0) return space;
  const int more = std::max(1, int(std::ceil(margin / space.grid.voxel)));
  VoxelGrid grid = space.grid;
  for (std::size_t k = 0; k < 3; ++k) {
    box.first[k] = std::max(0, box.first[k] - more);
    box.last[k] = std::min(space.grid.size[k] - 1, box.last[k] + more);
    grid.size[k] = box.last[k] - box.first[k] + 1;
    grid.corner[int(k)] = space.grid.corner[int(k)] + box.first[k] * space.grid.voxel;
  }
  // Rows move towards the beginning of the same lists: a second copy would need as much memory
  // again.
  std::vector<float>& clearance = space.clearance.of_all(space.grid.count());
  std::ptrdiff_t to = 0;
  for (int z = box.first[2]; z <= box.last[2]; ++z)
    for (int y = box.first[1]; y <= box.last[1]; ++y, to += grid.size[0]) {
      const auto from = std::ptrdiff_t(space.grid.index({box.first[0], y, z}));
      std::copy_n(space.kind.begin() + from, grid.size[0], space.kind.begin() + to);
      std::copy_n(clearance.begin() + from, grid.size[0], clearance.begin() + to);
    }
  space.grid = grid;
  space.kind.resize(grid.count());
  space.clearance.of_all(grid.count());
  return space;
}

}  // namespace rubble
