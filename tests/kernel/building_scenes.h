// A small building for tests, and the pile of any building.
#pragma once

#include "kernel/model/pile.h"
#include "kernel/settling/building_collapse.h"

namespace rubble::testing {

// One bay of 4 m and two storeys, without walls.
inline BuildingSpec small_building() {
  BuildingSpec b;
  b.storeys = 2;
  b.bays_x = b.bays_y = 1;
  b.span_x = b.span_y = 4;
  b.column = 0.3;
  b.beam_depth = 0.35;
  b.slab = 0.15;
  b.infill = Infill::none;
  b.piece = 1.3;
  b.seed = 4;
  return b;
}

inline Pile pile_of(const BuildingSpec& building) {
  Pile pile;
  pile.building = building;
  pile.types = make_building_types(building);
  return pile;
}

}  // namespace rubble::testing
