// Surfaces that every renderer has, on flat triangles: matt after Lambert with one colour for each surface
// name, or of the paint of a user's file, or rough mirrors after Trowbridge and Reitz without Fresnel's law, all of
// one grey.
#pragma once

#include <vector>

#include "io/mesh/pile_model.h"
#include "render/transport/surface_model.h"

namespace rubble {

inline constexpr float kMirrorGrey = 0.7f;  // share of the light that a facet mirrors

class PlainSurfaces : public SurfaceModel {
 public:
  // With the colours that the model is exported with. mirror_roughness: alpha of mirrors; 0: matt. The scene
  // must outlive it.
  PlainSurfaces(const PreparedScene& scene, const PileModel& model, double mirror_roughness);
  void find(const SurfaceQuery& query, SurfacePoint& out) const override;

 private:
  const PreparedScene& scene_;
  float mirror_roughness_;
  std::vector<Vec3f> albedo_;  // by index into all_surface_appearances()
};

// Colours further from grey, as paint has them: what light takes from one surface to the next is then plain
// to see. strength: 1 leaves them; the albedos stay between 0.02 and 0.9.
void strengthen_colours(PileModel& model, double strength);

}  // namespace rubble
