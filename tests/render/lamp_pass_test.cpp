// The lamp's light by way of surfaces and fog: by the shaders of gl beside that by the processor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace lamp_pass_test {

constexpr int kSide = 64;

RenderOptions baked() {
  RenderOptions options;
  options.threads = 2, options.texture_size = 64, options.bake_rays = 16;
  return options;
}

// A room with blocks, some in the beam, and daylight where `lit`.
Scene furnished_room(double fog_density, bool lit = false) {
  Scene scene = slab_room({4, 3, 2.4});
  scene.meshes.push_back(share(make_box({0.5, 0.6, 0.9})));
  const auto mesh = std::uint32_t(scene.meshes.size() - 1);
  scene.instances.push_back({mesh, 100, {{}, {0.6, 0.3, -0.75}}, 1});
  scene.instances.push_back({mesh, 101, {look_at({}, {0.5, 0.8, 0.3}).rotation, {1.2, -0.8, -0.6}}, 1});
  if (lit) scene.light.intensity = 1, scene.light.position = {1, 0, 0.5};
  scene.air.fog_density = fog_density;
  return scene;
}

// Beside the beam of a lamp that something else bears.
ViewRays aside() {
  ViewRays view{0, pinhole(kSide, kSide, 0.5 * kSide), look_at({-1, 0, 0}, {-1, 3, 0})};
  view.world_from_rig = look_at({-1, 0, 0}, {2, 0, 0});
  return view;
}
ViewRays ahead() {
  ViewRays view{0, pinhole(kSide, kSide, 0.5 * kSide), look_at({-1.2, 0.4, 0.3}, {2, -0.3, -0.4})};
  view.world_from_rig = look_at({-1, 0, 0}, {2, 0, 0});
  return view;
}

class LampPass : public ::testing::TestWithParam<double> {};

// Region by region: textures are mixed with other roundings.
TEST_P(LampPass, GivesTheLightThatTheProcessorDoes) {
  GlDevice gl;
  SoftwareDevice software;
  const Scene scene = furnished_room(GetParam(), true);
  Renderer by_gl(gl, scene, baked()), by_software(software, scene, baked());
  for (const ViewRays& view : {aside(), ahead()}) {
    const std::vector<float> found = by_gl.render_linear(view).rgb, expected = by_software.render_linear(view).rgb;
    constexpr int kRegion = 8;
    for (int region = 0; region < kRegion * kRegion; ++region) {
      double a = 0, b = 0;
      for (int i = 0; i < kSide / kRegion; ++i)
        for (int k = 0; k < kSide / kRegion; ++k) {
          const int v = region / kRegion * (kSide / kRegion) + i, u = region % kRegion * (kSide / kRegion) + k;
          for (int c = 0; c < 3; ++c) {
            const auto at = std::size_t((v * kSide + u) * 3 + c);
            a += double(found[at]), b += double(expected[at]);
          }
        }
      ASSERT_GT(b, 0);
      EXPECT_NEAR(a / b, 1, 0.01) << "region " << region;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fog, LampPass, ::testing::Values(0.0, 0.4));

// Nearly all that such a view shows comes from it, by way of other surfaces: without it the comparison above would fail.
TEST(LampPassControl, IsMostOfTheLight) {
  GlDevice gl;
  Scene scene = furnished_room(0);
  const auto sum = [&] {
    double out = 0;
    for (const float x : Renderer(gl, scene, baked()).render_linear(aside()).rgb) out += double(x);
    return out;
  };
  const double lit = sum();
  scene.lamp.on = false;
  EXPECT_GT(lit, 10 * sum());
}

// Pictures before it change nothing, nor does a lamp that has been put out.
TEST(LampPassControl, LeavesNothingBehind) {
  GlDevice gl;
  for (const double fog : {0.0, 0.2}) {
    const Scene scene = furnished_room(fog, true);
    LampSpec off = scene.lamp;
    off.on = false;
    Renderer renderer(gl, scene, baked());
    const auto draw = [&](const ViewRays& view) { return renderer.render_linear(view).rgb; };
    const std::vector<float> first = draw(aside());
    EXPECT_FALSE(first == draw(ahead()));
    EXPECT_TRUE(first == draw(aside()));
    renderer.restart(off, scene.air);
    const std::vector<float> dark = draw(aside());
    EXPECT_FALSE(first == dark);
    renderer.restart(scene.lamp, scene.air);
    EXPECT_TRUE(first == draw(aside()));
    renderer.restart(off, scene.air);
    EXPECT_TRUE(dark == draw(aside()));
  }
}

// Nothing of it is found on the processor, so it need not be handed over, nor waited for.
TEST(LampPassControl, HandsLittleOver) {
  GlDevice gl;
  Renderer renderer(gl, furnished_room(0.2), baked());
  renderer.view(aside()).rgb();
  const DeviceTraffic before = gl.traffic();
  renderer.view(ahead()).rgb();
  const DeviceTraffic after = gl.traffic();
  EXPECT_LT(after.given - before.given, 100000u);
  EXPECT_LE(after.waits - before.waits, 1u);
}

}  // namespace lamp_pass_test
}  // namespace rubble::testing
