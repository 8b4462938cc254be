// A COLMAP project with the true poses and intrinsics, as text:
// https://colmap.github.io/format.html
//
//   images/000000.png, ...          right/000000.png, ... where there is a right camera
//   sparse/cameras.txt              PINHOLE, OPENCV, FULL_OPENCV (with k3) or OPENCV_FISHEYE
//   sparse/images.txt               camera_from_world of the optical frame, w x y z
//   sparse/points3D.txt             empty: `colmap point_triangulator` fills it
// COLMAP's pixel (0, 0) has its centre at (0.5, 0.5): cx and cy are larger by a half than ours.
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_colmap_recorder(const std::string& path,
                                               const Recording& recording = {},
                                               int threads = recording_threads());

}  // namespace rubble
