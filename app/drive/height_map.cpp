#include "app/drive/height_map.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/parallel.h"

namespace rubble {
namespace {

constexpr double kMargin = 1;     // around what there is; unit: m
constexpr double kFromAbove = 100;  // rays start so high; unit: m

Vec3 place_of(const MapFrame& frame, int column, int row) {
  const double step = frame.side / frame.pixels;
  return frame.centre + Vec3((column + 0.5) * step - frame.side / 2,
                             frame.side / 2 - (row + 0.5) * step, 0);
}

std::vector<double> measure_heights(const PileQueries& queries, const MapFrame& frame,
                                    int threads) {
  const auto side = std::size_t(frame.pixels);
  std::vector<double> heights(side * side);
  parallel_for(side, threads, [&](std::size_t row) {
    for (std::size_t column = 0; column < side; ++column) {
      Vec3 from = place_of(frame, int(column), int(row));
      from.z = kFromAbove;
      const auto hit = queries.cast_ray(from, {0, 0, -1}, 2 * kFromAbove);
      heights[row * side + column] = hit ? hit->point.z : 0;
    }
  });
  return heights;
}

}  // namespace

double MapFrame::column(const Vec3& p) const {
  return (p.x - centre.x + side / 2) / side * pixels - 0.5;
}
double MapFrame::row(const Vec3& p) const {
  return (centre.y + side / 2 - p.y) / side * pixels - 0.5;
}

MapFrame frame_map(const PileState& pile, const Vec3& camera, int pixels) {
  Aabb box;
  box.include(camera);
  for (const PieceState& piece : pile.pieces)
    if (piece.status != PieceStatus::lost) box.include(piece.world_from_body.translation);
  MapFrame frame;
  frame.centre = (box.min + box.max) * 0.5;
  frame.side = std::max(box.max.x - box.min.x, box.max.y - box.min.y) + 2 * kMargin;
  frame.pixels = pixels;
  return frame;
}

RgbImage draw_height_map(const PileQueries& queries, const MapFrame& frame, int threads) {
  const std::vector<double> heights = measure_heights(queries, frame, threads);
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double lowest = *low, range = std::max(0.5, *high - lowest);  // of a hillside, too
  const double step = frame.side / frame.pixels;
  RgbImage image{frame.pixels, frame.pixels, {}};
  for (int row = 0; row < frame.pixels; ++row)
    for (int column = 0; column < frame.pixels; ++column) {
      const auto at = [&](int r, int c) {
        r = std::clamp(r, 0, frame.pixels - 1), c = std::clamp(c, 0, frame.pixels - 1);
        return heights[std::size_t(r * frame.pixels + c)];
      };
      const double height = (at(row, column) - lowest) / range;
      const double slope = (at(row + 1, column + 1) - at(row - 1, column - 1)) / (2 * step);
      const double light = (60 + 150 * height) * (1 - std::clamp(0.35 * slope, -0.35, 0.5));
      for (const double tint : {1.0, 0.97, 0.88})
        image.rgb.push_back(std::uint8_t(std::clamp(light * tint, 0.0, 255.0)));
    }
  return image;
}

}  // namespace rubble
