// What tests of the camera share: an edge of light, and flights past it.
#pragma once

#include "render/sensors/camera.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {

inline RenderOptions plain() {
  RenderOptions options;
  options.bake = false;
  options.shadow_size = 64;
  options.texture_size = 16;
  return options;
}

// Frames 100 ms apart from start_ns on, the pose a function of the time since then.
template <typename PoseAt>
Flight fly(int frames, PoseAt pose_at) {
  constexpr std::int64_t kStart = 5'000'000'000;
  Flight flight;
  flight.pose_at = [pose_at](std::int64_t ns) { return pose_at(double(ns - kStart) * 1e-9); };
  for (int i = 0; i < frames; ++i) {
    flight.stamps_ns.push_back(kStart + i * 100'000'000LL);
    flight.world_from_camera.push_back(flight.pose_at(flight.stamps_ns.back()));
  }
  return flight;
}

inline Pose sideways(double t) { return {{}, {0, 2 * t, 0}}; }  // 2 m/s to the left
inline Pose standing(double) { return {}; }

// A black-and-white edge: a wall that is lit left of y = 0 and, beside it, the empty sky.
inline Scene lit_wall() {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.type = LightType::directional;
  scene.light.intensity = 50;
  scene.light.rpy_deg = {0, 30, 0};
  scene.meshes.push_back(share(make_box({1, 20, 40}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {4.5, 10, 0}}, 5});
  return scene;
}

inline CameraSpec fixed_camera(int width, int height, double focal) {
  CameraSpec spec;
  spec.intrinsics = pinhole(width, height, focal);
  spec.exposure.mode = ExposureMode::fixed;
  spec.exposure.time = 0.02;
  spec.exposure.iso = 100;
  spec.exposure.f_number = 8;
  spec.sensor.noise = false;
  spec.sensor.bits = 16;
  spec.sensor.response = Response::linear;
  spec.seed = 3;
  return spec;
}

}  // namespace rubble::testing
