// Distance between two convex point sets in single precision (Gilbert, Johnson and Keerthi 1988;
// closest points on a simplex after Ericson 2005, chapter 5).
#pragma once

#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

// Corners turned to the world, relative to some origin.
struct PointSet {
  const Vec3f* points = nullptr;  // `count` corners; unit: m
  int count = 0;                  // at least 1
};

// The simplex where the last search ended: the next one starts there.
struct GjkCache {
  std::uint16_t a[3] = {}, b[3] = {};  // corners of A and B
  std::uint8_t size = 0;               // corners in use; 0: start anew; range: 0 to 3
};

struct GjkResult {
  enum class Kind { separated, beyond_margin, overlapping };
  Kind kind = Kind::separated;  // what of the rest is valid
  Vec3f normal;                 // unit length, from A to B
  float distance = 0;           // beyond the margin: at least this; unit: m
  Vec3f point_a, point_b;       // closest points, in the frame of A's corners
};

// `offset` is added to B's corners. Beyond `margin` the search ends early, with a normal that
// proves it. Overlapping, closer than about 10 micrometres, or beyond what
// single precision can tell: nothing but the kind is valid.
GjkResult calc_distance(const PointSet& a, const PointSet& b, const Vec3f& offset, float margin,
                        GjkCache& cache);

// The corner farthest along a direction.
int find_support(const PointSet& set, const Vec3f& direction);

}  // namespace rubble
