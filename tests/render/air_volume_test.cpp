// The table of the air beside the medium that it is made from, by every instruction set.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "render/media/air_box.h"
#include "render/media/air_volume.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace air_volume_test {

struct Case {
  const char* name;
  AirSpec air;
  double most;      // difference of the transmittance
  double farthest;  // unit: m
};

AirSpec thinning() {
  AirSpec air;
  air.fog_density = 0.2, air.fog_height = 1.5;
  return air;
}

AirSpec dusty() {
  AirSpec air = thinning();
  air.dust.period = 1, air.dust.density = 3, air.dust.half_life = 4,
  air.dust.position = {2, 0.5, 0.5};
  return air;
}

AirSpec billowing() {
  AirSpec air = thinning();
  air.fog_noise = 0.7, air.fog_noise_size = 3;
  return air;
}

AirSpec rainy() {
  AirSpec air = thinning();
  air.rain_mm_h = 20;
  return air;
}

std::vector<Case> cases() {
  // Billows are sampled once a slice here and in steps there: far away slices are wider than
  // billows.
  return {{"thinning", thinning(), 1e-5, 300},
          {"dusty", dusty(), 2e-5, 300},
          {"rainy", rainy(), 1e-5, 300},
          {"billowing", billowing(), 0.03, 6}};
}

ViewRays view() { return {0, pinhole(192, 192, 100), look_at({-1, 0, 1}, {3, 0.4, 0.6})}; }

// Where the middle ray of a rectangle of the table goes.
Vec3 direction(const ViewRays& rays, int column, int row) {
  const Intrinsics& k = rays.intrinsics;
  const double u = (column + 0.5) * k.width / AirVolume::kColumns - 0.5,
               v = (row + 0.5) * k.height / AirVolume::kRows - 0.5;
  return rays.pose(0).rotation.rotate(normalized(Vec3((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1)));
}

class AirTable {
 public:
  AirTable() : scene_(make_heap(1, 1)), lights_(make_lights(scene_)), pool_(2) {
    baked_.radiance = {{0.1f, 0.2f, 0.3f}};
  }

  const std::vector<std::array<float, 4>>& build(const Air& air, const std::vector<float>& farthest,
                                                 const WideShader& shader) {
    const LitAir lit{baked_, lights_, nullptr, Aabb{{-5, -5, -1}, {5, 5, 4}}};
    volume_.prepare(view_, air, lit, nullptr, false, farthest);
    return volume_.table(shader, pool_);
  }
  static std::size_t at(int column, int row, int slice) {
    return (std::size_t(slice) * AirVolume::kRows + std::size_t(row)) * AirVolume::kColumns +
           std::size_t(column);
  }

 private:
  const ViewRays view_ = view();
  Scene scene_;
  LightSet lights_;
  AirLight baked_;
  ThreadPool pool_;
  AirVolume volume_;
};

TEST(AirVolume, LetsThroughWhatTheMediumSays) {
  for (const Case& c : cases()) {
    const Air air = Medium(c.air, 7).at(2.3);
    for (const WideShader& shader : wide_shaders()) {
      AirTable table;
      const auto& found = table.build(air, {}, shader);
      double least = 1;
      for (int row = 3; row < AirVolume::kRows; row += 19)
        for (int column = 2; column < AirVolume::kColumns; column += 17)
          for (int slice = 0; slice < AirVolume::kSlices; slice += 3) {
            const double way = AirVolume::slice_distance(slice);
            if (way > c.farthest) break;
            const double expected =
                std::exp(-air.optical_depth({-1, 0, 1}, direction(view(), column, row), way));
            ASSERT_NEAR(double(found[AirTable::at(column, row, slice)][3]), expected, c.most)
                << c.name << ", " << shader.name << ", " << column << ", " << row << ", " << slice;
            least = std::min(least, expected);
          }
      EXPECT_LT(least, 0.4) << c.name;  // the air is thick enough to tell
    }
  }
}

// Up to the distance that is asked for the table is as without one, to the bit; beyond it is left
// alone.
TEST(AirVolume, EndsWhereNobodyReadsOn) {
  const Air air = Medium(dusty(), 7).at(2.3);
  AirTable whole, part;
  const auto expected = whole.build(air, {}, wide_shaders().front());
  const std::vector<float> farthest(std::size_t(AirVolume::kColumns) * AirVolume::kRows, 3.0f);
  const auto& found = part.build(air, farthest, wide_shaders().front());
  int within = 0, wanted = 0, beyond = 0;
  for (int slice = 0; slice < AirVolume::kSlices; ++slice) {
    const bool read = slice == 0 || AirVolume::slice_distance(slice - 1) <= 3;
    for (int ray = 0; ray < AirVolume::kColumns * AirVolume::kRows; ++ray) {
      const std::size_t i =
          AirTable::at(ray % AirVolume::kColumns, ray / AirVolume::kColumns, slice);
      within += read && found[i] == expected[i], wanted += read;
      beyond += !read && found[i] == std::array<float, 4>{};
    }
  }
  EXPECT_EQ(within, wanted);
  EXPECT_GT(wanted, AirVolume::kColumns * AirVolume::kRows);
  EXPECT_GT(beyond, 0);
}

}  // namespace air_volume_test
}  // namespace rubble::testing
