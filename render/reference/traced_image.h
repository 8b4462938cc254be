// What path tracing gives of one view: light, and the features that a filter goes by.
#pragma once

#include <cstddef>
#include <vector>

#include "render/reference/path_tracer.h"

namespace rubble {

// Rows from the top.
struct TracedImage {
  int width = 0, height = 0;   // unit: pixel
  std::vector<Vec3f> light;    // mean radiance; unit: kcd/m2
  std::vector<float> variance;  // of the mean's luminance; unit: (kcd/m2)^2
  // Of the surface seen first: means over the samples that met one.
  std::vector<Vec3f> albedo, normal;
  std::vector<float> distance;  // along the ray; unit: m
  std::vector<float> cover;     // share of samples that met one; range: 0 to 1

  std::size_t size() const { return light.size(); }
};

TracedImage average_samples(const std::vector<PixelSums>& sums, int width, int height, int samples);

}  // namespace rubble
