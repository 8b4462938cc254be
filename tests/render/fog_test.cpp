// Light in fog and smoke: the transfer on the grid against closed forms, and pictures of it against path tracing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/media/air_box.h"
#include "render/renderer.h"
#include "render/transport/air_transfer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace fog_test {

constexpr int kSide = 48, kRegions = 4;

// A low wall in the sun, on the ground.
Scene outside() {
  Scene scene;
  scene.lamp.on = false;
  scene.light.type = LightType::sun;
  scene.light.elevation_deg = 35, scene.light.azimuth_deg = 120;
  scene.meshes.push_back(share(make_box({0.4, 4, 1.5}, "concrete_cast")));
  scene.instances.push_back({0, 1, {{}, {0, 0, 0.75}}, 1});
  return scene;
}

// Light of 4 by 4 regions of the image.
std::vector<double> regions(const Scene& scene, const Pose& eye, RenderQuality quality, int samples,
                            int bake_rays = RenderOptions().bake_rays) {
  SoftwareDevice device;
  RenderOptions options = quality == RenderQuality::fast ? cached_options() : RenderOptions();
  options.threads = 1, options.texture_size = 64, options.bake_rays = bake_rays;
  options.colour.quality = quality, options.colour.samples = samples;
  const LinearFrame frame = Renderer(device, scene, options).render_linear({0, pinhole(kSide, kSide, 0.6 * kSide), eye});
  std::vector<double> out(kRegions * kRegions);
  constexpr std::size_t side = kSide, region = kSide / kRegions;
  for (std::size_t i = 0; i < side * side; ++i)
    out[i / side / region * kRegions + i % side / region] += double(frame.rgb[i * 3 + 1]) / double(region * region);
  return out;
}

void expect_as_paths(const Scene& scene, const Pose& eye, int samples, double most_bias, double most_error) {
  const std::vector<double> fast = regions(scene, eye, RenderQuality::fast, 1);
  const std::vector<double> paths = regions(scene, eye, RenderQuality::reference, samples);
  double off = 0, sum = 0, expected = 0;
  for (std::size_t i = 0; i < fast.size(); ++i)
    off += std::fabs(fast[i] - paths[i]) / paths[i] / double(fast.size()), sum += fast[i], expected += paths[i];
  EXPECT_NEAR(sum / expected, 1, most_bias) << scene.air.fog_density;
  EXPECT_LT(off, most_error) << scene.air.fog_density;
}

TEST(FogLight, OfALampFillsARoomAsPathsDo) {
  // In dense smoke the corners beside the beam are up to a third too dark: what is scattered straight on broadens it.
  for (const auto& [density, most_bias, most_error] : {std::array{0.1, 0.07, 0.09}, std::array{0.6, 0.12, 0.21}}) {
    Scene scene = slab_room({4, 3, 2.4});
    scene.air.fog_density = density;
    expect_as_paths(scene, look_at({-1.2, 0.3, 0}, {2, 0, 0}), 256, most_bias, most_error);
  }
}

TEST(FogLight, OfTheSunIsThatOfPathsOutside) {
  for (const double density : {0.05, 0.3}) {
    Scene scene = outside();
    scene.air.fog_density = density;
    expect_as_paths(scene, look_at({5, 2, 1.6}, {0, 0, 0.8}), 64, 0.07, 0.1);
  }
}

// A low chamber without an opening, outside of which it is day. Points of the air are farther from each other than its roof
// is thick, and than it is high: no light may be taken from between one inside and one outside.
TEST(FogLight, ComesThroughNoWall) {
  for (const double height : {0.3, 1.3}) {
    Scene scene = outside();
    scene.instances.clear();
    scene.air.fog_density = 0.3;
    const double side = 6, thick = 0.2;
    scene.meshes.push_back(share(make_box({side, side, thick}, "concrete_cast")));
    scene.meshes.push_back(share(make_box({side, thick, height}, "concrete_cast")));
    scene.meshes.push_back(share(make_box({thick, side, height}, "concrete_cast")));
    const double at = 0.5 * (side - thick);
    scene.instances.push_back({1, 1, {{}, {0, 0, height + 0.5 * thick}}, 1});
    scene.instances.push_back({2, 2, {{}, {0, at, 0.5 * height}}, 1});
    scene.instances.push_back({2, 3, {{}, {0, -at, 0.5 * height}}, 1});
    scene.instances.push_back({3, 4, {{}, {at, 0, 0.5 * height}}, 1});
    scene.instances.push_back({3, 5, {{}, {-at, 0, 0.5 * height}}, 1});
    const auto light_inside = [&] {
      const std::vector<double> all =
          regions(scene, look_at({-2, 0.3, 0.5 * height}, {2, 0, 0.45 * height}), RenderQuality::fast, 1, 32);
      return std::accumulate(all.begin(), all.end(), 0.0);
    };
    const double in_fog = light_inside();
    scene.air.fog_density = 0;
    // Baked light is taken from between points of a surface, of which some lie beyond an edge.
    EXPECT_LT(in_fog, 2 * light_inside()) << height;
  }
}

// Air that scatters once is darker.
TEST(FogLight, ScattersOnceInDrafts) {
  Scene scene = slab_room({4, 3, 2.4});
  scene.air.fog_density = 0.6;
  const Pose eye = look_at({-1.2, 0.3, 0}, {2, 0, 0});
  const std::vector<double> fast = regions(scene, eye, RenderQuality::fast, 1);
  const std::vector<double> draft = regions(scene, eye, RenderQuality::draft, 1);
  const double all = std::accumulate(fast.begin(), fast.end(), 0.0), once = std::accumulate(draft.begin(), draft.end(), 0.0);
  EXPECT_LT(once, 0.9 * all);
  EXPECT_GT(once, 0.3 * all);
}

// By day what air scatters twice of a lamp is left out. Light is linear in the lamp's intensity but for that, and
// nobody sees the step.
TEST(FogLight, OfALampDrownedByDaylightIsNotMissed) {
  Scene scene = outside();
  scene.air.fog_density = 0.1;
  const Pose eye = look_at({5, 2, 1.6}, {0, 0, 0.8});
  const auto light_with = [&](double intensity) {
    scene.lamp = {intensity > 0, intensity, 60, {0, 0.05, 0.05}};
    return regions(scene, eye, RenderQuality::fast, 1);
  };
  constexpr double kBright = 1e5;
  const std::vector<double> without = light_with(0), bright = light_with(kBright);
  double missed = 0;
  for (const double intensity : {100.0, 800.0, 3200.0, 12800.0, 51200.0}) {
    const std::vector<double> with = light_with(intensity);
    for (std::size_t i = 0; i < with.size(); ++i) {
      const double expected = without[i] + (bright[i] - without[i]) * intensity / kBright;
      missed = std::max(missed, (expected - with[i]) / expected);
    }
  }
  EXPECT_LT(missed, 3e-4);
  EXPECT_GT(missed, 6e-5) << "nothing is left out, or all";
}

TEST(FogLight, ThreadsChangeNoBit) {
  Scene scene = slab_room({4, 3, 2.4});
  scene.air.fog_density = 0.3;
  const auto draw = [&](int threads) {
    SoftwareDevice device;
    RenderOptions options;
    options.threads = threads, options.texture_size = 64, options.bake_rays = 16;
    return Renderer(device, scene, options).render_linear(look_at({-1.2, 0.3, 0}, {2, 0, 0}), pinhole(32, 32, 20)).rgb;
  };
  EXPECT_TRUE(draw(1) == draw(3));
}

// Light that is even everywhere stays so in air that only scatters, whatever its density; and what air takes beside
// that, follows from the law of Beer and Lambert where nothing is scattered.
TEST(AirTransfer, KeepsEvenLightAndWeakensItByTheLaw) {
  const Scene scene = slab_room({4, 3, 2.4});
  const PreparedScene prepared = prepare_scene(scene, 1);
  Aabb box;
  box.include({-2, -1.5, -1.2}), box.include({2, 1.5, 1.2});
  const RayScene rays(prepared, RayScene::Detail::finest);
  AirTransfer transfer(make_air_links(prepared, rays, box, 1));
  const std::size_t count = transfer.links().grid.count();
  std::size_t points = 0;
  for (const PlacedMesh& piece : prepared.placed) points += prepared.meshes[piece.mesh].bake_points.size();
  const std::vector<AirTransfer::Colour> walls(points, AirTransfer::Colour{AirTransfer::Four{1, 1, 1, 0}});
  const std::vector<Vec3f> even(count, Vec3f(1, 1, 1));
  AirTransfer::Sources sources;
  sources.surfaces = walls.data(), sources.direct.resize(count), sources.usual = even;
  sources.tolerance = 1e-6, sources.most = 200;
  ThreadPool pool(1);
  const float mean = harmonics_of({0, 0, 1})[0];
  for (const float density : {0.2f, 1.5f}) {
    AirMatter air;
    air.extinction.assign(count, density), air.scattered.assign(count, {1, 0.4f, 0.16f, 0.064f});
    const AirTransfer::Result lit = transfer.solve(air, sources, pool);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t k = lit.stand_in[i];
      ASSERT_NEAR((lit.ends[k][0].y + lit.air[k][0].y) * mean, 1, 0.03) << i;
    }
    air.scattered.assign(count, {});
    sources.usual.clear();
    const AirTransfer::Result dark = transfer.solve(air, sources, pool);
    for (std::size_t i = 0; i < count; ++i) {
      if (transfer.links().nearest[i] != i) continue;
      double expected = 0;
      for (std::size_t k = 0; k < AirLinks::kDirections; ++k)
        expected += std::exp(double(-density * transfer.links().ends[k * count + i].distance)) / AirLinks::kDirections;
      ASSERT_EQ(dark.air[i][0].y, 0);
      ASSERT_NEAR(double(dark.ends[i][0].y * mean) / expected, 1, 0.01) << i;
    }
    sources.usual = even;
  }
}

// Half way between the light of a void and sixteen times as much outside there is four times as much, not eight and a half.
TEST(RadianceGrid, LightLiesBetweenPointsInStops) {
  RadianceGrid field;
  field.grid = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  for (std::size_t i = 0; i < 8; ++i) {
    RadianceTerms& terms = field.terms.emplace_back();
    const float light = i % 2 ? 16.0f : 1.0f;
    terms[0] = {light, light, light}, terms[3] = {0.5f * light, 0, 0};
  }
  const RadianceTerms middle = field.at({0.5f, 0.3f, 0.7f});
  EXPECT_NEAR(middle[0].y, 4, 1e-5);
  EXPECT_NEAR(middle[3].x, 2, 1e-5);
  EXPECT_NEAR(field.at({0.25f, 0.5f, 0.5f})[0].y, 2, 1e-5);
  EXPECT_NEAR(field.at({1, 0.5f, 0.5f})[0].y, 16, 1e-4);
  // A lamp's is the mean.
  field.ends_of_lamp.assign(8, {});
  for (std::size_t i = 1; i < 8; i += 2) field.ends_of_lamp[i][0] = {2, 2, 2};
  EXPECT_NEAR(field.at({0.5f, 0.5f, 0.5f})[0].y, 5, 1e-5);
  // Darkness on one side leaves something of the other one.
  for (std::size_t i = 0; i < 8; i += 2) field.terms[i] = {};
  EXPECT_GT(field.at({0.5f, 0.5f, 0.5f})[0].y, 1.0f);
}

TEST(AirBox, ClipsRays) {
  Aabb box;
  box.include({-1, -2, -3}), box.include({1, 2, 3});
  float near = 0, far = 100;
  EXPECT_TRUE(clip_to_box(box, {-3, 0, 0}, {1, 0, 0}, near, far));
  EXPECT_FLOAT_EQ(near, 2);
  EXPECT_FLOAT_EQ(far, 4);
  near = 0, far = 100;
  EXPECT_FALSE(clip_to_box(box, {-3, 0, 0}, {0, 1, 0}, near, far));
  near = 0, far = 1.5f;
  EXPECT_FALSE(clip_to_box(box, {-3, 0, 0}, {1, 0, 0}, near, far));
  const Aabb about = air_box(box);
  EXPECT_DOUBLE_EQ(about.min.z, -4.5);
  EXPECT_TRUE(in_box(about, {2.4, -3.4, 4.4}));
  EXPECT_FALSE(in_box(about, {2.6, 0, 0}));
}

// Sixteen terms are orthonormal, and give the illuminance of even light, pi, on any surface.
TEST(Harmonics, AreOrthonormal) {
  std::array<std::array<double, kHarmonics>, kHarmonics> sums{};
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const double z = 1 - (2 * i + 1.0) / kPoints, turn = i * 0.6180339887498949, r = std::sqrt(1 - z * z);
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (turn - std::floor(turn)));
    const Harmonics y = harmonics_of({float(r * a.cos), float(r * a.sin), float(z)});
    for (std::size_t s = 0; s < kHarmonics; ++s)
      for (std::size_t t = 0; t < kHarmonics; ++t) sums[s][t] += double(y[s]) * double(y[t]) * 4 * portable::kPi / kPoints;
  }
  for (std::size_t s = 0; s < kHarmonics; ++s)
    for (std::size_t t = 0; t < kHarmonics; ++t) EXPECT_NEAR(sums[s][t], s == t ? 1 : 0, 1e-3) << s << " " << t;
  RadianceTerms even{};
  even[0] = Vec3f(1, 1, 1) * (4 * portable::kPiF * harmonics_of({0, 0, 1})[0]);
  EXPECT_NEAR(illuminance_of(even, normalized(Vec3f(1, 2, -0.5f))).y, portable::kPi, 1e-4);
}

}  // namespace fog_test
}  // namespace rubble::testing
