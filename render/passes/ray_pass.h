// What VisibilityPass finds by rasterising, found by casting one ray a pixel: for lenses that are no
// pinhole and shutters that open row by row. Each pixel's surface is exact; nothing is resampled.
//
// The resolve pass reads, for every pixel, the ray r in the optical frame with a length of
// 1 / max(cosine with the axis, kLeastCosine), and the depth value near / m, so that the surface is
// at r * m: where the cosine is not that small, m is the planar depth.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/geometry/scene_rays.h"
#include "render/geometry/scene_tables.h"

namespace rubble {

class RayPass {
 public:
  static constexpr float kLeastCosine = 0.05f;

  // What they refer to must outlive it.
  RayPass(const PreparedScene& scene, const TriangleNames& names, SceneRays& rays, int threads);

  void draw(const ViewRays& view);

  const std::vector<std::uint32_t>& ids() const { return ids_; }          // two a pixel, as TriangleRaster::ids()
  const std::vector<float>& ray_values() const { return ray_values_; }    // r, four a pixel
  std::uint64_t lens() const { return lens_; }                            // another number whenever those are others
  const std::vector<float>& pose_values() const { return pose_values_; }  // world_from_optical, twelve a row of pixels
  const std::vector<float>& depth_values() const { return depth_values_; }
  const std::vector<float>& distances() const { return distances_; }  // NaN: nothing; unit: m
  // Along the optical axis; NaN where there is nothing or it lies beside or behind the camera.
  std::vector<float> planar_depth() const;

 private:
  void resize(const ViewRays& view);
  void find_lens(const ViewRays& view);
  void find_poses(const ViewRays& view);
  void cast_row(const ViewRays& view, int v);
  double exact_distance(const RayScene::Triangle& triangle, const Vec3& eye, const Vec3& direction,
                        double about) const;

  const PreparedScene& scene_;
  const TriangleNames& names_;
  int threads_;
  SceneRays& rays_;
  const RayScene* scene_rays_ = nullptr;              // as the view is drawn
  std::shared_ptr<const LensDirections> directions_;  // of the lens that is there
  Intrinsics pinhole_;                                // what they were made for ...
  bool own_directions_ = false;                       // ... when the view came without
  std::uint64_t lens_ = 0;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> ids_;
  std::vector<float> depth_values_, distances_, ray_values_, pose_values_;
};

}  // namespace rubble
