// The sky as one picture that other renderers read: all directions by longitude and latitude.
#pragma once

#include <vector>

#include "render/lighting/sky.h"

namespace rubble {

// Twice as wide as high. Column x looks to the azimuth 180 - 360 (x + 0.5) / width degrees, from X towards Y;
// row y to the elevation 90 - 180 (y + 0.5) / height degrees. Below the horizon it is black.
struct SkyPanorama {
  int width = 0, height = 0;  // unit: pixel
  std::vector<float> rgb;     // 3 a pixel, rows from the top; unit: kcd/m2

  // Irradiance of level ground over pi, as Sky::mean.
  Vec3 mean() const;
};
// Without the disc of the sun.
SkyPanorama make_sky_panorama(const Sky& sky, int height);

}  // namespace rubble
