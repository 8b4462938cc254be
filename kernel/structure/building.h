// A building of any kind as members: the undamaged building, and the building after its cause.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/building.h"
#include "kernel/structure/structure.h"

namespace rubble {

// Throws InputError naming each key of the building that is out of range.
void validate(const BuildingSpec& building);

// Whether a member belongs to the column (i, j) of the ground storey, or to that part of a plan.
bool is_ground_column(const Member& member, int i, int j, const std::string& part = "");

// The building as it stands before its cause: as boxes, and cut into pieces.
std::vector<Member> list_members(const BuildingSpec& building);
Structure build_building(const BuildingSpec& building);
// The same with its cause's removed columns taken out, weak columns weakened and an overload added to its
// floor. Types keep their numbers, except that an overloaded floor has types of its own after them.
Structure build_damaged(const BuildingSpec& building, const Structure& whole);
// Both. Throws InputError for keys out of range.
struct BuildingStructures {
  Structure whole, damaged;  // a pile has the pieces of `damaged`, in their order
};
BuildingStructures build_structures(const BuildingSpec& building);

// The terrain under a building.
// A building stands on the ground z = 0. Throws InputError, with the place, where the terrain, whose mesh lies at
// `position` (m), reaches more than 1 mm into a member of the building or covers one.
void check_site(const Structure& building, const TriangleMesh& terrain, const Vec3& position);

}  // namespace rubble
