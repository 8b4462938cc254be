#include "io/voids/void_files.h"

#include <cmath>
#include <cstdint>

#include "io/base/atomic_file.h"
#include "kernel/base/hash.h"
#include "kernel/base/number_text.h"

namespace rubble {
namespace {

// Two bits for each child of a node, as OctoMap's OcTree::writeBinaryNode has them.
enum class Node : std::uint8_t { unknown = 0, free = 1, occupied = 2, inner = 3 };

constexpr int kLevels = 16;               // of an OcTree
constexpr std::int64_t kMiddle = 1 << 15;  // the key of the cell that begins at the origin

// The tree of a grid, bottom up and in the order of the file: a node's two bytes come before those of
// its inner children, and are taken back when all children turn out to be alike (pruning). The tree
// itself is never in memory; OctoMap's own would need 40 bytes for every voxel before it is pruned.
class TreeWriter {
 public:
  explicit TreeWriter(const VoidSpace& space) : space_(space) {
    for (int k = 0; k < 3; ++k)
      first_[k] = kMiddle + std::llround(space.grid.corner[k] / space.grid.voxel);
  }

  void run() {
    if (write(kLevels, 0, 0, 0) != Node::unknown) ++nodes;
  }

  std::string bytes;
  std::size_t nodes = 0;

 private:
  Node kind_of(std::int64_t x, std::int64_t y, std::int64_t z) const {
    const Cell cell{int(x - first_[0]), int(y - first_[1]), int(z - first_[2])};
    switch (space_.kind[space_.grid.index(cell)]) {
      case CellKind::solid:
        return Node::occupied;
      case CellKind::free_void:
        return Node::free;
      case CellKind::outside:
        return Node::unknown;
    }
    return Node::unknown;
  }

  bool is_beside_grid(const std::int64_t (&low)[3], std::int64_t edge) const {
    for (int k = 0; k < 3; ++k)
      if (low[k] + edge <= first_[k] || low[k] >= first_[k] + space_.grid.size[std::size_t(k)])
        return true;
    return false;
  }

  Node write(int level, std::int64_t x, std::int64_t y, std::int64_t z) {
    if (is_beside_grid({x, y, z}, std::int64_t(1) << level)) return Node::unknown;
    if (level == 0) return kind_of(x, y, z);
    const std::size_t start = bytes.size(), nodes_before = nodes;
    bytes.append(2, '\0');
    const std::int64_t half = std::int64_t(1) << (level - 1);
    unsigned bits = 0;
    bool alike = true;
    Node first = Node::unknown;
    for (int i = 0; i < 8; ++i) {
      const Node child =
          write(level - 1, x + (i & 1 ? half : 0), y + (i & 2 ? half : 0), z + (i & 4 ? half : 0));
      if (i == 0) first = child;
      alike = alike && child == first && child != Node::inner;
      if (child != Node::unknown) ++nodes;
      bits |= unsigned(child) << (2 * i);
    }
    if (alike) {
      bytes.resize(start);
      nodes = nodes_before;
      return first;
    }
    bytes[start] = char(bits & 0xff);
    bytes[start + 1] = char(bits >> 8);
    return Node::inner;
  }

  const VoidSpace& space_;
  std::int64_t first_[3];  // keys of cell (0, 0, 0)
};

}  // namespace

void write_octomap(const std::string& path, const VoidSpace& space) {
  TreeWriter tree(space);
  tree.run();
  write_text_file(path, "# Octomap OcTree binary file\n# pile state " + hex64(space.pile_state) + "\nid OcTree\nsize " +
                            std::to_string(tree.nodes) + "\nres " + exact_text(space.grid.voxel) +
                            "\ndata\n" + tree.bytes);
}

}  // namespace rubble
