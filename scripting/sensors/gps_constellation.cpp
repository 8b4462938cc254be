#include "scripting/sensors/gps_constellation.h"

#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

// GPS Standard Positioning Service Performance Standard, October 2001, table 3-1: slots by right ascension of the ascending
// node and argument of latitude at 0000Z, 1 July 1993, with Greenwich at 18 h 36 min 14.4 s. The orbits are circular,
// inclined by 55 degrees, with a semi-major axis of 26559.7 km.
struct Plane {
  double node_deg;
  double slots_deg[4];
};
constexpr Plane kPlanes[] = {
    {272.847, {268.126, 161.786, 11.676, 41.806}},  {332.847, {80.956, 173.336, 309.976, 204.376}},
    {32.847, {111.876, 11.796, 339.666, 241.556}},  {92.847, {135.226, 265.446, 35.156, 167.356}},
    {152.847, {197.046, 302.596, 66.066, 333.686}}, {212.847, {238.886, 345.226, 105.206, 135.346}}};
constexpr double kEpoch = 741484800;        // seconds since 1970; 1 July 1993
constexpr double kGreenwichDeg = 279.06;    // 18 h 36 min 14.4 s
constexpr double kInclinationDeg = 55;
constexpr double kSemiMajorAxis = 26559.7e3;     // unit: m
constexpr double kSiderealDay = 86164.0905;      // unit: s; a satellite goes round twice in it
constexpr double kEarthRadius = 6371e3;          // mean; unit: m
constexpr double kTurn = 2 * portable::kPi, kToRadians = portable::kPi / 180;

double turns_since_epoch(double utc_s, double period) {
  const double turns = (utc_s - kEpoch) / period;
  return turns - std::floor(turns);
}

}  // namespace

std::vector<Vec3> find_gps_satellites(double latitude_deg, double longitude_deg, double utc_s) {
  const double greenwich = kGreenwichDeg * kToRadians + kTurn * turns_since_epoch(utc_s, kSiderealDay);
  const auto [sin_lat, cos_lat] = portable::sincos(latitude_deg * kToRadians);
  // The place's meridian among the stars.
  const auto [sin_lon, cos_lon] = portable::sincos(longitude_deg * kToRadians + greenwich);
  const Vec3 up{cos_lat * cos_lon, cos_lat * sin_lon, sin_lat}, east{-sin_lon, cos_lon, 0};
  const Vec3 north = cross(up, east);
  const auto [sin_i, cos_i] = portable::sincos(kInclinationDeg * kToRadians);
  std::vector<Vec3> directions;
  for (const Plane& plane : kPlanes) {
    const auto [sin_node, cos_node] = portable::sincos(plane.node_deg * kToRadians);
    for (const double slot_deg : plane.slots_deg) {
      const auto [s, c] = portable::sincos(slot_deg * kToRadians + kTurn * turns_since_epoch(utc_s, kSiderealDay / 2));
      const Vec3 satellite{cos_node * c - sin_node * s * cos_i, sin_node * c + cos_node * s * cos_i, s * sin_i};
      const Vec3 to = normalized(satellite * kSemiMajorAxis - up * kEarthRadius);
      directions.push_back({dot(to, east), dot(to, north), dot(to, up)});
    }
  }
  return directions;
}

}  // namespace rubble
