// How far surfaces move over the image while the camera moves.
#pragma once

#include <vector>

#include "render/camera/view_rays.h"

namespace rubble {

// The longest way, in pixels, that a surface seen in `view` goes between two poses of the camera;
// every fourth row and column is looked at, and what leaves the image is left out. distances: along
// the rays; NaN: none, taken as infinitely far.
double longest_motion(const ViewRays& view, const std::vector<float>& distances,
                      const Pose& world_from_camera_before, const Pose& world_from_camera_after);

}  // namespace rubble
