// Floors and lintels that several kinds of building have.
#pragma once

#include <string>
#include <vector>

#include "kernel/structure/buildings/parts.h"

namespace rubble {

inline constexpr double kLintel = 0.2;       // depth of a lintel of reinforced concrete; unit: m
inline constexpr double kBoards = 0.04;      // thickness of the boards of timber floors; unit: m
inline constexpr double kLintelBears = 0.2;  // on either side of its opening; unit: m

BuildingPart make_lintel(const std::string& name, int storey, const Aabb& box);

// Joists across the shorter side of a room, which enter the walls by `bearing`, and boards on them whose upper
// side is the room's top.
void add_timber_floor(const BuildingSpec& building, const Aabb& room, double bearing, const std::string& name,
                      int storey, const std::string& plan_part, std::vector<BuildingPart>& parts);

}  // namespace rubble
