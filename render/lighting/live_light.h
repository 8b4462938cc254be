// Light by way of the sky and other surfaces for a scene in which something moves, as of one moment.
//
// The light of what rests is baked. A grid of probes over the scene says how bright each direction is,
// to first order in spherical harmonics, found by casting rays at the scene as it stands: first with
// dark surfaces, then with what the first pass says lights them. What moves takes its light from the
// probes; what rests keeps its baked light, less the share that the moving pieces take away, which is
// the ratio of the probes with and without them.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/geometry/ray_scene.h"
#include "render/lighting/bake.h"
#include "render/lighting/lighting.h"

namespace rubble {

class LiveLight {
 public:
  // scene: without anything that moves there. resting: the light of what rests, by first_light; what
  // it holds for the rest does not count. albedo: as the bake's. Both scene and light must outlive it.
  LiveLight(const PreparedScene& scene, const LightSet& light, std::vector<BakedLight> resting,
            const AlbedoAt& albedo, int threads);
  ~LiveLight();

  // Of every node of the scene as it stands now. A function of the scene alone: what was asked
  // before does not count.
  const std::vector<BakedLight>& update();
  const std::vector<BakedLight>& light() const { return out_; }  // of the update before

 private:
  struct Probe;
  struct Hit;
  using Grid = std::vector<Probe>;

  void find_albedos(const AlbedoAt& albedo);
  void lay_out_grid();
  Vec3f point_of(std::size_t probe) const;
  Grid solve();
  void trace(std::size_t probe, std::vector<Hit>& hits) const;
  Vec3f light_of(const Hit& hit) const;
  Probe gather(const std::vector<Hit>& hits, std::size_t first, const Grid* lit) const;
  void fill_inside(Grid& grid) const;
  Probe sample(const Grid& grid, const Vec3f& point) const;
  bool covers(const Vec3f& point) const;
  void light_moving(const PlacedMesh& piece);
  void light_resting(const PlacedMesh& piece);

  const PreparedScene& scene_;
  const LightSet& light_;
  int threads_;
  RayScene rays_;
  std::vector<Vec3f> directions_;
  std::vector<Vec3f> albedos_;  // mean over all that has a material, by material; unit: 1
  Vec3f origin_, cell_;      // of probe (0, 0, 0), and from probe to probe; unit: m
  int size_[3] = {2, 2, 2};  // probes along each axis
  std::vector<BakedLight> resting_, out_;
  Grid without_, now_;  // what rests alone; as the scene stands
};

}  // namespace rubble
