// A LeRobot dataset, version 3.0, of one episode.
//
//   meta/info.json, meta/stats.json, meta/tasks.parquet, meta/episodes/chunk-000/file-000.parquet
//   data/chunk-000/file-000.parquet                            a row for each instant of the cameras
//   videos/observation.images.NAME/chunk-000/file-000.mp4      colour of each camera: JPEG pictures in MP4
// observation.state: of each robot the position and the speed of its moving joints, and its true base: x y z, qw qx qy qz;
// without robots the rig: the same, and its velocity. action: the state of the next row, in the last row the own one.
// Depth and ground truth have no place in the format.
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError when `path` cannot be created. All cameras must have one rate.
std::unique_ptr<Recorder> make_lerobot_recorder(const std::string& path, const Recording& recording = {},
                                                int threads = recording_threads());

}  // namespace rubble
