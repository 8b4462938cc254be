// A building as members: columns and the blocks where beams meet them, beams, slabs, walls with windows.
#pragma once

#include <vector>

#include "kernel/model/building.h"
#include "kernel/structure/structure.h"

namespace rubble {

// Throws InputError naming each key of the building that is out of range.
void validate(const BuildingSpec& building);

// Whether a member is the column (i, j) of the ground storey.
bool is_ground_column(const Member& member, int i, int j);

// The building as it stands before its cause.
Structure build_building(const BuildingSpec& building);
// The same with its cause's removed columns taken out, weak columns weakened and an overload added to its
// floor. Types keep their numbers, except that an overloaded floor has types of its own after them.
Structure build_damaged(const BuildingSpec& building, const Structure& whole);

}  // namespace rubble
