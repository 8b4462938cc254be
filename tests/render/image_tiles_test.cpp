// Which parts of an image are coloured by which shader, and that leaving light out does not show.
#include "render/devices/gl/image_tiles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "render/colour/frame_light.h"
#include "render/devices/software/software_device.h"
#include "render/lighting/exposure.h"
#include "render/reference/display.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace image_tiles_test {

// 100 by 70: tiles at the right and lower edge are cut. Sky above, ground from row 40 on, the left
// half of it near.
std::vector<float> make_landscape() {
  std::vector<float> values(100 * 70, 0);
  for (int y = 40; y < 70; ++y)
    for (int x = 0; x < 100; ++x) values[std::size_t(y * 100 + x)] = x < 50 ? 0.01f : 0.0001f;
  return values;
}

TEST(ImageTiles, CoverEveryPixelOnceWithAContentThatHoldsThere) {
  const std::vector<float> values = make_landscape();
  ThreadPool pool(3);
  const ImageTiles tiles = cut_into_tiles(values, 100, 70, 0.001f, pool);
  std::vector<int> covered(values.size(), 0);
  int of_content[4] = {};
  for (const TileRun& run : tiles.runs) {
    ++of_content[int(run.content)];
    for (int y = run.y; y < run.y + run.height; ++y) {
      for (int x = run.x; x < run.x + run.width; ++x) {
        const std::size_t i = std::size_t(y * 100 + x);
        ++covered[i];
        if (run.content == TileContent::sky) {
          EXPECT_EQ(values[i], 0);
        }
        if (run.content == TileContent::surfaces) {
          EXPECT_GT(values[i], 0);
        }
        if (run.content == TileContent::near_surfaces) {
          EXPECT_GT(values[i], 0.001f);
        }
      }
    }
  }
  for (const int times : covered) ASSERT_EQ(times, 1);
  for (const int runs : of_content) EXPECT_GT(runs, 0);
  EXPECT_EQ(tiles.first_row, 32);
  EXPECT_EQ(tiles.last_row, 70);
  EXPECT_EQ(tiles.nearest_value, 0.01f);
}

TEST(ImageTiles, OfSkyAloneHaveNoRows) {
  ThreadPool pool(1);
  const ImageTiles tiles = cut_into_tiles(std::vector<float>(64 * 64, 0), 64, 64, 0.001f, pool);
  ASSERT_EQ(tiles.runs.size(), 2u);
  EXPECT_EQ(tiles.first_row, tiles.last_row);
  EXPECT_EQ(tiles.nearest_value, 0);
}

// The largest difference that the camera's lamp makes in the 8-bit image of a heap.
int difference_by_lamp(double sun_klx, double intensity_cd) {
  Scene scene = make_heap(60, 3);
  scene.light.intensity = sun_klx;
  scene.lamp.intensity_cd = intensity_cd;
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 256;
  options.texture_size = 32;
  options.fixed_exposure = 0.02;
  SoftwareDevice device;
  const auto draw = [&](bool lamp) {
    scene.lamp.on = lamp;
    return Renderer(device, scene, options)
        .render(look_at({5, 2, 2.5}, {0, 0, 0.3}), pinhole(160, 120, 100), 0, 0);
  };
  const Frame with = draw(true), without = draw(false);
  int most = 0;
  for (std::size_t i = 0; i < with.rgb.size(); ++i)
    most = std::max(most, std::abs(int(with.rgb[i]) - int(without.rgb[i])));
  return most;
}

TEST(LampInDaylight, IsLeftOutOnlyWhereItCannotBeSeen) {
  EXPECT_LE(difference_by_lamp(80, 5), 1);
  EXPECT_GT(difference_by_lamp(80, 5000), 3);  // too strong to be left out
}

// The largest difference of the 8-bit image of a heap from all of the light there, which nothing is left out of.
int difference_from_all_light(double sun_klx, double intensity_cd, bool bake) {
  constexpr int kWidth = 96, kHeight = 72;
  Scene scene = make_heap(25, 3);
  scene.light.intensity = sun_klx;
  scene.lamp.intensity_cd = intensity_cd;
  RenderOptions options = cached_options();
  options.shadow_size = 256, options.texture_size = 32, options.bake_rays = 16;
  options.antialias = false;
  const Pose eye = look_at({5, 2, 2.5}, {0, 0, 0.3});
  const Intrinsics k = pinhole(kWidth, kHeight, 60);
  SoftwareDevice device;
  const std::vector<float> all = Renderer(device, scene, options).render_linear(eye, k).rgb;
  options.bake = bake;
  const std::vector<std::uint8_t> shown = Renderer(device, scene, options).render(eye, k, 0, 0).rgb;
  const Vec3f gains = white_balance(make_lights(scene));
  const float exposure = find_exposure({0.21, 0}, meter_image(all, kWidth, kHeight, gains));
  const std::vector<std::uint8_t> expected = develop_image(all, kWidth, kHeight, gains, exposure);
  int most = 0;
  for (std::size_t i = 0; i < shown.size(); ++i)
    most = std::max(most, std::abs(int(shown[i]) - int(expected[i / 3 * 4 + i % 3])));
  return most;
}

TEST(LampInDaylight, ComesByWayOfSurfacesWhereItCanBeSeen) {
  EXPECT_LE(difference_from_all_light(80, 5, true), 2);
  EXPECT_LE(difference_from_all_light(0.001, 50, true), 2);
  EXPECT_GT(difference_from_all_light(0.001, 50, false), 8);  // without baked points there is no such light
}

}  // namespace image_tiles_test
}  // namespace rubble::testing
