#include "kernel/base/number_text.h"
#include "scripting/scenario/part_schemas.h"

#include <algorithm>
#include <cmath>

#include "scripting/sky/sun_position.h"
#include "scripting/values/value.h"

namespace rubble {

void add_sky_keys(Schema& k, LightScenario& l) {
  k.choice("light.sky", l.sky.type, {"clear", "hazy", "cloudy", "overcast", "moonlit", "city_night",
            "cie_clear"},
           "Sky of the light type `sun` (docs/explanation/sky.md). `hazy`: visibility of 9 km. `cloudy`: broken "
           "clouds from the seed, which may hide the sun. `overcast`: CIE standard overcast sky, no sun. `moonlit`: "
           "the full moon instead of the sun. `city_night`: the glow of a town, no sun or moon. `cie_clear`: CIE "
           "standard clear sky.");
  k.value("light.cloud_cover", l.sky.cloud_cover, "Sky `cloudy`: share of the sky that is cloud.")
      .between(0, 1);
  k.value("light.latitude_deg", l.latitude_deg,
          "Latitude (north is positive). With `longitude_deg` and `time`, it places the sun instead of "
          "`elevation_deg` and `azimuth_deg`.")
      .between(-90, 90)
      .unit("degree");
  k.value("light.longitude_deg", l.longitude_deg, "Longitude; east is positive.")
      .between(-180, 180)
      .unit("degree");
  k.value("light.time", l.time,
          "Date and time in UTC, from 1900 to 2100, such as \"2026-06-21T12:00:00Z\".");
  k.value("light.north_deg", l.north_deg,
          "Direction of north, from X towards Y; 90: X is east and Y is north.")
      .between(-360, 360)
      .unit("degree");
}

void check_sky(const LightScenario& l, std::vector<Diagnostic>& mistakes) {
  const auto add = [&](const char* key, const char* message, const char* expected, std::string found = "") {
    mistakes.push_back({"", 0, key, message, expected, std::move(found), ""});
  };
  if (l.sky.type != SkyType::clear && l.spec.type != LightType::sun)
    add("light.sky", "only the light type `sun` has this sky", "light.type of \"sun\", or \"clear\"");
  const bool by_time = l.latitude_deg || l.longitude_deg || l.time;
  if (!by_time) return;
  if (!l.latitude_deg || !l.longitude_deg || !l.time)
    add("light.time", "the position of the sun needs place and time",
        "light.latitude_deg, light.longitude_deg and light.time, or none of them");
  if (l.spec.type != LightType::sun)
    add("light.time", "only the sun follows from place and time", "light.type of \"sun\"");
  if (l.random_rotation)
    add("light.random_rotation", "place and time give the direction of the sun", "false");
  if (l.sky.type == SkyType::moonlit)
    add("light.time", "place and time give the sun, not the moon",
        "light.elevation_deg and light.azimuth_deg of the moon");
  if (l.time && !parse_utc(*l.time))
    add("light.time", "not a date and time in UTC", "such as \"2026-06-21T12:00:00Z\", from 1900 to 2100",
        "\"" + *l.time + "\"");
}

void place_sun(const LightScenario& l, LightSpec& spec) {
  if (!l.latitude_deg || !l.longitude_deg || !l.time) return;
  const auto utc = parse_utc(*l.time);
  if (!utc) return;  // check_sky() has said so
  constexpr double kNight = -18;  // degrees; lower, nothing changes
  const SunPosition sun = find_sun(*l.latitude_deg, *l.longitude_deg, *utc);
  spec.elevation_deg = std::max(kNight, sun.elevation_deg);
  spec.azimuth_deg = l.north_deg - sun.azimuth_deg;
}

void add_surroundings_keys(Schema& k, SurroundingsSpec& s) {
  k.group("surroundings", "Surroundings of the pile, as true geometry (docs/explanation/surroundings.md).");
  k.choice("surroundings.type", s.type, {"none", "street"},
           "`street`: a street with neighbouring buildings, trees, fences, parked vehicles, street lamps, uneven "
           "ground and a skyline. `none`: a plain.");
  k.value("surroundings.clearance", s.clearance, "Free distance outside the circle around all pieces.").between(0.5, 200).unit("m");
  k.value("surroundings.reach", s.reach, "Distance from the pile up to which the street has details.").between(40, 400).unit("m");
  k.value("surroundings.turn_deg", s.turn_deg, "Direction of the street, from the X axis towards Y.")
      .between(-360, 360)
      .unit("degree");
  k.value("surroundings.storeys", s.storeys, "Storeys of the buildings: {fewest, most}.").between(1, 12);
  k.value("surroundings.trees", s.trees, "Share of the tree places with a tree.").between(0, 1);
  k.value("surroundings.vehicles", s.vehicles, "Share of the parking places with a vehicle.").between(0, 1);
  k.choice("surroundings.lamps", s.lamps, {"auto", "on", "off"},
           "Street lamps. `auto`: on with a night sky, or with the sun below the horizon.");
  k.value("surroundings.lit_windows", s.lit_windows, "Share of lit windows while street lamps are on.")
      .between(0, 1);
}

void check_surroundings(const Scenario& scenario, std::vector<Diagnostic>& mistakes) {
  const SurroundingsSpec& s = scenario.surroundings;
  for (const double storeys : s.storeys)
    if (storeys != std::floor(storeys))
      mistakes.push_back({"", 0, "surroundings.storeys", "not a number of storeys", "whole numbers",
                          exact_text(storeys), ""});
  if (s.on() && scenario.pile.terrain.given())
    mistakes.push_back({"", 0, "surroundings.type", "the surroundings have their own ground",
                        "a mission without pile.terrain, or \"none\"", "both", ""});
}

}  // namespace rubble
