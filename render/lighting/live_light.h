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
#include "render/lighting/probe_grid.h"

namespace rubble {

class LiveLight {
 public:
  // scene: without anything that moves there. resting: the light of what rests, by first_light; what
  // it holds for the rest does not count, and what is not known yet is nothing. albedo: as the bake's. Both scene and light must outlive it.
  LiveLight(const PreparedScene& scene, const LightSet& light, LightTable resting,
            const AlbedoAt& albedo, int threads);
  ~LiveLight();

  // Of every node of the scene as it stands now. A function of the scene alone: what was asked
  // before does not count.
  const LightTable& update();
  const LightTable& light() const { return out_; }  // of the update before
  // The light of what rests at all nodes of a placed mesh, which was not known before.
  void set_resting(std::uint32_t piece, const BakedLight* light);

 private:
  struct Hit;
  using Probes = ProbeGrid::Probes;
  // A node of what rests: between which probes light is looked up for it, and what they say where nothing moves.
  struct RestingNode {
    std::int32_t cell = -1;  // number of the lowest of the eight probes; -1: outside the grid
    float before = 0;        // unit: klx
  };

  // What the probes meet, and what lights them: by dark surfaces, then by what the first grid says lights these.
  // `filled` are the same grids with the probes inside pieces.
  struct Solution {
    std::vector<Hit> hits;
    Probes first, first_filled, second, filled;
  };
  // Of what moves and is there: nothing that it does reaches a ray that passes by.
  struct Sphere {
    Vec3f centre;
    float radius = 0;  // unit: m
  };

  void find_albedos(const AlbedoAt& albedo);
  void lay_out_grid();
  void find_movers();
  bool meets_mover(const Vec3f& from, const Vec3f& direction, float farthest) const;
  void solve(const Solution* resting, Solution& out);
  bool trace(std::size_t probe, const Solution* resting, std::vector<Hit>& hits) const;
  Hit trace_ray(const Vec3f& from, const Vec3f& direction) const;
  bool keeps_lights(const Hit& hit) const;
  Vec3f light_of(const Hit& hit) const;
  LightProbe gather(const std::vector<Hit>& hits, std::size_t first, const Probes* lit) const;
  Vec3f lookup_of(const Hit& hit) const;
  Vec3f lookup_of(const PlacedMesh& piece, std::size_t node, Vec3f& normal) const;
  void find_resting_nodes();
  void light_moving(const PlacedMesh& piece);
  void light_resting(const PlacedMesh& piece);

  const PreparedScene& scene_;
  const LightSet& light_;
  int threads_;
  RayScene rays_;
  std::vector<Vec3f> directions_;
  std::vector<Vec3f> albedos_;  // mean over all that has a material, by material; unit: 1
  ProbeGrid grid_;
  LightTable resting_, out_;
  std::vector<RestingNode> nodes_;  // as `resting_`, of what rests
  Solution without_, now_;       // what rests alone; as the scene stands
  std::vector<Sphere> movers_;
  std::vector<std::uint8_t> changed_;  // cells, against what rests alone
};

}  // namespace rubble
