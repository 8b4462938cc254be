// The light of the camera's lamp by way of surfaces, found anew for each place of the lamp.
//
// From the lamp a map of distances is cast in all directions, which says which points of the bake it
// lights. Their light goes on over the points' links, which the bake has kept (direct-to-indirect
// transfer: Hasan et al. 2006), to the pieces that the lamp may see: once, and a second time together with
// the first, whose share stands for all further times. So its cost goes with what is about the lamp, and its
// noise lies still on the surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "render/geometry/ray_scene.h"
#include "render/lighting/bake.h"
#include "render/transport/scene_lights.h"

namespace rubble {

class LampBounce {
 public:
  // The scene must outlive it. links: of a bake of what rests there; what moves gets nothing.
  // first_point: of each placed mesh in turn, in the links; kNoPoints: it is not among them.
  static constexpr std::uint32_t kNoPoints = 0xffffffffu;
  LampBounce(const PreparedScene& scene, BakeLinks links, std::vector<std::uint32_t> first_point, int threads);

  // `base` and that light, for every node of the scene. extinction: of the air about the lamp; unit: 1/m.
  const std::vector<BakedLight>& add_to(const std::vector<BakedLight>& base, const PlacedLamp& lamp,
                                        float extinction);

 private:
  struct Point {
    Vec3f position, normal;
  };
  struct Arrived {
    Vec3f colour, vector;  // illuminance; dot(n, vector) is its strength on a normal n
  };

  void cast_map(const Vec3f& from);
  float distance_towards(const Vec3f& direction) const;
  bool may_see(const PlacedMesh& piece, const PlacedLamp& lamp) const;
  void light_points(const PlacedLamp& lamp);
  Arrived gather(std::size_t point, bool vector) const;
  void pass_on();
  void add_to_nodes(std::size_t piece, const std::vector<BakedLight>& base);

  const PreparedScene& scene_;
  BakeLinks links_;
  std::vector<std::uint32_t> first_point_;
  int threads_;
  RayScene rays_;
  std::vector<Point> points_;
  float extinction_ = 0;
  std::vector<float> map_;                // distances by direction, see distance_towards(); unit: m
  std::vector<std::uint32_t> seen_;       // placed meshes that the lamp may see
  std::vector<Vec3f> radiance_;           // of each point, matt: of its direct light, then of all
  std::vector<Arrived> arrived_;          // at each point of the seen
  std::vector<BakedLight> out_;
};

}  // namespace rubble
