// What an asset library is filled with, one asset at a time.
#pragma once

#include <string>
#include <vector>

#include "app/assets/asset_library.h"

namespace rubble {

struct FoundAsset {
  const AssetPack* pack;  // that it is of; never null
  const Asset* asset;     // in that pack; never null
};

// An articulated asset needs its pieces in the library. Throws InputError for a file that cannot be
// read.
void add_asset(const FoundAsset& found, AssetLibrary& library);

void add_box(const PlacedItem& item, const std::vector<Material>& materials, AssetLibrary& library);

// Nothing where the specification gives none. folders: where its file is looked for.
void add_terrain(const TerrainScenario& spec, const std::vector<std::string>& folders,
                 AssetLibrary& library);

// What layers are drawn from: the mission's mix, or every asset by its own weight.
std::vector<MixEntry> make_mix(const PileScenario& pile, const std::vector<FoundAsset>& all,
                               const AssetLibrary& library);

}  // namespace rubble
