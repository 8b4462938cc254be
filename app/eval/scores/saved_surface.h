// The true surface of the pile of a finished run.
#pragma once

#include <string>
#include <vector>

#include "app/mission/finished_run.h"
#include "app/planning/pile_survey.h"

namespace rubble {

// Everything that the queries refer to stays with them.
struct SavedSurface {
  // Throws InputError as open_finished_run and load_assets_of.
  SavedSurface(const std::string& folder, const std::vector<std::string>& asset_packs)
      : saved(open_finished_run(folder)),
        assets(load_assets_of(saved, asset_packs)),
        pile(load_pile_of(saved, assets)),
        geometry(assets, pile) {}
  SavedSurface(const SavedSurface&) = delete;
  SavedSurface& operator=(const SavedSurface&) = delete;

  FinishedRun saved;      // its folder and manifest
  AssetLibrary assets;    // that its pile is made of
  PileState pile;         // settled, with what stands about it
  PileGeometry geometry;  // exact, of both
};

}  // namespace rubble
