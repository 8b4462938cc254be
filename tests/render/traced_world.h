// Scenes of made-to-measure surfaces for the path tracer: any reflection, any emission.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "render/reference/traced_image.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {

// Asked for each point that is met; `piece` is the id of its instance.
using FindSurface = std::function<void(std::uint32_t piece, const SurfaceQuery&, SurfacePoint&)>;

class TracedWorld {
 public:
  // Sky black, no lights but those that are added to `lights`.
  TracedWorld(const Scene& scene, FindSurface find);

  LightSet lights;
  PlacedLamp lamp;
  AirPath air;

  TracedImage trace(const Pose& world_from_camera, const Intrinsics& k, const TraceOptions& options,
                    int tile = 16) const;

 private:
  PreparedScene scene_;
  std::unique_ptr<RayScene> rays_;
  std::unique_ptr<GlassSheets> sheets_;
  std::shared_ptr<const SurfaceModel> surfaces_;
};

void set_even_sky(LightSet& lights, float radiance);
// A square that faces +Z of its body, of this side; seen and lit from there alone.
TriangleMesh make_plate(double side);
// A closed box of glass.
TriangleMesh make_pane(const Vec3& size);
// A closed box that faces inwards.
TriangleMesh make_room(const Vec3& size);
double mean_green(const TracedImage& image);

}  // namespace rubble::testing
