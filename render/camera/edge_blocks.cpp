#include "render/camera/edge_blocks.h"

#include <algorithm>
#include <cmath>

namespace rubble {

namespace {

using Range = EdgePyramid::Range;

constexpr float kFlat = 0.002f;  // how far depth values of a flat block are from linear, as a share
constexpr float kAway = 0.1f;    // cosine of an angle with the sun that is surely beyond a right one

Range both(const Range& a, const Range& b) {
  return {std::min(a.nearest, b.nearest), std::max(a.most, b.most)};
}

// What is linear in the pixel and in depth: a place on the map is eye + z (corner + u right + v down).
struct PixelRows {
  std::array<float, 3> eye, corner, right, down;
};

PixelRows rows_of(const EdgeLayer& layer, const ViewProjection& view) {
  const Intrinsics& k = view.intrinsics;
  const Mat3 r = view.world_from_optical.rotation.matrix();
  const Vec3 t = view.world_from_optical.translation;
  PixelRows out;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& row = layer.rows[i];
    const Vec3 axis{double(row[0]), double(row[1]), double(row[2])};
    const double x = dot(axis, r.column(0)) / k.fx, y = dot(axis, r.column(1)) / k.fy;
    // 0 to 1 on the map.
    const double half = i < 2 ? 0.5 : 1, middle = i < 2 ? 0.5 : 0;
    out.eye[i] = float((dot(axis, t) + double(row[3])) * half + middle);
    out.corner[i] = float((dot(axis, r.column(2)) - k.cx * x - k.cy * y) * half);
    out.right[i] = float(x * half), out.down[i] = float(y * half);
  }
  return out;
}

struct Bounds {
  std::array<float, 3> low, high;
};

// Of a block's pixels, from edge to edge, at depths from z0 to z1.
Bounds bounds_of(const PixelRows& rows, float u, float v, float z0, float z1) {
  Bounds out;
  for (std::size_t i = 0; i < 3; ++i) {
    const float a = rows.corner[i] + u * rows.right[i] + v * rows.down[i];
    const float b = kEdgeBlock * rows.right[i], c = kEdgeBlock * rows.down[i];
    const float least = a + std::min(b, 0.0f) + std::min(c, 0.0f), most = a + std::max(b, 0.0f) + std::max(c, 0.0f);
    out.low[i] = rows.eye[i] + std::min(z0 * least, z1 * least);
    out.high[i] = rows.eye[i] + std::max(z0 * most, z1 * most);
  }
  return out;
}

class BlockFinder {
 public:
  BlockFinder(const ViewProjection& view, const std::vector<EdgeLayer>& layers, const Vec3& to_sun)
      : layers_(layers), lens_(view.intrinsics), to_sun_(view.world_from_optical.rotation.conjugate().rotate(to_sun)) {
    for (const EdgeLayer& layer : layers) rows_.push_back(rows_of(layer, view));
  }

  // Whether the sun is clearly behind the surface, by the depth values of a block's corners: they are linear over a
  // plane.
  bool looks_away(const DepthValues& depth, int u, int v) const {
    constexpr int kLast = kEdgeBlock - 1;
    if (u + kLast >= depth.width || v + kLast >= depth.height) return false;
    const float* d = depth.values.data() + std::size_t(v) * std::size_t(depth.width) + std::size_t(u);
    const float a = d[0], b = d[kLast], c = d[kLast * depth.width], e = d[kLast * depth.width + kLast];
    const float least = std::min(std::min(a, b), std::min(c, e));
    if (least <= 0 || std::fabs(a + e - b - c) > kFlat * least) return false;
    const float x = (float(u) - float(lens_.cx)) / float(lens_.fx), y = (float(v) - float(lens_.cy)) / float(lens_.fy);
    const float across = (b + e - a - c) * 0.5f / kLast * float(lens_.fx);
    const float down = (c + e - a - b) * 0.5f / kLast * float(lens_.fy);
    const Vec3f from_eye(across, down, a - x * across - y * down);  // the normal that points away from the eye
    return dot(from_eye, to_sun_) > kAway * norm(from_eye);
  }

  // The nearest edge in steps of 16 bits; 65535: it meets none.
  std::uint16_t nearest(float u, float v, float z0, float z1) const {
    std::uint16_t out = 65535;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const Bounds b = bounds_of(rows_[i], u, v, z0, z1);
      if (b.high[0] < 0 || b.high[1] < 0 || b.low[0] > 1 || b.low[1] > 1) continue;
      const Range r = layers_[i].edges->range(b.low[0], b.low[1], b.high[0], b.high[1]);
      const bool meets = float(r.nearest) < b.high[2] * 65535 && std::min(b.low[2], 1.0f) * 65535 <= float(r.most);
      if (meets && r.nearest < 65535) out = std::min(out, r.nearest);
      if (b.low[0] >= 0 && b.low[1] >= 0 && b.high[0] <= 1 && b.high[1] <= 1) break;
    }
    return out;
  }

 private:
  const std::vector<EdgeLayer>& layers_;
  const Intrinsics& lens_;
  Vec3f to_sun_;  // optical frame
  std::vector<PixelRows> rows_;
};

}  // namespace

EdgePyramid::EdgePyramid(const std::uint32_t* words, int side) {
  Level first{side, std::vector<Range>(std::size_t(side) * std::size_t(side))};
  for (std::size_t i = 0; i < first.tiles.size(); ++i)
    first.tiles[i] = {std::uint16_t(words[2 * i]), std::uint16_t(words[2 * i] >> 16)};
  levels_.push_back(std::move(first));
  while (levels_.back().side > 1) {
    const Level& from = levels_.back();
    Level to{(from.side + 1) / 2, {}};
    to.tiles.reserve(std::size_t(to.side) * std::size_t(to.side));
    const auto tile = [&](int x, int y) {
      return from.tiles[std::size_t(std::min(y, from.side - 1) * from.side + std::min(x, from.side - 1))];
    };
    for (int y = 0; y < to.side; ++y)
      for (int x = 0; x < to.side; ++x)
        to.tiles.push_back(both(both(tile(2 * x, 2 * y), tile(2 * x + 1, 2 * y)),
                                both(tile(2 * x, 2 * y + 1), tile(2 * x + 1, 2 * y + 1))));
    levels_.push_back(std::move(to));
  }
}

Range EdgePyramid::range(float x0, float y0, float x1, float y1) const {
  const float side = float(levels_.front().side);
  const auto tile = [side](float x) { return int(std::clamp(x * side, 0.0f, side - 1)); };
  int left = tile(x0), right = tile(x1), low = tile(y0), high = tile(y1);
  std::size_t level = 0;
  while (std::max(right - left, high - low) > 2) {
    left /= 2, right /= 2, low /= 2, high /= 2;
    ++level;
  }
  const Level& at = levels_[level];
  Range out;
  for (int y = low; y <= high; ++y)
    for (int x = left; x <= right; ++x) out = both(out, at.tiles[std::size_t(y * at.side + x)]);
  return out;
}

namespace {

// Least and greatest depth values of a row of blocks, by columns: those of no surface are 0 and do not count as least.
void find_depths(const float* values, int width, int rows, std::vector<float>& least, std::vector<float>& most) {
  std::vector<float> low(least.size() * kEdgeBlock, 3e38f), high(most.size() * kEdgeBlock, 0.0f);
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < width; ++x) {
      const float value = values[y * width + x], some = value > 0 ? value : 3e38f;
      low[std::size_t(x)] = std::min(low[std::size_t(x)], some);
      high[std::size_t(x)] = std::max(high[std::size_t(x)], value);
    }
  for (std::size_t i = 0; i < least.size(); ++i) {
    const float *a = low.data() + i * kEdgeBlock, *b = high.data() + i * kEdgeBlock;
    least[i] = *std::min_element(a, a + kEdgeBlock), most[i] = *std::max_element(b, b + kEdgeBlock);
  }
}

}  // namespace

std::vector<EdgeBlock> find_edge_blocks(const ViewProjection* view, const DepthValues& depth,
                                        const std::vector<EdgeLayer>& layers, const Vec3& to_sun, ThreadPool& pool) {
  constexpr int kRowsAJob = 8;  // of blocks
  std::vector<BlockFinder> finder;
  if (view) finder.emplace_back(*view, layers, to_sun);
  const std::size_t columns = std::size_t((depth.width + kEdgeBlock - 1) / kEdgeBlock);
  const int rows = (depth.height + kEdgeBlock - 1) / kEdgeBlock;
  std::vector<std::vector<EdgeBlock>> found(std::size_t((rows + kRowsAJob - 1) / kRowsAJob));
  const auto look_in = [&](int row, std::vector<float>& least, std::vector<float>& most, std::vector<EdgeBlock>& out) {
    const int v = row * kEdgeBlock;
    find_depths(depth.values.data() + std::size_t(v) * std::size_t(depth.width), depth.width,
                std::min(kEdgeBlock, depth.height - v), least, most);
    for (std::size_t i = 0; i < columns; ++i) {
      const int u = int(i) * kEdgeBlock;
      if (most[i] <= 0 || (view && finder.front().looks_away(depth, u, v))) continue;
      const std::uint16_t nearest =
          view ? finder.front().nearest(float(u) - 0.5f, float(v) - 0.5f, kNearPlane / most[i], kNearPlane / least[i])
               : std::uint16_t(65534);
      if (nearest < 65535) out.push_back({std::uint32_t(i) | std::uint32_t(row) << 16, float(nearest) / 65535});
    }
  };
  pool.run(int(found.size()), 1, [&](int begin, int end) {
    std::vector<float> least(columns), most(columns);
    for (int job = begin; job < end; ++job)
      for (int row = job * kRowsAJob; row < std::min((job + 1) * kRowsAJob, rows); ++row)
        look_in(row, least, most, found[std::size_t(job)]);
  });
  std::vector<EdgeBlock> out;
  for (const std::vector<EdgeBlock>& some : found) out.insert(out.end(), some.begin(), some.end());
  return out;
}

}  // namespace rubble
