#include "render/geometry/glass_sheets.h"

#include <cmath>

#include "render/surface/scalar_surface.h"

namespace rubble {

namespace {

constexpr int kMostFaces = 64;  // that one ray crosses
const float kMeanHaze = scalar::kHazeLeast + 0.5f * scalar::kHazeMore;

}  // namespace

GlassSheets::GlassSheets(const PreparedScene& scene)
    : scene_(scene), any_(scene.glass), rays_(scene, RayScene::Detail::finest, RayScene::Part::glass) {}

void GlassSheets::follow() {
  if (any_) rays_.follow();
}

RayScene::PreciseHit GlassSheets::next(RayScene::Ray ray) const {
  RayScene::PreciseHit hit;
  if (!any_) return hit;
  for (int i = 0; i < kMostFaces; ++i) {
    rays_.cast_many(&ray, 1, RayScene::Order::scattered, &hit);
    if (hit.triangle == RayScene::kNone || !hit.back) return hit;
    ray.nearest = just_behind(hit.distance);
  }
  return {};
}

Vec3f GlassSheets::normal_of(const RayScene::Triangle& triangle) const {
  const PlacedMesh& piece = scene_.placed[triangle.placed];
  const PreparedMesh& mesh = scene_.meshes[piece.mesh];
  const auto& v = mesh.triangles[triangle.source].vertices;
  const Vec3f a = mesh.vertices[v[0]].position;
  const Vec3f normal = cross(mesh.vertices[v[1]].position - a, mesh.vertices[v[2]].position - a);
  return Vec3f(piece.world_from_mesh.rotation.rotate(Vec3(normalized(normal))));
}

Vec3f GlassSheets::passed(RayScene::Ray ray) const {
  Vec3f share(1, 1, 1);
  if (!any_) return share;
  for (int i = 0; i < kMostFaces; ++i) {
    const RayScene::PreciseHit hit = next(ray);
    if (hit.triangle == RayScene::kNone) break;
    const float cosine = std::fabs(dot(normal_of(triangle(hit.triangle)), ray.direction));
    const Vec3f passed = scalar::to_vec3(scalar::find_sheet_shares(cosine).passed) * (1 - kMeanHaze);
    share = {share.x * passed.x, share.y * passed.y, share.z * passed.z};
    ray.nearest = just_behind(hit.distance);
  }
  return share;
}

}  // namespace rubble
