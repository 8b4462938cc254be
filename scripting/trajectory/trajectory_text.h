// Recorded trajectories as text: what SLAM programs, motion capture and ROS write. The one reader of
// them, for paths of missions and for scores.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct StampedPose {
  double stamp = 0;           // unit: s; without stamps the number of the pose
  Pose world_from_body;       // unit: m
  int line = 0;               // of the file; 1-based
  std::int64_t stamp_ns = 0;  // the stamp, exactly; unit: ns
};

struct RecordedTrajectory {
  std::vector<StampedPose> poses;  // at least one; stamps never decrease
  std::string format;              // what it was read as: "TUM (stamp tx ty tz qx qy qz qw; s)"
  bool has_stamps = true;          // KITTI's poses have none
  bool has_rotations = true;       // otherwise they are the identity
  bool optical = false;            // by the format's custom, bodies are optical frames, not REP 103's
  // By the format's custom the world is the first camera's optical frame: Z forward, Y down (KITTI).
  bool optical_world = false;
  // Roll, pitch and yaw as the file has them, of each pose; empty: it has quaternions or matrices; unit: degree
  std::vector<Vec3> rpy_deg;
  std::vector<int> repeated;       // lines whose stamp is that of the line before
  std::vector<std::string> notes;  // what was not understood or guessed, for the user
};

// Takes, in this order:
// - files whose columns are named, by a first line of words or by a comment with a name for each
//   column, in any order. Names: t, time, timestamp, stamp; x, px, p_x, position.x, ...; qx, q_x,
//   q_RS_x, orientation.x, ...; roll, pitch, yaw. Units: `[ns]`, `(mm)`, `x [ft]`, `yaw_deg`, `t_ns`; another unit in
//   brackets is refused. A stamp may be in two columns: header.stamp.secs and .nsecs, stamp/sec and stamp/nanosec. The
//   stamp of a header is taken before the time of arrival.
//   `columns`, "t,x,y,z,qx,qy,qz,qw", names those of a file that does not.
// - TUM: stamp tx ty tz qx qy qz qw, between blanks
// - KITTI: the first three rows of a matrix; also all four, and with a stamp before them
// - EuRoC: stamp,px,py,pz,qw,qx,qy,qz,..., between commas or semicolons, with integer stamps in ns
// Where the unit of stamps is not named, it follows from their size (s, ms, us or ns since 1970) or, of
// integers that begin elsewhere, from their steps. Other rows of numbers between commas or semicolons
// have no known order and are refused. Quaternions are normalised.
//
// Throws InputError with `path` and line: columns that are missing, ambiguous or without a unit, a
// line of another form, a number that is not finite, a quaternion or matrix that is no rotation within
// 1 %, stamps that decrease, no pose.
RecordedTrajectory parse_trajectory(std::string_view text, const std::string& path, const std::string& columns = "");

// The pose's body in REP 103 (X forward, Z up) from a body, and a world, that may be optical frames.
Pose body_pose(const Pose& world_from_body, bool optical, bool optical_world);

}  // namespace rubble
