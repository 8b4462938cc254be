// Links of articulated assets: from what a pack says to what the kernel takes.
#pragma once

#include "scripting/packs/asset_pack.h"
#include "scripting/packs/pack_schema.h"

namespace rubble {

// Angles in radians, the joint's frame from its axis; which link it hangs on is left open.
AssetLink make_asset_link(const LinkTable& table);

}  // namespace rubble
