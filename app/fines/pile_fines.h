// Fines of a settled pile: the stage that strews them, the file that keeps them, and how they are drawn, labelled and
// exported.
#pragma once

#include <cstdint>
#include <string>

#include "app/assets/asset_library.h"
#include "app/formats/class_labels.h"
#include "io/mesh/pile_model.h"
#include "io/recording/recording.h"
#include "kernel/fines/strew_fines.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"

namespace rubble {

inline constexpr const char* kFinesFile = "fines.bin";

// Strews what is asked for; nothing where that is none. Follows from spec, seed, assets and pile alone.
// Returns a warning where there is no room for all of it; empty: none. progress: as in StrewOptions.
std::string lay_fines(const FinesSpec& spec, std::uint64_t seed, const AssetLibrary& assets, int threads, PileState& pile,
                      const FinesProgress& progress = {});

// Of what fines are made from, for a stage that goes on from a file; `pile`: the same of the pile. The same as
// `pile` without fines.
std::uint64_t hash_fines_work(const FinesSpec& spec, std::uint64_t seed, std::uint64_t pile);

// FOLDER/fines.bin, where a mission has fines.
void save_fines_of(const FinesSpec& spec, const PileState& pile, const std::string& folder);
void load_fines_of(const FinesSpec& spec, const std::string& folder, PileState& pile);

// Puts the heaps at the end of the instances, each with the number kFirstFineHeap and its index.
void add_fines(const ClassLabels& labels, const PileState& pile, Scene& scene);
// Likewise at the end of types and pieces; the model keeps their meshes.
void add_fines(const PileState& pile, PileModel& model);
void add_fines(const ClassLabels& labels, const PileState& pile, Legend& legend);

}  // namespace rubble
