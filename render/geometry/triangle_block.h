// Triangles in blocks of eight, and where a ray meets one of them. Embree finds the blocks (ray_tree.h). Distances are
// computed here, by plain IEEE operations in the order written, and compiled once for each instruction set: so a hit has
// the same bits on every machine and with every version of Embree. Internal to render/.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct alignas(32) TriangleBlock {
  static constexpr int kSize = 8;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  float corners[3][3][kSize];  // by corner and axis; unit: m. A place without a triangle holds one point three times
  std::uint32_t ids[kSize];    // of the triangles; kNone: no triangle

  // A triangle is met within its bounding box, enlarged by this. reach: farthest from the origin that a ray begins;
  // farthest: largest coordinate of the block; unit: m, all. Not kept, because a scene has millions of blocks.
  static float margin(float reach, float farthest) { return 2 * kRounding * (reach + farthest); }

 private:
  // Of where a ray meets a plane: four halves of a unit in the last place of their distance.
  static constexpr float kRounding = 2.5e-7f;
};
static_assert(sizeof(TriangleBlock) == 320);

struct BlockRay {
  BlockRay() = default;
  // direction: of any length. nearest: unit: lengths of the direction, as all distances along a ray.
  // reach: as TriangleBlock::margin() has it.
  BlockRay(const Vec3f& from, const Vec3f& direction, float nearest, float reach, std::uint32_t first_id = 0);

  Vec3f from, direction, inverse;
  float nearest = 0;           // a hit is not nearer than this
  float reach = 0;             // farthest from the origin that it may begin; unit: m
  std::uint32_t first_id = 0;  // is added to the numbers of the triangles
};

// Of equally near hits, that of the triangle with the smallest number counts.
struct BlockHit {
  float distance = 0;                           // unit: lengths of the direction. Nothing beyond it is met
  std::uint32_t triangle = TriangleBlock::kNone;  // first_id of the ray plus that of the block; kNone: nothing is met
  float u = 0, v = 0;                           // weights of the second and third corner
  Vec3f normal;                                 // outwards, of any length, in the frame of the triangles
  bool back = false;                            // from inside
};

struct BlockFunctions {
  const char* name;  // of the instruction set
  // Whether `hit` is another now.
  bool (*meet)(const TriangleBlock& block, const BlockRay& ray, BlockHit& hit);
  // Whether a triangle is met not farther than `farthest`.
  bool (*hides)(const TriangleBlock& block, const BlockRay& ray, float farthest);
};
// Those that this processor can run, the fastest first. Never empty.
const std::vector<BlockFunctions>& block_functions();

// Which triangles lie together.
struct BlockOrder {
  std::vector<std::uint32_t> triangles;  // a permutation
  std::vector<std::uint32_t> ends;       // of each block, one past its last place in `triangles`
};
using TriangleCorners = std::function<std::array<Vec3f, 3>(std::uint32_t triangle)>;
BlockOrder order_blocks(std::uint32_t count, const TriangleCorners& corners);
// Numbers of triangles begin with first_id.
void append_blocks(const BlockOrder& order, const TriangleCorners& corners, std::uint32_t first_id,
                   std::vector<TriangleBlock>& blocks);
// The bounds that a tree has to keep of a block, so that rounding of its own never hides a hit. reach: of the rays that
// meet it.
Aabb tree_bounds(const TriangleBlock& block, float reach);

}  // namespace rubble
