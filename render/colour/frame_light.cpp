#include "render/colour/frame_light.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/base/quick_math.h"

namespace rubble {

namespace {

float grey_of(const Vec3f& c) { return dot(c, Vec3f(0.2126f, 0.7152f, 0.0722f)); }

}  // namespace

// At its highest that counts: seen and lit head-on.
float mirrored_peak(float reflectance, float roughness) {
  return reflectance > 0 ? reflectance / (4 * roughness * roughness) : 0;
}

Vec3f lamp_colour(const LampSpec& lamp) {
  // White light-emitting diodes, a little cold; luminance 1 by Rec. 709 weights.
  const Vec3f tint(0.96f, 1.0f, 1.12f);
  return tint *
         float(lamp.intensity_cd * 1e-3 / double(dot(tint, Vec3f(0.2126f, 0.7152f, 0.0722f))));
}

Vec3f white_balance(const LightSet& set) {
  const LightModel& main = set.lights.front();
  Vec3f light = set.sky.mean * portable::kPiF;
  if (main.type == LightType::directional) light += main.colour * std::max(-main.axis.z, 0.0f);
  // Under street lamps theirs is the light, as some metres below them.
  if (!set.far.empty()) light += set.far.front().colour * (1.0f / 50);
  const float bright = grey_of(light);
  if (bright <= 0) return {1, 1, 1};
  // Less at dusk, which is to look blue: 0.75 in daylight, 0.35 at 10 lx.
  const float adapted = std::clamp(0.35f + 0.1f * quick::log10(bright * 100), 0.35f, 0.75f);
  const auto gain = [&](float c) { return 1 / (1 + adapted * (c / bright - 1)); };
  const Vec3f gains(gain(light.x), gain(light.y), gain(light.z));
  return gains * (1 / grey_of(gains));
}

}  // namespace rubble
