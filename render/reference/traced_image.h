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

// Boxes of at most this side that cover an image, rows from the top.
std::vector<PixelBox> cut_into_boxes(int width, int height, int side);

struct TraceWork {
  int tile = 16;    // side of what is traced at once; unit: pixel; the image does not depend on it
  int threads = 1;  // nor on these
};
// The whole view. samples: those of the tracer's options.
TracedImage trace_image(const PathTracer& tracer, const TracedView& view, int samples,
                        const TraceWork& work);

}  // namespace rubble
