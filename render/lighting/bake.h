// Light that arrives by way of the sky and other surfaces, computed once by ray casting (Embree).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "kernel/base/disk_cache.h"
#include "render/geometry/geometry.h"
#include "render/lighting/lighting.h"

namespace rubble {

struct BakeOptions {
  int threads = 1;         // the result does not depend on it
  int rays = 64;           // a bake point; range: 8 to 1024
  int bounces = 3;         // between surfaces
  std::uint64_t seed = 0;  // of the directions of rays
};

// Light scattered in the air, on a grid over the pieces and a little around them.
struct AirLight {
  Vec3f origin, cell;                  // of grid point (0, 0, 0), and from point to point; unit: m
  std::array<std::int32_t, 3> size{};  // points along x, y and z
  // Of sky and surfaces, the mean over all directions; unit: kcd/m2; x runs fastest
  std::vector<Vec3f> radiance;
  // Of each light in turn, in grids like that: its illuminance where it arrives; unit: klx. Empty:
  // none arrives anywhere.
  std::vector<Vec3f> direct;

  // Between points, or of the border's nearest outside.
  Vec3f at(const Vec3f& point) const { return at(radiance.data(), point); }
  Vec3f direct_at(std::size_t light, const Vec3f& point) const {
    return direct.empty() ? Vec3f() : at(direct.data() + light * radiance.size(), point);
  }

 private:
  Vec3f at(const Vec3f* grid, const Vec3f& point) const;
};

struct BakedScene {
  std::vector<BakedLight> vertices;  // one a vertex of each placed mesh, in the order of first_light
  AirLight air;                      // of the same light
};

// Every vertex and all air as if nothing stood around: the sky alone.
BakedScene open_sky_light(const PreparedScene& scene, const LightSet& light);

// progress: called with the done fraction, on the calling thread.
BakedScene bake_light(const PreparedScene& scene, const LightSet& light,
                      const BakeOptions& options, const std::function<void(double)>& progress);

// The same by way of the disk cache: made only if it is not there.
BakedScene bake_light_once(const DiskCache& cache, const PreparedScene& scene,
                           const LightSet& light, const BakeOptions& options,
                           const std::function<void(double)>& progress);

}  // namespace rubble
