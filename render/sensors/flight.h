// Where a camera is: at its frames, and at any time between them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct Flight {
  std::vector<std::int64_t> stamps_ns;                  // of the frames, growing
  std::vector<Pose> world_from_camera;                  // at these
  std::function<Pose(std::int64_t stamp_ns)> pose_at;   // at any time
};

}  // namespace rubble
