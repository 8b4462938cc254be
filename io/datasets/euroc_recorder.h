// A folder as those of the EuRoC MAV dataset (Burri et al. 2016, "The EuRoC micro aerial vehicle
// datasets"), which visual-inertial programs read.
//
//   mav0/cam0/data/STAMP.png, data.csv, sensor.yaml    grey, 8 bit
//   mav0/cam1/...                                      the right camera, where there is one, and the
//                                                      further cameras, each followed by its right one
//   mav0/imu0/data.csv, sensor.yaml                    where the recording has an inertial unit; imu1 of a second one
//   mav0/state_groundtruth_estimate0/data.csv, sensor.yaml
// Stamps are nanoseconds. The body S is the rig that flies the trajectory (X forward, Y left, Z up): the
// body of the only camera. T_BS of a camera is its optical frame in the body. The reference R is the
// world. Quaternions are w x y z.
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_euroc_recorder(const std::string& path,
                                              const Recording& recording = {},
                                              int threads = recording_threads());

}  // namespace rubble
