// The TUM RGB-D format: https://cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// groundtruth.txt alone: `stamp tx ty tz qx qy qz qw`, the pose of the colour camera's optical
// centre, in the optical frame (Z forward, X right, Y down), in the world.
// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_tum_trajectory_recorder(const std::string& path);

// A whole sequence as a folder: rgb/STAMP.png, depth/STAMP.png (16 bit, 5000 = 1 m, 0: no return or
// beyond 13.1 m), rgb.txt, depth.txt, associations.txt, groundtruth.txt, and calibration.txt as
// `fx fy cx cy d0 d1 d2 d3 d4`. With measured depth, that is in depth/, and the exact one in
// depth_true/.
std::unique_ptr<Recorder> make_tum_recorder(const std::string& path,
                                            const Recording& recording = {},
                                            int threads = recording_threads());

}  // namespace rubble
