// Rays through the sheets of glass of a scene. A sheet is what lies between a face that a ray enters and the one by which
// it leaves: the first does all that the sheet does, the second nothing. Glass on a solid thing is a sheet before
// what is inside it, which is dark. Internal to render/.
#pragma once

#include "render/geometry/ray_scene.h"

namespace rubble {

class GlassSheets {
 public:
  // The scene must outlive it.
  explicit GlassSheets(const PreparedScene& scene);

  bool any() const { return any_; }
  void follow();  // as RayScene

  // The first sheet that the ray enters; its triangle is a number for triangle().
  RayScene::PreciseHit next(RayScene::Ray ray) const;
  RayScene::Triangle triangle(std::uint32_t number) const { return rays_.triangle(number); }
  // Share of light that comes straight through all sheets on the ray's way, with their mean haze.
  // Its direction must be of unit length.
  Vec3f passed(RayScene::Ray ray) const;

 private:
  Vec3f normal_of(const RayScene::Triangle& triangle) const;  // in the world, unit length

  const PreparedScene& scene_;
  bool any_;
  RayScene rays_;
};

// Where a ray goes on behind a surface that it met at a distance.
inline float just_behind(float distance) { return distance * (1 + 1e-6f) + 1e-6f; }

}  // namespace rubble
