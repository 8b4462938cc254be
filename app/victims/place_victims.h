// People in the voids of a settled pile: figures of the pack `victims` that are let fall into places where
// they fit, and come to rest on what lies there.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"
#include "kernel/queries/queries.h"
#include "kernel/voids/void_map.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Where in the voids of a pile people may lie, by how hard it is to get there.

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

// Puts them at the end of the pile's pieces. Each is near to where a robot of `victims.radius` gets from
// outside, which sees its trunk or head from there; so it is once all of them lie there. The pile itself
// does not move. Follows from pile, victims and seed alone. Throws InputError, keyed victims.count, when
// the voids have no room for all.
void place_victims(const VictimScenario& victims, std::uint64_t seed, double gravity, const AssetLibrary& assets,
                   int threads, PileState& pile);

struct Victim {
  int piece = 0;      // index into PileState::pieces
  std::string asset;  // "victim_supine"
  Vec3 trunk, head;   // their middles, in the world; unit: m
};
// The figures of the pack `victims` in a pile: those that place_victims() put there, and those of the mission.
std::vector<Victim> find_victims(const PileState& pile);

// How near a robot comes to a trunk to tell that somebody lies there; unit: m.
inline constexpr double kVictimNear = 1.0;
// Whether trunk or head are seen from a place that near.
bool sees_victim(const PileQueries& queries, const Vec3& place, const Victim& victim);

// What stands for the last `count` pieces among the layers of a pile, for World::lay().
void list_victims(const PileState& state, int count, Pile& pile);

// victims.json: where they lie.
std::string describe_victims(const std::vector<Victim>& victims);

}  // namespace rubble
