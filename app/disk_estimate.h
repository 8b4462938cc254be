// How much room a run will take, before it is begun.
#pragma once

#include <cstdint>
#include <string>

#include "app/asset_library.h"
#include "scripting/scenario.h"

namespace rubble {

// unit: byte. Nothing is counted as compressed, so a run takes this much at most, or a few per cent
// more for what formats add; usually it is half.
std::uint64_t estimate_bytes(const Scenario& scenario, const AssetLibrary& assets);

// Of all files in a folder; 0 when it is not there.
std::uint64_t count_bytes(const std::string& folder);
// Of the file system that the folder is on, for a user without privileges.
std::uint64_t free_bytes(const std::string& folder);

std::string format_bytes(std::uint64_t bytes);  // "3.4 GB"; 1 GB is 10^9

}  // namespace rubble
