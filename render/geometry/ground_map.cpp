#include "render/geometry/ground_map.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/quick_math.h"
#include "render/materials/tile_noise.h"

namespace rubble {

namespace {

constexpr int kSide = GroundMap::kSide;
constexpr float kSpread = 0.7f;    // how far fines lie from a piece; unit: m
constexpr float kLarge = 0.2f;     // radius of pieces that shed as much as any; unit: m
constexpr float kTooHigh = 1.2f;   // what lies higher sheds onto other pieces; unit: m
constexpr float kToneTile = 60;    // repetition of the tone; unit: m

float from_texel(int i) {
  const float s = (float(i) + 0.5f) / kSide * 2 - 1;
  return s / (1 - std::fabs(s));
}

int to_texel(float a) {
  const float s = 0.5f + 0.5f * a / (1 + std::fabs(a));
  return std::clamp(int(s * kSide), 0, kSide - 1);
}

float tone_at(float x, float y) {
  const float u = x / kToneTile, v = y / kToneTile;
  return tile_fractal(u - std::floor(u), v - std::floor(v), 9, 6, 0.6f, 201);
}

}  // namespace

GroundMap make_ground_map(const PreparedScene& scene) {
  GroundMap map;
  if (!scene.bounds.empty()) {
    const Vec3 middle = (scene.bounds.min + scene.bounds.max) * 0.5;
    const Vec3 half = (scene.bounds.max - scene.bounds.min) * 0.5;
    map.x = float(middle.x), map.y = float(middle.y);
    map.reach = float(std::clamp(std::max(half.x, half.y), 1.0, 60.0));
  }
  std::vector<float> cover(std::size_t(kSide) * kSide);
  for (const PlacedMesh& piece : scene.placed) {
    if (piece.id == kGroundId || piece.surrounds || piece.centre.z - piece.radius > kTooHigh) continue;
    const float inner = 0.8f * piece.radius, outer = piece.radius + kSpread;
    const float strength = 0.8f * std::min(1.0f, piece.radius / kLarge);
    const auto texel = [&](float x, float middle) { return to_texel((x - middle) / map.reach); };
    for (int j = texel(piece.centre.y - outer, map.y); j <= texel(piece.centre.y + outer, map.y); ++j) {
      const float dy = map.y + from_texel(j) * map.reach - piece.centre.y;
      for (int i = texel(piece.centre.x - outer, map.x); i <= texel(piece.centre.x + outer, map.x);
           ++i) {
        const float dx = map.x + from_texel(i) * map.reach - piece.centre.x;
        const float t = std::clamp((outer - std::sqrt(dx * dx + dy * dy)) / (outer - inner), 0.0f, 1.0f);
        cover[std::size_t(j * kSide + i)] += strength * t * t;
      }
    }
  }
  map.texels.resize(cover.size() * 2);
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const std::size_t at = std::size_t(j * kSide + i);
      const float tone = tone_at(map.x + from_texel(i) * map.reach, map.y + from_texel(j) * map.reach);
      map.texels[at * 2] = std::uint8_t(std::lround(255 * (1 - quick::exp(-cover[at]))));
      map.texels[at * 2 + 1] = std::uint8_t(std::lround(255 * std::clamp(tone, 0.0f, 1.0f)));
    }
  }
  return map;
}

}  // namespace rubble
