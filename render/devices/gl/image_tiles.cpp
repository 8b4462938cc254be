#include "render/devices/gl/image_tiles.h"

#include <algorithm>
#include <cstddef>

namespace rubble {

namespace {

constexpr int kTile = 32;  // side; unit: pixel

struct Bounds {
  float least, most;
};

Bounds bounds_of(const float* corner, std::size_t stride, int width, int height) {
  Bounds b{corner[0], corner[0]};
  for (int y = 0; y < height; ++y, corner += stride) {
    for (int x = 0; x < width; ++x) {
      b.least = corner[x] < b.least ? corner[x] : b.least;
      b.most = corner[x] > b.most ? corner[x] : b.most;
    }
  }
  return b;
}

TileContent content_of(const Bounds& b, float near_value) {
  if (b.most <= 0) return TileContent::sky;
  if (b.least <= 0) return TileContent::mixed;
  return b.least > near_value ? TileContent::near_surfaces : TileContent::surfaces;
}

}  // namespace

ImageTiles cut_into_tiles(const std::vector<float>& depth_values, int width, int height,
                          float near_value, ThreadPool& pool) {
  const int across = (width + kTile - 1) / kTile, down = (height + kTile - 1) / kTile;
  std::vector<Bounds> bounds(std::size_t(across) * std::size_t(down));
  pool.run(down, 1, [&](int begin, int end) {
    for (int row = begin; row < end; ++row)
      for (int column = 0; column < across; ++column) {
        const int x = column * kTile, y = row * kTile;
        const float* corner = depth_values.data() + std::size_t(y) * std::size_t(width) + x;
        bounds[std::size_t(row * across + column)] =
            bounds_of(corner, std::size_t(width), std::min(kTile, width - x), std::min(kTile, height - y));
      }
  });
  ImageTiles out;
  out.first_row = height;
  for (int y = 0; y < height; y += kTile) {
    const int rows = std::min(kTile, height - y);
    for (int x = 0; x < width; x += kTile) {
      const int columns = std::min(kTile, width - x);
      const Bounds b = bounds[std::size_t(y / kTile * across + x / kTile)];
      const TileContent content = content_of(b, near_value);
      if (x > 0 && out.runs.back().content == content)
        out.runs.back().width += columns;
      else
        out.runs.push_back({content, x, y, columns, rows});
      if (content == TileContent::sky) continue;
      out.first_row = std::min(out.first_row, y);
      out.last_row = y + rows;
      out.nearest_value = std::max(out.nearest_value, b.most);
    }
  }
  out.first_row = std::min(out.first_row, out.last_row);
  std::stable_sort(out.runs.begin(), out.runs.end(),
                   [](const TileRun& a, const TileRun& b) { return a.content < b.content; });
  return out;
}

}  // namespace rubble
