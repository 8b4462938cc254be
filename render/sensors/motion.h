// How far surfaces move over the image while the camera, or they themselves, move.
#pragma once

#include <vector>

#include "render/camera/view_rays.h"

namespace rubble {

// A moment near that of a view: where the camera is then, and how far each pixel's surface goes from
// the view to then (Renderer::shifts; empty: all rests).
struct MomentNearby {
  Pose world_from_camera;     // then; unit: m
  std::vector<Vec3f> shifts;  // one a pixel; unit: m
};

// The longest way, in pixels, that a surface seen in `view` goes between two moments; every fourth row
// and column is looked at, and what leaves the image is left out. distances: along the rays; NaN: none,
// taken as infinitely far.
double longest_motion(const ViewRays& view, const std::vector<float>& distances,
                      const MomentNearby& before, const MomentNearby& after);

}  // namespace rubble
