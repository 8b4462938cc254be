// Where the cameras of a finished run were, and what was in their pictures.
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

// One of the cameras, the same in all of its frames.
struct RecordedCamera {
  Intrinsics intrinsics;  // of its pictures
  Lens lens;              // of these intrinsics
  ViewRange range;        // what its depth image holds
};

struct RecordedViews {
  std::vector<RecordedCamera> cameras;   // of the run; at least one
  std::vector<std::size_t> camera;       // of each frame: index into the cameras
  std::vector<Pose> world_from_optical;  // one per frame; unit: m

  const RecordedCamera& camera_of(std::size_t frame) const { return cameras[camera[frame]]; }
  // Adds a camera with its frames.
  void add(const RecordedCamera& added, const std::vector<Pose>& poses);
  // Whether a point of the world is inside the picture and the range; what hides it does not count.
  bool has_in_picture(std::size_t frame, const Vec3& point) const;
  // Of a place in the picture; a unit vector in the world. Nothing where the lens sees nothing.
  std::optional<Vec3> direction(std::size_t frame, double u, double v) const;
};

// The poses of groundtruth.txt in the folder of a run or of one of its cameras. Throws InputError when it is not there.
std::vector<Pose> load_true_poses(const std::string& folder);

}  // namespace rubble
