// Rain and snow against what was measured of them, and against the closed forms of their statistics.
#include "render/media/precipitation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/media/falling_drops.h"
#include "render/media/medium.h"
#include "render/media/streaks.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"

namespace rubble {
namespace precipitation_test {

constexpr PrecipitationKind kRain = PrecipitationKind::rain, kSnow = PrecipitationKind::snow;

// Sums f(D) N(D) dD by the midpoint rule, with N(D) dD from count().
template <typename F>
double sum_over_sizes(const Precipitation& p, double low, double high, const F& f) {
  constexpr int kSteps = 4000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = low + (high - low) * i / kSteps, b = low + (high - low) * (i + 1) / kSteps;
    sum += p.count(a, b) * f(0.5 * (a + b));
  }
  return sum;
}

TEST(Precipitation, HasTheSizesOfMarshallAndPalmer) {
  for (const double rate : {1.0, 5.0, 25.0}) {
    const double slope = 4.1 * std::pow(rate, -0.21);
    const Precipitation rain(kRain, rate);
    EXPECT_NEAR(rain.count(0, 100), 8000 / slope, 1e-9 * 8000);
    EXPECT_NEAR(rain.count(1, 2), 8000 / slope * (std::exp(-slope) - std::exp(-2 * slope)), 1e-6);
    EXPECT_NEAR(rain.extinction(), 1e-6 * M_PI / 4 * 8000 * 2 / (slope * slope * slope), 1e-12);
  }
}

// The rate that a distribution was stated for must come back when its drops fall at speeds measured by others.
TEST(Precipitation, BringsDownTheWaterOfItsRate) {
  for (const PrecipitationKind kind : {kRain, kSnow})
    for (const double rate : {0.5, 1.0, 3.0}) {
      const Precipitation p(kind, rate);
      const double flux = sum_over_sizes(p, 0, 15, [&](double d) { return M_PI / 6 * d * d * d * p.fall_speed(d); });
      EXPECT_NEAR(flux * 3600e-6, rate, 0.25 * rate) << int(kind);  // mm3/(m2 s) to mm/h
    }
}

// Gunn and Kinzer 1949, table 2: at 20 degrees and 1013 hPa.
TEST(Precipitation, DropsFallAsFastAsMeasured) {
  const Precipitation rain(kRain, 10);
  const double measured[][2] = {{0.5, 2.06}, {1, 4.03}, {2, 6.49}, {3, 8.06}, {4, 8.83}, {5, 9.09}};
  for (const auto& m : measured) EXPECT_NEAR(rain.fall_speed(m[0]), m[1], 0.035 * m[1] + 0.05) << m[0];
}

TEST(Precipitation, ExtinctionIsTheSumOfTheDiscs) {
  for (const PrecipitationKind kind : {kRain, kSnow}) {
    const Precipitation p(kind, 4);
    const double discs = sum_over_sizes(p, 0.5, 6, [&](double d) {
      const double seen = 1e-3 * p.diameter(d);
      return M_PI / 4 * seen * seen;
    });
    EXPECT_NEAR(p.extinction(0.5, 6), discs, 1e-4 * discs);
    EXPECT_NEAR(p.veil(1000), p.extinction(), 1e-15);
    EXPECT_LT(p.veil(0), 0.7 * p.extinction());
    for (double d = 0.2; d < 20; d += 0.3) EXPECT_LE(p.veil(d), p.veil(d + 0.3) + 1e-15);
  }
}

TEST(Medium, DropsAddToWhatHangsInTheAir) {
  AirSpec spec;
  spec.fog_density = 0.1, spec.fog_noise = 0.5, spec.rain_mm_h = 10;
  const Medium medium(spec, 3);
  AirSpec dry = spec;
  dry.rain_mm_h = 0;
  const Air wet_air = medium.at(1), dry_air = Medium(dry, 3).at(1);
  const double rain = Precipitation(kRain, 10).extinction();
  const Vec3 p(1, 2, 3), along(0.6, 0, 0.8);
  EXPECT_NEAR(wet_air.extinction(p), dry_air.extinction(p) + rain, 1e-12);
  EXPECT_NEAR(wet_air.optical_depth(p, along, 30), dry_air.optical_depth(p, along, 30) + 30 * rain, 1e-12);
  EXPECT_NEAR(wet_air.scattering(p, -1), dry_air.scattering(p, -1) + rain * phase_function(0.75, -1), 1e-12);
  AirSpec snow;
  snow.snow_mm_h = 1;
  EXPECT_FALSE(Medium(snow, 1).clear());
  EXPECT_TRUE(Medium(snow, 1).homogeneous());
}

// Every size fills a ball of its own: about() against the mean of Poisson's law, over eyes and times.
TEST(FallingDrops, AreAsManyAsTheirStatisticsSay) {
  for (const PrecipitationKind kind : {kRain, kSnow}) {
    const Precipitation p(kind, kind == kRain ? 10 : 1);
    const FallingDrops drops(p, {2, -1, 0}, 7);
    const double expected = sum_over_sizes(p, p.smallest(), p.largest(), [&](double d) {
      return 4 * M_PI / 3 * std::pow(p.reach(d), 3);
    });
    const auto found = [&](const Vec3& eye, double seconds) {
      return drops.about(eye, {0, 0, 1}, -2, 0, seconds, 2);
    };
    for (const double t : {0.0, 12345.6}) {
      const std::vector<Drop> here = found({100, -3, 2}, t);
      EXPECT_NEAR(double(here.size()), expected, 5 * std::sqrt(expected) + 0.002 * expected) << int(kind) << " " << t;
      const auto above = std::count_if(here.begin(), here.end(), [](const Drop& d) { return d.place.z > 2; });
      EXPECT_NEAR(double(above), 0.5 * expected, 5 * std::sqrt(expected)) << t;
    }
  }
}

TEST(FallingDrops, AreThoseOfTheWorld) {
  const FallingDrops drops(Precipitation(kRain, 5), {3, 0, 0}, 1);
  const std::vector<Drop> first = drops.about({0, 0, 2}, {1, 0, 0}, -2, 0, 10, 1);
  const std::vector<Drop> other = drops.about({0.1, 0.05, 2}, {1, 0, 0}, -2, 0, 10, 3);
  const std::vector<Drop> later = drops.about({0, 0, 2}, {1, 0, 0}, -2, 0, 10.01, 1);
  const auto has = [](const std::vector<Drop>& list, const Vec3& place) {
    return std::any_of(list.begin(), list.end(), [&](const Drop& d) { return distance(d.place, place) < 1e-9; });
  };
  int near = 0;
  for (const Drop& drop : first) {
    if (distance(drop.place, {0, 0, 2}) > 1.5) continue;
    ++near;
    ASSERT_TRUE(has(other, drop.place));
    ASSERT_TRUE(has(later, drop.place + drop.velocity * 0.01));
  }
  EXPECT_GT(near, 1000);
  const FallingDrops reseeded(Precipitation(kRain, 5), {3, 0, 0}, 2);
  EXPECT_FALSE(has(reseeded.about({0, 0, 2}, {1, 0, 0}, -2, 0, 10, 1), first.front().place));
}

Intrinsics wide(int width, int height) {
  Intrinsics k;
  k.width = width, k.height = height, k.fx = k.fy = 0.6 * width, k.cx = 0.5 * (width - 1), k.cy = 0.5 * (height - 1);
  return k;
}

TEST(Streaks, AreAsLongAsADropFallsWhileExposed) {
  const Intrinsics k = wide(640, 480);
  const Lens lens(k);
  const Drop drop{{4, 0.2, 0.1}, {0, 0, -6.5}, 2e-3};  // 4 m before a camera that looks along X
  Streak s;
  ASSERT_TRUE(place_streak(lens, {}, {}, 0.01, drop, s));
  EXPECT_NEAR(std::hypot(s.u1 - s.u0, s.v1 - s.v0), 6.5 * 0.01 * k.fx / 4, 1e-9);
  EXPECT_GT(s.v1, s.v0) << "rain falls up";
  const Pose falling{{}, {0, 0, -6.5 * 0.01}};  // a camera that falls with the drop
  ASSERT_TRUE(place_streak(lens, {}, falling, 0.01, {drop.place + drop.velocity * 0.005, drop.velocity, 2e-3}, s));
  EXPECT_NEAR(s.v1, s.v0, 1e-9);
  EXPECT_FALSE(place_streak(lens, {}, {}, 0.01, {{-4, 0, 0}, {}, 2e-3}, s));
}

TEST(Streaks, TakeTheAreaOfTheDiscAndLieEvenly) {
  const int width = 200, height = 150;
  const std::vector<float> nothing(std::size_t(width) * height, NAN);
  for (const double w : {0.2, 0.9, 3.0})
    for (const double blur : {0.0, 5.0}) {
      Streak s;
      s.u0 = 60.3, s.v0 = 20.8, s.u1 = 90.7, s.v1 = 120.2, s.width = w, s.blur = blur, s.distance = 2, s.radiance = {1, 2, 3};
      std::vector<float> image(nothing.size() * 3, 0);
      draw_streaks({s}, nothing, width, height, 2, image);
      double sum = 0, along = 0, spread = 0;
      const double length = std::hypot(30.4, 99.4);
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const double a = double(image[std::size_t(y * width + x) * 3]);
          const double t = ((x - 75.5) * 30.4 + (y - 70.5) * 99.4) / length;
          sum += a, along += a * t, spread += a * t * t;
        }
      EXPECT_NEAR(sum, M_PI / 4 * w * w, 0.01 * w * w) << w;
      EXPECT_NEAR(along / sum, 0, 0.2);
      EXPECT_NEAR(std::sqrt(12 * spread / sum), length, 0.05 * length);  // of an even rod
      EXPECT_FLOAT_EQ(image[(70 * width + 75) * 3 + 2], 3 * image[(70 * width + 75) * 3]);
      std::vector<float> hidden(nothing.size() * 3, 0);
      draw_streaks({s}, std::vector<float>(nothing.size(), 1.5f), width, height, 1, hidden);
      EXPECT_EQ(*std::max_element(hidden.begin(), hidden.end()), 0) << "seen through what is nearer";
    }
}

// A slab 3 m above the ground, if any, under an overcast sky.
Scene rainy(bool roof, double rain = 20, double snow = 0) {
  Scene scene;
  scene.light.type = LightType::sun, scene.sky.type = SkyType::overcast;
  scene.lamp.on = false;
  scene.air.rain_mm_h = rain, scene.air.snow_mm_h = snow;
  TriangleMesh slab;
  const float z = roof ? 3 : -1, r = roof ? 40 : 1;
  slab.positions = {{-r, -r, z}, {r, -r, z}, {r, r, z}, {-r, r, z}};
  slab.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  auto mesh = std::make_shared<SceneMesh>();
  mesh->levels = {slab};
  scene.meshes = {mesh};
  scene.instances.resize(1);
  return scene;
}

struct Exposure {
  Scene scene;
  double seconds = 0.01;
  int threads = 1;
  float before = 1;  // of all pixels
  Intrinsics k = wide(160, 120);

  // The mean of `images` at every half second.
  std::vector<float> light(int images = 1) const {
    SoftwareDevice device;
    RenderOptions options = testing::cached_options();
    options.threads = threads, options.bake = false;
    Renderer renderer(device, scene, options);
    std::vector<float> sum(std::size_t(k.width) * std::size_t(k.height) * 3);
    for (int i = 0; i < images; ++i) {
      const ViewRays view{i * 500'000'000LL, k, {portable::quat_from_rpy(0, -0.3, 0.3), {0, 0, 1.5}}};
      const std::vector<float> distances = renderer.view(view).distances();
      std::vector<float> image(sum.size(), before);
      renderer.add_drops({view, view.world_from_camera, view.world_from_camera, seconds, distances}, image);
      for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += image[p] / float(images);
    }
    return sum;
  }
};

// What single drops take and what their veil leaves out are the same: the mean over pixels of a picture so bright
// that the drops are black before it, against the integral along the axis.
TEST(DropDrawer, TakesWhatTheVeilLeavesOut) {
  for (const bool snow : {false, true}) {
    Exposure e{rainy(false, snow ? 0 : 20, snow ? 2 : 0)};
    e.before = 1e6f;
    e.k = wide(320, 240), e.k.fx = e.k.fy = 800;  // narrow: all pixels look the same way far
    const std::vector<float> image = e.light(24);
    const double mean = std::accumulate(image.begin(), image.end(), 0.0) / double(image.size()) / 1e6;
    const Precipitation p(snow ? kSnow : kRain, snow ? 2 : 20);
    double expected = 0;
    for (double r = 0.15; r < 20; r += 0.001) expected += (p.extinction() - p.veil(r)) * 0.001;
    EXPECT_NEAR(-std::log(mean), expected, 0.08 * expected) << (snow ? "snow" : "rain");
    EXPECT_GT(expected, 1e-3);
  }
}

TEST(DropDrawer, LongExposuresSmearDrops) {
  Exposure e{rainy(false)};
  e.before = 0;
  const std::vector<float> brief = (e.seconds = 1e-4, e.light()), lengthy = (e.seconds = 0.03, e.light());
  const auto most = [](const std::vector<float>& image) { return *std::max_element(image.begin(), image.end()); };
  EXPECT_GT(most(brief), 5 * most(lengthy));
}

TEST(DropDrawer, NothingFallsUnderARoof) {
  const auto change = [](bool roof) {
    double sum = 0;
    for (const float value : Exposure{rainy(roof)}.light()) sum += std::fabs(double(value) - 1);
    return sum;
  };
  // A streak is a pixel wide at least: those just above the roof show half a pixel at its far end.
  EXPECT_LT(change(true), 0.005 * change(false));
  EXPECT_EQ(Exposure{rainy(false, 0)}.light(), std::vector<float>(160 * 120 * 3, 1));
}

TEST(DropDrawer, ThreadsChangeNoBit) {
  Exposure one{rainy(false, 10, 1)}, three{rainy(false, 10, 1)};
  one.threads = 1, three.threads = 3;
  EXPECT_EQ(one.light(), three.light());
}

}  // namespace precipitation_test
}  // namespace rubble
