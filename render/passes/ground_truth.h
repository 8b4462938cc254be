// Ground truth of a drawn view, each pixel for itself: nothing is filtered or interpolated between
// pixels. Internal to render/.
#pragma once

#include <cstdint>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/geometry/moving_pieces.h"
#include "render/geometry/scene_rays.h"
#include "render/geometry/scene_tables.h"
#include "render/scene/camera_spec.h"
#include "render/scene/frame.h"

namespace rubble {

using TruthImages = decltype(Frame::truth);

// What is needed of a view that was drawn.
struct DrawnView {
  const ViewRays& rays;                   // as they were drawn
  const std::vector<std::uint32_t>& ids;  // two a pixel, as TriangleRaster::ids()
  const std::vector<float>& distances;    // along the ray; NaN: nothing there; unit: m
  const ViewRays* next;                   // the next image's; null: there is none
  MovingPieces::Shift shift = {};         // of what moves, until the next image
};

class GroundTruthMaker {
 public:
  GroundTruthMaker(const PreparedScene& scene, const TriangleNames& names, SceneRays& rays, int threads)
      : scene_(scene), names_(names), rays_(rays), threads_(threads) {}

  // Makes these streams of ground truth.
  void fill(const StreamSet& streams, const DrawnView& view, TruthImages& truth);
  // How far each pixel's surface goes, one a pixel; 0 where nothing is there or it does not stay.
  std::vector<Vec3f> shifts(const DrawnView& view) const;
  // 1 where a place in the camera body frame has a free line to the surface, 0 elsewhere.
  std::vector<std::uint8_t> line_of_sight_mask(const DrawnView& view, const Vec3& place_in_camera);
  // Of each pixel's surface for light just beyond red; 0: nothing there.
  std::vector<float> albedos(const DrawnView& view) const;

 private:
  struct Pixel;
  struct Corners;
  class Seen;

  Corners corners_of(const Pixel& pixel) const;
  std::optional<Vec3> where_next(const DrawnView& view, std::uint32_t placed, const Vec3& world) const;
  Vec3 find_normal(const Pixel& pixel, const Pose& world_from_optical) const;
  std::vector<Seen> see_row(const DrawnView& view, const Lens& lens, int v) const;
  static void fill_row(const ImageStream& stream, const std::vector<Seen>& row, std::size_t width,
                       ImageValues& image);

  const PreparedScene& scene_;
  const TriangleNames& names_;
  SceneRays& rays_;
  const RayScene* free_ = nullptr;  // all as they stood when they were last asked for
  int threads_;
};

}  // namespace rubble
