// How far surfaces move over the image while the camera, or they themselves, move.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/sensors/flight.h"

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

// Times from `from` to `to`, which are the first and the last. Between two the camera hardly turns and goes nearly straight: on a
// longer way longest_motion() would see neither what comes back nor what has left the image.
std::vector<std::int64_t> cut_way(const Flight& flight, std::int64_t from, std::int64_t to);
// The sum of longest_motion() over a way. moments: at the times of cut_way(), two at least. Where there are more, each part counts as
// what the middle of the image goes, at least.
double longest_way(const ViewRays& view, const std::vector<float>& distances, const std::vector<MomentNearby>& moments);

}  // namespace rubble
