// rubble.terrain.rough against the spectra of ISO 8608.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scripting/mission.h"

namespace rubble {
namespace rough_ground_test {

constexpr double kPi = 3.14159265358979323846;

TerrainScenario rough(const std::string& options, int seed) {
  const std::string text = "return rubble.mission { seed = " + std::to_string(seed) + ", pile = { terrain = rubble.terrain.rough { " + options + " } } }";
  return load_mission_text(text, "m.lua").scenario.pile.terrain;
}

// Mean square of the heights along the lines of a square grid whose spatial frequency lies between two; by Fourier sums
// under a Hann window. unit: m2
double power_between(const TerrainScenario& t, double low, double high, bool along_x) {
  const int count = t.columns;
  const double per_sample = 1 / (count * t.spacing);
  double sum = 0;
  int lines = 0;
  for (int line = 0; line < count; line += 16, ++lines) {
    for (int k = int(std::ceil(low / per_sample)); k * per_sample < high; ++k) {
      double re = 0, im = 0;
      for (int i = 0; i < count; ++i) {
        const double h = t.heights[std::size_t(along_x ? line * count + i : i * count + line)];
        const double window = 0.5 - 0.5 * std::cos(2 * kPi * i / count), angle = 2 * kPi * k * i / count;
        re += window * h * std::cos(angle), im += window * h * std::sin(angle);
      }
      sum += 2 * (re * re + im * im) / (double(count) * count) / 0.375;  // 0.375: mean square of the window
    }
  }
  return sum / lines;
}

TEST(RoughGround, HasTheSpectrumOfItsClass) {
  struct Class {
    const char* name;
    double unevenness;  // at 0.1 cycles/m; unit: m3
  };
  constexpr double kLow[] = {0.1, 0.2, 0.4};  // octaves begin here; unit: cycles/m
  constexpr int kSeeds = 4;
  for (const Class& c : {Class{"B", 64e-6}, Class{"D", 1024e-6}}) {
    double power[3] = {};
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const TerrainScenario t = rough(std::string("class = '") + c.name + "', length = 40, width = 40", seed);
      for (int i = 0; i < 3; ++i) power[i] += power_between(t, kLow[i], 2 * kLow[i], true) + power_between(t, kLow[i], 2 * kLow[i], false);
    }
    for (int i = 0; i < 3; ++i) {
      const double expected = c.unevenness * 0.01 * (1 / kLow[i] - 1 / (2 * kLow[i])), share = power[i] / (2 * kSeeds) / expected;
      EXPECT_GT(share, 0.6) << c.name << " from " << kLow[i];
      EXPECT_LT(share, 1.6) << c.name << " from " << kLow[i];
    }
  }
}

TEST(RoughGround, IsLevelInTheMiddleAndRisesFromThere) {
  const TerrainScenario t = rough("level = 6, length = 40, width = 40, spacing = 0.5", 3);
  ASSERT_EQ(t.columns, 81);
  double highest = 0;
  for (int row = 0; row < t.rows; ++row) {
    for (int column = 0; column < t.columns; ++column) {
      const double h = t.heights[std::size_t(row * t.columns + column)], r = 0.5 * std::hypot(column - 40, row - 40);
      EXPECT_GE(h, 0);
      if (r <= 6) {
        EXPECT_EQ(h, 0);
      }
      highest = std::max(highest, h);
    }
  }
  EXPECT_GT(highest, 0.02);
  EXPECT_LT(highest, 0.3);
}

TEST(RoughGround, FollowsFromTheSeedAlone) {
  const std::string small = "length = 4, width = 4";
  EXPECT_EQ(rough(small, 5).heights, rough(small, 5).heights);
  EXPECT_NE(rough(small, 5).heights, rough(small, 6).heights);
  EXPECT_THROW(rough("class = 'H'", 1), InputError);
  EXPECT_THROW(rough("longest = 2, spacing = 1", 1), InputError) << "no wave fits the grid";
}

}  // namespace rough_ground_test
}  // namespace rubble
