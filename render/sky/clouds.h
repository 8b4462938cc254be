// A layer of broken cumulus clouds, drawn by the seed.
//
// The layer lies 1,200 m above the ground, curved as the earth is. Its optical thickness tau follows from
// noise of six octaves above a threshold at which the stated share of the layer is cloud. A line of sight
// sees
//
//   L = Lsky exp(-tau) + (1 - exp(-tau)) T(tau) E / pi + Esun P(angle) tau exp(-tau),
//
// what comes through straight; light scattered many times, T = 1 / (1 + (1 - g) tau sqrt(3) / 2) of the
// horizontal illuminance E (two streams without absorption, Coakley and Chylek 1975, g = 0.85); and sunlight
// scattered once, P after Henyey and Greenstein: the bright rims before the sun. Clouds far away fade into
// the horizon.
#pragma once

#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

class CloudLayer {
 public:
  // cover: share of the layer, 0 to 1; beam: of the sun, on a facing surface; sky_light: of the clear sky,
  // on the horizontal. unit: klx
  CloudLayer(double cover, std::uint64_t seed, const Vec3f& to_sun, const Vec3f& beam,
             const Vec3f& sky_light);

  // direction: unit length, pointing up.
  float thickness(const Vec3f& direction) const;
  // What is seen there before a clear sky of this radiance; horizon: of the clear sky. unit: kcd/m2
  Vec3f cover(const Vec3f& direction, const Vec3f& clear, const Vec3f& horizon) const;
  // Share of a beam from there that comes through straight.
  float beam_share(const Vec3f& direction) const;

 private:
  struct Place {
    float x, y;  // in the layer; unit: m
    float far;   // along the line of sight; unit: m
  };
  Place meet(const Vec3f& direction) const;
  float noise(float x, float y) const;  // about 0 to 1
  float thickness_at(float x, float y) const;

  bool none_;
  std::uint32_t seed_;
  float threshold_ = 0;
  Vec3f to_sun_, beam_, level_;  // level_: illuminance of the horizontal, above; unit: klx
};

}  // namespace rubble
