// Colours by the software device beside those by the shaders of gl, whose formulas they
// repeat; and the same bits from every instruction set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "render/camera/lens.h"
#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/passes/antialias.h"
#include "render/renderer.h"
#include "render/shading/wide_shader.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace shading_test {

constexpr int kWidth = 186, kHeight = 143;  // no multiple of any width of registers

struct View {
  const char* name;
  std::function<void(Scene&)> change;
  Vec3 eye, target;
  bool wide = false;  // by a lens with distortion, each pixel with a ray of its own
};

void to_sun(Scene& scene) {
  scene.light = {};
  scene.light.type = LightType::sun, scene.light.elevation_deg = 35, scene.light.azimuth_deg = 60;
}

void to_night(Scene& scene) {
  scene.light = {};
  scene.light.type = LightType::spot, scene.light.intensity = 2, scene.light.cone_deg = 70;
  scene.light.position = {3, -2, 4}, scene.light.rpy_deg = {0, 50, 145};
  LightSpec point;
  point.type = LightType::point, point.intensity = 0.3, point.position = {-1, 2, 1.5};
  scene.more_lights.push_back(point);
}

// Four sheets of glass between the eye and the heap, some behind each other, and a block with glass all about.
void put_panes(Scene& scene) {
  to_sun(scene);
  scene.meshes.push_back(share(make_box({0.006, 1.6, 1.2}, "glass")));
  scene.meshes.push_back(share(make_box({0.5, 0.4, 0.4}, "glass")));
  const std::uint32_t pane = std::uint32_t(scene.meshes.size()) - 2;
  for (int i = 0; i < 4; ++i)
    scene.instances.push_back({pane, 1,
                               {portable::quat_from_rpy(0.1 * i, 0.3 - 0.2 * i, 0.3 * i), {3.2 - 0.4 * i, 1.2 - 0.4 * i, 1.5}},
                               std::uint32_t(scene.instances.size())});
  scene.instances.push_back({pane + 1, 1, {{}, {3, 2, 1}}, std::uint32_t(scene.instances.size())});
}

const std::vector<View>& views() {
  static const std::vector<View> all{
      {"sun", to_sun, {5, 2, 2}, {-1.5, 0.1, 0.5}},
      {"sun, wide lens", to_sun, {3, 2, 2}, {-1.5, 0.1, 0.5}, true},
      {"void with lamp", [](Scene& s) { s.lamp.on = true; }, {1, 0.2, 0.6}, {-1.5, 0.1, 0.5}},
      {"fog with lamp",
       [](Scene& s) { s.lamp.on = true, s.air.fog_density = 0.15, s.air.fog_noise = 0.5; },
       {1, 0.2, 0.6},
       {-1.5, 0.1, 0.5}},
      {"fog that thins",
       [](Scene& s) { to_sun(s), s.air.fog_density = 0.2, s.air.fog_height = 3; },
       {5, 2, 2},
       {-1.5, 0.1, 0.5}},
      {"wet", [](Scene& s) { to_sun(s), s.wetness = 0.8; }, {4, -3, 2}, {-1.5, 0.1, 0.5}},
      {"night", to_night, {4, -3, 2}, {-1.5, 0.1, 0.5}},
      {"night, wet, lamp",
       [](Scene& s) { to_night(s), s.wetness = 1, s.lamp.on = true; },
       {3, 1, 1},
       {-1.5, 0.1, 0.5}},
      {"horizon", to_sun, {7, 1, 1.2}, {0, 0, 1.3}},
      {"panes", put_panes, {5, 2, 2}, {-1.5, 0.1, 0.5}},
      {"panes, wide lens", put_panes, {4.5, 2, 2}, {-1.5, 0.1, 0.5}, true},
      {"panes, fog, wet, lamp",
       [](Scene& s) { put_panes(s), s.air.fog_density = 0.1, s.wetness = 0.5, s.lamp.on = true; },
       {5, 2, 2},
       {-1.5, 0.1, 0.5}}};
  return all;
}

RenderOptions plain() {
  RenderOptions options = cached_options();
  options.texture_size = 128, options.shadow_size = 1024, options.bake_rays = 16;
  options.antialias = false;
  return options;
}

ViewRays rays_of(const View& view) {
  Intrinsics k = pinhole(kWidth, kHeight, view.wide ? 70 : 120);
  if (view.wide) k.lens = LensModel::fisheye;
  ViewRays rays{1000000000, k, look_at(view.eye, view.target)};
  if (view.wide) rays.directions = make_lens_directions(k, 1);
  return rays;
}

class Shading : public ::testing::TestWithParam<std::size_t> {
 protected:
  const View& view() const { return views()[GetParam()]; }
  Scene scene() const {
    Scene heap = make_heap(60, 4);
    view().change(heap);
    return heap;
  }
};

// A suite of its own, so that the two run beside each other.
class ShadingBits : public Shading {};

INSTANTIATE_TEST_SUITE_P(Views, Shading, ::testing::Range(std::size_t(0), views().size()));
INSTANTIATE_TEST_SUITE_P(Views, ShadingBits, ::testing::Range(std::size_t(0), views().size()));

// Textures are halved and mixed with other roundings there, so pixels differ by a step or two.
TEST_P(Shading, IsThatOfTheShadersOfGl) {
  GlDevice gl;
  SoftwareDevice software;
  Renderer by_gl(gl, scene(), plain()), by_software(software, scene(), plain());
  RenderedView a = by_gl.view(rays_of(view())), b = by_software.view(rays_of(view()));
  EXPECT_NEAR(double(b.exposure() / a.exposure()), 1, 0.01);
  const std::vector<std::uint8_t>& expected = a.rgb();
  const std::vector<std::uint8_t>& found = b.rgb();
  ASSERT_EQ(expected.size(), found.size());
  double sum = 0, bias = 0;
  int far = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const int difference = int(found[i]) - int(expected[i]);
    sum += std::abs(difference), bias += difference, far += std::abs(difference) > 8;
  }
  EXPECT_LT(sum / double(found.size()), 0.7) << view().name;
  EXPECT_LT(std::fabs(bias) / double(found.size()), 0.25) << view().name;
  EXPECT_LT(double(far) / double(found.size()), 0.004) << view().name;
}

// The card smooths what it has drawn itself.
TEST(GlFinish, SmoothsEdgesAsTheProcessorDoes) {
  GlDevice gl;
  const Scene heap = make_heap(60, 4);
  RenderOptions options = plain();
  options.fixed_exposure = 0.05;
  const View& view = views().front();
  const auto draw = [&](bool antialias) {
    options.antialias = antialias;
    Renderer renderer(gl, heap, options);
    RenderedView seen = renderer.view(rays_of(view));
    return std::make_pair(seen.rgb(), seen.depth());
  };
  const auto [rough, depth] = draw(false);
  std::vector<std::uint8_t> rgba, expected;
  std::vector<float> values;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    rgba.insert(rgba.end(), {rough[3 * i], rough[3 * i + 1], rough[3 * i + 2], 0});
    values.push_back(std::isnan(depth[i]) ? 0.0f : kNearPlane / depth[i]);
  }
  ThreadPool pool(1);
  smooth_edges(rgba, values, kWidth, kHeight, pool, expected);
  const std::vector<std::uint8_t> found = draw(true).first;
  std::size_t different = 0, smoothed = 0;
  for (std::size_t i = 0; i < found.size(); ++i) different += found[i] != expected[i], smoothed += expected[i] != rough[i];
  EXPECT_GT(smoothed, found.size() / 100);
  EXPECT_LE(different, 12u);  // depth has been to metres and back
}

// As the control of the one above them: a light that is 3 % brighter is seen.
TEST(ShadingControl, SeesALittleMoreLight) {
  SoftwareDevice device;
  RenderOptions options = plain();
  options.fixed_exposure = 0.05;
  const View& view = views().front();
  Scene heap = make_heap(60, 4);
  view.change(heap);
  Renderer one(device, heap, options);
  options.fixed_exposure *= 1.03;
  Renderer other(device, heap, options);
  RenderedView a = one.view(rays_of(view)), b = other.view(rays_of(view));
  double bias = 0;
  for (std::size_t i = 0; i < a.rgb().size(); ++i) bias += int(b.rgb()[i]) - int(a.rgb()[i]);
  EXPECT_GT(bias / double(a.rgb().size()), 0.5);
}

// Each set with another number of threads.
TEST_P(ShadingBits, AreTheSameByEveryInstructionSetAndAnyNumberOfThreads) {
  SoftwareDevice device;
  const std::vector<WideShader>& sets = wide_shaders();
  std::vector<float> first;
  for (std::size_t i = 0; i < std::max(sets.size(), std::size_t(3)); ++i) {
    RenderOptions options = plain();
    options.threads = int(i) + 1;
    options.instruction_set = sets[i % sets.size()].name;
    Renderer renderer(device, scene(), options);
    const std::vector<float> found = renderer.view(rays_of(view())).radiance();
    if (first.empty()) first = found;
    ASSERT_EQ(found.size(), first.size());
    std::size_t differ = 0;
    for (std::size_t k = 0; k < found.size(); ++k) differ += std::memcmp(&found[k], &first[k], sizeof(float)) != 0;
    EXPECT_EQ(differ, 0u) << view().name << " by " << options.instruction_set << ", threads " << options.threads;
  }
}

// A card keeps the light of the image before, and gets what the lamp changes. So an image after others, of other
// places of the camera and of the lamp, is that of a renderer which has drawn nothing else.
TEST(GlLight, IsThatOfARendererWhichDrewNothingBefore) {
  GlDevice device;
  RenderOptions options = plain();
  options.fixed_exposure = 2;
  Scene heap = make_heap(60, 4);
  heap.light.intensity = 0, heap.lamp.on = true;
  const auto look = [](const Vec3& target) {
    return ViewRays{1000000000, pinhole(kWidth, kHeight, 120), look_at({1, 0.2, 0.6}, target)};
  };
  const ViewRays at_heap = look({-1.5, 0.1, 0.5}), away = look({8, 0.2, 0.3});
  ViewRays lamp_far = at_heap;  // no piece is lit
  lamp_far.world_from_rig = look_at({60, 0, 5}, {80, 0, 5});
  Renderer used(device, heap, options);
  const std::vector<std::uint8_t> lit = used.view(at_heap).rgb();
  used.view(away).rgb();
  const std::vector<std::uint8_t> unlit = used.view(lamp_far).rgb(), again = used.view(at_heap).rgb();
  EXPECT_EQ(again, lit);
  Renderer fresh(device, heap, options);
  EXPECT_EQ(fresh.view(lamp_far).rgb(), unlit);
  EXPECT_NE(lit, unlit);
  EXPECT_EQ(fresh.view(at_heap).rgb(), lit);
}

// What render_bench --split prints. A frame that waits more often, or hands over more, is slower on a card.
TEST(GlTraffic, OfAFrameIsCounted) {
  GlDevice gl;
  SoftwareDevice software;
  Scene heap = make_heap(60, 4);
  heap.light.intensity = 0, heap.lamp.on = true;
  const ViewRays at_heap{1000000000, pinhole(kWidth, kHeight, 120), look_at({1, 0.2, 0.6}, {-1.5, 0.1, 0.5})};
  Renderer by_gl(gl, heap, plain()), by_software(software, heap, plain());
  by_gl.view(at_heap).rgb();
  const DeviceTraffic before = gl.traffic();
  EXPECT_GT(before.given, 100000u);  // the scene
  RenderedView seen = by_gl.view(at_heap);
  seen.rgb(), seen.depth();
  const DeviceTraffic after = gl.traffic();
  EXPECT_EQ(after.waits - before.waits, 1u);  // for all together
  EXPECT_LT(after.given - before.given, 100000u);
  // In fog as well: the card finds the light in the air, of which a table would be 5.9 MB.
  AirSpec fog;
  fog.fog_density = 0.2;
  heap.air = fog;
  Renderer in_fog(gl, heap, plain());
  in_fog.view(at_heap).rgb();
  const std::uint64_t given = gl.traffic().given;
  in_fog.view(at_heap).rgb();
  EXPECT_LT(gl.traffic().given - given, 1000000u);
  const std::uint64_t pixels = std::uint64_t(kWidth) * std::uint64_t(kHeight);
  EXPECT_GE(after.taken - before.taken, 7 * pixels);
  EXPECT_LE(after.taken - before.taken, 8 * pixels);
  by_software.view(at_heap).rgb();
  EXPECT_EQ(software.traffic().given + software.traffic().taken + software.traffic().waits, 0u);
}

TEST(WideShaders, AreNamedWhereOneIsUnknown) {
  EXPECT_EQ(find_wide_shader("plain").name, std::string("plain"));
  EXPECT_EQ(find_wide_shader("").name, wide_shaders().front().name);
  try {
    find_wide_shader("mmx");
    FAIL();
  } catch (const RunError& error) {
    EXPECT_NE(
        std::string(error.what()).find("cannot shade with the instruction set mmx; it can with"),
        std::string::npos);
  }
}

}  // namespace shading_test
}  // namespace rubble::testing
