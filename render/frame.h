// One neutral camera sample: what the renderer hands over and every recorder reads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Pinhole with Brown-Conrady distortion, as ROS plumb_bob and OpenCV. Pixel (0, 0) is the top-left
// one and its centre has the coordinates (0, 0).
struct Intrinsics {
  int width = 1024, height = 1024;        // unit: pixel
  double fx = 0, fy = 0, cx = 0, cy = 0;  // unit: pixel
  std::array<double, 5> distortion{};     // k1 k2 p1 p2 k3
};

struct Frame {
  int index = 0;                  // 0-based
  std::int64_t stamp_ns = 0;      // simulation time; one stamp for all that is in the frame
  Intrinsics intrinsics;          // of colour and depth alike: they are registered
  Pose world_from_camera;         // camera body frame: X forward, Y left, Z up
  std::vector<std::uint8_t> rgb;  // 3 bytes a pixel, rows from the top
  std::vector<float> depth;       // planar, along the optical axis; unit: m; NaN: no return
};

}  // namespace rubble
