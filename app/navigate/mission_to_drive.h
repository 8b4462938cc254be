// A pile of the navigation benchmark as a mission for `rubble drive`: the crawler stands before the void with its scanner,
// and is driven by whoever listens to its topics (docs/explanation/autonomy.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/navigate/navigation_world.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Unlike in the benchmark, the debris moves.
Scenario make_mission_to_drive(const NavigationWorld& world);

// The waypoints, the last of them the goal, ahead (X) and to the left (Y) of where the robot starts; unit: m.
std::vector<Vec3> waypoints_from_start(const NavigationWorld& world);

// Writes SEED.lua, and SEED.json with the waypoints, into a folder that is there.
void write_mission_to_drive(const std::string& folder, std::uint64_t seed, const NavigationWorld& world, bool packs);

}  // namespace rubble
