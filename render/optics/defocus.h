// Blur of what is out of focus, from the exact depth.
//
// A thin lens of the aperture A = focal length / f-number that is focused on the plane at s spreads a
// point at the depth z over a disc of the diameter fx A |1/s - 1/z| pixels: the cone of light from the
// point through the aperture, where it cuts the sharp plane, seen from the middle of the lens. (The circle
// of confusion on the sensor is A |z - s| / z times v / s, v the distance of the sensor from the lens, and
// fx is v in pixels.)
//
// Each pixel's light is spread evenly over its disc; what is nearer lies over what is farther. Behind the
// soft edge of something near, where the exact image shows nothing, the background beside it is taken.
#pragma once

#include <vector>

#include "render/optics/line_filters.h"

namespace rubble {

struct ThinLens {
  double aperture = 0;  // diameter; unit: m
  double focus = 0;     // the sharp distance s; unit: m
  double focal = 0;     // fx; unit: pixel

  // Of the disc, in pixels; negative before the sharp plane. depth: unit: m; NaN: infinitely far.
  double signed_radius(double depth) const;
};
inline constexpr double kMostDefocus = 32;  // larger radii are cut to this; unit: pixel

// depth: one a pixel, in m; NaN: infinitely far.
LinearImage defocus(const LinearImage& sharp, const std::vector<float>& depth, const ThinLens& lens,
                    int threads);

}  // namespace rubble
