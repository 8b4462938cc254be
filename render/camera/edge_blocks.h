// Which blocks of an image may show soft edges of the sun's shadows: those that meet edges of the shadow map. Found on
// the processor, because software drivers run all of a shader for each pixel, whatever its branches.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"

namespace rubble {

// The edges of one layer of the shadow map, by tiles, by 2 x 2 of these, and so on.
class EdgePyramid {
 public:
  // Depths of 0 to 1 in steps of 16 bits.
  struct Range {
    std::uint16_t nearest = 65535;  // least depth of what stands beside an edge; 65535: no edge
    std::uint16_t most = 0;         // greatest depth about
  };

  EdgePyramid() = default;
  // words: two for each of side x side tiles, as shaders/shadow_edges.frag.glsl writes them.
  EdgePyramid(const std::uint32_t* words, int side);

  // Of a rectangle of the map, 0 to 1, and a little beyond it.
  Range range(float x0, float y0, float x1, float y1) const;
  // Of each tile, side() x side() of them.
  const std::vector<Range>& tiles() const { return levels_.front().tiles; }
  int side() const { return levels_.front().side; }

 private:
  struct Level {
    int side = 0;
    std::vector<Range> tiles;
  };
  std::vector<Level> levels_;
};

struct EdgeLayer {
  std::array<std::array<float, 4>, 3> rows{};  // of clip_from_world: -1 to 1, -1 to 1, 0 to 1
  const EdgePyramid* edges = nullptr;          // never null
};

inline constexpr int kEdgeBlock = 4;  // side of a block, as in the shaders; unit: pixel

struct EdgeBlock {
  std::uint32_t place;  // column and row of blocks, 16 bits each
  float nearest;        // of the edges it meets
};

struct DepthValues {
  const std::vector<float>& values;  // near / Z; 0: no surface
  int width, height;
};

// In order of rows; not those whose surface looks away from the sun. view: null where pixels have rays of their own:
// then all blocks with surfaces. to_sun: in the world, unit length. The same for any number of threads.
std::vector<EdgeBlock> find_edge_blocks(const ViewProjection* view, const DepthValues& depth,
                                        const std::vector<EdgeLayer>& layers, const Vec3& to_sun, ThreadPool& pool);

}  // namespace rubble
