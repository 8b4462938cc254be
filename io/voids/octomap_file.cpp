#include "io/voids/octomap_file.h"

#include <octomap/octomap.h>

#include <sstream>

#include "io/atomic_file.h"
#include "kernel/base/error.h"

namespace rubble {

void write_octomap(const std::string& path, const VoidSpace& space) {
  octomap::OcTree tree(space.grid.voxel);
  for (std::size_t i = 0; i < space.kind.size(); ++i) {
    if (space.kind[i] == CellKind::outside) continue;
    const Vec3 p = space.grid.centre(i);
    const bool solid = space.kind[i] == CellKind::solid;
    tree.setNodeValue(octomap::point3d(float(p.x), float(p.y), float(p.z)),
                      solid ? tree.getClampingThresMaxLog() : tree.getClampingThresMinLog(), true);
  }
  tree.updateInnerOccupancy();
  tree.prune();
  // The header is written here, because OctoMap's own writer talks to standard error.
  std::ostringstream stream(std::ios::binary);
  stream << "# Octomap OcTree binary file\nid OcTree\nsize " << tree.size() << "\nres "
         << tree.getResolution() << "\ndata\n";
  if (!tree.writeBinaryData(stream)) throw RunError(path + ": OctoMap cannot write it");
  write_text_file(path, stream.str());
}

}  // namespace rubble
