// manifest.json: everything needed to reproduce a dataset and to check that it was.
//
// Stable keys that other programs read: "state_hash" (16 hexadecimal digits) and "outputs" (file
// name to SHA-256). All but "not_reproducible" is the same for the same input.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "app/asset_library.h"
#include "kernel/pile_state.h"
#include "scripting/mission.h"

namespace rubble {

struct ManifestContents {
  const Mission* mission = nullptr;
  const AssetLibrary* assets = nullptr;
  const PileState* pile = nullptr;
  int frames = 0;
  std::map<std::string, std::string> outputs;       // file name to SHA-256
  std::map<std::string, double> wall_seconds;       // a stage's name to its time
  std::map<std::string, std::string> environment;   // what this machine drew with, and the like
};

// The manifest as indented JSON, ending in a line feed.
std::string make_manifest(const ManifestContents& contents);

}  // namespace rubble
