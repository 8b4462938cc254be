#include "render/passes/ray_pass.h"

#include <algorithm>
#include <limits>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"

namespace rubble {

namespace {

constexpr float kFarthest = 1e5f;  // unit: m
constexpr int kMostBacks = 16;     // surfaces seen from behind that a ray passes through

bool same_pinhole(const Intrinsics& a, const Intrinsics& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy;
}

}  // namespace

RayPass::RayPass(const PreparedScene& scene, const TriangleNames& names, SceneRays& rays, int threads)
    : scene_(scene), names_(names), threads_(threads), rays_(rays) {}

void RayPass::resize(const ViewRays& view) {
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  if (width == width_ && height == height_) return;
  width_ = width, height_ = height;
  directions_.reset();
  own_directions_ = false;
  const std::size_t size = std::size_t(width) * std::size_t(height);
  ids_.resize(size * 2);
  depth_values_.resize(size);
  distances_.resize(size);
}

void RayPass::find_lens(const ViewRays& view) {
  const bool known = view.directions ? directions_ == view.directions
                                     : own_directions_ && same_pinhole(pinhole_, view.intrinsics);
  if (known) return;
  pinhole_ = view.intrinsics;
  own_directions_ = !view.directions;
  directions_ = view.directions ? view.directions : make_lens_directions(view.intrinsics, threads_);
  ray_values_.clear();
  ray_values_.reserve(directions_->size() * 4);
  for (const Vec3f& d : *directions_) {
    const Vec3f r = d * (1 / std::max(d.z, kLeastCosine));
    ray_values_.insert(ray_values_.end(), {r.x, r.y, r.z, 0.0f});
  }
  ++lens_;
}

void RayPass::find_poses(const ViewRays& view) {
  pose_values_.clear();
  for (int v = 0; v < height_; ++v) {
    const Pose pose = view.pose(v);
    const Mat3 r = pose.rotation.matrix();
    for (int i = 0; i < 3; ++i)
      pose_values_.insert(pose_values_.end(), {float(r.rows[i].x), float(r.rows[i].y), float(r.rows[i].z),
                                               float(pose.translation[i])});
  }
}

// Where the ray meets the triangle's plane, in double precision. A sliver, whose plane its corners
// hardly fix, keeps the distance that the tree gave.
double RayPass::exact_distance(const RayScene::Triangle& triangle, const Vec3& eye,
                               const Vec3& direction, double about) const {
  const PlacedMesh& piece = scene_.placed[triangle.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const Quat turn = piece.world_from_mesh.rotation.conjugate();
  const Vec3 from = turn.rotate(eye - piece.world_from_mesh.translation) * (1 / piece.scale);
  const Vec3 along = turn.rotate(direction) * (1 / piece.scale);
  Vec3 p[3];
  for (std::size_t i = 0; i < 3; ++i)
    p[i] = Vec3(mesh.vertices[mesh.triangles[triangle.source].vertices[i]].position);
  const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
  const double t = dot(normal, p[0] - from) / dot(normal, along);
  return std::fabs(t - about) <= 1e-4 * about ? t : about;
}

void RayPass::cast_row(const ViewRays& view, int v) {
  const Pose pose = view.pose(v);
  const Vec3f eye(pose.translation);
  for (int u = 0; u < width_; ++u) {
    const std::size_t i = std::size_t(v) * std::size_t(width_) + std::size_t(u);
    ids_[i * 2] = ids_[i * 2 + 1] = 0;
    depth_values_[i] = 0;
    distances_[i] = std::numeric_limits<float>::quiet_NaN();
    const Vec3f d = (*directions_)[i];
    if (d == Vec3f()) continue;
    const float slope = 1 / std::max(d.z, kLeastCosine);
    const Vec3 along = pose.rotation.rotate(Vec3(d));
    const Vec3f ray(along);
    float near = kNearPlane * slope;
    RayScene::Hit hit = scene_rays_->cast(eye, ray, near, kFarthest);
    for (int back = 0; hit.triangle != RayScene::kNone && hit.back && back < kMostBacks; ++back) {
      near = hit.distance * (1 + 1e-6f) + 1e-6f;
      hit = scene_rays_->cast(eye, ray, near, kFarthest);
    }
    if (hit.triangle == RayScene::kNone || hit.back) continue;
    const RayScene::Triangle triangle = scene_rays_->triangle(hit.triangle);
    const double t = exact_distance(triangle, pose.translation, along, double(hit.distance));
    ids_[i * 2] = triangle.placed + 1;
    ids_[i * 2 + 1] = names_.name(scene_.placed[triangle.placed].mesh, triangle.source);
    distances_[i] = float(t);
    depth_values_[i] = kNearPlane * slope / float(t);
  }
}

void RayPass::draw(const ViewRays& view) {
  resize(view);
  find_lens(view);
  find_poses(view);
  scene_rays_ = &rays_.all();
  parallel_for(std::size_t(height_), threads_, [&](std::size_t v) { cast_row(view, int(v)); });
}

std::vector<float> RayPass::planar_depth() const {
  std::vector<float> out(distances_.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float z = distances_[i] * (*directions_)[i].z;
    out[i] = z > 0 ? z : std::numeric_limits<float>::quiet_NaN();
  }
  return out;
}

}  // namespace rubble
