// A view with the motion of its camera while it is exposed.
#pragma once

#include <vector>

#include "render/camera/view_rays.h"

namespace rubble {

struct ExposedView {
  const ViewRays& middle;               // in the middle of the exposure
  Pose open, close;                     // world_from_camera when it begins and ends
  double seconds = 0;                   // of the exposure; unit: s
  const std::vector<float>& distances;  // of `middle`: RenderedView::distances()
  // Thin lens: the disc of defocus of a point at depth z is fx * aperture * abs(1 / focus - 1 / z) pixels wide.
  double focus = 0, aperture = 0;  // unit: m; focus 0: all is sharp
};

}  // namespace rubble
