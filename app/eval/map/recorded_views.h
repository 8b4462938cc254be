// Where the camera of a finished run was, and what was in its picture.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "render/camera/lens.h"

namespace rubble {

struct ViewRange {
  double nearest = 0, farthest = 10;  // planar depth, along the optical axis; unit: m
};

struct RecordedViews {
  Intrinsics intrinsics;                 // of all frames
  Lens lens;                             // of these intrinsics
  ViewRange range;                       // what the depth image holds
  std::vector<Pose> world_from_optical;  // one per frame

  // Whether a point of the world is inside the picture and the range; what hides it does not count.
  bool has_in_picture(std::size_t frame, const Vec3& point) const;
  // Of a place in the picture; a unit vector in the world. Nothing where the lens sees nothing.
  std::optional<Vec3> direction(std::size_t frame, double u, double v) const;
};

// The poses of groundtruth.txt in the folder of a run. Throws InputError when it is not there.
std::vector<Pose> load_true_poses(const std::string& folder);

}  // namespace rubble
