// A COLMAP project with the true poses and intrinsics of all cameras, as text:
// https://colmap.github.io/format.html
//
//   images/000000.png, ...          of a single camera; left/000000.png and right/000000.png of a stereo camera; of
//                                   several cameras below NAME/
//   sparse/cameras.txt              PINHOLE, OPENCV, FULL_OPENCV (with k3) or OPENCV_FISHEYE
//   sparse/images.txt               camera_from_world of the optical frame, w x y z
//   sparse/points3D.txt             empty: `colmap point_triangulator` fills it
// A number is that of the instant: cameras of lower rates leave some out.
// With more than one camera, counting right ones (COLMAP 3.12 and later read these):
//   sparse/rigs.txt                 a rig for each carrier of cameras: the rig that flies, or a link of a robot
//   sparse/frames.txt               the pictures of each rig at each stamp, and its pose
//   rig_config.json                 for `colmap rig_configurator`
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
