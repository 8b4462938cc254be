// A finished run, read back: its manifest, its assets and its settled pile.
//
//   const FinishedRun saved = open_finished_run("out/first_pile");
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

struct FinishedRun {
  std::string folder;  // as it was given
  Manifest manifest;   // read and found sealed
};

// manifest.json. Throws InputError: it cannot be read, or is not sealed, saying which part was altered.
Manifest load_manifest(const std::string& path);

// Throws InputError: no such folder, unfinished (saying how to go on), no manifest, or an altered
// one.
FinishedRun open_finished_run(const std::string& folder);

// Found by content, in `folders`, where they were, or among the bundled packs.
AssetLibrary load_assets_of(const FinishedRun& saved, const std::vector<std::string>& folders);

// pile.bin, and fines.bin where the mission has fines. Throws InputError when it is missing, damaged, or not the pile of the manifest.
PileState load_pile_of(const FinishedRun& saved);
// The same with what stands about it, where the mission has surroundings. assets: those of the run.
PileState load_pile_of(const FinishedRun& saved, const AssetLibrary& assets);

}  // namespace rubble
