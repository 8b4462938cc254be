// The stage from a settled pile to one with its fines: what is strewn, and the file that keeps it.
#pragma once

#include <cstdint>
#include <string>

#include "app/assets/asset_library.h"
#include "kernel/model/pile_state.h"

namespace rubble {

inline constexpr const char* kFinesFile = "fines.bin";

// Strews what is asked for; nothing where that is none. Follows from spec, seed, assets and pile alone.
// Returns a warning where there is no room for all of it; empty: none.
std::string lay_fines(const FinesSpec& spec, std::uint64_t seed, const AssetLibrary& assets, int threads, PileState& pile);

// Of what fines are made from, for a stage that goes on from a file; `pile`: the same of the pile. The same as
// `pile` without fines.
std::uint64_t hash_fines_work(const FinesSpec& spec, std::uint64_t seed, std::uint64_t pile);

// FOLDER/fines.bin, where a mission has fines.
void save_fines_of(const FinesSpec& spec, const PileState& pile, const std::string& folder);
void load_fines_of(const FinesSpec& spec, const std::string& folder, PileState& pile);

}  // namespace rubble
