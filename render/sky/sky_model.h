// Published figures and distributions of skies other than the clear one.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

// Times the haze of a clear day: an extinction of 4.1e-4 /m at the ground, which with that of the air is a
// visibility of 3.912 / (4.1e-4 + 1.4e-5) = 9.3 km (Koschmieder 1924); meteorology calls less than 10 km
// haze.
inline constexpr double kHazyDay = 14;

// Horizontal illuminance under a hazy sky: that of the clear sky, and of what the beam of the sun lost to the
// haze all but what is absorbed (0.06) and what is scattered upwards, (2 - 3 g sin(elevation)) / 4 (Eddington's
// approximation, as Meador and Weaver 1980 give it), g = 0.76. The single scattering of ClearSky gives only
// how it is distributed. lost: on a facing surface; unit: klx
float hazy_illuminance(float clear, float lost, float sine);

// Of illuminance outside the atmosphere: the full moon of magnitude -12.74 gives 0.267 lx (Allen's
// Astrophysical Quantities), the sun 133 klx. The moon's light is taken to have the sun's colour.
inline constexpr float kMoonOverSun = 0.267f / 133e3f;

// Horizontal illuminance under an overcast sky, by the sun's elevation g: 300 + 21000 sin g lx (Krochmann
// and Seidl 1974). With the sun below the horizon it falls from 300 lx as the clear twilight does, whose
// illuminance is clear_dusk then. Unit: klx.
float overcast_illuminance(double sun_elevation_deg, float clear_dusk);

// The standard overcast sky of the CIE (Moon and Spencer 1942; CIE S 011, type 16): L = Lz (1 + 2 sin g) / 3
// at the elevation g, the zenith's luminance Lz = 9 / (7 pi) of the horizontal illuminance. Grey as D65.
// Unit: kcd/m2.
Vec3f overcast_radiance(float sine, float horizontal_klx);

// The standard clear sky of the CIE with low turbidity (CIE S 011:2003, ISO 15469:2004, type 12): luminance over
// that of the zenith, by the sines of the elevations of the direction and of the sun, and by the cosine of the
// angle between them.
float cie_clear_ratio(float sine, float sun_sine, float sun_cosine);

// The glow of a town with street lamps of 3000 K: 3 mcd/m2 at the zenith, as over large towns (Falchi et
// al. 2016, "The New World Atlas of Artificial Night Sky Brightness"), five times that at the horizon; the
// distribution is our choice. Unit: kcd/m2.
Vec3f city_glow(float sine);

}  // namespace rubble
