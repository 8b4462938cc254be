// An asset made of another material than its pack says: the same shape, another weight and look.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scripting/packs/asset_pack.h"

namespace rubble {

// "chunk_1 of brick": the variant's name, which is its type's.
std::string variant_name(const std::string& asset, const std::string& material);

// Whether an asset is such a variant.
bool is_variant(const Asset& asset);

// Density and friction are the material's, whatever the pack says of this asset. Surfaces that look
// like the asset's own material look like the new one, broken faces like its breaks; others (bars,
// fittings) stay. The asset has a mesh.
Asset make_variant(const Asset& asset, const Material& material);

// The asset itself, or its variant, that goes by this name; none: neither does.
std::optional<Asset> find_variant(const Asset& asset, const std::string& name,
                                  const std::vector<Material>& materials);

}  // namespace rubble
