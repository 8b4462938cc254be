#include "render/looks.h"

#include "kernel/base/error.h"

namespace rubble {

// Albedos after published tables: concrete 0.2-0.4, brick 0.2-0.3, dry soil 0.25-0.35, weathered
// zinc 0.4, softwood 0.3-0.5, gypsum plaster 0.6-0.8. The colours within them are our choice.
const std::vector<Look>& all_looks() {
  static const std::vector<Look> looks = {
      {"concrete_cast",
       Pattern::cast_concrete,
       {0.13f, 0.13f, 0.126f},
       {0.42f, 0.415f, 0.40f},
       {0.21f, 0.19f, 0.16f},
       1.7f,
       0.5f,
       0.0f,
       0.55f,
       0.30f},
      {"concrete_fracture",
       Pattern::broken_concrete,
       {0.10f, 0.096f, 0.09f},
       {0.43f, 0.415f, 0.385f},
       {0.25f, 0.205f, 0.165f},
       0.8f,
       1.0f,
       0.0f,
       0.6f,
       0.22f},
      {"brick",
       Pattern::brick_face,
       {0.15f, 0.052f, 0.032f},
       {0.37f, 0.145f, 0.085f},
       {0.42f, 0.39f, 0.35f},
       0.8f,
       0.6f,
       0.0f,
       0.5f,
       0.40f},
      {"brick_fracture",
       Pattern::broken_brick,
       {0.19f, 0.062f, 0.034f},
       {0.46f, 0.19f, 0.105f},
       {0.11f, 0.05f, 0.04f},
       0.4f,
       1.0f,
       0.0f,
       0.5f,
       0.30f},
      {"cinder_block",
       Pattern::porous_block,
       {0.11f, 0.11f, 0.108f},
       {0.33f, 0.325f, 0.315f},
       {0.08f, 0.078f, 0.075f},
       0.5f,
       0.9f,
       0.0f,
       0.5f,
       0.25f},
      {"rebar",
       Pattern::rust,
       {0.055f, 0.024f, 0.013f},
       {0.235f, 0.098f, 0.042f},
       {0.10f, 0.095f, 0.09f},
       0.25f,
       0.6f,
       0.03f,
       0.3f,
       0.30f},
      {"steel_galvanised",
       Pattern::galvanised,
       {0.26f, 0.27f, 0.28f},
       {0.46f, 0.475f, 0.49f},
       {0.30f, 0.20f, 0.13f},
       0.5f,
       0.15f,
       0.25f,
       0.6f,
       0.15f},
      {"timber",
       Pattern::wood,
       {0.17f, 0.10f, 0.055f},
       {0.46f, 0.32f, 0.19f},
       {0.08f, 0.05f, 0.032f},
       0.8f,
       0.5f,
       0.0f,
       0.7f,
       0.40f},
      {"plaster",
       Pattern::plaster,
       {0.42f, 0.41f, 0.385f},
       {0.66f, 0.645f, 0.61f},
       {0.46f, 0.50f, 0.47f},
       1.3f,
       0.35f,
       0.0f,
       0.6f,
       0.18f},
      {"ground",
       Pattern::soil,
       {0.085f, 0.076f, 0.064f},
       {0.30f, 0.275f, 0.24f},
       {0.37f, 0.36f, 0.34f},
       2.3f,
       0.8f,
       0.0f,
       0.12f,
       0.0f},
  };
  return looks;
}

std::vector<std::string> known_looks() {
  std::vector<std::string> names;
  for (const Look& look : all_looks())
    if (look.name != std::string("ground")) names.push_back(look.name);
  return names;
}

std::uint32_t find_look(const std::string& name) {
  const std::vector<Look>& looks = all_looks();
  for (std::size_t i = 0; i < looks.size(); ++i)
    if (name == looks[i].name) return std::uint32_t(i);
  std::string known;
  for (const std::string& n : known_looks()) known += (known.empty() ? "" : ", ") + n;
  throw RunError("unknown surface \"" + name + "\"; the known ones are " + known);
}

}  // namespace rubble
