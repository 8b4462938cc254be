// The robots of a run for the page that shows it: their links, and where these were.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace rubble {

// Of robots/robots.json, robots/track.bin and what is beside them; an empty list where the run has no robots. Each robot
// has a name, the way of its first link, and links with a mesh and a pose for each of the stamps (seconds).
// Throws InputError for files that are not sound.
nlohmann::ordered_json describe_robots_of(const std::string& folder);

}  // namespace rubble
