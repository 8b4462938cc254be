// How much room a run will take, before it is begun.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "app/assets/asset_library.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Each file or folder that the run will leave, by the name that the manifest has, and how large it
// gets at most; unit: byte. Nothing is counted as compressed: what is written as it is (bag, MCAP,
// rawlog, meshes) takes between a fifth of it and all, pictures in PNG and EXR files and a
// trajectory's plan less. Changes of brightness, of an event camera, are counted as one for every
// second pixel of a frame.
std::map<std::string, std::uint64_t> estimate_outputs(const Scenario& scenario,
                                                      const AssetLibrary& assets);

// All of them, or those that a run leaves which renders nothing (`pile_only`).
std::map<std::string, std::uint64_t> estimate_files(const Scenario& scenario,
                                                    const AssetLibrary& assets, bool pile_only);
// The sum of these.
std::uint64_t estimate_bytes(const Scenario& scenario, const AssetLibrary& assets,
                             bool pile_only = false);

// Pieces of the mission's building and of what furnishes it, at most; 0 where there is none.
double count_building_pieces(const PileScenario& pile, const AssetLibrary& assets);

// Of all files in a folder; 0 when it is not there.
std::uint64_t count_bytes(const std::string& folder);
// Of the file system that the folder is on, for a user without privileges.
std::uint64_t free_bytes(const std::string& folder);

std::string format_bytes(std::uint64_t bytes);  // "3.4 GB"; 1 GB is 10^9

}  // namespace rubble
