// What a LiDAR measures: the echoes of one scan, each with the time at which its ray was sent.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// One echo. Coordinates are in the frame of the sensor (X forward, Y left, Z up) as it was when the
// ray left: a scan of a moving sensor is bent by its motion, as a real one is.
struct LidarPoint {
  float x = 0, y = 0, z = 0;  // unit: m
  float intensity = 0;        // share of light thrown back, times 100, as the range corrects it: see Beam
  float time = 0;             // since the scan's stamp; unit: s
  std::uint16_t ring = 0;     // which laser, from the lowest up; of a non-repeating sensor its line
  std::uint16_t column = 0;   // which firing of that laser in the scan, from 0
};
static_assert(sizeof(LidarPoint) == 24, "points are hashed and written as they are in memory");

struct LidarScan {
  std::int64_t stamp_ns = 0;  // of its first ray
  int sensor = 0;             // number among the recording's LiDARs
  int index = 0;              // of this LiDAR's scans, 0-based
  // Where the sensor truly was: at the stamp, and every kMotionStep on until after the last ray.
  std::vector<Pose> world_from_lidar;
  static constexpr std::int64_t kMotionStep = 1'000'000;  // unit: ns
  // In the order in which the rays left; a ray without an echo gives none, with two gives the
  // stronger one first.
  std::vector<LidarPoint> points;
};

}  // namespace rubble
