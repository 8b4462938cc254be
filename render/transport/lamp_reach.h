// What the camera's lamp may light, found anew for each place of it: distances to what lies about it in all directions.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/parallel.h"
#include "render/device/device_lamp.h"
#include "render/geometry/scene_rays.h"
#include "render/transport/scene_lights.h"

namespace rubble {

class LampReach {
 public:
  static constexpr int kSide = 80;      // of the map of distances; a direction is about 1.9 degrees wide
  static constexpr float kReach = 10;   // of the lamp's light, and of what comes of it; unit: m
  static constexpr float kFade = 2;     // over which it ends; unit: m
  static constexpr float kNear = 0.03f;   // what lies so little behind what the map says is lit; unit: m
  static constexpr float kSlack = 0.03f;  // the same, as a share of the distance

  // The scene, the rays and the pool must outlive it. counted: of each placed mesh whether it is asked for.
  LampReach(const PreparedScene& scene, SceneRays& rays, std::vector<std::uint8_t> counted, ThreadPool& pool);

  // extinction: of the air about the lamp; unit: 1/m
  void aim(const PlacedLamp& lamp, float extinction);
  const PlacedLamp& lamp() const { return lamp_; }
  float extinction() const { return extinction_; }
  const std::vector<float>& map() const { return map_; }  // octahedral, kSide by kSide, rows by y; unit: m
  const std::vector<std::uint32_t>& seen() const { return seen_; }  // placed meshes that the lamp may see, in order

  float distance_towards(const Vec3f& direction) const;  // of any length
  bool shines_on(const Vec3f& way, float away) const {  // at the end of that way from the lamp
    return away < distance_towards(way) * (1 + kSlack) + kNear;
  }
  LampAim aim_of_device() const;  // refers to this
  // The share of directions in which nothing lies within reach of the lamp.
  float open_share() const;
  // Of light so far from the lamp.
  static float kept_at(float away);

 private:
  void cast_map();
  bool may_see(const PlacedMesh& piece) const;

  const PreparedScene& scene_;
  SceneRays& rays_;
  std::vector<std::uint8_t> counted_;
  ThreadPool& pool_;
  PlacedLamp lamp_;
  float extinction_ = 0;
  std::vector<float> map_;
  std::vector<std::uint32_t> seen_;
};

}  // namespace rubble
