// How much a sheet of glass mirrors and passes: the formulas of materials/glass.cpp, by the same names.
#pragma once

#include "render/materials/glass.h"
#include "render/shading/wide_math.h"

namespace rubble::RUBBLE_ISA {

struct SheetShares {
  Real mirrored;  // of green light
  Real3 passed;   // straight on
};

RUBBLE_INLINE SheetShares find_sheet_shares(Real cosine) {
  const Real c = clamp(cosine, 0.01f, 1.0f);
  const Real inner = sqrt(1.0f - (1.0f - c * c) * (1.0f / (kGlassIndex * kGlassIndex)));
  const Real across = (c - kGlassIndex * inner) / (c + kGlassIndex * inner);
  const Real along = (kGlassIndex * c - inner) / (kGlassIndex * c + inner);
  const Real faces[2] = {across * across, along * along};
  const auto passed = [&](Real clear) {
    Real sum = real(0);
    for (const Real face : faces)
      sum += (1.0f - face) * (1.0f - face) * clear / (1.0f - face * face * clear * clear);
    return sum * 0.5f;
  };
  const Real way = 1.0f / inner, green = exp2(way * kGlassLog2Clear[1]), twice = green * green;
  SheetShares out{real(0),
                  {passed(exp2(way * kGlassLog2Clear[0])), passed(green), passed(exp2(way * kGlassLog2Clear[2]))}};
  for (const Real face : faces)
    out.mirrored += 0.5f * (face + face * (1.0f - face) * (1.0f - face) * twice / (1.0f - face * face * twice));
  return out;
}

}  // namespace rubble::RUBBLE_ISA
