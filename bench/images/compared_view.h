// The fast renderer beside the reference, in one view. Light is compared before exposure, by region; then both are
// developed at the exposure that the reference's light asks for, and compared as pictures.
#pragma once

#include "bench/images/picture_file.h"
#include "render/renderer.h"

namespace rubble {

struct DrawnPicture {
  LinearFrame frame;
  double seconds = 0, processor = 0;  // of the image alone
};
DrawnPicture draw_view(Renderer& renderer, const ViewRays& view);

struct ViewComparison {
  Picture expected, found;  // developed
  double mean_error = 0, bias = 0;  // of light, as RegionDifference
  double similarity = 0;            // of the pictures; 1: equal
};
// gains: of white balance; regions: across and down.
ViewComparison compare_views(const LinearFrame& reference, const LinearFrame& fast, const Vec3f& gains, int regions,
                             int threads);

// Of the reference's light alone, as `expected`.
Picture develop_reference(const LinearFrame& reference, const Vec3f& gains);

}  // namespace rubble
