// Where the sun stands by place and time.
//
// The algorithm of the NOAA Solar Calculator, after Meeus 1998, "Astronomical Algorithms", chapters 25 and
// 28, with NOAA's refraction: within 0.01 degrees from 1950 to 2050 where the sun is well above the horizon.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace rubble {

// Seconds since 1970-01-01T00:00:00Z of a time such as "2026-06-21T12:00:00Z" (ISO 8601, UTC), of the years
// 1900 to 2100; nothing: it is not one.
std::optional<std::int64_t> parse_utc(const std::string& text);

struct SunPosition {
  double elevation_deg = 0;    // apparent: raised by refraction; range: -90 to 90
  double azimuth_deg = 0;      // from north, clockwise: 90 is east; range: 0 to 360
  double declination_deg = 0;  // north of the equator
};
// Latitude: north is positive; longitude: east is positive. unit: degree
SunPosition find_sun(double latitude_deg, double longitude_deg, std::int64_t utc_seconds);

}  // namespace rubble
