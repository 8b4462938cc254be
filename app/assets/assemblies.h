// Articulated assets: from the records of a pack to the kernel's assemblies.
#pragma once

#include "app/assets/asset_library.h"
#include "scripting/packs/asset_pack.h"

namespace rubble {

// The types of the links must have been loaded.
AssemblyType make_assembly(const Asset& asset, const AssetLibrary& library);

// Over the joints, the places of the links and the content of their pieces.
std::string hash_content(const Asset& asset, const AssemblyType& assembly,
                         const AssetLibrary& library);

}  // namespace rubble
