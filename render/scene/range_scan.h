// A scan of ranges: echoes, each with the time of its ray.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/base/math.h"
#include "render/scene/lidar_spec.h"

namespace rubble {

// One echo. Coordinates are in the frame of the sensor (X forward, Y left, Z up) at the time of the ray. So the scan of a
// moving sensor is distorted by its motion, as a real one.
struct ScanPoint {
  float x = 0, y = 0, z = 0;  // unit: m
  float intensity = 0;        // reflected share of the light, times 100, corrected by range: see Beam
  float time = 0;             // since the scan's stamp; unit: s
  std::uint16_t ring = 0;     // number of the laser, from the lowest up; line of a non-repeating sensor
  std::uint16_t column = 0;   // number of this laser's firing in the scan, from 0
};
static_assert(sizeof(ScanPoint) == 24, "points are hashed and written as they are in memory");

struct RangeScan {
  std::shared_ptr<const LidarSpec> spec;  // where the rays of its sensor go; never null
  std::int64_t stamp_ns = 0;  // of its first ray
  int index = 0;              // of the scans of its sensor, 0-based
  // True poses of the sensor: at the stamp, and after every kMotionStep until after the last ray.
  std::vector<Pose> world_from_sensor;
  static constexpr std::int64_t kMotionStep = 1'000'000;  // unit: ns
  // In the order of the rays. A ray without an echo has no point; a ray with two echoes has the stronger one first.
  std::vector<ScanPoint> points;

  // Of an echo in the world, by the true pose nearest to its time.
  Vec3 place(const ScanPoint& p) const {
    const auto step = std::size_t(double(p.time) * 1e9 / double(kMotionStep) + 0.5);
    return world_from_sensor[std::min(step, world_from_sensor.size() - 1)] * Vec3{p.x, p.y, p.z};
  }
};

}  // namespace rubble
