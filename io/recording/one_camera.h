// For formats that hold a single camera: of several, each gets a recorder of its own.
#pragma once

#include <memory>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Passes on the frames of that camera, and the readings of one inertial unit beside it (negative: of none).
std::unique_ptr<Recorder> make_one_camera_recorder(int camera, int imu, std::unique_ptr<Recorder> recorder);
// The first inertial unit that the same carrier has as the camera; -1: none.
int find_imu_beside(const Recording& recording, std::size_t camera);

}  // namespace rubble
