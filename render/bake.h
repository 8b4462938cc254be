// Light that arrives by way of the sky and other surfaces, computed once by ray casting (Embree).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "render/geometry.h"
#include "render/lighting.h"

namespace rubble {

struct BakeOptions {
  int threads = 1;  // the result does not depend on it
  int rays = 64;    // a bake point; range: 8 to 1024
  int bounces = 3;  // between surfaces
  std::uint64_t seed = 0;
};

// Every vertex as if nothing stood around it: the sky alone.
std::vector<BakedLight> open_sky_light(const PreparedScene& scene, const LightModel& light);

// The pieces as a ray caster sees them, with the light on them.
class Baker {
 public:
  // Called with the done fraction, on the calling thread.
  using Progress = std::function<void(double)>;

  Baker(const PreparedScene& scene, const LightModel& light, const BakeOptions& options,
        const Progress& progress);
  ~Baker();

  // One entry a vertex of each placed mesh, in the order of first_light.
  std::vector<BakedLight> vertex_light() const;
  // Mean radiance from all directions at a point in the air; unit: kcd/m2.
  Vec3f air_radiance(const Vec3f& point) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rubble
