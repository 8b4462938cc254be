// Sunlight and the clear sky by where the sun stands, from physics: air, haze and ozone over a round
// earth, so that dusk has its colours and the earth's shadow (Nishita et al., "Display of the Earth
// Taking into Account Atmospheric Scattering", 1993; densities and cross-sections after Bruneton and
// Neyret 2008 and Bruneton 2017; 133 klx outside the atmosphere).
#pragma once

#include <vector>

#include "kernel/base/math.h"

namespace rubble {

inline constexpr double kLowestSun = -18;  // degrees; below, night has fallen

// On a surface that faces the sun, at the ground; black once its disc has set. haze: how many times as
// much haze hangs in the air as on a clear day. Unit: klx.
Vec3f sun_illuminance(double elevation_deg, double haze = 1);

// Airglow and stars; in ClearSky::radiance already. Unit: kcd/m2.
Vec3f night_sky();

// Light scattered once is integrated along each ray; what is scattered again is taken to come evenly
// from everywhere, as bright as the mean of sky and ground. That keeps the horizon from going black
// at dusk, when the air before it lies in the earth's shadow.
// The haze has an optical depth of 0.035 at 550 nm, a clear day, and an Angstrom exponent of 1.3.
class ClearSky {
 public:
  // to_sun: unit length, also below the horizon.
  explicit ClearSky(const Vec3f& to_sun, double haze = 1);

  // Without the sun's disc. direction: unit length; below the horizon as level. Unit: kcd/m2.
  Vec3f radiance(const Vec3f& direction) const;

 private:
  // Scattered along a ray: sunlight, and light that comes evenly from everywhere at radiance 1.
  struct Scattered {
    Vec3 sun, even;
  };
  Scattered scatter(const Vec3& direction) const;
  Vec3 sunlight_at(const Vec3& point) const;  // as a share of that outside the atmosphere

  static constexpr int kHeights = 32, kCosines = 48;
  Vec3 sun_;
  double haze_;
  Vec3 around_;                 // mean radiance of sky and ground; unit: kcd/m2
  std::vector<Vec3> sunlight_;  // by height and by the sun's place above that height's horizon
};

}  // namespace rubble
