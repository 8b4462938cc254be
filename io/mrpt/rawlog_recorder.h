// An MRPT 2.5 rawlog of observations, with its pictures inside.
//
// Each frame is two observations with one stamp: a CObservationRobotPose labelled `ground_truth`
// (the rig in the world: the body of the only camera), then a CObservation3DRangeScan labelled `camera`
// with planar depth and colour (sensor frame: X forward, Y left, Z up), which stands at the robot's
// origin. Where the recording has them: before these CObservationIMU `imu`; after them a scan
// `ground_truth_depth` (the exact depth, when `camera` has that of a sensor) and a
// CObservationImage `camera_right`. Of sensors that scan, by their names: CObservationRotatingScan, of a
// non-repeating one CObservationPointCloud, of a 2-D scanner CObservation2DRangeScan. Several cameras:
// labels NAME, NAME_ground_truth_depth and NAME_right, each where it is mounted, and one pose an instant.
// Robots: CObservationOdometry NAME_odometry and CObservationRobotPose NAME_ground_truth, both of the
// robot's own base frame. Velocities go with odometry that turns only: MRPT 2.5 divides by the rate of turn, and a
// rate of 0 makes its icp-slam lose the robot. MRPT's clock ticks every 100 ns:
// stamps are rounded down to that.
#pragma once

#include <memory>
#include <string>

#include "io/recording/recorder.h"
#include "io/recording/recording.h"

namespace rubble {

struct RawlogOptions {
  int gzip_level = 0;         // 0 to 9; 1 halves the file and takes 3.5 times the CPU time
  double depth_unit = 0.001;  // of the stored integers, up to 65535 of them; unit: m; > 0
  Recording recording{};      // what is recorded, and under which names
  // Of the robot of this number, from 0: actions by its odometry and sensory frames, see action_frames.h. The sensors
  // of others are in it as well. -1: single observations, as above.
  int actions_of = -1;
};

// Throws RunError when `path` cannot be created.
std::unique_ptr<Recorder> make_rawlog_recorder(const std::string& path,
                                               const RawlogOptions& options = {});

}  // namespace rubble
