#include "bench/images/plain_surfaces.h"

#include <algorithm>

#include "render/materials/surface_appearance.h"

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
  out.reflection.base = albedo_[mesh.triangles[query.triangle.source].material];
}

void strengthen_colours(PileModel& model, double strength) {
  for (PlainAppearance& look : model.surface_appearance) {
    const float grey = dot(look.colour, Vec3f(0.2126f, 0.7152f, 0.0722f));
    for (int i = 0; i < 3; ++i)
      look.colour[i] = std::clamp(grey + (look.colour[i] - grey) * float(strength), 0.02f, 0.9f);
  }
}

}  // namespace rubble
