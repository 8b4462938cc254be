// From what settled to what is drawn and exported.
#pragma once

#include <string>
#include <vector>

#include "app/assets/asset_library.h"
#include "io/mesh/pile_model.h"
#include "kernel/model/pile_state.h"
#include "render/scene/scene.h"
#include "render/sensors/flight.h"
#include "scripting/scenario/scenario.h"

namespace rubble {

// What the scenario asks to be dropped, in the library's terms.
PileSpec build_pile_spec(const Scenario& scenario, const AssetLibrary& assets);

// Every piece but the lost ones, with the scenario's light, lamp and air.
Scene build_scene(const Scenario& scenario, const AssetLibrary& assets, const PileState& pile);

// A camera of the mission (all_cameras), with what is in its place.
CameraSpec build_camera(const Scenario& scenario, const MountedCamera& camera, int threads);

// The legend of the stream `label`: the name of each class, by its number.
std::vector<std::string> label_names(const AssetLibrary& assets);

// The same pieces at full detail, with names and plain colours, for the exports. Refers to `assets`.
PileModel build_pile_model(const AssetLibrary& assets, const PileState& pile);

// Where that camera is, at its own rate, along the scenario's trajectory, whose places are resolved:
// app/planning/flight.h.
Flight build_flight(const Scenario& scenario, const MountedCamera& camera);

}  // namespace rubble
