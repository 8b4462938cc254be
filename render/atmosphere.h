// The light of sun and clear sky by the sun's elevation, from physics: single scattering by air and
// haze and absorption by ozone in a round atmosphere, so that dusk has its colours and the earth's
// shadow (Nishita et al., "Display of the Earth Taking into Account Atmospheric Scattering", 1993;
// densities and cross-sections after Bruneton and Neyret 2008 and Bruneton 2017; 128 klx outside
// the atmosphere). Light scattered more than once is added as an even share of what was scattered.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

inline constexpr double kLowestSun = -18;  // degrees; below, night has fallen

// What the atmosphere leaves of the sun: illuminance on a facing surface at the ground, as red,
// green and blue in klx; black once the whole disc is below the horizon.
Vec3f sun_illuminance(double elevation_deg);

// Radiance of the clear sky in a direction (unit length; below the horizon: as at it); kcd/m2.
// to_sun: unit length, also below the horizon.
Vec3f clear_sky_radiance(const Vec3f& direction, const Vec3f& to_sun);

}  // namespace rubble
