// What is said of a map: figures, and files to look at.
#pragma once

#include <string>
#include <vector>

#include "app/eval/map/carved_space.h"
#include "app/eval/map/map_score.h"
#include "app/eval/scores/score_table.h"
#include "kernel/voids/void_map.h"

namespace rubble {

// Everything that was found out about a map.
struct MapFindings {
  PlyMesh map;                   // in the world
  std::vector<Vec3> samples;     // of it
  SeenPoints seen;               // what the camera could have mapped
  MapAccuracy accuracy;          // how far the map's points are from the true surface
  MapCompleteness completeness;  // how much of the seen surface the map has
  // By the map, and by the seen surface itself in its place: what the best map could have found.
  struct Voids {
    double volume = 0;               // of all voids that is known; unit: m3
    std::vector<FoundVoids> robots;  // as VoidMap::robots
  };
  Voids found, best;  // by the map; by the seen surface
};

// The row of the table; per radius some cells whose keys end in its millimetres, as in _r100.
ScoreRow make_map_row(const std::string& name, const MapFindings& findings, const VoidMap& voids);

// The entrances of all voids, a line each, for people.
std::string entrance_text(const MapFindings& findings, const VoidMap& voids);

// Writes, in a folder that is there:
//   NAME_map.ply        the map's points, red where they are 5 cm or more off, with their `distance`
//   NAME_seen.ply       the seen surface, green where the map has it within 5 cm, red where not
//   NAME_entrances.csv  radius, rank of the void, place, direction, clear radius, best, found
// Throws RunError.
void write_map_details(const std::string& folder, const std::string& name,
                       const MapFindings& findings, const VoidMap& voids);

}  // namespace rubble
