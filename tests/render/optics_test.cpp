// The real lens against closed forms: point spread, glare, defocus, colour, dirt and drops.
#include "render/optics/lens_optics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/optics/lens_surface.h"
#include "render/sensors/camera.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace optics_test {

LinearImage even_image(int width, int height, float value) {
  return {width, height, std::vector<float>(std::size_t(width) * std::size_t(height) * 3, value)};
}
std::size_t place(const LinearImage& image, int x, int y) {
  return 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
}
// All light in one pixel.
LinearImage spot_image(int width, int height, int x, int y, float value = 1000) {
  LinearImage image = even_image(width, height, 0);
  for (std::size_t c = 0; c < 3; ++c) image.rgb[place(image, x, y) + c] = value;
  return image;
}

// Of one colour of an image: all its light, where its middle is, and the variance along X.
struct Light {
  double sum = 0, x = 0, y = 0, variance_x = 0;
};
Light measure(const LinearImage& image, std::size_t colour = 1) {
  Light light;
  double squares = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double value = double(image.rgb[place(image, x, y) + colour]);
      light.sum += value, light.x += value * x, light.y += value * y, squares += value * x * x;
    }
  light.x /= light.sum, light.y /= light.sum;
  light.variance_x = squares / light.sum - light.x * light.x;
  return light;
}

LinearImage apply(const OpticsSpec& spec, const LinearImage& image, int threads = 1) {
  const LensOptics optics(spec, 2, pinhole(image.width, image.height, 100), 5, threads);
  return {image.width, image.height, optics.spread(image.rgb, 0)};
}

TEST(LineFilters, WeightsAreModifiedBesselFunctions) {
  for (const double sigma : {0.05, 0.6, 2.0, 9.0}) {
    const std::vector<double> weights = gaussian_weights(sigma);
    const double t = sigma * sigma;
    for (const std::size_t n : {0u, 1u, 3u, 8u})
      EXPECT_NEAR(n < weights.size() ? weights[n] : 0,
                  std::exp(-t) * std::cyl_bessel_i(double(n), t), 3e-9) << sigma << " " << n;
  }
}

TEST(LineFilters, BoxesHaveAnyVariance) {
  for (const double variance : {0.1, 1.0, 5.37, 400.0}) {
    const ExtendedBox box = make_extended_box(variance);
    double sum = 0, squares = 0;
    for (int i = -box.radius - 1; i <= box.radius + 1; ++i) {
      const double weight = std::abs(i) > box.radius ? box.edge : 1;
      sum += weight, squares += weight * i * i;
    }
    EXPECT_NEAR(squares / sum, variance, 1e-9 * variance);
    EXPECT_TRUE(box.edge >= 0 && box.edge <= 1) << box.edge;
  }
}

TEST(PointSpread, KeepsTheLightAndHasItsVariance) {
  for (const double sigma : {0.3, 1.0, 2.5, 7.0}) {
    OpticsSpec spec;
    spec.point_spread = sigma;
    const Light light = measure(apply(spec, spot_image(121, 90, 60, 41)));
    EXPECT_NEAR(light.sum / 1000, 1, 1e-5) << sigma;
    EXPECT_NEAR(light.variance_x / (sigma * sigma), 1, 1e-3) << sigma;
    // In the corner, too: the image goes on as in a mirror.
    EXPECT_NEAR(measure(apply(spec, spot_image(121, 90, 0, 0))).sum / 1000, 1, 1e-5) << sigma;
  }
}

TEST(Glare, KeepsTheLightAndWhatIsEven) {
  OpticsSpec spec;
  spec.glare = 0.2;
  for (const auto& [x, y] : {std::pair(128, 100), std::pair(3, 0), std::pair(255, 190)}) {
    const LinearImage out = apply(spec, spot_image(256, 191, x, y));
    EXPECT_NEAR(measure(out).sum / 1000, 1, 1e-4);
    EXPECT_NEAR(out.rgb[place(out, x, y)], 800, 0.2 * 1000 / 10);  // and a little of the skirt's middle
    EXPECT_GT(out.rgb[place(out, 255 - x, 190 - y)], 0);
  }
  const LinearImage even = apply(spec, even_image(256, 191, 3));
  for (const float value : even.rgb) ASSERT_NEAR(value, 3, 1e-4);
}

// The test of ISO 9358: in the middle of a black disc in a white field nothing is but glare. A Gaussian of
// the standard deviation s brings there exp(-R^2 / 2 s^2) of the field.
TEST(Glare, FillsABlackDiscAsTheSkirtSays) {
  constexpr int kSide = 257;
  constexpr double kGlare = 0.05;
  OpticsSpec spec;
  spec.glare = kGlare;
  for (const double radius : {4.0, 12.0, 40.0}) {
    LinearImage image = even_image(kSide, kSide, 1);
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x)
        if (std::hypot(x - 128, y - 128) < radius)
          std::fill_n(image.rgb.begin() + std::ptrdiff_t(place(image, x, y)), 3, 0.0f);
    double expected = 0;
    for (int i = 0; i < 7; ++i) {
      const double s = double(kSide) / 256 * std::exp2(i);
      expected += kGlare * std::exp(-radius * radius / (2 * s * s)) / 7;
    }
    const LinearImage out = apply(spec, image);
    EXPECT_NEAR(out.rgb[place(out, 128, 128)] / expected, 1, 0.05) << radius;
  }
}

// The circle of confusion on a sensor behind a thin lens, by the textbook: c = A |z - s| / z * f / (s - f),
// in pixels of the pitch v / fx with 1 / v = 1 / f - 1 / s.
double textbook_radius(double focal, double f_number, double focus, double depth, double fx) {
  const double c = focal / f_number * std::fabs(depth - focus) / depth * focal / (focus - focal);
  const double pitch = focal * focus / (focus - focal) / fx;
  return 0.5 * c / pitch;
}

TEST(Defocus, SpreadsOverTheDiscOfTheThinLens) {
  const double fx = 900, focal = 0.016, f_number = 1.4, focus = 2;
  const ThinLens lens{focal / f_number, focus, fx};
  const LinearImage spot = spot_image(121, 121, 60, 60);
  for (const double depth : {0.4, 0.8, 1.5, 4.0, 1000.0}) {
    const std::vector<float> depths(spot.rgb.size() / 3, float(depth));
    const LinearImage out = defocus(spot, depths, lens, 1);
    const double radius = textbook_radius(focal, f_number, focus, depth, fx);
    const Light light = measure(out);
    EXPECT_NEAR(light.sum / 1000, 1, 1e-4) << depth;
    // A disc of the radius R has the variance R^2 / 4 along each axis.
    EXPECT_NEAR(2 * std::sqrt(light.variance_x), radius, 0.35) << depth;
    EXPECT_NEAR(light.x, 60, 1e-6);
  }
  const std::vector<float> sharp(spot.rgb.size() / 3, float(focus));
  EXPECT_EQ(defocus(spot, sharp, lens, 1).rgb, spot.rgb);
  const std::vector<float> sky(spot.rgb.size() / 3, std::numeric_limits<float>::quiet_NaN());
  EXPECT_NEAR(2 * std::sqrt(measure(defocus(spot, sky, lens, 1)).variance_x),
              textbook_radius(focal, f_number, focus, 1e9, fx), 0.35);
}

// A white half before a black one, an edge at x = 50.
struct TwoSurfaces {
  TwoSurfaces(double near, double far) : image(even_image(100, 60, 0)), depth(6000) {
    for (int y = 0; y < 60; ++y)
      for (int x = 0; x < 100; ++x) {
        depth[std::size_t(y * 100 + x)] = float(x < 50 ? near : far);
        if (x < 50) std::fill_n(image.rgb.begin() + std::ptrdiff_t(place(image, x, y)), 3, 1.0f);
      }
  }
  float at(const ThinLens& lens, int x) const {
    const LinearImage out = defocus(image, depth, lens, 1);
    return out.rgb[place(out, x, 30)];
  }
  LinearImage image;
  std::vector<float> depth;
};

TEST(Defocus, NearSurfacesCoverFarOnes) {
  // Sharp before a blurred background: the edge stays sharp, and nothing bleeds over it.
  const TwoSurfaces surfaces(1, 20);
  const ThinLens near{0.02, 1, 900}, far{0.02, 20, 900};
  for (const int x : {30, 45, 49}) EXPECT_EQ(surfaces.at(near, x), 1) << x;
  for (const int x : {50, 54, 70}) EXPECT_EQ(surfaces.at(near, x), 0) << x;
  // Blurred before a sharp one: half of it at the edge, all and nothing a radius away.
  const double radius = std::fabs(far.signed_radius(1));
  EXPECT_NEAR(radius, 0.5 * 900 * 0.02 * 0.95, 0.01);
  EXPECT_NEAR(surfaces.at(far, 49) + surfaces.at(far, 50), 1, 0.1);
  EXPECT_GT(surfaces.at(far, 48), 0.4);
  EXPECT_EQ(surfaces.at(far, 50 + int(radius) + 2), 0);
  EXPECT_NEAR(surfaces.at(far, 50 - int(radius) - 2), 1, 1e-3);
}

TEST(LateralColour, ShiftsRedAgainstBlueInProportionToTheRadius) {
  OpticsSpec spec;
  spec.lateral_colour = 3;
  LinearImage image = even_image(200, 150, 0);
  const double cx = 99.5, cy = 74.5, corner = std::hypot(99.5, 74.5);
  for (const double share : {0.0, 0.4, 0.85}) {
    const double x = cx + share * cx, y = cy + share * cy;  // on the diagonal
    for (int v = 0; v < 150; ++v)
      for (int u = 0; u < 200; ++u)
        for (std::size_t c = 0; c < 3; ++c)
          image.rgb[place(image, u, v) + c] =
              float(std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (2 * 4)));
    const LinearImage out = apply(spec, image);
    const Light red = measure(out, 0), green = measure(out, 1), blue = measure(out, 2);
    EXPECT_NEAR(std::hypot(red.x - blue.x, red.y - blue.y), 3 * share, 0.03) << share;
    EXPECT_GE(std::hypot(red.x - cx, red.y - cy), std::hypot(blue.x - cx, blue.y - cy) - 1e-3);
    EXPECT_NEAR(red.x + blue.x, 2 * green.x, 0.03);
    EXPECT_NEAR((red.x - blue.x) * cy, (red.y - blue.y) * cx, 0.03 * corner);  // along the radius
  }
}

TEST(LensSurface, SmudgesTakeHalfOfWhatTheyDoNotThrowOn) {
  const LensSurface dirty(200, 150, 0.8, 0, 7, 0);
  LinearImage even = even_image(200, 150, 2);
  dirty.soil(even, even_image(200, 150, 2));
  const auto [least, most] = std::minmax_element(even.rgb.begin(), even.rgb.end());
  EXPECT_EQ(*most, 2);
  EXPECT_LT(*least, 1.7);
  EXPECT_GE(*least, 1);
  LinearImage other = even_image(200, 150, 2);
  LensSurface(200, 150, 0.8, 0, 8, 0).soil(other, even_image(200, 150, 2));
  EXPECT_NE(other.rgb, even.rgb);
}

// A picture that grows brighter to the right is turned over in a drop, and 3.5 times as steep.
TEST(LensSurface, DropsShowTheSceneUpsideDown) {
  LinearImage ramp = even_image(1200, 300, 0);
  for (int y = 0; y < ramp.height; ++y)
    for (int x = 0; x < ramp.width; ++x)
      std::fill_n(ramp.rgb.begin() + std::ptrdiff_t(place(ramp, x, y)), 3, float(x - 600));
  LinearImage wet = ramp;
  LensSurface(1200, 300, 0, 12, 3, 0).wet(wet, ramp);
  std::size_t inverted = 0, changed = 0;
  for (int y = 0; y < ramp.height; ++y)
    for (int x = 0; x + 2 < ramp.width; ++x) {
      const float slope = (wet.rgb[place(wet, x + 2, y)] - wet.rgb[place(wet, x, y)]) / 2;
      inverted += std::fabs(slope + 3.5f) < 0.1f ? 1 : 0;
      changed += wet.rgb[place(wet, x, y)] != ramp.rgb[place(ramp, x, y)] ? 1 : 0;
    }
  EXPECT_GT(inverted, 500u);
  EXPECT_LT(changed, std::size_t(12 * 3.15 * 54 * 54));  // the largest twelve discs
}

OpticsSpec all_faults() {
  OpticsSpec spec;
  spec.point_spread = 0.7, spec.glare = 0.03, spec.focus_distance = 1.5, spec.focal_length = 0.012;
  spec.lateral_colour = 1.5, spec.dirt = 0.4, spec.drops = 5;
  return spec;
}

TEST(LensOptics, DoesNotDependOnThreads) {
  const LinearImage image = [] {
    LinearImage made = even_image(131, 77, 0);
    for (std::size_t i = 0; i < made.rgb.size(); ++i) made.rgb[i] = float((i * 7919) % 1013);
    return made;
  }();
  std::vector<float> depth(image.rgb.size() / 3);
  for (std::size_t i = 0; i < depth.size(); ++i) depth[i] = 0.3f + float(i % 97) * 0.1f;
  std::vector<float> results[2];
  for (const int threads : {1, 4}) {
    const LensOptics optics(all_faults(), 1.8, pinhole(131, 77, 120), 5, threads);
    results[threads > 1] = optics.spread(optics.defocus(image.rgb, depth), 0);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_NE(results[0], image.rgb);
}

Flight one_frame() {
  Flight flight;
  flight.pose_at = [](std::int64_t) { return look_at({4, 1, 1.2}, {0, 0, 0.5}); };
  flight.stamps_ns = {5'000'000'000};
  flight.world_from_camera = {flight.pose_at(0)};
  return flight;
}

TEST(CameraOptics, ChangesTheColoursAlone) {
  const Scene scene = make_heap(40, 2);
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = false, options.shadow_size = 64, options.texture_size = 16;
  Renderer renderer(device, scene, options);
  CameraSpec spec;
  spec.intrinsics = pinhole(96, 64, 60);
  spec.baseline = 0.1;
  spec.exposure.mode = ExposureMode::fixed, spec.exposure.time = 0.0003;
  spec.sensor.noise = false;
  const Frame perfect = Camera(renderer, spec, one_frame()).take(0);
  spec.optics = all_faults();
  const Frame real = Camera(renderer, spec, one_frame()).take(0);
  const auto bits = [](const std::vector<float>& values) {
    std::vector<std::uint32_t> out(values.size());
    std::memcpy(out.data(), values.data(), values.size() * sizeof(float));
    return out;
  };
  EXPECT_EQ(bits(real.depth), bits(perfect.depth));
  EXPECT_NE(real.rgb, perfect.rgb);
  EXPECT_NE(real.rgb_right, perfect.rgb_right);
  spec.exposure.mode = ExposureMode::ideal;
  EXPECT_THROW(Camera(renderer, spec, one_frame()), RunError);
}

// The colour of a pixel is the mean of pictures that are shifted by parts of it.
TEST(CameraOptics, PixelsSeeTheirWholeArea) {
  Scene scene;
  scene.ground = false, scene.lamp.on = false;
  scene.light.rpy_deg = {0, 30, 0};
  scene.meshes.push_back(share(make_box({1, 20, 40}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {4.5, 10, 0}}, 5});
  SoftwareDevice device;
  RenderOptions options = cached_options();
  options.bake = false, options.shadow_size = 64, options.texture_size = 16;
  Renderer renderer(device, scene, options);
  Flight flight = one_frame();
  flight.world_from_camera = {{portable::quat_from_rpy(0.2, 0, 0), {}}};
  flight.pose_at = [pose = flight.world_from_camera[0]](std::int64_t) { return pose; };
  const auto take = [&](int samples, double right, double down) {
    CameraSpec spec;
    spec.intrinsics = pinhole(32, 32, 200);
    spec.intrinsics.cx -= right, spec.intrinsics.cy -= down;
    spec.exposure.mode = ExposureMode::fixed, spec.exposure.time = 0.00028;
    spec.sensor.noise = false, spec.sensor.response = Response::linear;
    spec.sensor.pixel_samples = samples;
    return Camera(renderer, spec, flight).take(0).rgb;
  };
  const std::vector<std::uint8_t> middle = take(1, 0, 0), whole = take(2, 0, 0);
  std::vector<double> expected(whole.size());
  for (const double right : {-0.25, 0.25})
    for (const double down : {-0.25, 0.25}) {
      const std::vector<std::uint8_t> part = take(1, right, down);
      for (std::size_t i = 0; i < part.size(); ++i) expected[i] += part[i] / 4.0;
    }
  int differ = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_NEAR(whole[i], expected[i], 1.01) << i;
    differ += std::abs(int(whole[i]) - int(middle[i])) > 8 ? 1 : 0;
  }
  EXPECT_GT(differ, 30);  // along the edge of the wall
}

}  // namespace optics_test
}  // namespace rubble::testing
