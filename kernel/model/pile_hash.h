// Fingerprints of a pile's description, so that what was saved for one is not used with another.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/model/pile.h"

namespace rubble {

// XXH64 over everything that the physics of types and assemblies depends on; their names are left out.
std::uint64_t hash_types(const std::vector<PieceType>& types,
                         const std::vector<AssemblyType>& assemblies = {});
// The same over the whole pile: types, what stands already, and the layers.
std::uint64_t hash_pile(const Pile& pile);

}  // namespace rubble
