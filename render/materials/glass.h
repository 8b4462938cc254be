// Sheets of glass: how much a pane mirrors, and how much goes straight through it. Unpolarised light, both
// faces with all reflections between them; what passes is not displaced, for a pane is thin.
#pragma once

#include <cstdint>

#include "kernel/base/math.h"

namespace rubble {

inline constexpr const char* kGlassAppearance = "glass";  // the look that is clear
std::uint32_t glass_appearance();                          // its index into all_surface_appearances()

inline constexpr float kGlassIndex = 1.52f;  // refractive index of soda-lime glass
// What the glass itself lets through on its way straight through a sheet, 0.86, 0.905 and 0.875, as binary logarithms:
// with both faces 0.79, 0.83 and 0.80, as the green safety glass of cars.
inline constexpr float kGlassLog2Clear[3] = {-0.21759f, -0.14401f, -0.19265f};
// Share of a sheet that dust and dirt cover wherever it faces: kHazeLeast + kHazeMore times the brightness of its
// texture; our choice.
inline constexpr float kHazeLeast = 0.03f, kHazeMore = 0.11f;
// Of the share of dust that lies on other things that face up as much: a pane keeps less of it; our choice.
inline constexpr float kGlassDust = 0.45f;
inline constexpr float kMeanHaze = kHazeLeast + 0.5f * kHazeMore;

struct SheetShares {
  float mirrored = 0;  // of green light; the other colours differ by a fiftieth of it
  Vec3f passed;        // straight on
};
// Of clean glass; cosine: of the light with the normal, on either side.
SheetShares find_sheet_shares(float cosine);

}  // namespace rubble
