// Spots on bodies that move: they light what spots that stand there light, and throw the same shadows.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace carried_light_test {

constexpr std::uint32_t kBody = 20;
constexpr double kIntensity = 400;  // unit: cd

RenderOptions plain() {
  RenderOptions options;
  options.bake = false;
  options.shadow_size = 512;
  options.texture_size = 16;
  return options;
}

Pose body_at(double t) { return {portable::quat_from_rpy(0, 0.1 * t, 0.25 - 0.3 * t), {-0.5, t - 0.6, 0.8}}; }
const Pose kBodyFromLight{portable::quat_from_rpy(0, 0.2, 0), {0.12, 0.03, 0}};

// By night: a wall, a block before it, and a small body that moves; gone after 3 s.
Scene night_scene() {
  Scene scene;
  scene.light.intensity = 0;
  scene.lamp.on = false;
  scene.meshes = {share(make_box({0.2, 4, 2.5})), share(make_box({0.3, 0.3, 0.9})), share(make_box({0.02, 0.02, 0.02}))};
  scene.instances = {{0, 1, {{}, {4, 0, 1.25}}, 10, 2}, {1, 1, {{}, {2, 0.1, 0.45}}, 11, 2}, {2, 1, {}, kBody, 2}};
  scene.motion.moving = {2};
  scene.motion.reach = {{-1, -2, 0}, {1, 4, 2}};
  scene.motion.poses_at = [](std::int64_t stamp_ns) {
    const double t = double(stamp_ns) * 1e-9;
    return std::vector<std::optional<Pose>>{t > 3 ? std::nullopt : std::optional<Pose>(body_at(t))};
  };
  return scene;
}

Scene with_carried() {
  Scene scene = night_scene();
  scene.carried_lights = {{2, kBodyFromLight, kIntensity, 50}};
  return scene;
}

Scene with_spot_at(double t) {
  Scene scene = night_scene();
  const Pose place = body_at(t) * kBodyFromLight;
  LightSpec spot;
  spot.type = LightType::spot;
  spot.intensity = 1e-3 * kIntensity;
  spot.position = place.translation;
  const Vec3 beam = place.rotation.rotate({1, 0, 0});
  spot.rpy_deg = Vec3{0, -std::asin(beam.z), std::atan2(beam.y, beam.x)} * (180 / portable::kPi);
  spot.cone_deg = 50;
  scene.more_lights = {spot};
  return scene;
}

LinearFrame draw(Renderer& renderer, double t) {
  const Pose eye{portable::quat_from_rpy(0, 0.3, 0.45), {-1.5, -2, 2.2}};
  return renderer.render_linear(ViewRays{std::llround(t * 1e9), pinhole(96, 72, 75), eye});
}

TEST(CarriedLights, ShineAsSpotsThatStandThere) {
  SoftwareDevice device;
  Renderer carried(device, with_carried(), plain());
  for (const double t : {0.3, 1.2, 0.7}) {
    Renderer standing(device, with_spot_at(t), plain());
    const LinearFrame a = draw(carried, t), b = draw(standing, t);
    double sum = 0, off = 0;
    for (std::size_t i = 0; i < a.instance.size(); ++i) {
      if (a.instance[i] == kBody) continue;
      const double x = double(a.rgb[i * 3 + 1]), y = double(b.rgb[i * 3 + 1]);
      sum += y, off += std::abs(x - y);
    }
    EXPECT_GT(sum, 1) << t;
    EXPECT_LT(off, 1e-3 * sum) << t;
  }
}

TEST(CarriedLights, DoNotShineWhenTheirBodyIsNotThere) {
  SoftwareDevice device;
  Renderer carried(device, with_carried(), plain()), none(device, night_scene(), plain());
  EXPECT_NE(draw(carried, 1).rgb, draw(none, 1).rgb);
  EXPECT_EQ(draw(carried, 4).rgb, draw(none, 4).rgb);
}

TEST(CarriedLights, ReferencePicturesFollowThem) {
  SoftwareDevice device;
  RenderOptions options = plain();
  options.colour.quality = RenderQuality::reference;
  options.colour.samples = 4;
  Renderer carried(device, with_carried(), options);
  double column[2] = {};
  for (int k = 0; k < 2; ++k) {
    const LinearFrame frame = draw(carried, k == 0 ? 0.3 : 1.2);
    double sum = 0;
    for (std::size_t i = 0; i < frame.instance.size(); ++i) {
      sum += double(frame.rgb[i * 3 + 1]);
      column[k] += double(frame.rgb[i * 3 + 1]) * double(i % 96);
    }
    column[k] /= sum;
  }
  EXPECT_GT(std::abs(column[0] - column[1]), 3) << "the middle of the light, in pixels";
}

}  // namespace carried_light_test
}  // namespace rubble::testing
