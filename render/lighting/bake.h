// Light that arrives by way of the sky and other surfaces, computed once by ray casting (Embree).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "kernel/base/system/disk_cache.h"
#include "render/geometry/scene_rays.h"
#include "render/lighting/lighting.h"

namespace rubble {

struct BakeOptions {
  int threads = 1;         // the result does not depend on it
  int rays = 512;          // a bake point at most, fewer where light is even; range: 8 to 1024
  int bounces = 5;         // between surfaces
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
  Vec3f nearest(const Vec3f& point) const;  // of the box of the grid
  Vec3f direct_at(std::size_t light, const Vec3f& point) const {
    return direct.empty() ? Vec3f() : at(direct.data() + light * radiance.size(), point);
  }

 private:
  Vec3f at(const Vec3f* grid, const Vec3f& point) const;
};

// What the bake points see of each other, for light that is found later.
struct BakeLinks {
  static constexpr std::size_t kPerPoint = 24;  // directions, cosine-weighted
  static constexpr std::uint32_t kDark = 0xffffffffu;   // no surface there, or the inside of one
  static constexpr std::uint32_t kNoRay = 0xfffffffeu;  // nothing was looked for: it does not count

  // kPerPoint of each point in turn: another point, kDark or kNoRay. Points are those of the placed meshes
  // in turn.
  std::vector<std::uint32_t> seen;
  std::vector<Vec3f> albedos;  // of each point
  std::vector<Vec3f> radiance; // of each point by the light that was baked, matt; unit: kcd/m2
};

struct BakedScene {
  std::vector<BakedLight> nodes;  // one a node of each placed mesh, in the order of first_light
  AirLight air;                   // of the same light
  BakeLinks links;                // empty under an open sky
};

// Every node and all air as if nothing stood around: the sky alone.
BakedScene open_sky_light(const PreparedScene& scene, const LightSet& light);

// Albedo for light from all around of a place on a triangle (weights of its second and third corner), the
// mean over some centimetres. Called from several threads.
using AlbedoAt = std::function<Vec3f(const RayScene::Triangle& triangle, float u, float v)>;

// rays: of that scene. progress: called with the done fraction, on the calling thread.
BakedScene bake_light(const PreparedScene& scene, SceneRays& rays, const LightSet& light, const AlbedoAt& albedo,
                      const BakeOptions& options, const std::function<void(double)>& progress);

// The same by way of the disk cache: made only if it is not there. surfaces: what the albedos follow from
// besides the scene, as a hash.
BakedScene bake_light_once(const DiskCache& cache, const PreparedScene& scene, SceneRays& rays,
                           const LightSet& light, const AlbedoAt& albedo, const std::string& surfaces, const BakeOptions& options,
                           const std::function<void(double)>& progress);

}  // namespace rubble
