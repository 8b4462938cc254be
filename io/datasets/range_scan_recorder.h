// Scans of ranges as files: a folder for each sensor that scans, a file for each scan.
//
//   pcd/NAME/000000.pcd    binary PCD 0.7 (PCL): x y z intensity, ring (u16), time (f32, s since the stamp)
//   pcd/NAME/stamps.txt    a line a scan: its stamp, the file
//   pcd/NAME/motion.txt    TUM: where the sensor truly was, every millisecond of every scan
//   kitti/NAME/velodyne/000000.bin   x y z and reflectance (intensity / 100), float32
//   kitti/NAME/times.txt   seconds since the first scan; poses.txt: the true pose at each stamp, the upper
//                          three rows of world_from_sensor
#pragma once

#include <memory>
#include <string>

#include "io/base/ordered_tasks.h"
#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

// Both throw RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_pcd_recorder(const std::string& path, const Recording& recording,
                                            int threads = recording_threads());
std::unique_ptr<Recorder> make_kitti_recorder(const std::string& path, const Recording& recording,
                                              int threads = recording_threads());

}  // namespace rubble
