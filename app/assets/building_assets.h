// The pieces of a mission's building as assets: what they collide with, and how they look.
#pragma once

#include "app/assets/asset_library.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// The pack that a provenance names for them.
inline constexpr const char* kBuildingPack = "building of the mission";

// The building of a pile, cut by this seed.
BuildingSpec building_of(const PileScenario& pile, std::uint64_t seed);

// Adds every type of its pieces in their order, and notes the first; nothing where there is no building.
// Throws InputError naming keys that contradict each other, and where the library's terrain, which lies at
// `terrain_position`, reaches into a member as built: a building stands on the ground z = 0.
void add_building(const BuildingSpec& building, const Vec3& terrain_position, AssetLibrary& library);

}  // namespace rubble
