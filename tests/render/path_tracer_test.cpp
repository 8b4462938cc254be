// The path tracer against closed forms: furnaces, lights, form factors, air.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/reference/traced_image.h"
#include "render/surface/scalar_surface.h"
#include "tests/render/traced_world.h"

namespace rubble::testing {
namespace path_tracer_test {

constexpr double kPi = portable::kPi;

TraceOptions with_samples(int samples) {
  TraceOptions options;
  options.samples = samples;
  options.seed = 3;
  return options;
}

Reflection matt(float albedo) {
  Reflection r;
  r.base = Vec3f(1, 1, 1) * albedo;
  return r;
}

Reflection glossy(float base, float reflectance, float roughness) {
  Reflection r = matt(base);
  r.gloss = {1, reflectance, roughness};
  return r;
}

Scene bare(TriangleMesh mesh, const Pose& pose = {}) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(std::move(mesh)));
  scene.instances.push_back({0, 1, pose, 1});
  return scene;
}

// In a closed room whose walls glow everywhere, light gathers to e / (1 - albedo).
TEST(Furnace, AMattRoomGathersTheGeometricSeries) {
  for (const float albedo : {0.2f, 0.8f}) {
    TracedWorld world(bare(make_room({4, 3, 2.5})), [&](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
      p.reflection = matt(albedo), p.emission = {1, 1, 1};
    });
    const double expected = 1 / (1 - double(albedo));
    const TracedImage image =
        world.trace(look_at({0.4, 0.2, 0.1}, {2, 1, 0}), pinhole(16, 16, 10), with_samples(1024));
    EXPECT_NEAR(mean_green(image) / expected, 1, 0.005) << albedo;
  }
}

// Walls in balance with their light glow as much as they do not reflect (Kirchhoff): then all light
// is 1, whichever way they mirror.
TEST(Furnace, ARoughlyMirroringRoomKeepsItsBalance) {
  for (const float roughness : {0.1f, 0.3f, 0.8f}) {
    const Reflection wall = glossy(0.5f, 0.3f, roughness);
    TracedWorld world(bare(make_room({4, 3, 2.5})), [&](std::uint32_t, const SurfaceQuery& q, SurfacePoint& p) {
      p.reflection = wall;
      const float mirrored = mirrored_share(wall.gloss, -dot(q.direction, p.face_normal));
      p.emission = Vec3f(1, 1, 1) * (1 - mirrored - 0.5f * (1 - mirrored));
    });
    const TracedImage image =
        world.trace(look_at({0.4, 0.2, 0.1}, {2, 1, 0}), pinhole(16, 16, 10), with_samples(512));
    EXPECT_NEAR(mean_green(image), 1, 0.005) << roughness;
  }
}

// A white thing in an even light cannot be seen, however it mirrors.
TEST(Furnace, AWhiteSphereVanishesInAnEvenSky) {
  for (const float roughness : {0.05f, 0.24f, 0.7f}) {
    TracedWorld world(bare(make_plate(100)), [&](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
      p.reflection = glossy(1, 0.5f, roughness);
      p.reflection.film = {0.5f, 0.02f, 0.12f}, p.reflection.gloss.cover = 0.5f;
    });
    set_even_sky(world.lights, 2);
    const TracedImage image =
        world.trace(look_at({0, 0, 3}, {2, 1, 0}), pinhole(16, 16, 20), with_samples(512));
    EXPECT_NEAR(mean_green(image), 2, 0.01) << roughness;
  }
}

TEST(Reflection, IsFoundAsOftenAsItsDensitySays) {
  const Reflection r = glossy(0.4f, 0.2f, 0.25f);
  const SampleSequence numbers(1, 2);
  for (const float cosine : {0.9f, 0.3f}) {
    const Vec3f out(std::sqrt(1 - cosine * cosine), 0, cosine);
    double found = 0, integral = 0, light = 0, sampled = 0;
    constexpr std::uint32_t kCount = 1 << 17;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const SamplePair u = numbers.pair(i, 0);
      const ReflectedSample s = sample_reflection(r, out, u, numbers.pair(i, 1).x);
      found += s.density > 0 && s.in.x < -0.3f, sampled += double(s.weight.y);
      // Evenly over the half sphere.
      const float flat = std::sqrt(1 - u.x * u.x), turn = float(2 * kPi) * u.y;
      const Vec3f in(flat * std::cos(turn), flat * std::sin(turn), u.x);
      integral += in.x < -0.3f ? 2 * kPi * double(reflection_density(r, out, in)) : 0;
      light += 2 * kPi * double(reflect_share(r, out, in).y);
    }
    EXPECT_NEAR(found / kCount, integral / kCount, 0.004) << cosine;
    EXPECT_NEAR(sampled / kCount, light / kCount, 0.004) << cosine;
    const double mirrored = double(mirrored_share(r.gloss, cosine));
    EXPECT_NEAR(sampled / kCount, mirrored + 0.4 * (1 - mirrored), 0.004) << cosine;
  }
}

TEST(Reflection, IsTheSameBothWays) {
  const Reflection r = glossy(0.4f, 0.2f, 0.25f);
  const Vec3f a = normalized(Vec3f(0.3f, 0.1f, 0.6f)), b = normalized(Vec3f(-0.7f, 0.2f, 0.3f));
  EXPECT_NEAR(reflect_share(r, a, b).x / b.z, reflect_share(r, b, a).x / a.z, 1e-5);
}

TEST(TracedSun, OnAPlaneGivesAlbedoTimesCosineOverPi) {
  TracedWorld world(bare(make_plate(1000)), [](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = matt(0.4f);
  });
  LightModel& sun = world.lights.lights.front();
  sun.type = LightType::directional, sun.colour = {90, 100, 80};
  sun.axis = -normalized(Vec3f(0.5f, 0.2f, 0.7f));
  const TracedImage image =
      world.trace(look_at({0, 0, 2}, {1, 0, 0}), pinhole(8, 8, 20), with_samples(16));
  const double cosine = 0.7 / std::sqrt(0.25 + 0.04 + 0.49);
  EXPECT_NEAR(mean_green(image) / (100 * cosine * 0.4 / kPi), 1, 0.002);
}

// The edge of a roof's shadow is as wide as the disc of the sun is at that distance.
TEST(TracedSun, HasAPenumbra) {
  Scene scene = bare(make_plate(1000));
  scene.meshes.push_back(share(make_box({20, 20, 0.1})));
  scene.instances.push_back({1, 1, {{}, {10, 0, 10.05}}, 2});
  TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = matt(piece == 1 ? 0.5f : 0);  // or the roof would light the floor
  });
  LightModel& sun = world.lights.lights.front();
  sun.type = LightType::directional, sun.colour = {100, 100, 100}, sun.axis = {0, 0, -1};
  // Looks straight down at the edge's shadow, x = 0; a pixel is 2 mm wide.
  const Pose down{portable::quat_from_rpy(0, kPi / 2, 0), {0, 0, 2}};
  const TracedImage image = world.trace(down, pinhole(16, 128, 1000), with_samples(256));
  std::vector<double> rows;  // along X, downwards in the image
  for (int v = 0; v < 128; ++v) {
    double sum = 0;
    for (int u = 0; u < 16; ++u) sum += double(image.light[std::size_t(v * 16 + u)].y) / 16;
    rows.push_back(sum / (100 * 0.5 / kPi));
  }
  const double wide = 0.002 * double(std::count_if(rows.begin(), rows.end(), [](double r) { return r > 0.01 && r < 0.99; }));
  const double disc = 2 * 10 * std::sqrt(6.8e-5 / kPi);  // its shadow's width: 93 mm
  EXPECT_NEAR(wide, 0.96 * disc, 0.004);
  EXPECT_NEAR(rows[63] + rows[64], 1, 0.02);  // half the disc in the middle
}

TEST(TracedLamp, FallsWithTheSquareOfTheDistance) {
  TracedWorld world(bare(make_plate(1000)), [](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = matt(0.5f);
  });
  LampSpec lamp;
  lamp.position = {0, 0, 0};
  const Intrinsics k = pinhole(4, 4, 4000);
  for (const double height : {0.5, 2.0, 8.0}) {
    const Pose down{portable::quat_from_rpy(0, kPi / 2, 0), {0, 0, height}};
    world.lamp = place_lamp(lamp, {0.1f, 0.1f, 0.1f}, down);
    const TracedImage image = world.trace(down, k, with_samples(4));
    EXPECT_NEAR(mean_green(image) / (0.1 / (height * height) * 0.5 / kPi), 1, 1e-3) << height;
  }
  // On the axis of a ring of diodes: I d / (d^2 + r^2)^1.5.
  lamp.shape = LampShape::ring, lamp.size = 0.4;
  const Pose down{portable::quat_from_rpy(0, kPi / 2, 0), {0, 0, 0.5}};
  lamp.cone_deg = 170;
  world.lamp = place_lamp(lamp, {0.1f, 0.1f, 0.1f}, down);
  const double cone = 1 / (1 - std::cos(85 * kPi / 180)), far = std::sqrt(0.29);
  const double fall = std::exp2(-std::pow((1 - 0.5 / far) * cone, 2));
  const TracedImage image = world.trace(down, k, with_samples(64));
  EXPECT_NEAR(mean_green(image) / (0.1 * fall * 0.5 / (far * far * far) * 0.5 / kPi), 1, 2e-3);
}

// Two equal squares that face each other at the distance of their side: F = 0.199825.
TEST(FormFactor, OfTwoPlatesIsTheKnownOne) {
  Scene scene = bare(make_plate(1));
  scene.instances.push_back({0, 1, {portable::quat_from_rpy(kPi, 0, 0), {0, 0, 1}}, 2});
  TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = matt(piece == 1 ? 1.0f : 0.0f);
    if (piece == 2) p.emission = {1, 1, 1};
  });
  // Through the back of the glowing one, which the camera does not see; the image is the plate.
  const Pose down{portable::quat_from_rpy(0, kPi / 2, 0), {0, 0, 4}};
  const TracedImage image = world.trace(down, pinhole(32, 32, 128), with_samples(512));
  EXPECT_NEAR(mean_green(image) / 0.199825, 1, 0.005);
}

// Glass without dust; what it absorbs it glows.
void find_clean_glass(const SurfaceQuery& q, SurfacePoint& p, bool glows) {
  const scalar::SheetShares sheet = scalar::find_sheet_shares(-dot(q.direction, p.face_normal));
  p.reflection = glossy(0, 1, 0.03f), p.reflection.gloss.cover = sheet.mirrored;
  p.passed = scalar::to_vec3(sheet.passed);
  if (glows) p.emission = Vec3f(1, 1, 1) * (1 - sheet.mirrored) - p.passed;
}

// By Fresnel's equations, in green, of one sheet without dust.
struct Pane {
  double mirrored = 0, passed = 0;
};
Pane pane_at(double angle) {
  const double n = 1.52, inner = std::asin(std::sin(angle) / n), a = std::pow(0.905, 1 / std::cos(inner));
  const double s = angle > 0 ? std::sin(angle - inner) / std::sin(angle + inner) : (n - 1) / (n + 1);
  const double p = angle > 0 ? std::tan(angle - inner) / std::tan(angle + inner) : (n - 1) / (n + 1);
  Pane out;
  for (const double r : {s * s, p * p}) {
    double light = 1 - r;  // that is in the glass, before it crosses
    out.mirrored += 0.5 * r;
    for (int crossing = 0; crossing < 60; ++crossing) {
      light *= a;
      (crossing % 2 ? out.mirrored : out.passed) += 0.5 * light * (1 - r);
      light *= r;
    }
  }
  return out;
}

TEST(Glass, SharesAreThoseOfFresnelsEquations) {
  EXPECT_NEAR(2 * std::pow(0.52 / 2.52, 2) / (1 + std::pow(0.52 / 2.52, 2)), 0.0817, 1e-4);  // without absorption
  for (const double degrees : {0.0, 30.0, 56.66, 70.0, 85.0}) {
    const double angle = degrees * kPi / 180;
    const scalar::SheetShares sheet = scalar::find_sheet_shares(float(std::cos(angle)));
    EXPECT_NEAR(double(sheet.mirrored), pane_at(angle).mirrored, 1e-4) << degrees;
    EXPECT_NEAR(double(sheet.passed.y), pane_at(angle).passed, 1e-4) << degrees;
  }
  const scalar::SheetShares facing = scalar::find_sheet_shares(1);
  EXPECT_NEAR(double(facing.passed.x), 0.79, 0.005);
  EXPECT_NEAR(double(facing.passed.y), 0.83, 0.005);
  EXPECT_NEAR(double(facing.passed.z), 0.80, 0.005);
}

// Panes in balance with an even light cannot be seen, neither one by itself nor one through another.
TEST(Furnace, PanesInABalancedRoomVanish) {
  Scene scene = bare(make_room({4, 3, 2.5}));
  scene.meshes.push_back(share(make_pane({0.006, 1.6, 1.2})));
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0.1, 0.2, 0.5), {0.9, 0.1, 0}}, 2});
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0, 0.6, -0.4), {1.4, 0, 0}}, 3});
  TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery& q, SurfacePoint& p) {
    if (piece > 1) return find_clean_glass(q, p, true);
    p.reflection = matt(0.5f), p.emission = {0.5f, 0.5f, 0.5f};
  });
  const TracedImage image =
      world.trace(look_at({-1.2, 0, 0}, {2, 0, 0}), pinhole(16, 16, 12), with_samples(512));
  EXPECT_NEAR(mean_green(image), 1, 0.005);
  for (const Vec3f& light : image.light) EXPECT_NEAR(double(light.y), 1, 0.1);
}

// A wall that glows behind a tilted pane, and nothing else to see: the light that passes. Then a sky that the pane mirrors.
TEST(TracedGlass, ShowsWhatIsBehindAndBesideAsFresnelsEquationsSay) {
  for (const double degrees : {20.0, 45.0, 70.0}) {
    const double angle = degrees * kPi / 180;
    Scene scene = bare(make_plate(1), {portable::quat_from_rpy(0, -kPi / 2, 0), {3, 0, 0}});
    scene.meshes.push_back(share(make_pane({0.006, 1, 1})));
    scene.instances.push_back({1, 1, {portable::quat_from_rpy(0, angle, 0), {1, 0, 0}}, 2});
    TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery& q, SurfacePoint& p) {
      if (piece > 1) return find_clean_glass(q, p, false);
      p.emission = {1, 1, 1};
    });
    const TracedImage image = world.trace({}, pinhole(16, 16, 4000), with_samples(1024));
    EXPECT_NEAR(mean_green(image) / pane_at(angle).passed, 1, 0.005) << degrees;
    set_even_sky(world.lights, 1);
    const TracedImage with_sky = world.trace({}, pinhole(16, 16, 4000), with_samples(1024));
    const double expected = pane_at(angle).passed + pane_at(angle).mirrored;
    EXPECT_NEAR(mean_green(with_sky) / expected, 1, 0.01) << degrees;
  }
}

// The sun on a plane under a pane, and a lamp behind one.
TEST(TracedGlass, WeakensTheLightOfLampAndSun) {
  Scene scene = bare(make_plate(1000));
  scene.meshes.push_back(share(make_pane({4, 4, 0.004})));
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0.5, 0, 0), {0, 0, 3}}, 2});
  TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery& q, SurfacePoint& p) {
    if (piece > 1) return find_clean_glass(q, p, false);
    p.reflection = matt(0.02f);  // or the pane would throw its light back
  });
  LightModel& sun = world.lights.lights.front();
  sun.type = LightType::directional, sun.colour = {100, 100, 100}, sun.axis = {0, 0, -1};
  const Pose down{portable::quat_from_rpy(0, kPi / 2, 0), {0, 0, 1}};
  const TracedImage by_sun = world.trace(down, pinhole(4, 4, 100), with_samples(64));
  EXPECT_NEAR(mean_green(by_sun) / (100 * 0.02 / kPi), pane_at(0.5).passed, 0.003);
  sun.colour = {};
  LampSpec lamp;
  lamp.position = {-4, 0, 0};  // above the pane
  world.lamp = place_lamp(lamp, {0.1f, 0.1f, 0.1f}, down);
  const TracedImage by_lamp = world.trace(down, pinhole(4, 4, 4000), with_samples(64));
  EXPECT_NEAR(mean_green(by_lamp) / (0.1 / 25 * 0.02 / kPi), pane_at(0.5).passed, 0.003);
}

Air even_air(double density, double albedo, double g) {
  AirSpec spec;
  spec.fog_density = density, spec.fog_intensity = albedo, spec.fog_asymmetry = g;
  return Medium(spec, 1).at(0);
}
Aabb cube(double half) {
  Aabb box;
  box.include({-half, -half, -half}), box.include({half, half, half});
  return box;
}

TEST(TracedAir, TakesLightAwayAsBeerAndLambertSay) {
  TracedWorld world(bare(make_plate(100), {portable::quat_from_rpy(0, -kPi / 2, 0), {3, 0, 0}}),
                    [](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) { p.emission = {1, 1, 1}; });
  for (const double density : {0.1, 0.5}) {
    world.air = AirPath(even_air(density, 0, 0), cube(10));
    const TracedImage image = world.trace({}, pinhole(16, 16, 4000), with_samples(1024));
    EXPECT_NEAR(mean_green(image) / std::exp(-3 * density), 1, 0.005) << density;
  }
}

// Where hardly any light is scattered twice: a beam from straight above, that came through 4 m of it.
TEST(TracedAir, ScattersABeamOnceAsTheIntegralSays) {
  for (const double g : {0.0, 0.7}) {
    // A small wall behind it, or it would cut into the penumbra of the beam.
    TracedWorld world(bare(make_plate(1), {portable::quat_from_rpy(0, -kPi / 2, 0), {3, 0, 0}}),
                      [](std::uint32_t, const SurfaceQuery&, SurfacePoint&) {});
    LightModel& beam = world.lights.lights.front();
    beam.type = LightType::directional, beam.colour = {100, 100, 100}, beam.axis = {0, 0, -1};
    const double density = 0.2, albedo = 1e-3;
    world.air = AirPath(even_air(density, albedo, g), cube(4));
    const TracedImage image = world.trace({}, pinhole(16, 16, 4000), with_samples(1024));
    const double expected = 100 * albedo * phase_function(g, 0) * std::exp(-4 * density) *
                            (1 - std::exp(-3 * density));
    EXPECT_NEAR(mean_green(image) / expected, 1, 0.01) << g;
  }
}

// The glow of a lamp beside the lens: the integral by quadrature.
TEST(TracedAir, GlowsAroundTheLampAsTheIntegralSays) {
  TracedWorld world(bare(make_plate(100), {portable::quat_from_rpy(0, -kPi / 2, 0), {3, 0, 0}}),
                    [](std::uint32_t, const SurfaceQuery&, SurfacePoint&) {});
  LampSpec lamp;
  lamp.position = {0, 0, 0.05}, lamp.cone_deg = 90;
  world.lamp = place_lamp(lamp, {0.1f, 0.1f, 0.1f}, {});
  const double density = 0.3, albedo = 1e-3, g = 0.6;
  world.air = AirPath(even_air(density, albedo, g), cube(4));
  double expected = 0;
  constexpr int kSteps = 200000;
  for (int i = 0; i < kSteps; ++i) {
    const double x = 0.01 + (3 - 0.01) * (i + 0.5) / kSteps;  // from the near plane on
    const double d = std::sqrt(x * x + 0.0025), c = x / d;
    const double fall = std::exp2(-std::pow((1 - c) / (1 - std::cos(kPi / 4)), 2));
    expected += 0.1 * fall / (d * d) * phase_function(g, -c) * std::exp(-density * (x + d)) *
                density * albedo * (3 - 0.01) / kSteps;
  }
  const TracedImage image = world.trace({}, pinhole(8, 8, 40000), with_samples(1024));
  EXPECT_NEAR(mean_green(image) / expected, 1, 0.01);
}

// Air that scatters all light and takes none: a white furnace with fog in it.
TEST(TracedAir, LosesNoLightBetweenGlowingWalls) {
  TracedWorld world(bare(make_room({4, 3, 2.5})), [](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = matt(0.5f), p.emission = {0.5f, 0.5f, 0.5f};
  });
  AirSpec spec;
  spec.fog_density = 0.5, spec.fog_intensity = 1, spec.fog_noise = 0.8, spec.fog_height = 1;
  world.air = AirPath(Medium(spec, 1).at(0), cube(4));
  const TracedImage image =
      world.trace(look_at({0.4, 0.2, 0.1}, {2, 1, 0}), pinhole(16, 16, 10), with_samples(512));
  EXPECT_NEAR(mean_green(image), 1, 0.005);
}

TEST(PathTracer, GivesTheSameBitsInTilesOfAnySize) {
  TracedWorld world(bare(make_room({4, 3, 2.5})), [](std::uint32_t, const SurfaceQuery&, SurfacePoint& p) {
    p.reflection = glossy(0.5f, 0.1f, 0.2f), p.emission = {p.position.x > 1 ? 1.0f : 0, 0.1f, 0};
  });
  const auto draw = [&](int tile, std::uint64_t seed) {
    TraceOptions options = with_samples(9);
    options.seed = seed;
    return world.trace(look_at({0.4, 0.2, 0.1}, {2, 1, 0}), pinhole(33, 17, 20), options, tile).light;
  };
  EXPECT_TRUE(draw(8, 3) == draw(16, 3));
  EXPECT_TRUE(draw(5, 3) == draw(64, 3));
  EXPECT_FALSE(draw(8, 3) == draw(8, 4));
}

TEST(PathTracer, GivesTheSameBitsBehindGlass) {
  Scene scene = bare(make_room({4, 3, 2.5}));
  scene.meshes.push_back(share(make_pane({0.006, 1, 1})));
  scene.instances.push_back({1, 1, {portable::quat_from_rpy(0.1, 0.2, 0.5), {1.2, 0.1, 0}}, 2});
  TracedWorld world(scene, [](std::uint32_t piece, const SurfaceQuery& q, SurfacePoint& p) {
    if (piece > 1) return find_clean_glass(q, p, false);
    p.reflection = glossy(0.5f, 0.1f, 0.2f), p.emission = {p.position.x > 1 ? 1.0f : 0, 0.1f, 0};
  });
  const auto draw = [&](int tile) {
    return world.trace(look_at({0.4, 0.2, 0.1}, {2, 1, 0}), pinhole(33, 17, 20), with_samples(9), tile).light;
  };
  EXPECT_TRUE(draw(8) == draw(16));
  EXPECT_TRUE(draw(5) == draw(64));
}

// The error of a well spread sequence falls faster than that of dice, as one over the root of n.
TEST(SampleSequence, FillsSquaresEvenly) {
  for (std::uint32_t use = 0; use < 20; ++use) {
    const SampleSequence numbers(7, use * 13);
    std::vector<int> cells(64 * 4, 0);
    for (std::uint32_t i = 0; i < 256; ++i) {
      const SamplePair p = numbers.pair(i, use);
      ASSERT_TRUE(p.x >= 0 && p.x < 1 && p.y >= 0 && p.y < 1);
      ++cells[std::size_t(p.y * 16) * 16 + std::size_t(p.x * 16)];
    }
    for (const int count : cells) EXPECT_EQ(count, 1);
  }
}

}  // namespace path_tracer_test
}  // namespace rubble::testing
