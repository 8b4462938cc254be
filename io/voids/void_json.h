// voids.json: the voids of a pile, their entrances, and the graph of chambers and throats.
#pragma once

#include <string>

#include "kernel/voids/void_map.h"

namespace rubble {

// Indented JSON, ending in a line feed; lengths in metres, volumes in m3, world frame; stable keys,
// described in docs/explanation/voids.md. Numbers are rounded to 0.1 mm (positions, radii) or 1e-6 m3.
std::string make_void_json(const VoidMap& map);

}  // namespace rubble
