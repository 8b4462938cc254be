#include "scripting/scenario/surroundings_schema.h"

#include <cmath>

#include "scripting/values/value.h"

namespace rubble {

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
                          format_number(storeys), ""});
  if (s.on() && scenario.pile.terrain.given())
    mistakes.push_back({"", 0, "surroundings.type", "the surroundings have their own ground",
                        "a mission without pile.terrain, or \"none\"", "both", ""});
}

}  // namespace rubble
