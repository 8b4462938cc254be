// The ray of every pixel of one image: lens and shutter together. Internal to render/.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "render/lens.h"

namespace rubble {

// Unit directions in the optical frame, rows from the top; zero where the lens sees nothing.
using LensDirections = std::vector<Vec3f>;

struct ViewRays {
  Intrinsics intrinsics;
  std::vector<Pose> world_from_optical;  // one for the whole image, or one a row
  std::shared_ptr<const LensDirections> directions;  // none: a pinhole

  const Pose& pose(int row) const {
    return world_from_optical[world_from_optical.size() > 1 ? std::size_t(row) : 0];
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
