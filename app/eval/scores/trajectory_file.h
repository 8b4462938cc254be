// Trajectories as text: what SLAM programs write and what ours writes as ground truth.
#pragma once

#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct StampedPose {
  double stamp = 0;      // unit: s
  Pose world_from_body;  // unit: m
  int line = 0;          // of the file; 1-based
};

// Reads
//   TUM:   stamp tx ty tz qx qy qz qw, by white space; unit: s
//   EuRoC: stamp,px,py,pz,qw,qx,qy,qz[,...], by commas; unit: ns
// Lines that begin with # are comments. Quaternions are normalised. Throws InputError with file and
// line for: a line of another form, a number that is not finite, a quaternion that is not of unit
// length within 1 %, stamps that do not ascend (a repeated one is named as such), no pose at all.
std::vector<StampedPose> load_trajectory(const std::string& path);

}  // namespace rubble
