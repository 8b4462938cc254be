// Metadata of Ouster's LiDARs, as keys of a `lidar`.
#pragma once

#include <string>
#include <vector>

#include "scripting/values/value.h"

namespace rubble {

struct OusterMetadata {
  Value keys;                      // model, columns, rate and the sensor's own beams
  std::vector<std::string> notes;  // what is left out
  std::string kind;                // of the sensor: "lidar"
};

// Keys at the top of the file (firmware 1 and 2), or in sections such as `beam_intrinsics` (firmware 3). Throws
// InputError with `path` and the key.
OusterMetadata read_ouster_metadata(const Value& root, const std::string& path);

}  // namespace rubble
