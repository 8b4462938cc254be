// Figures of pictures against pictures whose figures are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "bench/images/image_measures.h"
#include "bench/images/picture_file.h"
#include "io/image/image_file.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace image_measures_test {

namespace fs = std::filesystem;

Luma even(int side, float value) {
  return {side, side, std::vector<float>(std::size_t(side) * std::size_t(side), value)};
}

Luma noise(int side, double deviation) {
  RandomStream random(3, "noise");
  Luma out = even(side, 128);
  for (float& v : out.values) v += float(deviation * random.normal());
  return out;
}

TEST(ImageStatistics, OfNormalNoiseAreThoseOfTheNormalLaw) {
  const ImageStatistics s = measure_image(noise(256, 20));
  EXPECT_NEAR(s.gradient_kurtosis, 3, 0.1);  // the sum of twelve uniforms has 2.9
  EXPECT_LT(s.flat_share, 0.02);
  EXPECT_NEAR(s.spectral_slope, 0, 0.05);  // white
  EXPECT_NEAR(s.mean, 128, 0.5);
}

TEST(ImageStatistics, OfAnEvenPictureAreNothing) {
  const ImageStatistics s = measure_image(even(64, 255));
  EXPECT_EQ(s.gradient_kurtosis, 0);
  EXPECT_EQ(s.flat_share, 1);
  EXPECT_EQ(s.clipped, 1);
  EXPECT_THROW(measure_image(even(31, 0)), RunError);
}

// One edge in an even picture: most differences are none, and a few are large.
TEST(ImageStatistics, OfOneEdgeHaveTheKurtosisOfItsShare) {
  Luma image = even(101, 50);
  for (int y = 0; y < 101; ++y)
    for (int x = 51; x < 101; ++x) image.values[std::size_t(y * 101 + x)] = 200;
  // Of 2 * 100 * 100 differences 100 are d, the rest 0: (100 d^4 / n) / (100 d^2 / n)^2 = n / 100.
  EXPECT_NEAR(measure_image(image).gradient_kurtosis, 200, 1e-6);
  EXPECT_NEAR(measure_image(image).flat_share, 97.0 / 99, 1e-9);
}

// A sum of waves in all directions whose amplitudes fall as f^-1.2.
TEST(ImageStatistics, FindTheSlopeOfASpectrum) {
  constexpr int kSide = 128;
  Luma image = even(kSide, 0);
  RandomStream random(5, "waves");
  std::vector<double> sum(image.values.size(), 0);
  for (int fy = -40; fy <= 40; fy += 1) {
    for (int fx = 0; fx <= 40; fx += 1) {
      const double f = std::hypot(fx, fy);
      if (f < 1 || f > 40) continue;
      const double phase = random.uniform(0, 2 * portable::kPi), height = std::pow(f, -1.2);
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          sum[std::size_t(y * kSide + x)] +=
              height * std::cos(2 * portable::kPi * (fx * x + fy * y) / kSide + phase);
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) image.values[i] = float(128 + 10 * sum[i]);
  EXPECT_NEAR(measure_image(image).spectral_slope, -1.2, 0.06);
}

TEST(StructuralSimilarity, IsOneOfEqualsAndFallsWithNoise) {
  const Luma a = noise(64, 20);
  Luma b = a, c = a;
  RandomStream random(9, "more");
  for (float& v : b.values) v += float(5 * random.normal());
  for (float& v : c.values) v += float(40 * random.normal());
  EXPECT_NEAR(structural_similarity(a, a), 1, 1e-6);
  const double near = structural_similarity(a, b), far = structural_similarity(a, c);
  EXPECT_GT(near, 0.9);
  EXPECT_LT(near, 1);
  EXPECT_LT(far, 0.6);
  // Of two even pictures the formula leaves the means alone.
  const double x = 100, y = 110, c1 = 2.55 * 2.55;
  EXPECT_NEAR(structural_similarity(even(32, 100), even(32, 110)),
              (2 * x * y + c1) / (x * x + y * y + c1), 1e-9);
  EXPECT_THROW(structural_similarity(a, even(32, 0)), RunError);
}

TEST(RegionDifference, NamesTheRegionThatIsOff) {
  std::vector<float> a(64 * 64, 2.0f), b = a;
  for (int y = 16; y < 32; ++y)
    for (int x = 48; x < 64; ++x) b[std::size_t(y * 64 + x)] = 3;
  const RegionDifference d = compare_regions(a, b, 64, 64, 4, 4);
  EXPECT_NEAR(d.mean_error, 0.5 / 16, 1e-9);
  EXPECT_NEAR(d.worst_error, 0.5, 1e-9);
  EXPECT_EQ(d.worst_column, 3);
  EXPECT_EQ(d.worst_row, 1);
  EXPECT_NEAR(d.bias, 0.5 / 16, 1e-9);
}

TEST(PictureFile, ReadsWhatWeWriteAndCountsSpots) {
  const fs::path folder = fs::temp_directory_path() / "picture_file_test";
  fs::create_directories(folder);
  RgbImage image{128, 128, std::vector<std::uint8_t>(128 * 128 * 3, 60)};
  for (int k = 0; k < 9; ++k)
    for (int y = -4; y <= 4; ++y)
      for (int x = -4; x <= 4; ++x)
        if (x * x + y * y <= 16)
          for (int c = 0; c < 3; ++c)
            image.rgb[std::size_t(((k / 3 * 40 + 24 + y) * 128 + k % 3 * 40 + 24 + x) * 3 + c)] = 220;
  write_png((folder / "a.png").string(), image);
  const Picture png = read_picture((folder / "a.png").string());
  EXPECT_TRUE(png.rgb == image.rgb);
  std::ofstream(folder / "a.jpg", std::ios::binary) << encode_jpeg(128, 128, image.rgb.data(), 95);
  const Picture jpeg = read_picture((folder / "a.jpg").string());
  ASSERT_EQ(jpeg.rgb.size(), png.rgb.size());
  EXPECT_GE(count_keypoints(png), 9);
  EXPECT_LE(count_keypoints(png), 100);  // also between the spots
  EXPECT_EQ(count_keypoints({64, 64, std::vector<std::uint8_t>(64 * 64 * 3, 7)}), 0);
  EXPECT_THROW(read_picture((folder / "none.png").string()), InputError);
  fs::remove_all(folder);
}

}  // namespace image_measures_test
}  // namespace rubble
