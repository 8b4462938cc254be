#include "render/reference/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "render/reference/wave.h"

namespace rubble {

namespace {

constexpr int kMostPaths = 4096;  // at once: their state stays in the second-level cache

void add_sample(const Path& path, PixelSums& sum) {
  const Vec3 light(path.light);
  const double luminance = dot(light, Vec3(0.2126, 0.7152, 0.0722));
  if (!std::isfinite(luminance)) return;  // a degenerate triangle can give no direction
  sum.light += light;
  sum.luminance2 += luminance * luminance;
  if (!path.met_surface) return;
  sum.albedo += path.albedo, sum.normal += path.normal;
  sum.distance += path.first_distance;
  ++sum.surfaces;
}

}  // namespace

void PathTracer::trace(const TracedView& view, const PixelBox& box,
                       std::vector<PixelSums>& out) const {
  const int pixels = box.width * box.height;
  out.assign(std::size_t(pixels), {});
  const int at_once = std::clamp(kMostPaths / std::max(1, pixels), 1, options_.samples);
  Wave wave(scene_, view, options_);
  for (int first = 0; first < options_.samples; first += at_once) {
    const int last = std::min(first + at_once, options_.samples);
    wave.begin(box, first, last);
    while (wave.step()) {
    }
    for (const Path& path : wave.paths()) add_sample(path, out[path.pixel]);
  }
}

}  // namespace rubble
