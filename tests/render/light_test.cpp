// Light and air against closed forms, in luminance before exposure and tone mapping.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/sky/atmosphere.h"
#include "render/lighting/lighting.h"
#include "render/media/medium.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace light_test {

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
  RenderOptions options = cached_options();
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
  SoftwareDevice device;
  return middle(Renderer(device, scene, plain()).render_linear({}, pinhole(128, 128, 400)));
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

// A camera that stands back sees the wall as bright as the one beside the lamp; with a lamp of its own,
// twice as far, a quarter of it.
TEST(Lamp, StaysOnTheRigThatBearsIt) {
  SoftwareDevice device;
  Renderer renderer(device, with_lamp(0), plain());
  ViewRays view{0, pinhole(128, 128, 400), {}};
  const double dark = without_light();
  const double beside = middle(renderer.render_linear(view)) - dark;
  view.world_from_camera = {{}, {-2, 0, 0}};
  const double alone = middle(renderer.render_linear(view)) - dark;
  view.world_from_rig = Pose{};
  const double back = middle(renderer.render_linear(view)) - dark;
  EXPECT_NEAR(back / beside, 1, 0.05);
  EXPECT_NEAR(alone / beside, 0.25, 0.03);
}

TEST(Lamp, HasHalfItsIntensityAtTheHalfPowerAngle) {
  const double dark = without_light();
  // The same spot of the wall under a narrow and a wide lamp, on the axis and 30 degrees off it.
  SoftwareDevice device;
  const auto lit = [&](double cone_deg, const Intrinsics& k) {
    Scene scene = with_lamp(0);
    scene.lamp.cone_deg = cone_deg;
    return middle(Renderer(device, scene, plain()).render_linear({}, k), 2);
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
  // Fog that only absorbs, between camera and wall and between light and wall.
  Scene scene = with_light(LightType::point, {}, {}, 100);
  scene.air.fog_intensity = 0;
  const double clear = draw_middle(scene);
  scene.air.fog_density = GetParam();
  EXPECT_NEAR(draw_middle(scene) / clear, std::exp(-GetParam() * 4.0), 1e-3);
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

// The lamp alone in thin smoke before black nothing: what each pixel sees is the sum along its ray,
// with the lamp where it is and light turned by the phase function.
TEST(Air, LampsBeamIsScatteredByThePhaseFunction) {
  for (const double g : {0.0, 0.75}) {
    Scene scene;
    scene.ground = false;
    scene.light.intensity = 0;
    scene.lamp.on = true;
    scene.lamp.intensity_cd = 50000;  // beside it the night sky is nothing
    scene.lamp.position = {0, -1.2, 0};  // to the right: the beam is seen from its side
    scene.lamp.cone_deg = 60;
    scene.air.fog_density = 0.1;
    scene.air.fog_asymmetry = g;
    SoftwareDevice device;
    Renderer renderer(device, scene, plain());
    const Intrinsics k = pinhole(65, 65, 40);
    const LinearFrame image = renderer.render_linear(Pose{{}, {0, 0, 20}}, k);
    for (const int u : {20, 32, 44}) {
      const Vec3 d = normalized(Vec3(1, -(u - k.cx) / k.fx, 0));  // body frame
      double sum = 0;
      const double step = 0.002;
      for (double r = step / 2; r < 60; r += step) {
        const Vec3 from = d * r - scene.lamp.position;
        const double e = norm(from), x = (1 - from.x / e) / (1 - std::cos(M_PI / 6));
        const double c = -dot(from, d) / e, base = 1 + g * g - 2 * g * c;
        sum += 0.1 * std::exp(-0.2 * r) * 50 * std::exp2(-x * x) / (e * e) * step *
               (1 - g * g) / (4 * M_PI * std::pow(base, 1.5));
      }
      const std::size_t at = (32 * 65 + std::size_t(u)) * 3;
      const double seen = 0.2126 * image.rgb[at] + 0.7152 * image.rgb[at + 1] + 0.0722 * image.rgb[at + 2];
      EXPECT_NEAR(seen / sum, 1, 0.06) << g << " " << u;
    }
  }
}

// Fog before a low sun: looking towards it is brighter than looking away.
TEST(Air, SunlightIsScatteredForwards) {
  const auto seen = [](double g, double yaw, double height) {
    Scene scene;
    scene.lamp.on = false;
    scene.light.type = LightType::directional;
    scene.light.intensity = 40;
    scene.light.rpy_deg = {0, 30, 0};  // travels along X, and down
    scene.air.fog_density = 0.5;
    scene.air.fog_height = height;
    scene.air.fog_asymmetry = g;
    SoftwareDevice device;
    RenderOptions options = plain();
    options.bake = true, options.bake_rays = 16;
    Renderer renderer(device, scene, options);
    const Pose pose{portable::quat_from_rpy(0, 0, yaw), {0, 0, 1}};
    return double(renderer.render_linear(pose, pinhole(32, 32, 40)).rgb[(8 * 32 + 16) * 3 + 1]);
  };
  // Against what even scattering gives, the sky behind the fog included.
  EXPECT_GT(seen(0.75, portable::kPi, 1), 1.2 * seen(0, portable::kPi, 1));
  EXPECT_LT(seen(0.75, 0, 1), 0.9 * seen(0, 0, 1));
  // Also in fog without end: the sun is what comes to the scene.
  EXPECT_GT(seen(0.75, portable::kPi, 0), 1.2 * seen(0, portable::kPi, 0));
}

// What is far behind fog cannot be told apart: just below the horizon the ground, just above it the
// sky.
TEST(Fog, HidesTheHorizon) {
  Scene scene;
  scene.lamp.on = false;
  scene.air.fog_density = 0.3;
  SoftwareDevice device;
  const LinearFrame frame =
      Renderer(device, scene, plain()).render_linear({{}, {0, 0, 1.5}}, pinhole(64, 64, 200));
  const auto green = [&](int row) { return double(frame.rgb[std::size_t(row * 64 + 32) * 3 + 1]); };
  EXPECT_NEAR(green(35) / green(28), 1, 0.02);
}

// A ring of radius R gives on its axis, at the distance d, E = I d / (d^2 + R^2)^1.5.
TEST(Lamp, ARingIsWeakerNearby) {
  const double dark = without_light();
  const auto lit = [&](LampShape shape, double distance) {
    Scene scene = with_lamp(distance - 2);
    scene.lamp.cone_deg = 170;
    scene.lamp.shape = shape;
    scene.lamp.size = 1;
    return draw_middle(scene) - dark;
  };
  for (const double d : {0.7, 1.5, 4.0}) {
    const double ring = lit(LampShape::ring, d) / lit(LampShape::point, d);
    EXPECT_NEAR(ring, std::pow(d * d / (d * d + 0.25), 1.5), 0.01) << d;
  }
}

TEST(Lamp, ThrowsItsOwnShadow) {
  // A plate half-way to the wall; the lamp is 20 cm beside the lens, so the shadow lies 20 cm beside.
  Scene scene = with_lamp(0);
  scene.lamp.position = {0, 0.2, 0};
  scene.meshes.push_back(share(make_box({0.01, 0.2, 0.2}, "plaster")));
  const auto column = [&](bool plate) {
    scene.instances.resize(1);
    if (plate) scene.instances.push_back({1, 1, {{}, {1.0, 0.1, 0}}, 2});
    SoftwareDevice device;
    const LinearFrame f =
        Renderer(device, scene, plain()).render_linear({}, pinhole(256, 256, 300));
    // On the wall 5 cm to the right of the axis; the plate is to the left.
    return double(f.rgb[std::size_t(128 * 256 + 128 + int(0.02 / 2 * 300)) * 3 + 1]);
  };
  const double free = column(false), shaded = column(true);
  EXPECT_LT(shaded, 0.25 * free);
}

TEST(Lights, AddUp) {
  const double dark = without_light();
  Scene one = with_light(LightType::point, {1, 0, 0}, {}, 2);
  Scene other = with_light(LightType::spot, {0, 0, 0}, {}, 5);
  Scene both = one;
  both.more_lights = {other.light};
  const double a = draw_middle(one) - dark, b = draw_middle(other) - dark;
  EXPECT_GT(std::min(a, b), 0.01);
  EXPECT_NEAR(draw_middle(both) - dark, a + b, 0.005 * (a + b));
  both.more_lights.assign(kMostLights, other.light);
  EXPECT_THROW(draw_middle(both), std::runtime_error);
}

// Figures of daylight: 100 klx of sun and 8 to 15 klx of clear sky at noon, 0.4 to 1.5 klx at
// sunset, about 3.4 lx at the end of civil twilight (IES, and every book on daylight).
TEST(Sun, GivesDaylightByItsElevation) {
  const auto lum = [](const Vec3f& c) {
    return 0.2126 * double(c.x) + 0.7152 * double(c.y) + 0.0722 * double(c.z);
  };
  const auto sky_klx = [&](double elevation) {
    Scene scene;
    scene.light.type = LightType::sun;
    scene.light.elevation_deg = elevation;
    return portable::kPi * lum(make_lights(scene).sky.mean);
  };
  EXPECT_NEAR(lum(sun_illuminance(60)), 105, 10);
  EXPECT_NEAR(sky_klx(60), 10, 4);
  EXPECT_GT(sky_klx(0), 0.4);
  EXPECT_LT(sky_klx(0), 1.6);
  EXPECT_GT(sky_klx(-6), 0.002);
  EXPECT_LT(sky_klx(-6), 0.008);
  EXPECT_LT(sky_klx(-18), 1e-5);
  EXPECT_EQ(lum(sun_illuminance(-1)), 0);
  // Reddening: at noon it is nearly white, near the horizon red outweighs blue many times.
  EXPECT_LT(sun_illuminance(60).x / sun_illuminance(60).z, 1.4f);
  EXPECT_GT(sun_illuminance(3).x / sun_illuminance(3).z, 6.0f);
  double last = 1e9;
  for (double e = 60; e >= -18; e -= 6) {
    EXPECT_LT(sky_klx(e), last);
    last = sky_klx(e);
  }
}

TEST(Sky, TheMapIsTheFormula) {
  Scene scene;
  scene.light.type = LightType::sun;
  scene.light.elevation_deg = 25;
  scene.light.azimuth_deg = 70;
  const Sky sky = make_lights(scene).sky;
  for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(1, 0, 0.3f), Vec3f(-0.3f, -1, 0.15f), Vec3f(0.5f, 1, 1)}) {
    const Vec3f n = normalized(d), want = ClearSky(sky.sun_direction).radiance(n);
    EXPECT_NEAR(sky.radiance(n).y, want.y, 0.04f * want.y);
    EXPECT_NEAR(sky.radiance(n).z, want.z, 0.04f * want.z);
  }
}

// What the air's table lets through is what the medium says, and so what the image shows.
TEST(Air, TheImageFollowsTheMedium) {
  Scene scene = with_light(LightType::point, {}, {}, 100);
  scene.air.fog_intensity = 0;  // it only absorbs
  const double clear = draw_middle(scene);
  scene.air.fog_density = 0.4;
  scene.air.fog_height = 3;
  EXPECT_NEAR(draw_middle(scene) / clear, std::exp(-0.4 * 4), 0.01);  // level: as at z = 0
  scene.air.fog_noise = 0.9;
  scene.air.fog_noise_size = 0.7;
  // Billows count on the way to the camera; the light's own way is through their mean.
  const Air air = Medium(scene.air, scene.seed).at(0);
  EXPECT_NEAR(draw_middle(scene) / clear, std::exp(-air.optical_depth({}, {1, 0, 0}, 2) - 0.4 * 2), 0.02);
}

TEST(Wetness, DarkensAndGlitters) {
  Scene scene = with_light(LightType::directional, {}, {0, 40, 0}, 100);
  const double dry = draw_middle(scene);
  scene.wetness = 1;
  EXPECT_LT(draw_middle(scene), 0.9 * dry);
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

}  // namespace light_test
}  // namespace rubble::testing
