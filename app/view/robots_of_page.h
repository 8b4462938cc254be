// The robots of a run for the page that shows it: their links, and where these were.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rubble {

// Of robots/robots.json, robots/track.bin and the meshes beside them; an empty list where the run has no robots. Each robot
// has a name, the way of its first link, and links with a mesh and a pose for each of the stamps (seconds).
// start_ns: the stamp of the track's time 0. Throws InputError for files that are not sound.
nlohmann::ordered_json describe_robots_of(const std::string& folder, std::int64_t start_ns);

}  // namespace rubble
