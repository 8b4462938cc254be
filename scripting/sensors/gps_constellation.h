// Where the satellites of GPS stand: the 24 slots of the nominal constellation, on circular orbits.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Directions from a place on Earth to all 24 satellites, in the order of the slots: X east, Y north, Z up, unit length; also
// of those below the horizon. Latitude: north is positive; longitude: east is positive. unit: degree
std::vector<Vec3> find_gps_satellites(double latitude_deg, double longitude_deg, double utc_s);

}  // namespace rubble
