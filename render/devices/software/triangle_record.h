// A triangle on the image, ready to be filled. Internal to render/devices/software.
#pragma once

#include <cstdint>

namespace rubble {

// Corners are on a grid of 1/256 pixel, as graphics devices do it: so edges that two triangles share
// leave neither gap nor overlap. Depth is that of the triangle's own plane, not of the grid.
struct TriangleRecord {
  static constexpr int kGrid = 256;  // steps a pixel

  std::int32_t x[3], y[3];  // turned so that E(x, y) of every edge is positive inside
  double a, b, c;           // depth value (near / Z, or of a shadow map) = a u + b v + c at the pixel (u, v)
  float least, most;        // of the depth values at the corners: it never leaves them
  std::uint64_t id;         // placed mesh + 1, and above bit 32 the triangle's name
};
static_assert(sizeof(TriangleRecord) == 64, "one cache line");

// Rows [first_row, last_row) of an image of `width` columns; memory of row 0 is at the pointers.
struct RasterTarget {
  float* depth;                    // near / Z; 0: nothing
  std::uint64_t* ids;              // TriangleRecord::id
  int width, first_row, last_row;  // unit: pixel
};

// As a shadow map has it: depth 0 to 1, of which the smaller is kept. Ids are not drawn.
struct DepthTarget {
  float* depth;
  int width, first_row, last_row;  // as RasterTarget
};

// Draws the part of the triangle that covers pixel centres of those rows and is nearer than what is
// there. An edge through a pixel's centre gives the pixel to the triangle on its right or below it.
void fill_triangle(const TriangleRecord& triangle, const RasterTarget& target);
void fill_triangle(const TriangleRecord& triangle, const DepthTarget& target);

}  // namespace rubble
