#include "scripting/sky/sun_position.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "kernel/base/portable_math.h"

namespace rubble {

namespace {

constexpr double kDegree = portable::kPi / 180;
constexpr std::int64_t kDaySeconds = 86400;
constexpr double kDaysTo2000 = 10957.5;  // from 1970-01-01 to 2000-01-01, 12 h (J2000.0)

double sin_deg(double degrees) { return portable::sin(std::fmod(degrees, 360.0) * kDegree); }
double cos_deg(double degrees) { return portable::cos(std::fmod(degrees, 360.0) * kDegree); }
double asin_deg(double x) { return portable::asin(std::clamp(x, -1.0, 1.0)) / kDegree; }

int days_of_month(int year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = (year % 4 == 0 && year % 100 != 0) || year % 400 == 0;
  return kDays[month - 1] + (leap && month == 2 ? 1 : 0);
}

std::int64_t days_since_1970(int year, int month, int day) {
  std::int64_t days = day - 1;
  for (int m = 1; m < month; ++m) days += days_of_month(year, m);
  for (int y = 1970; y < year; ++y) days += days_of_month(y, 2) + 337;
  for (int y = year; y < 1970; ++y) days -= days_of_month(y, 2) + 337;
  return days;
}

// How far the air raises a light that stands at this elevation; unit: degree.
double refraction(double elevation) {
  const double tangent = sin_deg(elevation) / cos_deg(elevation), h = elevation;
  double seconds = 0;
  if (elevation > 85) return 0;
  if (elevation > 5)
    seconds = 58.1 / tangent - 0.07 / (tangent * tangent * tangent) +
              0.000086 / (tangent * tangent * tangent * tangent * tangent);
  else if (elevation > -0.575)
    seconds = 1735 + h * (-518.2 + h * (103.4 + h * (-12.79 + h * 0.711)));
  else
    seconds = -20.774 / tangent;
  return seconds / 3600;
}

}  // namespace

std::optional<std::int64_t> parse_utc(const std::string& text) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, second = 0, used = 0;
  const std::string shape = "dddd-dd-ddTdd:dd:ddZ";
  if (text.size() != shape.size()) return std::nullopt;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] == 'd' ? text[i] < '0' || text[i] > '9' : text[i] != shape[i]) return std::nullopt;
  if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%2dZ%n", &year, &month, &day, &hour, &minute, &second,
                  &used) != 6)
    return std::nullopt;
  if (year < 1900 || year > 2100 || month < 1 || month > 12 || hour > 23 || minute > 59 || second > 59)
    return std::nullopt;
  if (day < 1 || day > days_of_month(year, month)) return std::nullopt;
  return days_since_1970(year, month, day) * kDaySeconds + hour * 3600 + minute * 60 + second;
}

SunPosition find_sun(double latitude_deg, double longitude_deg, std::int64_t utc_seconds) {
  const double days = double(utc_seconds) / double(kDaySeconds);
  const double t = (days - kDaysTo2000) / 36525;  // Julian centuries since J2000.0
  const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
  const double anomaly = 357.52911 + t * (35999.05029 - 0.0001537 * t);
  const double eccentricity = 0.016708634 - t * (0.000042037 + 0.0000001267 * t);
  const double centre = sin_deg(anomaly) * (1.914602 - t * (0.004817 + 0.000014 * t)) +
                        sin_deg(2 * anomaly) * (0.019993 - 0.000101 * t) + sin_deg(3 * anomaly) * 0.000289;
  const double node = 125.04 - 1934.136 * t;
  const double longitude = mean_longitude + centre - 0.00569 - 0.00478 * sin_deg(node);
  const double obliquity =
      23 + (26 + (21.448 - t * (46.815 + t * (0.00059 - t * 0.001813))) / 60) / 60 + 0.00256 * cos_deg(node);
  SunPosition sun;
  sun.declination_deg = asin_deg(sin_deg(obliquity) * sin_deg(longitude));

  const double half = sin_deg(obliquity / 2) / cos_deg(obliquity / 2), y = half * half, e = eccentricity;
  const double equation_minutes =  // of time
      4 / kDegree *
      (y * sin_deg(2 * mean_longitude) - 2 * e * sin_deg(anomaly) +
       4 * e * y * sin_deg(anomaly) * cos_deg(2 * mean_longitude) - 0.5 * y * y * sin_deg(4 * mean_longitude) -
       1.25 * e * e * sin_deg(2 * anomaly));
  const double solar_minutes = (days - std::floor(days)) * 1440 + equation_minutes + 4 * longitude_deg;
  const double hour_angle = solar_minutes / 4 - 180;

  const double sin_declination = sin_deg(sun.declination_deg), cos_declination = cos_deg(sun.declination_deg);
  const double up = sin_deg(latitude_deg) * sin_declination +
                    cos_deg(latitude_deg) * cos_declination * cos_deg(hour_angle);
  const double east = -cos_declination * sin_deg(hour_angle);
  const double north = cos_deg(latitude_deg) * sin_declination -
                       sin_deg(latitude_deg) * cos_declination * cos_deg(hour_angle);
  const double elevation = asin_deg(up);
  sun.elevation_deg = elevation + refraction(elevation);
  const double azimuth = portable::atan2(east, north) / kDegree;
  sun.azimuth_deg = azimuth < 0 ? azimuth + 360 : azimuth;
  return sun;
}

}  // namespace rubble
