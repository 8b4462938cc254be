// Where in the voids of a pile people may lie, by how hard it is to get there.
#pragma once

#include <vector>

#include "kernel/voids/void_map.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// How the voids are looked at where victims are concerned, for a robot of that radius.
VoidSpaceOptions victim_space_options(double radius);

struct VictimPlace {
  Vec3 position;      // of the centre of a robot that fits there; unit: m
  double way_in = 0;  // to there from the nearest entrance; unit: m
};

// Places of the first robot of the map in voids that have an entrance, at least kLeastWayIn from it: the
// nearest, the middle or the farthest third of them, ordered by their ways in.
inline constexpr double kLeastWayIn = 0.3;  // unit: m
std::vector<VictimPlace> find_victim_places(const VoidMap& map, VictimDifficulty difficulty);

}  // namespace rubble
