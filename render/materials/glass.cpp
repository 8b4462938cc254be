#include "render/materials/glass.h"

#include <algorithm>
#include <cmath>

#include "render/materials/surface_appearance.h"

namespace rubble {

namespace {

constexpr float kLeastCosine = 0.01f;

// Of one polarisation. face: share that one face mirrors; clear: that the glass lets through on one crossing.
float mirrored(float face, float clear) {
  const float first = 1 - face, through = clear * clear;
  return face + face * first * first * through / (1 - face * face * through);
}
float passed(float face, float clear) {
  const float first = 1 - face;
  return first * first * clear / (1 - face * face * clear * clear);
}

}  // namespace

std::uint32_t glass_appearance() {
  static const std::uint32_t look = find_surface_appearance(kGlassAppearance);
  return look;
}

// Fresnel's equations; the sum over all reflections between the faces is a geometric series.
SheetShares find_sheet_shares(float cosine) {
  const float c = std::clamp(cosine, kLeastCosine, 1.0f);
  const float inner = std::sqrt(1 - (1 - c * c) / (kGlassIndex * kGlassIndex));
  const float across = (c - kGlassIndex * inner) / (c + kGlassIndex * inner);
  const float along = (kGlassIndex * c - inner) / (kGlassIndex * c + inner);
  const float s = across * across, p = along * along;
  SheetShares out;
  float clear[3];
  for (int i = 0; i < 3; ++i) clear[i] = std::exp2(kGlassLog2Clear[i] / inner);
  const auto mean = [&](float a) { return 0.5f * (passed(s, a) + passed(p, a)); };
  out.passed = {mean(clear[0]), mean(clear[1]), mean(clear[2])};
  out.mirrored = 0.5f * (mirrored(s, clear[1]) + mirrored(p, clear[1]));
  return out;
}

}  // namespace rubble
