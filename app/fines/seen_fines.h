// Fines as what is drawn, labelled and exported.
#pragma once

#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "io/mesh/pile_model.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// The class of a kind in the stream `label`: after those of all types, and of robots where the mission has them.
std::uint16_t fine_label(const Scenario& scenario, const AssetLibrary& assets, FineKind kind);

// Puts the heaps at the end of the instances, each with the number kFirstFineHeap and its index.
void add_fines(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile, Scene& scene);
// Likewise at the end of types and pieces; the model keeps their meshes.
void add_fines(const PileState& pile, PileModel& model);
void add_fines(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile, Legend& legend);

// The piece that carries a heap, by its instance number; -1: the ground, or no heap. hosts: of all heaps.
std::vector<int> find_heap_hosts(const PileState& pile);

}  // namespace rubble
