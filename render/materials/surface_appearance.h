// The surfaces that meshes may name, and what each looks like.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

// Which procedural texture a look uses; see textures.h.
enum class Pattern {
  cast_concrete,
  broken_concrete,
  brick_face,
  broken_brick,
  porous_block,
  rust,
  galvanised,
  wood,
  plaster,
  soil,
  splinters,
  paint,
  weave,
  smooth,
  masonry
};
inline constexpr int kPatternCount = 15;

// So many looks fit into a triangle's word for the shaders: see find_look() in shaders/geometry.glsl.
inline constexpr std::uint32_t kMaxSurfaceAppearances = 45;

// How a surface reflects. Colours are linear-light albedos (0 to 1).
struct SurfaceAppearance {
  const char* name;   // as meshes name it: "concrete_cast"
  Pattern pattern;    // of its texture
  Vec3f dark, light;  // albedo where the texture is darkest and brightest
  Vec3f accent;       // albedo of what the texture's mask picks out: stains, grains, mortar
  float tile;         // side of one repetition; unit: m
  float bump;         // strength of the relief; 0: flat
  float dust;         // share of dust that rests on it facing up; range: 0 to 1
  float variation;    // how much brightness differs from piece to piece; range: 0 to 1
  // See transport/reflection.h: the share that its outermost face mirrors at normal incidence (0: matt), and
  // the roughness alpha of that mirror.
  float reflectance = 0, roughness = 1;
  float glow = 0;  // luminance that it shines with, seen from anywhere; it lights nothing; unit: kcd/m2
};

// The look of surfaces that have a paint instead (kernel/base/mesh.h), which no mesh may name.
inline constexpr const char* kPaintedAppearance = "painted";

// All of them, in a fixed order; the last is the ground's.
const std::vector<SurfaceAppearance>& all_surface_appearances();

// Mean red albedo of a surface, dust included, for light just beyond red. up: the Z part of its
// unit normal in the world.
float mean_red_albedo(const SurfaceAppearance& look, float up);

// The names that meshes may use.
std::vector<std::string> known_surface_appearances();

// Index into all_surface_appearances(). Throws RunError naming the unknown look and the known ones.
std::uint32_t find_surface_appearance(const std::string& name);

}  // namespace rubble
