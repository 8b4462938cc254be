// The glow of twice scattered light next to a lamp, where a grid of the air is too coarse for it.
//
// Light of a lamp of intensity I that is scattered once fills the air about it as I / d^2. What arrives from that at a
// distance r, so near that hardly any is lost, falls with 1 / r alone, by the scaling of lengths:
//   radiance = scattering coefficient * I / r * G(angle from the axis; direction)
// G is an integral along the direction, with angles at the lamp instead of distances. A grid whose points are `cell`
// apart has about I / sqrt(r^2 + cell^2) of this: the rest is here.
#pragma once

#include <vector>

#include "render/lighting/harmonics.h"
#include "render/media/air_glow.h"

namespace rubble {

class NearGlow {
 public:
  // cone: as of AirLamp; cosine: mean cosine of the first scattering.
  NearGlow(float cone, double cosine);

  static constexpr std::size_t kAngles = 32;
  // By the angle from the axis, in kAngles equal steps to 180 degrees: G, in a frame whose Z is the axis and whose Y is
  // normal to the plane of axis and point.
  const std::vector<Harmonics>& table() const { return table_; }

 private:
  std::vector<Harmonics> table_;
};

}  // namespace rubble
