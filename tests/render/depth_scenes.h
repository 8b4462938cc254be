// What tests of depth sensors share: a view of one plane, and two sensors.
#pragma once

#include <cmath>
#include <vector>

#include "kernel/base/portable_math.h"
#include "render/sensors/camera.h"
#include "render/sensors/depth_sensor.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {

inline constexpr double kPi = portable::kPi;

// A view of one plane, worked out by hand: at depth z in the middle, turned about the vertical.
struct Plane {
  Plane(int width, int height, double focal, double z, double turn) {
    rays.intrinsics = pinhole(width, height, focal);
    const Vec3 normal(std::sin(turn), 0, -std::cos(turn));
    for (int v = 0; v < height; ++v)
      for (int u = 0; u < width; ++u) {
        const Vec3 d = rays.direction(u, v);
        distances.push_back(float(-z * std::cos(turn) / dot(d, normal)));
        for (int c = 0; c < 3; ++c) normals.push_back(float(normal[c]));
      }
    projected.assign(distances.size(), 1);
    albedos.assign(distances.size(), 0.4f);
  }
  DepthView view(int frame = 0) const {
    return {rays, distances, normals, projected, albedos, air, frame};
  }

  ViewRays rays;
  std::vector<float> distances, normals, albedos;
  std::vector<std::uint8_t> projected;
  Air air = Medium().at(0);
};

struct Statistics {
  double mean = 0, deviation = 0, valid = 0;
};
inline Statistics statistics_of(const std::vector<float>& depth) {
  Statistics s;
  double count = 0, squares = 0;
  for (const float z : depth)
    if (!std::isnan(z)) ++count, s.mean += double(z);
  s.mean /= count;
  for (const float z : depth)
    if (!std::isnan(z)) squares += (double(z) - s.mean) * (double(z) - s.mean);
  s.deviation = std::sqrt(squares / count);
  s.valid = count / double(depth.size());
  return s;
}

// A Kinect: f = 586 pixels of 640, b = 75 mm.
inline CameraSpec kinect() {
  CameraSpec spec;
  spec.depth_sensor.type = DepthSensorType::structured_light;
  spec.depth_sensor.max_range = 12;
  spec.seed = 5;
  return spec;
}

inline CameraSpec time_of_flight() {
  CameraSpec spec;
  spec.depth_sensor.type = DepthSensorType::time_of_flight;
  spec.depth_sensor.min_range = 0;
  spec.depth_sensor.max_range = 7.4;
  spec.depth_sensor.step = 0;
  spec.seed = 6;
  return spec;
}

}  // namespace rubble::testing
