// The pile from above: how high the topmost surface is, for the map beside the camera's picture.
#pragma once

#include "io/image/image_file.h"
#include "kernel/queries/queries.h"

namespace rubble {

// A square of the world, north (Y) up in the picture.
struct MapFrame {
  Vec3 centre;      // unit: m; z is not used
  double side = 1;  // unit: m
  int pixels = 1;   // a side

  // Column and row of a place, also outside.
  double column(const Vec3& p) const;
  double row(const Vec3& p) const;
};

// Around all pieces and `camera`, with a margin.
MapFrame frame_map(const PileState& pile, const Vec3& camera, int pixels);

// Heights as colours from dark (the ground) to light, shaded by their slope.
RgbImage draw_height_map(const PileQueries& queries, const MapFrame& frame, int threads);

}  // namespace rubble
