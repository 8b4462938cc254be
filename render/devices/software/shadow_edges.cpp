#include "render/devices/software/shadow_edges.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace rubble {

namespace {

constexpr int kSide = EdgeView::kTile;
constexpr int kRowsOfTiles = 16;  // that a thread takes at a time

}  // namespace

ShadowEdges::ShadowEdges(int side, std::vector<EdgeView> views, ThreadPool& pool)
    : views_(std::move(views)), map_side_(side), side_((side + kSide - 1) / kSide), pool_(pool), layers_(views_.size()) {
  const std::size_t count = std::size_t(side_) * std::size_t(side_);
  for (Layer& layer : layers_) layer.found.resize(count), layer.edges.resize(count);
  across_.resize(count);
}

void ShadowEdges::find(const std::vector<float>& texels) {
  for (std::size_t layer = 0; layer < views_.size(); ++layer) find_in(texels.data(), layer, {{0, 0, side_, side_}});
  build_pyramids();
}

void ShadowEdges::find_again(const std::vector<float>& texels, const std::vector<std::vector<TexelRect>>& changed) {
  layers_ = kept_;
  for (std::size_t layer = 0; layer < views_.size(); ++layer) {
    std::vector<TexelRect> tiles;
    // A tile also reads the texels beside it on the right and above.
    for (const TexelRect& r : changed[layer])
      tiles.push_back({(r.x0 - 1) / kSide, (r.y0 - 1) / kSide, r.x1 / kSide + 1, r.y1 / kSide + 1});
    find_in(texels.data(), layer, merge_rects(std::move(tiles)));
  }
  build_pyramids();
}

void ShadowEdges::build_pyramids() {
  pyramids_.clear();
  for (const Layer& layer : layers_) pyramids_.emplace_back(layer.edges.front().data(), side_);
}

template <typename Make>
void ShadowEdges::fill(const std::vector<TexelRect>& tiles, int grow_x, int grow_y, std::vector<Tile>& out,
                       const Make& make) {
  for (const TexelRect& r : tiles) {
    const int x0 = std::max(0, r.x0 - grow_x), x1 = std::min(side_, r.x1 + grow_x);
    const int y0 = std::max(0, r.y0 - grow_y), y1 = std::min(side_, r.y1 + grow_y);
    if (x0 >= x1 || y0 >= y1) continue;
    pool_.run(y1 - y0, kRowsOfTiles, [&](int begin, int end) {
      for (int y = y0 + begin; y < y0 + end; ++y)
        for (int x = x0; x < x1; ++x) out[std::size_t(y) * std::size_t(side_) + std::size_t(x)] = make(x, y);
    });
  }
}

void ShadowEdges::find_in(const float* texels, std::size_t layer, const std::vector<TexelRect>& tiles) {
  const EdgeView& view = views_[layer];
  const float* const map = texels + layer * std::size_t(map_side_) * std::size_t(map_side_);
  const int reach = view.reach();
  Layer& out = layers_[layer];
  fill(tiles, 0, 0, out.found, [&](int x, int y) { return find_tile(map, view, x, y); });
  fill(tiles, reach, 2 * reach, across_, [&](int x, int y) { return spread(out.found, x, y, 1, 0, reach); });
  fill(tiles, reach, reach, out.edges, [&](int x, int y) { return spread(across_, x, y, 0, 1, reach); });
}

ShadowEdges::Tile ShadowEdges::find_tile(const float* map, const EdgeView& view, int tile_x, int tile_y) const {
  const float size = float(map_side_), least_step = view.least_step();
  const float at_x = (float(tile_x) + 0.5f) * kSide / size, at_y = (float(tile_y) + 0.5f) * kSide / size;
  // Where the map shows nothing.
  const float below = std::max(view.ground[0] + (view.ground[1] * at_x + view.ground[2] * at_y), 1.0f);
  float nearest = 1, farthest = 0, most = 0;
  const auto compare = [&](float one, float other) {
    const float near = std::min(one, other), far = std::max(one, other);
    if (far - near < least_step) return;
    nearest = std::min(nearest, near);
    farthest = std::max(farthest, far < 1 ? far : below);
  };
  float before[kSide + 1] = {};
  for (int y = 0; y <= kSide; ++y) {
    const float* const row =
        map + std::size_t(std::min(tile_y * kSide + y, map_side_ - 1)) * std::size_t(map_side_);
    float left = 0;
    for (int x = 0; x <= kSide; ++x) {
      const float depth = row[std::min(tile_x * kSide + x, map_side_ - 1)];
      if (x > 0) compare(left, depth);
      if (y > 0) compare(before[x], depth);
      most = std::max(most, depth);
      left = before[x] = depth;
    }
  }
  const float reach =
      nearest < 1 ? std::ceil((farthest - nearest) * view.reach_a_depth() + EdgeView::kLeastReach) : 0.0f;
  // To the next step of 16 bits, so that nothing is lost.
  const float low = std::clamp(nearest, 0.0f, 1.0f) * 65535, high = std::clamp(most, 0.0f, 1.0f) * 65535;
  return {std::uint32_t(std::floor(low)) | std::uint32_t(std::ceil(high)) << 16, std::uint32_t(std::min(reach, 255.0f))};
}

ShadowEdges::Tile ShadowEdges::spread(const std::vector<Tile>& tiles, int x, int y, int along_x, int along_y,
                                      int most_reach) const {
  const auto tile_at = [&](int i) -> const Tile& {
    const int column = std::clamp(x + along_x * i, 0, side_ - 1), row = std::clamp(y + along_y * i, 0, side_ - 1);
    return tiles[std::size_t(row) * std::size_t(side_) + std::size_t(column)];
  };
  std::uint32_t nearest = 65535, most = 0, reach = 0;
  for (int i = -most_reach; i <= most_reach; ++i) {
    const Tile& tile = tile_at(i);
    if (int(tile[1]) < std::abs(i)) continue;
    nearest = std::min(nearest, tile[0] & 65535u), reach = std::max(reach, tile[1]);
  }
  const int about = std::min(int(reach), most_reach);
  for (int i = -about; i <= about; ++i) most = std::max(most, tile_at(i)[0] >> 16);
  return {nearest | most << 16, reach};
}

}  // namespace rubble
