// The drops and flakes that a camera sees one by one, lit where they are. Internal to render/.
#pragma once

#include <memory>
#include <vector>

#include "render/camera/view_rays.h"
#include "render/geometry/ray_scene.h"
#include "render/media/air_glow.h"
#include "render/media/falling_drops.h"
#include "render/view/exposed_view.h"
#include "render/view/lit_scene.h"

namespace rubble {

class DropDrawer {
 public:
  // The scene must outlive it.
  explicit DropDrawer(LitScene& scene) : scene_(scene) {}

  // After LitScene::change().
  void restart();

  // Adds them to the mean light of an exposure, 3 floats a pixel; unit: kcd/m2.
  void add(const ExposedView& exposed, std::vector<float>& radiance);

 private:
  void prepare();
  // A drop under a roof never came there: the scene hides where it would have come from. seconds: after it is there,
  // the exposure ends.
  bool sheltered(const Drop& drop, double seconds) const;
  // Light that it throws towards the eye. direction: from the eye, unit length.
  Vec3f radiance_of(const Drop& drop, const Vec3& direction, const AirLamp& lamp) const;

  LitScene& scene_;
  std::vector<FallingDrops> falling_;
  std::unique_ptr<RayScene> rays_;  // none: nothing falls
};

}  // namespace rubble
