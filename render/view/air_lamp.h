// The lamp of a camera as what shines into the air. Internal to render/.
#pragma once

#include <algorithm>

#include "kernel/base/portable_math.h"
#include "render/colour/frame_light.h"
#include "render/media/air_glow.h"

namespace rubble {

// bearer: of the lamp, in the world.
inline AirLamp glow_of(const LampSpec& lamp, const Pose& bearer) {
  AirLamp glow;
  glow.position = Vec3f(bearer * lamp.position);
  glow.axis = Vec3f(bearer.rotation.rotate({1, 0, 0}));
  glow.colour = lamp.on ? lamp_colour(lamp) : Vec3f();
  glow.cone = float(1 / (1 - portable::cos(0.5 * lamp.cone_deg * portable::kPi / 180)));
  glow.size2 = float(std::max(lamp.shape == LampShape::point ? 0.0 : 0.25 * lamp.size * lamp.size, 1e-4));
  return glow;
}

}  // namespace rubble
