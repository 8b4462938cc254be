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
#include "render/geometry/geometry.h"
#include "render/geometry/scene_rays.h"
#include "render/gl/gl_objects.h"

namespace rubble {

class RayPass {
 public:
  static constexpr float kLeastCosine = 0.05f;

  // textures: false: those below stay empty.
  RayPass(const Gl& gl, const PreparedScene& scene, const GpuGeometry& geometry, SceneRays& rays, int threads,
          bool textures);

  void draw(const ViewRays& view);

  const GlTexture& ids() const { return ids_; }  // as VisibilityPass::ids()
  const GlTexture& depth() const { return depth_; }
  const GlTexture& lens_rays() const { return lens_rays_; }
  const GlTexture& row_poses() const { return row_poses_; }
  const std::vector<std::uint32_t>& id_values() const { return id_values_; }
  const std::vector<float>& ray_values() const { return ray_values_; }    // as lens_rays(), four a pixel
  const std::vector<float>& pose_values() const { return pose_values_; }  // as row_poses(), twelve a row
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

  const Gl& gl_;
  const PreparedScene& scene_;
  const GpuGeometry& geometry_;
  int threads_;
  bool textures_;
  SceneRays& rays_;
  const RayScene* scene_rays_ = nullptr;              // as the view is drawn
  std::shared_ptr<const LensDirections> directions_;  // of the lens that is there
  Intrinsics pinhole_;                                // what they were made for ...
  bool own_directions_ = false;                       // ... when the view came without
  GlTexture ids_, depth_, lens_rays_, row_poses_;
  int width_ = 0, height_ = 0;
  std::vector<std::uint32_t> id_values_;
  std::vector<float> depth_values_, distances_, ray_values_, pose_values_;
};

}  // namespace rubble
