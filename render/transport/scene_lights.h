// The lights of a scene as the path tracer samples them: each arrival at a point is a beam of known
// illuminance from one direction. The sun's disc and the diodes of a lamp are drawn from point by point.
#pragma once

#include <cstddef>
#include <vector>

#include "render/lighting/lighting.h"
#include "render/transport/sample_sequence.h"
#include "render/transport/sky_sampler.h"

namespace rubble {

// The lamp on the camera, where it is while one row is exposed.
struct PlacedLamp {
  Vec3f position, axis, side, up;  // of its middle; the way it looks, and across; unit vectors
  Vec3f intensity;                 // on the axis, of all diodes together; unit: kcd; black: unlit
  float cone = 1;                  // 1 / (1 - cosine of the half-power angle)
  float radius = 0;                // of its ring or disc; unit: m
  bool disc = false;               // diodes all over the disc; false: along its rim

  Vec3f diode(SamplePair u) const;  // a place of one of them
  Vec3f illuminance(const Vec3f& diode, const Vec3f& point) const;  // on a facing surface; klx
};
PlacedLamp place_lamp(const LampSpec& lamp, const Vec3f& colour, const Pose& world_from_camera);

class SceneLights {
 public:
  explicit SceneLights(const LightSet& lights);

  struct Arrival {
    Vec3f to_light;     // unit length
    Vec3f illuminance;  // on a facing surface, unshadowed; black: none arrives; unit: klx
    float distance = 0;  // unit: m; kFarAway for beams from the sky
  };
  static constexpr float kFarAway = 1e5f;

  // The lights of the place, then the camera's lamp.
  std::size_t count() const { return lights_.lights.size() + 1; }
  bool located(std::size_t light) const;  // false: a beam from very far away
  Arrival arrive(std::size_t light, const PlacedLamp& lamp, const Vec3f& point, SamplePair u) const;
  // Where it shines from, for one that is located.
  Vec3f place(std::size_t light, const PlacedLamp& lamp, SamplePair u) const;
  Vec3f illuminance_from(std::size_t light, const PlacedLamp& lamp, const Vec3f& place,
                         const Vec3f& point) const;

  Vec3f sky(const Vec3f& direction) const { return lights_.sky.radiance(direction); }
  const SkySampler& sky_sampler() const { return sky_sampler_; }
  // As the eye meets it: with the sun's disc, and trees and roofs far away; shaders/lighting.glsl.
  Vec3f backdrop(const Vec3f& direction) const;

 private:
  LightSet lights_;
  SkySampler sky_sampler_;
  Vec3f skyline_;  // unit: kcd/m2
};

}  // namespace rubble
