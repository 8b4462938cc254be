// For formats that hold a single camera: of several, each gets a recorder of its own.
#pragma once

#include <memory>

#include "io/recording/recorder.h"

namespace rubble {

// Passes on the frames of that camera, and the readings of all inertial units.
std::unique_ptr<Recorder> make_one_camera_recorder(int camera, std::unique_ptr<Recorder> recorder);

}  // namespace rubble
