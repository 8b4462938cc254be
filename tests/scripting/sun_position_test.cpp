// The sun by place and time against published positions, and the keys for it.
#include "scripting/sky/sun_position.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scripting/scenario/scenario.h"
#include "tests/scripting/test_support.h"

namespace rubble::testing {
namespace sun_position_test {

SunPosition sun_at(double latitude, double longitude, const char* utc) {
  const auto seconds = parse_utc(utc);
  EXPECT_TRUE(seconds) << utc;
  return find_sun(latitude, longitude, seconds.value_or(0));
}

TEST(ParseUtc, KnowsTheCalendar) {
  EXPECT_EQ(parse_utc("1970-01-01T00:00:00Z"), 0);
  EXPECT_EQ(parse_utc("2000-03-01T00:00:00Z"), 951868800);  // 2000 was a leap year
  EXPECT_EQ(parse_utc("2026-11-22T23:30:59Z"), 1795390259);
  EXPECT_EQ(parse_utc("1969-12-31T23:59:59Z"), -1);
  EXPECT_EQ(parse_utc("2024-02-29T12:00:00Z"), 1709208000);
  for (const char* wrong : {"", "2026-06-21", "2026-06-21T12:00:00", "2026-06-21 12:00:00Z", "2026-13-01T00:00:00Z",
                            "2026-02-29T00:00:00Z", "2100-02-29T00:00:00Z", "2026-06-21T24:00:00Z",
                            "2026-06-21T12:60:00Z", "1899-06-21T12:00:00Z", "2026-06-00T12:00:00Z", "+026-06-21T12:00:00Z"})
    EXPECT_FALSE(parse_utc(wrong)) << wrong;
}

// The example of NREL's Solar Position Algorithm (Reda and Andreas 2004, table A5.1): Golden, Colorado,
// 2003-10-17 12:30:30 at UTC - 7 h: topocentric zenith angle 50.11162, azimuth 194.34024.
TEST(SunPosition, IsThatOfNrelsExample) {
  const SunPosition sun = sun_at(39.742476, -105.1786, "2003-10-17T19:30:30Z");
  EXPECT_NEAR(sun.elevation_deg, 90 - 50.11162, 0.02);
  EXPECT_NEAR(sun.azimuth_deg, 194.34024, 0.02);
}

// Meeus, example 25.a: 1992 October 13 at 0 h dynamical time, 59 s after universal time: declination
// -7.78507 degrees.
TEST(SunPosition, HasTheDeclinationOfMeeusExample) {
  EXPECT_NEAR(sun_at(0, 0, "1992-10-12T23:59:01Z").declination_deg, -7.78507, 0.0005);
}

// The highest sun of a day: elevation 90 - latitude + declination, due south of northern Europe. At the
// solstices the declination is the obliquity of the ecliptic, 23.436 degrees in 2026.
TEST(SunPosition, CulminatesAtTheColatitudePlusTheDeclination) {
  const auto highest = [](double latitude, const std::string& day) {
    SunPosition best;
    best.elevation_deg = -90;
    for (int minute = 0; minute < 1440; ++minute) {
      char time[32];
      std::snprintf(time, sizeof time, "%sT%02d:%02d:00Z", day.c_str(), minute / 60, minute % 60);
      const SunPosition sun = sun_at(latitude, 11.5, time);
      if (sun.elevation_deg > best.elevation_deg) best = sun;
    }
    return best;
  };
  const SunPosition june = highest(48.1, "2026-06-21"), december = highest(48.1, "2026-12-21");
  EXPECT_NEAR(june.elevation_deg, 90 - 48.1 + 23.436, 0.02);
  EXPECT_NEAR(june.azimuth_deg, 180, 0.4);
  EXPECT_NEAR(december.elevation_deg, 90 - 48.1 - 23.436, 0.06);  // raised by refraction: 0.04
  EXPECT_NEAR(highest(-33.9, "2026-12-21").elevation_deg, 90 - 33.9 + 23.436, 0.02);
  const double azimuth = highest(-33.9, "2026-12-21").azimuth_deg;
  EXPECT_LT(std::min(azimuth, 360 - azimuth), 1);  // due north
}

// The instants of the equinoxes of March, as almanacs give them to the minute: the sun crosses the equator, at
// 0.0165 degrees an hour.
TEST(SunPosition, CrossesTheEquatorAtTheEquinox) {
  for (const char* utc : {"2024-03-20T03:06:00Z", "2025-03-20T09:01:00Z", "2026-03-20T14:46:00Z"})
    EXPECT_NEAR(sun_at(0, 0, utc).declination_deg, 0, 0.004) << utc;
  // That day it rises due east everywhere, and is highest in the north for whom lives in the south.
  const SunPosition rise = sun_at(0, 0, "2026-03-20T06:07:00Z");
  EXPECT_NEAR(rise.azimuth_deg, 90, 0.3);
  EXPECT_NEAR(rise.elevation_deg, 0.3, 0.5);
}

TEST(SkyKeys, TheSunFollowsFromPlaceAndTime) {
  Scenario s;
  s.lights[0].spec.type = LightType::sun;
  s.lights[0].latitude_deg = 39.742476, s.lights[0].longitude_deg = -105.1786;
  s.lights[0].time = "2003-10-17T19:30:30Z";
  s.validate();
  EXPECT_NEAR(resolve_light(s).elevation_deg, 39.888, 0.02);
  // X east, Y north: south-south-west is 194 degrees clockwise of Y.
  EXPECT_NEAR(std::cos((resolve_light(s).azimuth_deg - (90 - 194.34)) * M_PI / 180), 1, 1e-6);
  s.lights[0].north_deg = 0;  // X is north
  EXPECT_NEAR(std::cos((resolve_light(s).azimuth_deg + 194.34) * M_PI / 180), 1, 1e-6);
  s.lights[0].time = "2003-10-17T07:30:30Z";
  EXPECT_EQ(resolve_light(s).elevation_deg, -18);  // deep night
}

template <typename Change>
std::string mistake(Change change) {
  Scenario s;
  change(s.lights[0]);
  return error_of([&] { s.validate(); });
}

TEST(SkyKeys, NameWhatContradicts) {
  EXPECT_EQ(mistake([](LightScenario& l) { l.sky.type = SkyType::overcast; }),
            "light.sky: only the light type `sun` has this sky: expected light.type of \"sun\", or "
            "\"clear\"");
  EXPECT_EQ(mistake([](LightScenario& l) { l.spec.type = LightType::sun, l.latitude_deg = 3; }),
            "light.time: the position of the sun needs place and time: expected light.latitude_deg, "
            "light.longitude_deg and light.time, or none of them");
  const auto at = [](LightScenario& l) {
    l.spec.type = LightType::sun, l.latitude_deg = 3, l.longitude_deg = 4, l.time = "2026-06-21T12:00:00Z";
  };
  EXPECT_EQ(mistake(at), "");
  EXPECT_EQ(mistake([&](LightScenario& l) { at(l), l.time = "noon"; }),
            "light.time: not a date and time in UTC: expected such as \"2026-06-21T12:00:00Z\", from 1900 to "
            "2100, found \"noon\"");
  EXPECT_EQ(mistake([&](LightScenario& l) { at(l), l.random_rotation = true; }),
            "light.random_rotation: place and time give the direction of the sun: expected false");
  EXPECT_EQ(mistake([&](LightScenario& l) { at(l), l.sky.type = SkyType::moonlit; }),
            "light.time: place and time give the sun, not the moon: expected light.elevation_deg and "
            "light.azimuth_deg of the moon");
  EXPECT_EQ(mistake([&](LightScenario& l) { at(l), l.spec.type = LightType::directional; }),
            "light.time: only the sun follows from place and time: expected light.type of \"sun\"");
}

}  // namespace sun_position_test
}  // namespace rubble::testing
