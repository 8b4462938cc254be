// The finest triangles of a scene for casting rays, made when they are first asked for and shared by all that ask: a tree
// of thousands of pieces takes seconds and hundreds of MiB. Internal to render/.
#pragma once

#include <memory>

#include "render/geometry/ray_scene.h"

namespace rubble {

// What it gives has all that moves where it is in the scene now, and stays valid; not to be asked while another thread
// asks or casts.
class SceneRays {
 public:
  // The scene must outlive it.
  explicit SceneRays(const PreparedScene& scene) : scene_(scene) {}

  const RayScene& all() { return now(all_, RayScene::Part::all); }
  // Without glass.
  const RayScene& solid() { return scene_.glass ? now(solid_, RayScene::Part::solid) : all(); }

 private:
  const RayScene& now(std::unique_ptr<RayScene>& rays, RayScene::Part part) {
    if (!rays) rays = std::make_unique<RayScene>(scene_, RayScene::Detail::finest, part);
    rays->follow();
    return *rays;
  }

  const PreparedScene& scene_;
  std::unique_ptr<RayScene> all_, solid_;
};

}  // namespace rubble
