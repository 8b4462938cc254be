// The parts of the module, one source each. Internal to python/.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>

#include "app/mission/resolved_mission.h"
#include "kernel/model/pile_state.h"
#include "render/scene/frame.h"
#include "render/scene/scene.h"

namespace rubble::python {

// A settled pile with what it was made of.
struct SettledMission {
  ResolvedMission mission;
  PileState state;
};
// Never changed once it is made; not const, as pybind11 keeps it.
using SharedPile = std::shared_ptr<SettledMission>;

// Options of all that the module runs: no progress is printed.
RunOptions quiet(int threads);

void add_errors(pybind11::module_& module);
void add_pile(pybind11::module_& module);
void add_sensors(pybind11::module_& module);
void add_range_scans(pybind11::module_& module);
void add_geometry(pybind11::module_& module);
void add_random(pybind11::module_& module);
void add_explorer(pybind11::module_& module);

Scene scene_of(const SettledMission& settled);
// A flat camera, checked. shift_x, shift_y: of its principal point from the middle, to the right and downwards, at most half
// a side; unit: pixel. Throws InputError.
Intrinsics pinhole(int width, int height, double fov_deg, double shift_x = 0, double shift_y = 0);
pybind11::array_t<double> camera_matrix(const Intrinsics& k);  // K, 3 by 3
void add_sessions(pybind11::module_& module);
void add_recordings(pybind11::module_& module);

}  // namespace rubble::python
