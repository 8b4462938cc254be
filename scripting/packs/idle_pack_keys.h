// Keys of a pack.lua that nothing reads: the density of an asset that is made of others, say. They are allowed, and hardly meant.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "scripting/packs/pack_schema.h"

namespace rubble {

// stated: whole paths, as in "assets[1].links[2].travel". Diagnostics without file and line, in that order.
std::vector<Diagnostic> find_idle_pack_keys(const PackTable& pack, const std::vector<std::string>& stated);

}  // namespace rubble
