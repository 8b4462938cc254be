// Plain pictures: every channel of every frame as a file of its own, for programs that know no
// recording format. INDEX is the frame's number with six digits.
//
//   rgb/INDEX.png            8 bit
//   depth/INDEX.exr          channel Z: planar depth, float, m; NaN: no return. With a depth
//                            sensor, what that measures, and the exact one in depth_true/
//   right/INDEX.png          the right camera
//   NAME/INDEX.exr, .png, .flo  streams of ground truth, each as its file render/streams/NAME.cpp
//                            says: floats and 32-bit integers (signed) as EXR, of one value a pixel in
//                            channel Y, of three in R, G and B; 8 and 16 bit integers as PNG; optical
//                            flow as Middlebury .flo, above 1e9: unknown
//   events.txt               `seconds x y polarity`, a line each
//   imu.csv, poses.csv       poses: of the camera body (X forward, Y left, Z up) in the world
//   camera.json, legend.json
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_frames_recorder(const std::string& path,
                                               const Recording& recording = {},
                                               int threads = recording_threads());

}  // namespace rubble
