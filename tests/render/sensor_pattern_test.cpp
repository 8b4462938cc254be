// What is not the same in all pixels of an image sensor: fixed patterns by EMVA 1288, hot pixels, the
// mosaic of colours; and the losses of a JPEG, judged by libjpeg.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <opencv2/imgcodecs.hpp>

#include "render/sensors/bayer.h"
#include "render/sensors/image_sensor.h"
#include "render/sensors/jpeg_loss.h"
#include "render/sensors/noise_field.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace sensor_pattern_test {

constexpr int kSide = 200;
constexpr std::size_t kPixels = std::size_t(kSide) * kSide;
constexpr ExposureSettings kSettings{0.02, 100};

CameraSpec plain_sensor() {
  CameraSpec spec;
  spec.intrinsics = pinhole(kSide, kSide, 100);
  spec.exposure.mode = ExposureMode::fixed;
  spec.exposure.f_number = 4;
  spec.sensor.noise = false;
  spec.sensor.full_well = 10000;
  spec.sensor.bits = 16;
  spec.sensor.response = Response::linear;
  spec.seed = 3;
  return spec;
}

// Electrons of every photosite under a flat field of this share of saturation.
std::vector<double> electrons(const CameraSpec& spec, double share, int frame = 0, int eye = 0,
                              ExposureSettings settings = kSettings) {
  const ImageSensor sensor(spec, LensDirections(kPixels, Vec3f(0, 0, 1)));
  const float light = float(share / saturation_share(settings, spec.exposure.f_number));
  const auto counts = sensor.count(std::vector<float>(kPixels * 3, light), settings, frame, eye);
  std::vector<double> out(counts.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = counts[i] * (spec.sensor.full_well * 100 / settings.iso) / sensor.most();
  return out;
}

struct Moments {
  double mean = 0, deviation = 0;
};
Moments moments_of(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / double(values.size());
  for (const double v : values) m.deviation += (v - m.mean) * (v - m.mean) / double(values.size() - 1);
  m.deviation = std::sqrt(m.deviation);
  return m;
}
std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> out(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
  return out;
}

TEST(FixedPattern, PrnuIsTheSpreadOfAFlatField) {
  CameraSpec spec = plain_sensor();
  spec.sensor.prnu = 0.012;
  const std::vector<double> field = electrons(spec, 0.5);
  EXPECT_NEAR(moments_of(field).mean, 5000, 2);
  EXPECT_NEAR(moments_of(field).deviation / moments_of(field).mean, 0.012, 0.012 * 0.02);
  // Multiplicative; the same in every frame; another on another sensor.
  EXPECT_NEAR(moments_of(electrons(spec, 0.1)).deviation, 0.012 * 1000, 0.3);
  EXPECT_EQ(electrons(spec, 0.5, 7), field);
  spec.seed = 4;
  EXPECT_NE(electrons(spec, 0.5), field);
  spec.seed = 3, spec.baseline = 0.1;
  EXPECT_EQ(electrons(spec, 0.5), field);
  EXPECT_NE(electrons(spec, 0.5, 0, 1), field);
}

// With noise, the difference of two frames has none of the pattern, and twice the variance of the noise.
TEST(FixedPattern, IsNotTemporalNoise) {
  CameraSpec spec = plain_sensor();
  spec.sensor.noise = true, spec.sensor.read_noise = 5;
  spec.sensor.prnu = 0.02, spec.sensor.dsnu = 30;
  const std::vector<double> one = electrons(spec, 0.3, 0), two = electrons(spec, 0.3, 1);
  EXPECT_NEAR(moments_of(difference(one, two)).deviation, std::sqrt(2 * (3000 + 25.0)), 1);
  EXPECT_NEAR(moments_of(one).deviation, std::sqrt(3000 + 25 + 60.0 * 60 + 30 * 30), 1);
}

TEST(FixedPattern, DsnuIsTheSpreadOfTheDark) {
  CameraSpec spec = plain_sensor();
  spec.sensor.dsnu = 6;
  spec.sensor.dark_current = 5000;  // 100 electrons: the converter does not count below zero
  EXPECT_NEAR(moments_of(electrons(spec, 0)).mean, 100, 0.2);
  EXPECT_NEAR(moments_of(electrons(spec, 0)).deviation, 6, 0.1);
  EXPECT_NEAR(moments_of(electrons(spec, 0, 0, 0, {0.04, 100})).mean, 200, 0.2);
}

TEST(FixedPattern, HotPixelsAreTheSameInEveryFrame) {
  CameraSpec spec = plain_sensor();
  spec.sensor.hot_pixels = 0.004, spec.sensor.hot_current = 5e4;
  const std::vector<double> dark = electrons(spec, 0);
  const double hot = double(std::count_if(dark.begin(), dark.end(), [](double e) { return e > 0.5; }));
  const double count = double(dark.size());
  EXPECT_NEAR(hot / count, 0.004, 4 * std::sqrt(0.004 / count));
  EXPECT_NEAR(moments_of(dark).mean * count / hot, 5e4 * 0.02, 150);  // of an exponential distribution
  EXPECT_EQ(electrons(spec, 0, 11), dark);
  spec.seed = 99;
  EXPECT_NE(electrons(spec, 0), dark);
}

TEST(FixedPattern, DoesNotDependOnThreads) {
  CameraSpec spec = plain_sensor();
  spec.sensor.noise = true, spec.sensor.prnu = 0.02, spec.sensor.hot_pixels = 0.001;
  spec.sensor.mosaic = Mosaic::grbg;
  const std::vector<double> one = electrons(spec, 0.3);
  spec.threads = 4;
  EXPECT_EQ(electrons(spec, 0.3), one);
}

TEST(Mosaic, HasTheOrderOfItsName) {
  const auto name = [](Mosaic m) {
    std::string text;
    for (const auto& [x, y] : {std::pair(0, 0), std::pair(1, 0), std::pair(0, 1), std::pair(1, 1)})
      text += "rgb"[mosaic_colour(m, x + 4, y + 2)];
    return text;
  };
  EXPECT_EQ(name(Mosaic::rggb), "rggb");
  EXPECT_EQ(name(Mosaic::bggr), "bggr");
  EXPECT_EQ(name(Mosaic::grbg), "grbg");
  EXPECT_EQ(name(Mosaic::gbrg), "gbrg");
}

std::vector<std::uint16_t> mosaic_of(Mosaic mosaic, int width, int height,
                                     const std::function<int(int, int, int)>& colour_at) {
  std::vector<std::uint16_t> counts;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      counts.push_back(std::uint16_t(colour_at(x, y, mosaic_colour(mosaic, x, y))));
  return counts;
}

TEST(Mosaic, KeepsEvenColoursAndGreyRamps) {
  for (const Mosaic mosaic : {Mosaic::rggb, Mosaic::bggr, Mosaic::grbg, Mosaic::gbrg}) {
    const int colours[] = {900, 500, 100};
    const auto even = demosaic(
        mosaic, 12, 9, mosaic_of(mosaic, 12, 9, [&](int, int, int c) { return colours[c]; }), 4095);
    for (std::size_t i = 0; i < even.size(); ++i) EXPECT_EQ(even[i], colours[i % 3]) << i;
    const auto ramp = demosaic(
        mosaic, 12, 9, mosaic_of(mosaic, 12, 9, [](int x, int y, int) { return 100 + 8 * x + 24 * y; }),
        4095);
    for (int y = 2; y < 7; ++y)
      for (int x = 2; x < 10; ++x)
        for (int c = 0; c < 3; ++c)
          EXPECT_EQ(ramp[std::size_t(3 * (y * 12 + x) + c)], 100 + 8 * x + 24 * y);
  }
}

// What one bright photosite adds around it: the coefficients of the paper's filters, over 8.
TEST(Mosaic, HasThePublishedFilters) {
  const auto spread = [](int bx, int by, int x, int y, int colour) {
    auto counts = std::vector<std::uint16_t>(11 * 11, 2000);
    counts[std::size_t(by * 11 + bx)] = 2800;
    const auto out = demosaic(Mosaic::rggb, 11, 11, counts, 65535);
    return (int(out[std::size_t(3 * (y * 11 + x) + colour)]) - 2000) / 100.0;
  };
  // A bright red at (4, 4).
  EXPECT_EQ(spread(4, 4, 4, 4, 1), 4);     // green there
  EXPECT_EQ(spread(4, 4, 6, 4, 1), -1);    // green at the next red
  EXPECT_EQ(spread(4, 4, 4, 4, 2), 6);     // blue there
  EXPECT_EQ(spread(4, 4, 5, 5, 0), 2);     // red at the blue beside it
  EXPECT_EQ(spread(4, 4, 6, 4, 2), -1.5);  // blue at the next red
  EXPECT_EQ(spread(4, 4, 5, 4, 0), 4);     // red at the green beside it
  // A bright green at (5, 4), in a row of red.
  EXPECT_EQ(spread(5, 4, 5, 4, 0), 5);
  EXPECT_EQ(spread(5, 4, 7, 4, 0), -1);
  EXPECT_EQ(spread(5, 4, 5, 6, 0), 0.5);
  EXPECT_EQ(spread(5, 4, 6, 5, 0), -1);
  EXPECT_EQ(spread(5, 4, 4, 4, 1), 2);
}

// Smooth shading, an edge, some grain.
std::vector<std::uint8_t> make_picture(int width, int height) {
  const NoiseField grain(2, "grain");
  std::vector<std::uint8_t> rgb;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) {
        const double wave = 110 + 60 * std::sin(x * 0.05 + c) + 40 * std::cos(y * 0.09 - 2 * c);
        const double edge = x + 2 * y > width ? 35 : 0;
        const double noise = 6 * grain.normal(rgb.size());
        rgb.push_back(std::uint8_t(std::clamp(wave + edge + noise, 0.0, 255.0)));
      }
  return rgb;
}

double mean_difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b[i]));
  return sum / double(a.size());
}

TEST(JpegLoss, IsThatOfLibjpeg) {
  for (const auto& [width, height] : {std::pair(160, 120), std::pair(83, 61)}) {
    const std::vector<std::uint8_t> picture = make_picture(width, height);
    cv::Mat bgr(height, width, CV_8UC3);
    for (std::size_t i = 0; i < picture.size(); ++i) bgr.data[i / 3 * 3 + 2 - i % 3] = picture[i];
    for (const int quality : {20, 60, 90}) {
      std::vector<std::uint8_t> file;
      cv::imencode(".jpg", bgr, file, {cv::IMWRITE_JPEG_QUALITY, quality});
      const cv::Mat back = cv::imdecode(file, cv::IMREAD_COLOR);
      std::vector<std::uint8_t> judged(picture.size()), ours = picture;
      for (std::size_t i = 0; i < judged.size(); ++i) judged[i] = back.data[i / 3 * 3 + 2 - i % 3];
      lose_to_jpeg(ours, width, height, quality, 2);
      const double loss = mean_difference(picture, judged);
      EXPECT_GT(loss, 2);
      EXPECT_NEAR(mean_difference(picture, ours) / loss, 1, 0.02) << width << " " << quality;
      EXPECT_LT(mean_difference(ours, judged), 0.2 * loss) << width << " " << quality;
    }
  }
}

TEST(JpegLoss, IsOfTheStoredImage) {
  CameraSpec spec = plain_sensor();
  spec.sensor.noise = true;
  const auto develop = [&] {
    const ImageSensor sensor(spec, LensDirections(kPixels, Vec3f(0, 0, 1)));
    return sensor.develop(sensor.count(std::vector<float>(kPixels * 3, 0.5f), kSettings, 0, 0));
  };
  const std::vector<std::uint8_t> whole = develop();
  spec.sensor.jpeg_quality = 30;
  std::vector<std::uint8_t> expected = whole;
  lose_to_jpeg(expected, kSide, kSide, 30, 1);
  EXPECT_EQ(develop(), expected);
  EXPECT_NE(expected, whole);
}

}  // namespace sensor_pattern_test
}  // namespace rubble::testing
