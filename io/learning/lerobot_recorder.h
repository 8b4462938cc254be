// Records a run as a LeRobot dataset of one episode.
// observation.state: of each robot the position and the speed of its moving joints, and its true base: x y z, qw qx qy qz;
// without robots the rig: the same, and its velocity. action: the state of the next row, in the last row the own one.
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
