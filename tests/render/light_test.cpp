// Light and air against closed forms, in luminance before exposure and tone mapping.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/lighting.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace {

// The camera looks along +X at a wall 2 m away.
Scene wall() {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.type = LightType::point;
  scene.light.intensity = 0;
  scene.meshes.push_back(share(make_box({1, 30, 30}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {2.5, 0, 0}}, 1});
  return scene;
}

RenderOptions plain() {
  RenderOptions options;
  options.bake = false;
  options.shadow_size = 256;
  options.texture_size = 64;
  return options;
}

// Mean green radiance of the middle pixels.
double middle(const LinearFrame& frame, int half = 4) {
  double sum = 0;
  int count = 0;
  for (int v = frame.height / 2 - half; v < frame.height / 2 + half; ++v)
    for (int u = frame.width / 2 - half; u < frame.width / 2 + half; ++u, ++count)
      sum += double(frame.rgb[std::size_t(v * frame.width + u) * 3 + 1]);
  return sum / count;
}

double draw_middle(const Scene& scene) {
  GlContext context;
  return middle(Renderer(context, scene, plain()).render_linear({}, pinhole(128, 128, 400)));
}

double without_light() { return draw_middle(wall()); }

Scene with_lamp(double behind) {
  Scene scene = wall();
  scene.lamp = {true, 1000, 60, {-behind, 0, 0}};
  return scene;
}

TEST(Lamp, FallsWithTheSquareOfTheDistance) {
  const double dark = without_light();
  const double at2 = draw_middle(with_lamp(0)) - dark, at4 = draw_middle(with_lamp(2)) - dark;
  EXPECT_NEAR(at2 / at4, 4.0, 0.04);
  EXPECT_GT(at2, 10 * dark);
}

TEST(Lamp, HasHalfItsIntensityAtTheHalfPowerAngle) {
  const double dark = without_light();
  // The same spot of the wall under a narrow and a wide lamp, on the axis and 30 degrees off it.
  GlContext context;
  const auto lit = [&](double cone_deg, const Intrinsics& k) {
    Scene scene = with_lamp(0);
    scene.lamp.cone_deg = cone_deg;
    return middle(Renderer(context, scene, plain()).render_linear({}, k), 2);
  };
  const Intrinsics ahead = pinhole(128, 128, 400);
  Intrinsics aside = ahead;
  aside.cx = 63.5 - 400 * std::tan(portable::kPi / 6);
  EXPECT_NEAR((lit(60, ahead) - dark) / (lit(170, ahead) - dark), 1.0, 0.005);
  const double x = (1 - std::cos(portable::kPi / 6)) / (1 - std::cos(85 * portable::kPi / 180));
  const double expected = 0.5 / std::exp2(-x * x);
  EXPECT_NEAR((lit(60, aside) - dark) / (lit(170, aside) - dark), expected, 0.01);
}

Scene with_light(LightType type, const Vec3& position, const Vec3& rpy_deg, double intensity) {
  Scene scene = wall();
  scene.light.type = type;
  scene.light.position = position;
  scene.light.rpy_deg = rpy_deg;
  scene.light.intensity = intensity;
  scene.light.cone_deg = 40;
  return scene;
}

TEST(PointLight, FallsWithTheSquareOfTheDistanceAndIsLinear) {
  const double dark = without_light();
  const auto from = [&](double x, double kcd) {
    return draw_middle(with_light(LightType::point, {x, 0, 0}, {}, kcd)) - dark;
  };
  const double at1 = from(1, 2);
  EXPECT_NEAR(at1 / from(-1, 2), 9.0, 0.1);
  EXPECT_NEAR(from(1, 6) / at1, 3.0, 0.01);
}

TEST(SpotLight, LightsItsConeAlone) {
  const double dark = without_light();
  const double ahead = draw_middle(with_light(LightType::spot, {0, 0, 0}, {0, 0, 0}, 5)) - dark;
  const double point = draw_middle(with_light(LightType::point, {0, 0, 0}, {0, 0, 0}, 5)) - dark;
  const double aside = draw_middle(with_light(LightType::spot, {0, 0, 0}, {0, 30, 0}, 5)) - dark;
  EXPECT_NEAR(ahead / point, 1.0, 0.01);
  EXPECT_NEAR(aside / point, 0.0, 1e-4);
}

TEST(DirectionalLight, FollowsTheCosine) {
  // The sky's share does not depend on the direction with the sun well above the horizon; take it
  // away by a sun that comes from behind the wall.
  const auto sun = [&](double yaw, double pitch) {
    return draw_middle(with_light(LightType::directional, {}, {0, pitch, yaw}, 100));
  };
  const double behind = sun(180, 40), straight = sun(0, 40) - behind,
               slanting = sun(50, 40) - behind;
  EXPECT_NEAR(slanting / straight, std::cos(50 * portable::kPi / 180), 0.03);
  EXPECT_GT(straight, behind);
}

TEST(DirectionalLight, HasTheLuminanceOfALambertianSurface) {
  // 100 klx at 40 degrees on plaster of albedo 0.42 to 0.66: between these, L = E cos a / pi.
  const double e = 100 * std::cos(40 * portable::kPi / 180) / portable::kPi;
  const double behind = draw_middle(with_light(LightType::directional, {}, {0, 40, 180}, 100));
  const double lit = draw_middle(with_light(LightType::directional, {}, {0, 40, 0}, 100)) - behind;
  EXPECT_GT(lit, 0.35 * e);
  EXPECT_LT(lit, 0.75 * e);
}

class Shadow : public ::testing::TestWithParam<LightType> {};

TEST_P(Shadow, LiesBehindWhatStandsInTheWay) {
  // From above and behind the camera, over a plate that floats between light and wall.
  Scene scene = with_light(GetParam(), {-2, 0, 0}, {0, 0, 0}, 50);
  scene.light.cone_deg = 60;
  const double lit = draw_middle(scene);
  scene.meshes.push_back(share(make_box({0.01, 0.5, 0.5})));
  scene.instances.push_back({1, 1, {{}, {-1, 0, 0}}, 2});  // behind the camera: not in the picture
  const double shaded = draw_middle(scene);
  scene.instances.back().world_from_body.translation = {-1, 5, 0};
  EXPECT_NEAR(draw_middle(scene), lit, 1e-3 * lit);  // negative control: moved aside
  EXPECT_LT(shaded, 0.5 * lit);
  if (GetParam() != LightType::directional) {
    EXPECT_LT(shaded, 0.01 * lit);
  }
}

INSTANTIATE_TEST_SUITE_P(Types, Shadow,
                         ::testing::Values(LightType::directional, LightType::spot,
                                           LightType::point));

class Fog : public ::testing::TestWithParam<double> {};

TEST_P(Fog, LetsThroughByTheLawOfBeerAndLambert) {
  // Fog that only absorbs; the wall is lit by the sun, whose own way through the fog is not
  // counted.
  Scene scene = with_light(LightType::directional, {}, {0, 40, 0}, 100);
  scene.air.fog_intensity = 0;
  const double clear = draw_middle(scene);
  scene.air.fog_density = GetParam();
  EXPECT_NEAR(draw_middle(scene) / clear, std::exp(-GetParam() * 2.0), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Densities, Fog, ::testing::Values(0.05, 0.3, 1.0, 3.0));

TEST(Fog, GlowsInTheLampAndBrightensWithIt) {
  Scene scene = with_lamp(0.05);
  scene.air.fog_density = 3;
  scene.air.fog_intensity = 0;
  const double dark_fog = draw_middle(scene);
  scene.air.fog_intensity = 1;
  const double bright_fog = draw_middle(scene);
  EXPECT_GT(bright_fog, 3 * dark_fog);
}

TEST(LightModel, TheBeamLeavesAlongXAndPitchLowersIt) {
  LightSpec spec;
  spec.rpy_deg = {0, 90, 0};
  const LightModel down = make_light_model(spec);
  EXPECT_NEAR(down.axis.z, -1, 1e-6);
  EXPECT_NEAR(down.at({5, 3, 0}).to_light.z, 1, 1e-6);
  const Vec3f e = down.at({}).illuminance;
  EXPECT_NEAR(0.2126f * e.x + 0.7152f * e.y + 0.0722f * e.z, 60, 1e-3);
}

}  // namespace
}  // namespace rubble::testing
