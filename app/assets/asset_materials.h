// Materials and looks of assets: variants made of another material, and which surfaces keep the colours of their file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/mesh.h"
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

// The look of a surface of this name; empty: it keeps its paint. paint: null: it has none.
using ChooseLook = std::function<std::string(const std::string& surface, const SurfacePaint* paint)>;

// Surfaces that keep their paint get a name of their own: "wood_1a2b3c4d".
void choose_surfaces(TriangleMesh& mesh, const ChooseLook& choose);

bool has_paint(const TriangleMesh& mesh);

// Whether a surface whose name is a look keeps its paint all the same: an image is meant, while programs write some
// plain colour for every material.
inline bool outdoes_name(const SurfacePaint* paint) { return paint && paint->albedo.side > 0; }

}  // namespace rubble
