#include "render/passes/glass_layers.h"

#include <algorithm>

#include "kernel/base/parallel.h"
#include "render/camera/projection.h"
#include "render/materials/glass.h"
#include "render/passes/ray_pass.h"

namespace rubble {

namespace {

constexpr float kRayEnd = 1e5f;  // unit: m
// The other face of the same sheet, or the same one where it was drawn coarser or farther by rounding; unit: m
constexpr float kSameSheet = 0.012f;
constexpr std::size_t kPixelChunk = 256;  // a job

// Off the sheet by more than the rounding of depth values.
float behind(float distance) { return distance * (1 + 1e-5f) + 1e-4f; }

}  // namespace

GlassRays::GlassRays(const PreparedScene& scene, const TriangleNames& names, SceneRays& rays, int threads)
    : scene_(scene),
      names_(names),
      threads_(threads),
      rays_(rays),
      sheets_(scene) {}

bool GlassRays::shows_glass(const std::uint32_t* ids) const {
  if (!ids[0]) return false;
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[ids[0] - 1].mesh];
  return mesh.glass && mesh.triangles[names_.triangle_of_name[ids[1]]].material == glass_appearance();
}

bool GlassRays::begin_layer(const ViewRays& view, const std::uint32_t* ids, GlassLayer& out) {
  const int width = view.intrinsics.width, height = view.intrinsics.height;
  pixels_.clear();
  for (int v = 0, i = 0; v < height; ++v)
    for (int u = 0; u < width; ++u, ++i)
      if (shows_glass(ids + 2 * std::size_t(i))) pixels_.push_back({std::uint32_t(i), u, v});
  if (pixels_.empty()) return false;
  constexpr int kBlock = GlassLayer::kBlock;
  out.blocks_across = (width + kBlock - 1) / kBlock;
  out.blocks.assign(std::size_t(out.blocks_across) * std::size_t((height + kBlock - 1) / kBlock), 0);
  out.x0 = width, out.y0 = height;
  for (const Pixel& p : pixels_) {
    out.blocks[std::size_t(p.v / kBlock) * std::size_t(out.blocks_across) + std::size_t(p.u / kBlock)] = 1;
    out.x0 = std::min(out.x0, p.u), out.x1 = std::max(out.x1, p.u + 1);
    out.y0 = std::min(out.y0, p.v), out.y1 = std::max(out.y1, p.v + 1);
  }
  return true;
}

void GlassRays::cast(const RayScene& solid, const ViewRays& view, const Pixel& pixel, bool last, GlassLayer& out) const {
  const Pose pose = view.pose(pixel.v);
  const Vec3f d(view.direction(pixel.u, pixel.v));
  const float slope = 1 / std::max(d.z, RayPass::kLeastCosine);
  float& value = out.depth_values[pixel.index];
  std::uint32_t* const id = &out.ids[2 * std::size_t(pixel.index)];
  const std::uint32_t piece = id[0] - 1;
  const float before = kNearPlane * slope / value;
  RayScene::Ray ray{Vec3f(pose.translation), behind(before), Vec3f(pose.rotation.rotate(Vec3(d))), kRayEnd};
  RayScene::PreciseHit hit, sheet;
  solid.cast_many(&ray, 1, RayScene::Order::scattered, &hit);
  if (hit.triangle != RayScene::kNone) ray.farthest = hit.distance;
  if (!last) sheet = sheets_.next(ray);
  if (sheet.triangle != RayScene::kNone && sheet.distance - before < kSameSheet &&
      sheets_.triangle(sheet.triangle).placed == piece) {
    ray.nearest = just_behind(sheet.distance);
    sheet = sheets_.next(ray);
  }
  const bool glass = sheet.triangle != RayScene::kNone;
  if (glass) hit = sheet;
  id[0] = id[1] = 0, value = 0;
  if (hit.triangle == RayScene::kNone) return;
  if (hit.back) {
    value = GlassLayer::kDark;
    return;
  }
  const RayScene::Triangle t = glass ? sheets_.triangle(hit.triangle) : solid.triangle(hit.triangle);
  id[0] = t.placed + 1;
  id[1] = names_.name(scene_.placed[t.placed].mesh, t.source);
  value = kNearPlane * slope / hit.distance;
}

std::vector<GlassLayer> GlassRays::find(const ViewRays& view, const std::uint32_t* ids,
                                        const std::vector<float>& depth_values) {
  const RayScene& solid = rays_.solid();
  sheets_.follow();
  std::vector<GlassLayer> out;
  while (out.size() < kMostLayers) {
    GlassLayer layer;
    if (!begin_layer(view, out.empty() ? ids : out.back().ids.data(), layer)) break;
    layer.ids = out.empty() ? std::vector<std::uint32_t>(ids, ids + 2 * depth_values.size()) : out.back().ids;
    layer.depth_values = out.empty() ? depth_values : out.back().depth_values;
    const bool last = out.size() + 1 == kMostLayers;
    parallel_for((pixels_.size() + kPixelChunk - 1) / kPixelChunk, threads_, [&](std::size_t job) {
      for (std::size_t i = job * kPixelChunk; i < std::min((job + 1) * kPixelChunk, pixels_.size()); ++i)
        cast(solid, view, pixels_[i], last, layer);
    });
    out.push_back(std::move(layer));
  }
  return out;
}

}  // namespace rubble
