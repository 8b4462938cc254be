// The text format of bench/workloads, read into a Pile.
#pragma once

#include <cstdint>
#include <string>

#include "kernel/model/pile.h"

namespace rubble {

inline constexpr double kWorkloadDensity = 2300;  // unit: kg/m3
inline constexpr double kWorkloadFriction = 0.6;

// Throws InputError with file and line at the first mistake, RunError when reading fails.
Pile load_workload(const std::string& path);
// The same from text; `name` stands for the file in errors.
Pile parse_workload(const std::string& text, const std::string& name);

// Draws the orientation of every piece anew, about its origin. Bounding spheres about the origins
// stay where they are, so a layer that was free of overlaps stays so.
void turn_pieces(Pile& pile, std::uint64_t seed);

}  // namespace rubble
