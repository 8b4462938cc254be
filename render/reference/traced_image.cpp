#include "render/reference/traced_image.h"

#include <algorithm>

#include "kernel/base/parallel.h"

namespace rubble {

TracedImage average_samples(const std::vector<PixelSums>& sums, int width, int height, int samples) {
  TracedImage out;
  out.width = width, out.height = height;
  const double n = samples;
  for (const PixelSums& s : sums) {
    const Vec3 light = s.light * (1 / n);
    const double grey = dot(light, Vec3(0.2126, 0.7152, 0.0722));
    const double spread = std::max(0.0, s.luminance2 / n - grey * grey);
    const float met = float(s.surfaces);
    out.light.push_back(Vec3f(light));
    out.variance.push_back(float(spread / std::max(1.0, n - 1)));
    out.cover.push_back(met / float(n));
    out.albedo.push_back(met > 0 ? s.albedo * (1 / met) : Vec3f());
    out.normal.push_back(met > 0 ? s.normal * (1 / met) : Vec3f());
    out.distance.push_back(met > 0 ? s.distance / met : 0);
  }
  return out;
}

std::vector<PixelBox> cut_into_boxes(int width, int height, int side) {
  std::vector<PixelBox> out;
  for (int y = 0; y < height; y += side)
    for (int x = 0; x < width; x += side)
      out.push_back({x, y, std::min(side, width - x), std::min(side, height - y)});
  return out;
}

TracedImage trace_image(const PathTracer& tracer, const TracedView& view, int samples,
                        const TraceWork& work) {
  const int width = view.rays.intrinsics.width, height = view.rays.intrinsics.height;
  const std::vector<PixelBox> boxes = cut_into_boxes(width, height, work.tile);
  std::vector<PixelSums> sums(std::size_t(width) * std::size_t(height));
  parallel_for(boxes.size(), work.threads, [&](std::size_t i) {
    const PixelBox& b = boxes[i];
    std::vector<PixelSums> tile;
    tracer.trace(view, b, tile);
    for (int y = 0; y < b.height; ++y)
      std::copy_n(tile.begin() + std::ptrdiff_t(y) * b.width, b.width,
                  sums.begin() + std::ptrdiff_t(b.y + y) * width + b.x);
  });
  return average_samples(sums, width, height, samples);
}

}  // namespace rubble
