// What stands about a settled pile: how it is made, drawn, labelled, lit and exported.
#pragma once

#include "app/assets/asset_library.h"
#include "app/formats/class_labels.h"
#include "io/mesh/pile_model.h"
#include "io/recording/recording.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// Whether street lamps shine by themselves: at night, and when the sun is below the horizon.
bool is_dark(const Scenario& scenario);

// Puts what the scenario asks for about the pile; nothing where it asks for none. Follows from scenario, assets and
// pile alone.
void lay_surroundings(const Scenario& scenario, const AssetLibrary& assets, PileState& pile);

// Puts the things at the end of the instances, each with the number kFirstSurrounding and its index.
void add_surroundings(const ClassLabels& labels, const PileState& pile, Scene& scene);
// The street lamps, where they are lit: as many of the nearest as there is room for among the lights, which throw
// sharp shadows, the others as far lights. Call it when the scene has the lights of the mission.
// reserved: lights that come later.
void add_street_lamps(const PileState& pile, std::size_t reserved, Scene& scene);
// Likewise at the end of types and pieces, which stay those of the pile.
void add_surroundings(const PileState& pile, PileModel& model);
void add_surroundings(const ClassLabels& labels, const PileState& pile, Legend& legend);

}  // namespace rubble
