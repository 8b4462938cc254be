// Small pictures against stored ones, with a limit on the largest and one on the mean difference.
// Not hashes: other processors draw with other vector widths, and so with other last bits.
//
// A test that fails writes expected, found and difference side by side and prints the path.
// RUBBLE_UPDATE_GOLDENS=1 stores what is drawn now; look at it before it is committed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <cmath>
#include <functional>

#include "io/image/image_file.h"
#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace image_golden_test {

namespace fs = std::filesystem;

constexpr int kSide = 96;
// Of means over 3 by 3 pixels, so that an edge that falls on the other side of a pixel's centre does
// not count; unit: step of 255.
constexpr double kMostDifference = 24, kMostMean = 1.0;

struct Difference {
  double most = 0, mean = 0;
};

// The mean over the 3 by 3 pixels around a pixel.
double around(const RgbImage& image, int x, int y, int c) {
  double sum = 0;
  for (int v = y - 1; v <= y + 1; ++v)
    for (int u = x - 1; u <= x + 1; ++u)
      sum += image.rgb[std::size_t((v * image.width + u) * 3 + c)];
  return sum / 9;
}

Difference compare(const RgbImage& a, const RgbImage& b) {
  Difference out;
  int count = 0;
  for (int y = 1; y + 1 < a.height; ++y)
    for (int x = 1; x + 1 < a.width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double d = std::fabs(around(a, x, y, c) - around(b, x, y, c));
        out.most = std::max(out.most, d), out.mean += d, ++count;
      }
  out.mean /= count;
  return out;
}

// Expected, found, and four times the difference about grey.
RgbImage side_by_side(const RgbImage& expected, const RgbImage& found) {
  RgbImage out{3 * expected.width, expected.height, {}};
  for (int y = 0; y < expected.height; ++y) {
    const std::size_t row = std::size_t(y * expected.width) * 3, end = std::size_t(expected.width) * 3;
    for (std::size_t i = 0; i < end; ++i) out.rgb.push_back(expected.rgb[row + i]);
    for (std::size_t i = 0; i < end; ++i) out.rgb.push_back(found.rgb[row + i]);
    for (std::size_t i = 0; i < end; ++i)
      out.rgb.push_back(std::uint8_t(
          std::clamp(128 + 4 * (int(found.rgb[row + i]) - int(expected.rgb[row + i])), 0, 255)));
  }
  return out;
}

struct View {
  const char* name;
  Vec3 eye, target;
  std::function<void(Scene&)> change;
};

RgbImage draw(Device& device, const View& view, const std::function<void(Scene&)>& more = {},
              int pieces = 220) {
  Scene scene = make_heap(pieces, 7);
  scene.lamp.on = false;
  if (view.change) view.change(scene);
  if (more) more(scene);
  RenderOptions options;
  options.threads = 2;
  options.texture_size = 256, options.bake_rays = 64;
  const char* cache = std::getenv("RUBBLE_CACHE");
  options.cache_folder = cache ? cache : "";
  Renderer renderer(device, scene, options);
  const Frame frame = renderer.render(look_at(view.eye, view.target),
                                      pinhole(kSide, kSide, 0.6 * kSide), 0, 1000000000);
  return {kSide, kSide, frame.rgb};
}

const std::vector<View>& views() {
  const Vec3 outside(7, 3, 2), middle(0, 0, 0.6), inside(1.6, 0.3, 0.6), wall(-1.5, 0, 0.5);
  static const std::vector<View> all{
      {"noon", outside, middle, {}},
      {"dusk", outside, middle,
       [](Scene& s) {
         s.light.type = LightType::sun;
         s.light.elevation_deg = -3;
       }},
      {"fog", outside, middle,
       [](Scene& s) {
         s.air.fog_density = 0.15;
         s.air.fog_height = 2;
         s.air.fog_noise = 0.8;
       }},
      {"void_dark", {-1.2, 0.2, 0.6}, {2, 0, 0.55}, {}},
      {"void_lamp", inside, wall, [](Scene& s) { s.lamp.on = true; }},
      {"void_wet_ring", inside, wall,
       [](Scene& s) {
         s.lamp.on = true;
         s.lamp.shape = LampShape::ring;
         s.wetness = 1;
         s.light.type = LightType::point;
         s.light.intensity = 0.1;
         s.light.position = {0, 0, 1};
       }}};
  return all;
}

fs::path golden_path(const View& view) {
  return fs::path(RUBBLE_SOURCE_DIR) / "tests/golden/images" / (std::string(view.name) + ".png");
}

class ImageGolden : public ::testing::TestWithParam<std::size_t> {};

TEST_P(ImageGolden, LooksAsStored) {
  const View& view = views()[GetParam()];
  SoftwareDevice device;
  const RgbImage found = draw(device, view);
  if (std::getenv("RUBBLE_UPDATE_GOLDENS")) {
    write_png(golden_path(view).string(), found, 9);
    GTEST_SKIP() << "stored anew: " << golden_path(view);
  }
  const RgbImage expected = read_rgb_png(golden_path(view).string());
  ASSERT_EQ(expected.width, found.width);
  ASSERT_EQ(expected.height, found.height);
  const Difference difference = compare(expected, found);
  RecordProperty("most", std::to_string(difference.most));
  RecordProperty("mean", std::to_string(difference.mean));
  if (difference.most <= kMostDifference && difference.mean <= kMostMean) return;
  const fs::path picture = fs::temp_directory_path() / ("golden_" + std::string(view.name) + ".png");
  write_png(picture.string(), side_by_side(expected, found), 6);
  ADD_FAILURE() << view.name << ": largest difference " << difference.most << " (at most "
                << kMostDifference << "), mean " << difference.mean << " (at most " << kMostMean
                << "); expected, found and difference: " << picture.string();
}

INSTANTIATE_TEST_SUITE_P(Views, ImageGolden, ::testing::Range(std::size_t{0}, views().size()),
                         [](const auto& view) { return std::string(views()[view.param].name); });

// The limits tell what a person would see: another place of the sun, thin fog, wet surfaces.
TEST(ImageGoldenControl, FailsForWhatAPersonWouldSee) {
  SoftwareDevice device;
  const View& noon = views()[0];
  const RgbImage expected = draw(device, noon, {}, 30);
  const auto fails = [&](const std::function<void(Scene&)>& change) {
    const Difference d = compare(expected, draw(device, noon, change, 30));
    return d.most > kMostDifference || d.mean > kMostMean;
  };
  EXPECT_FALSE(fails([](Scene&) {}));
  EXPECT_TRUE(fails([](Scene& s) { s.light.rpy_deg.z += 12; }));
  EXPECT_TRUE(fails([](Scene& s) { s.air.fog_density = 0.02; }));
  EXPECT_TRUE(fails([](Scene& s) { s.wetness = 0.4; }));
}

TEST(ImageGoldenControl, ComparesWhatIsStored) {
  const RgbImage noon = read_rgb_png(golden_path(views()[0]).string());
  RgbImage spot = noon;
  for (int y = 40; y < 44; ++y)
    for (int x = 40; x < 44; ++x) spot.rgb[std::size_t((y * kSide + x) * 3)] ^= 0x60;
  EXPECT_GT(compare(noon, spot).most, kMostDifference);
  EXPECT_EQ(compare(noon, noon).most, 0);
}

}  // namespace image_golden_test
}  // namespace rubble::testing
