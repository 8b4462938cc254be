#include <algorithm>
#include <cmath>

#include "kernel/voids/cell_box.h"
#include "kernel/voids/void_space.h"

namespace rubble {
namespace {

// All that is not outside.
CellBox find_box(const VoidSpace& space) {
  CellBox box{{1 << 30, 1 << 30, 1 << 30}, {-1, -1, -1}};
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
  if (box.empty()) return space;
  const int more = std::max(1, int(std::ceil(margin / space.grid.voxel)));
  VoxelGrid grid = space.grid;
  for (std::size_t k = 0; k < 3; ++k) {
    box.first[k] = std::max(0, box.first[k] - more);
    box.last[k] = std::min(space.grid.size[k] - 1, box.last[k] + more);
    grid.size[k] = box.last[k] - box.first[k] + 1;
    grid.corner[int(k)] = space.grid.corner[int(k)] + box.first[k] * space.grid.voxel;
  }
  // Within the same lists: a second copy would need as much memory again.
  BoxWalk before(space.grid, box);
  space.clearance.renumber(grid.count(), before);
  for (std::size_t to = 0; to < grid.count(); ++to) space.kind.set(to, space.kind[before.next()]);
  space.grid = grid;
  space.kind.shrink(grid.count());
  return space;
}

}  // namespace rubble
