// The ray of every pixel of one image: lens and shutter together.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera/lens.h"

namespace rubble {

// Unit directions in the optical frame, rows from the top; zero where the lens sees nothing.
using LensDirections = std::vector<Vec3f>;

struct ViewRays {
  std::int64_t stamp_ns = 0;  // simulation time, in the middle of the exposure; unit: ns
  Intrinsics intrinsics;      // width and height in pixels; a pinhole's where `directions` is not given
  Pose world_from_camera;     // in the middle of the exposure
  // Of what bears the lamp; not given: the camera bears it.
  std::optional<Pose> world_from_rig{};
  std::vector<Pose> row_poses{};         // world_from_optical of each row; empty: all as above
  std::shared_ptr<const LensDirections> directions{};  // none: a pinhole

  // Number of the noise that hides the steps of 8 bits: another one for each image of each camera.
  std::uint64_t noise = 0;

  // A pinhole with one pose for all rows can be drawn the fast way.
  bool plain() const { return !directions && row_poses.empty(); }
  const Pose& lamp_bearer() const { return world_from_rig ? *world_from_rig : world_from_camera; }
  Pose pose(int row) const {  // world_from_optical
    return row_poses.empty() ? world_from_camera * camera_from_optical
                             : row_poses[std::size_t(row)];
  }
  Vec3 direction(int u, int v) const {
    const Intrinsics& k = intrinsics;
    if (!directions) return normalized(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1));
    return Vec3((*directions)[std::size_t(v) * std::size_t(k.width) + std::size_t(u)]);
  }
};

// The directions of a lens, worked out on `threads` threads.
std::shared_ptr<const LensDirections> make_lens_directions(const Intrinsics& k, int threads);

}  // namespace rubble
