#include "render/materials/surface_appearance.h"

#include <algorithm>

#include "kernel/base/error.h"

namespace rubble {

// Albedos after published tables: concrete 0.2-0.4, brick 0.2-0.3, dry soil 0.25-0.35, weathered
// zinc 0.4, softwood 0.3-0.5, gypsum plaster 0.6-0.8, tyres 0.03-0.05. The colours within them are our choice.
// Reflectances at normal incidence by Fresnel's equations: lacquer and rubber of index 1.5 give 0.04, a
// pane's two faces 0.08; iron oxide of 2.2 gives 0.14, much of it rough; weathered zinc 0.4. The
// roughnesses are our choice.
const std::vector<SurfaceAppearance>& all_surface_appearances() {
  static const std::vector<SurfaceAppearance> looks = {
      {"concrete_cast",
       Pattern::cast_concrete,
       {0.13f, 0.13f, 0.126f},
       {0.42f, 0.415f, 0.40f},
       {0.21f, 0.19f, 0.16f},
       1.7f,
       0.5f,
       0.55f,
       0.30f},
      {"concrete_fracture",
       Pattern::broken_concrete,
       {0.10f, 0.096f, 0.09f},
       {0.43f, 0.415f, 0.385f},
       {0.25f, 0.205f, 0.165f},
       0.8f,
       1.0f,
       0.6f,
       0.22f},
      {"brick",
       Pattern::brick_face,
       {0.15f, 0.052f, 0.032f},
       {0.37f, 0.145f, 0.085f},
       {0.34f, 0.31f, 0.275f},
       0.8f,
       0.6f,
       0.5f,
       0.40f},
      {"brick_fracture",
       Pattern::broken_brick,
       {0.19f, 0.062f, 0.034f},
       {0.46f, 0.19f, 0.105f},
       {0.11f, 0.05f, 0.04f},
       0.4f,
       1.0f,
       0.5f,
       0.30f},
      {"cinder_block",
       Pattern::porous_block,
       {0.11f, 0.11f, 0.108f},
       {0.33f, 0.325f, 0.315f},
       {0.08f, 0.078f, 0.075f},
       0.5f,
       0.9f,
       0.5f,
       0.25f},
      {"rebar",
       Pattern::rust,
       {0.055f, 0.024f, 0.013f},
       {0.235f, 0.098f, 0.042f},
       {0.10f, 0.095f, 0.09f},
       0.25f,
       0.6f,
       0.3f,
       0.30f,
       0.08f,
       0.4f},
      {"steel_galvanised",
       Pattern::galvanised,
       {0.26f, 0.27f, 0.28f},
       {0.46f, 0.475f, 0.49f},
       {0.30f, 0.20f, 0.13f},
       0.5f,
       0.15f,
       0.6f,
       0.15f,
       0.4f,
       0.3f},
      {"timber",
       Pattern::wood,
       {0.15f, 0.105f, 0.068f},
       {0.43f, 0.33f, 0.225f},
       {0.09f, 0.062f, 0.042f},
       0.8f,
       0.5f,
       0.7f,
       0.40f},
      {"plaster",
       Pattern::plaster,
       {0.42f, 0.41f, 0.385f},
       {0.66f, 0.645f, 0.61f},
       {0.46f, 0.50f, 0.47f},
       1.3f,
       0.35f,
       0.6f,
       0.18f},
      {"steel_rusty",
       Pattern::rust,
       {0.05f, 0.026f, 0.016f},
       {0.2f, 0.095f, 0.05f},
       {0.13f, 0.125f, 0.12f},
       0.9f,
       0.5f,
       0.4f,
       0.25f,
       0.08f,
       0.4f},
      {"timber_fracture",
       Pattern::splinters,
       {0.26f, 0.165f, 0.085f},
       {0.58f, 0.44f, 0.27f},
       {0.1f, 0.06f, 0.035f},
       0.4f,
       1.0f,
       0.5f,
       0.3f},
      {"drywall",
       Pattern::plaster,
       {0.48f, 0.47f, 0.44f},
       {0.7f, 0.685f, 0.65f},
       {0.52f, 0.53f, 0.5f},
       1.6f,
       0.25f,
       0.6f,
       0.12f},
      {"drywall_core",
       Pattern::plaster,
       {0.52f, 0.51f, 0.49f},
       {0.78f, 0.77f, 0.75f},
       {0.6f, 0.585f, 0.56f},
       0.35f,
       0.9f,
       0.5f,
       0.1f},
      {"car_paint",
       Pattern::paint,
       {0.03f, 0.055f, 0.085f},
       {0.062f, 0.105f, 0.155f},
       {0.115f, 0.085f, 0.068f},
       1.2f,
       0.2f,
       0.6f,
       0.75f,
       0.045f,
       0.08f},
      {"glass",
       Pattern::smooth,
       {0.02f, 0.03f, 0.028f},
       {0.045f, 0.06f, 0.056f},
       {0.2f, 0.2f, 0.19f},
       0.8f,
       0.1f,
       0.5f,
       0.1f,
       0.08f,
       0.03f},
      {"fabric",
       Pattern::weave,
       {0.085f, 0.085f, 0.1f},
       {0.24f, 0.23f, 0.23f},
       {0.15f, 0.11f, 0.08f},
       0.12f,
       0.8f,
       0.7f,
       0.55f},
      {"rubber",
       Pattern::smooth,
       {0.018f, 0.018f, 0.018f},
       {0.045f, 0.044f, 0.043f},
       {0.11f, 0.105f, 0.1f},
       0.4f,
       0.6f,
       0.7f,
       0.2f,
       0.04f,
       0.45f},
      {"ground",
       Pattern::soil,
       {0.095f, 0.079f, 0.061f},
       {0.33f, 0.285f, 0.23f},
       {0.34f, 0.325f, 0.30f},
       2.3f,
       0.9f,
       0.12f,
       0.0f},
  };
  return looks;
}

// As shaders/surface.glsl mixes them, with its texture at its mean.
float mean_red_albedo(const SurfaceAppearance& look, float up) {
  const float t = std::clamp((up - 0.26f) / 0.75f, 0.0f, 1.0f);
  const float dust = t * t * (3 - 2 * t) * look.dust;
  return 0.5f * (look.dark.x + look.light.x) * (1 - dust) + 0.34f * dust;
}

std::vector<std::string> known_surface_appearances() {
  std::vector<std::string> names;
  for (const SurfaceAppearance& look : all_surface_appearances())
    if (look.name != std::string("ground")) names.push_back(look.name);
  return names;
}

std::uint32_t find_surface_appearance(const std::string& name) {
  const std::vector<SurfaceAppearance>& looks = all_surface_appearances();
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (name == looks[i].name) return std::uint32_t(i);
  std::string known;
  for (const std::string& n : known_surface_appearances()) known += (known.empty() ? "" : ", ") + n;
  throw RunError("unknown surface \"" + name + "\"; the known ones are " + known);
}

}  // namespace rubble
