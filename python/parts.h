// The parts of the module, one source each. Internal to python/.
#pragma once

#include <memory>

#include "app/mission/resolved_mission.h"
#include "kernel/model/pile_state.h"
#include "python/arrays.h"
#include "render/scene/frame.h"
#include "render/scene/range_scan.h"
#include "render/scene/scene.h"

namespace rubble::python {

// A settled pile with what it was made of.
struct SettledMission {
  ResolvedMission mission;
  PileState state;
};
// Never changed once it is made; not const, as nanobind keeps it.
using SharedPile = std::shared_ptr<SettledMission>;

// Options of all that the module runs: no progress is printed.
RunOptions quiet(int threads);

// A structured array: a field for each of a point's.
nb::object to_structured(std::vector<ScanPoint>&& points);

void add_errors(nb::module_& module);
void add_pile(nb::module_& module);
void add_sensors(nb::module_& module);
void add_range_scans(nb::module_& module);
void add_geometry(nb::module_& module);
void add_random(nb::module_& module);
void add_explorer(nb::module_& module);

Scene scene_of(const SettledMission& settled);
// A flat camera, checked. shift_x, shift_y: of its principal point from the middle, to the right and downwards, at most half
// a side; unit: pixel. Throws InputError.
Intrinsics pinhole(int width, int height, double fov_deg, double shift_x = 0, double shift_y = 0);
Array<double> camera_matrix(const Intrinsics& k);  // K, 3 by 3
void add_sessions(nb::module_& module);
void add_recordings(nb::module_& module);
void add_episodes(nb::module_& module);

}  // namespace rubble::python
