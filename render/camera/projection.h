// From world points to pixels and depth values.
//
// Optical frame: Z forward, X right, Y down. Pixel (u, v) has its centre at the whole number, so
// u = fx X/Z + cx. The image is drawn with row 0 first, hence clip y grows with v:
//   clip.x = (2 fx/W) X + ((2 cx + 1)/W - 1) Z,  clip.y = (2 fy/H) Y + ((2 cy + 1)/H - 1) Z,
//   clip.z = near,  clip.w = Z
// with clip space of depth 0 to 1. The depth buffer then holds near / Z (reversed, no far plane),
// whose relative error is that of a float at every distance.
#pragma once

#include <array>

#include "kernel/base/math.h"
#include "render/scene/frame.h"

namespace rubble {

inline constexpr float kNearPlane = 0.01f;  // unit: m; nothing nearer is drawn

// Rows x, y and w of clip_from_optical, times optical_from_world.
struct ViewProjection {
  Pose world_from_optical, optical_from_world;  // inverse of each other; unit: m
  Intrinsics intrinsics;                        // a pinhole: distortion does not count

  ViewProjection(const Pose& world_from_camera, const Intrinsics& k);
  // Rows x, y and w of clip_from_mesh, as shaders/visibility.vert wants them.
  std::array<std::array<float, 4>, 3> clip_rows(const Pose& world_from_mesh, double scale) const;
};

}  // namespace rubble
