#include "bench/images/plain_surfaces.h"

#include <algorithm>

#include "render/materials/surface_appearance.h"
#include "render/transport/paint_point.h"

namespace rubble {

PlainSurfaces::PlainSurfaces(const PreparedScene& scene, const PileModel& model, double mirror_roughness)
    : scene_(scene), mirror_roughness_(float(mirror_roughness)) {
  for (const SurfaceAppearance& look : all_surface_appearances())
    albedo_.push_back(model.colour_of(look.name));
}

void PlainSurfaces::find(const SurfaceQuery& query, SurfacePoint& out) const {
  out = find_flat_point(scene_, query);
  if (mirror_roughness_ > 0) {
    out.reflection.gloss = {kMirrorGrey, 1, mirror_roughness_};
    return;
  }
  const PreparedMesh& mesh = scene_.meshes[scene_.placed[query.triangle.placed].mesh];
  const PreparedTriangle& triangle = mesh.triangles[query.triangle.source];
  out.reflection.base = albedo_[triangle.material];
  if (mesh.paint.empty() || mesh.paint[query.triangle.source].paint < 0) return;
  PaintQuery at;  // of no width: Cycles has no halved levels either
  for (std::size_t i = 0; i < 3; ++i) at.corners[i] = mesh.vertices[triangle.vertices[i]].position;
  at.weights = {1 - query.u - query.v, query.u, query.v};
  out.reflection.base = find_paint(*scene_.paints, mesh.paint[query.triangle.source], at).albedo;
}

void strengthen_colours(PileModel& model, double strength) {
  for (PlainAppearance& look : model.surface_appearance) {
    const float grey = dot(look.colour, Vec3f(0.2126f, 0.7152f, 0.0722f));
    for (int i = 0; i < 3; ++i)
      look.colour[i] = std::clamp(grey + (look.colour[i] - grey) * float(strength), 0.02f, 0.9f);
  }
}

}  // namespace rubble
