// A finished run, read back: its manifest, its assets and its settled pile.
//
//   const SavedRun saved = open_saved_run("out/first_pile");
//   const AssetLibrary assets = load_assets_of(saved, {});
//   const PileState pile = load_pile_of(saved);
//   export_pile(build_pile_model(assets, pile), "stl", ".");
#pragma once

#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "app/provenance/manifest.h"
#include "kernel/model/pile_state.h"

namespace rubble {

struct SavedRun {
  std::string folder;
  Manifest manifest;
};

// Throws InputError: no such folder, unfinished (saying how to go on), no manifest, or an altered
// one.
SavedRun open_saved_run(const std::string& folder);

// Found by content, in `folders`, where they were, or among the bundled packs.
AssetLibrary load_assets_of(const SavedRun& saved, const std::vector<std::string>& folders);

// pile.bin. Throws InputError when it is missing, damaged, or not the pile of the manifest.
PileState load_pile_of(const SavedRun& saved);

}  // namespace rubble
