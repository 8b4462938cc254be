#include "render/geometry/triangle_block.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rubble {

namespace plain {
extern const BlockFunctions kBlockFunctions;
}
#if defined(__x86_64__)
namespace avx2 {
extern const BlockFunctions kBlockFunctions;
}
#endif

namespace {

constexpr std::uint32_t kSize = TriangleBlock::kSize;
constexpr std::uint32_t kManyTriangles = 4096;  // above, halves are good enough: sorting takes long

struct Box {
  Vec3f low{3e38f, 3e38f, 3e38f}, high{-3e38f, -3e38f, -3e38f};

  void include(const Vec3f& p) { low = rubble::min(low, p), high = rubble::max(high, p); }
  void include(const Box& b) { include(b.low), include(b.high); }
  float area() const {
    const Vec3f d = high - low;
    return d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

// Divides triangles in two, and the halves again, until they fit into blocks: each time along the axis and at the place
// where the blocks on both sides have the least area.
class BlockMaker {
 public:
  BlockMaker(std::uint32_t count, const TriangleCorners& corners) {
    boxes_.resize(count), middles_.resize(count);
    order_.triangles.resize(count);
    std::iota(order_.triangles.begin(), order_.triangles.end(), 0u);
    for (std::uint32_t t = 0; t < count; ++t) {
      for (const Vec3f& corner : corners(t)) boxes_[t].include(corner);
      middles_[t] = boxes_[t].low + boxes_[t].high;
    }
  }

  BlockOrder run() {
    divide(0, std::uint32_t(order_.triangles.size()));
    return std::move(order_);
  }

 private:
  void divide(std::uint32_t begin, std::uint32_t end) {
    if (begin == end) return;
    if (end - begin <= kSize) return order_.ends.push_back(end);
    const std::uint32_t cut = end - begin > kManyTriangles ? halve(begin, end) : cut_best(begin, end);
    divide(begin, cut);
    divide(cut, end);
  }

  bool before(std::uint32_t a, std::uint32_t b, int axis) const {
    return middles_[a][axis] != middles_[b][axis] ? middles_[a][axis] < middles_[b][axis] : a < b;
  }

  std::uint32_t halve(std::uint32_t begin, std::uint32_t end) {
    Box box;
    for (std::uint32_t i = begin; i < end; ++i) box.include(middles_[order_.triangles[i]]);
    const Vec3f size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t cut = begin + (end - begin) / 2 / kSize * kSize;
    const auto first = order_.triangles.begin();
    std::nth_element(first + begin, first + cut, first + end,
                     [&](std::uint32_t a, std::uint32_t b) { return before(a, b, axis); });
    return cut;
  }

  void sort(std::uint32_t begin, std::uint32_t end, int axis) {
    const auto first = order_.triangles.begin();
    std::sort(first + begin, first + end, [&](std::uint32_t a, std::uint32_t b) { return before(a, b, axis); });
  }

  std::uint32_t cut_best(std::uint32_t begin, std::uint32_t end) {
    float least = 3e38f;
    int best_axis = 0;
    std::uint32_t best = begin + kSize;
    std::vector<float> right(end - begin + 1);
    for (int axis = 0; axis < 3; ++axis) {
      sort(begin, end, axis);
      Box box;
      for (std::uint32_t i = end; i > begin; --i)
        box.include(boxes_[order_.triangles[i - 1]]), right[i - 1 - begin] = box.area();
      box = Box();
      for (std::uint32_t i = begin; i + 1 < end; ++i) {
        box.include(boxes_[order_.triangles[i]]);
        const std::uint32_t cut = i + 1;
        if ((cut - begin) % kSize != 0) continue;
        const float cost = box.area() * blocks_of(cut - begin) + right[cut - begin] * blocks_of(end - cut);
        if (cost < least) least = cost, best_axis = axis, best = cut;
      }
    }
    if (best_axis != 2) sort(begin, end, best_axis);
    return best;
  }

  static float blocks_of(std::uint32_t triangles) { return float((triangles + kSize - 1) / kSize); }

  std::vector<Box> boxes_;
  std::vector<Vec3f> middles_;  // twice
  BlockOrder order_;
};

// Never infinite: a product of zero and infinity is no number.
float inverse(float x) { return 1 / (std::fabs(x) > 1e-18f ? x : std::copysign(1e-18f, x)); }

}  // namespace

BlockRay::BlockRay(const Vec3f& from_, const Vec3f& direction_, float nearest_, float reach_, std::uint32_t first_id_)
    : from(from_),
      direction(direction_),
      inverse(rubble::inverse(direction_.x), rubble::inverse(direction_.y), rubble::inverse(direction_.z)),
      nearest(nearest_),
      reach(reach_),
      first_id(first_id_) {}

const std::vector<BlockFunctions>& block_functions() {
  static const std::vector<BlockFunctions> all = [] {
    std::vector<BlockFunctions> out;
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx2")) out.push_back(avx2::kBlockFunctions);
#endif
    out.push_back(plain::kBlockFunctions);
    return out;
  }();
  return all;
}

BlockOrder order_blocks(std::uint32_t count, const TriangleCorners& corners) { return BlockMaker(count, corners).run(); }

void append_blocks(const BlockOrder& order, const TriangleCorners& corners, std::uint32_t first_id,
                   std::vector<TriangleBlock>& blocks) {
  std::uint32_t begin = 0;
  for (const std::uint32_t end : order.ends) {
    TriangleBlock& block = blocks.emplace_back();
    for (std::uint32_t i = 0; i < kSize; ++i) {
      const bool there = begin + i < end;
      const std::uint32_t triangle = order.triangles[there ? begin + i : begin];
      const std::array<Vec3f, 3> of = corners(triangle);
      block.ids[i] = there ? first_id + triangle : TriangleBlock::kNone;
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) block.corners[corner][axis][i] = of[there ? std::size_t(corner) : 0][axis];
    }
    begin = end;
  }
}

Aabb tree_bounds(const TriangleBlock& block, float reach) {
  Box box;
  for (std::uint32_t i = 0; i < kSize; ++i)
    for (const auto& corner : block.corners) box.include({corner[0][i], corner[1][i], corner[2][i]});
  // Three times: once of the block's own, twice for what a tree rounds.
  const Vec3f far = max(box.high, box.low * -1.0f);
  const double more = 3.0 * double(TriangleBlock::margin(reach, std::max({far.x, far.y, far.z})));
  return {Vec3(box.low) - Vec3(more, more, more), Vec3(box.high) + Vec3(more, more, more)};
}

}  // namespace rubble
