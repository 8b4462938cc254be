// From what settled to what is drawn and exported.
#pragma once

#include <cstdint>

#include "app/assets/asset_library.h"
#include "app/formats/class_labels.h"
#include "io/mesh/pile_model.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// What a mission asks to be dropped, in the library's terms.
PileSpec build_pile_spec(const PileScenario& pile, std::uint64_t seed, const AssetLibrary& assets);

// number: of the piece in its pile.
SceneInstance make_instance(const ClassLabels& labels, const PieceState& piece, std::size_t number);

// Pieces of one member of a building look like one body: sets where each was cut from.
void set_building_cuts(const AssetLibrary& assets, const PileState& pile, Scene& scene);

// Every piece but the lost ones, the fines and what stands about the pile, with the scenario's light, lamp and air.
Scene build_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile);

// The same at full detail, with names and plain colours, for the exports. Refers to `assets`.
PileModel build_pile_model(const AssetLibrary& assets, const PileState& pile);
// With the pieces that were lost, which a track has, and without fines, which come when all rests.
PileModel build_track_model(const AssetLibrary& assets, const PileState& pile);

}  // namespace rubble
