#include "render/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "render/camera/view_rays.h"
#include "render/devices/make_device.h"
#include "render/devices/software/software_device.h"
#include "render/gl/gl_context.h"
#include "render/materials/surface_appearance.h"
#include "tests/base/environment.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace renderer_test {

RenderOptions small(int threads) {
  RenderOptions options;
  options.threads = threads;
  options.bake_rays = 16;
  options.shadow_size = 512;
  options.texture_size = 64;
  return options;
}

// A hash over colour and depth of a short flight.
std::string fly(const Scene& scene, const RenderOptions& options, double shift = 0) {
  SoftwareDevice device;
  Renderer renderer(device, scene, options);
  StateHash hash;
  for (int i = 0; i < 3; ++i) {
    const Pose pose = look_at({6 - 1.9 * i, 1 + shift, 1.2}, {0, 0, 0.7});
    const Frame frame = renderer.render(pose, pinhole(160, 120, 100), i, i * 33000000);
    hash.add_bytes(frame.rgb.data(), frame.rgb.size());
    hash.add_bytes(frame.depth.data(), frame.depth.size() * sizeof(float));
  }
  return hex64(hash.digest());
}

TEST(Determinism, SameBitsTwiceAndWithTwoThreads) {
  Scene scene = make_heap(80, 11);
  scene.air.fog_density = 0.05;
  const std::string once = fly(scene, small(1));
  EXPECT_EQ(once, fly(scene, small(2)));
  EXPECT_NE(once, fly(scene, small(1), 0.01));  // negative control: another path
  scene.seed = 12;
  EXPECT_NE(once, fly(scene, small(1)));  // negative control: another seed, other looks
}

TEST(Bake, MakesAVoidDarkAndItsMouthBright) {
  Scene scene = make_heap(60, 5);
  scene.lamp.on = false;
  SoftwareDevice device;
  Renderer renderer(device, scene, small(2));
  const auto mean = [&](const Vec3& eye, const Vec3& target) {
    const LinearFrame f = renderer.render_linear(look_at(eye, target), pinhole(64, 64, 60));
    double sum = 0;
    for (const float c : f.rgb) sum += double(c);
    return sum / double(f.rgb.size());
  };
  const double deep = mean({0.5, 0, 0.6}, {-1.5, 0.3, 0.6}), out = mean({6, 0, 1}, {2, 0, 0});
  EXPECT_LT(deep * 8, out);
  EXPECT_GT(deep, 0);
}

// Whatever the quality and the lens.
TEST(SoftwareDevice, OpensNoDriver) {
  const Environment nowhere("RUBBLE_EGL_LIBRARY", "/nowhere/libEGL.so.1");
  EXPECT_THROW(make_device({DeviceKind::gl}), RunError);  // the control
  const std::unique_ptr<Device> device = make_device({DeviceKind::software});
  EXPECT_EQ(device->info().name, "software");
  for (const RenderQuality quality : {RenderQuality::fast, RenderQuality::draft, RenderQuality::reference}) {
    RenderOptions options = small(1);
    options.colour.quality = quality, options.colour.samples = 1;
    Renderer renderer(*device, make_heap(10, 2), options);
    Intrinsics k = pinhole(24, 16, 20);
    EXPECT_GT(renderer.render(look_at({4, 1, 1}, {0, 0, 0.3}), k, 0, 0).rgb.size(), 0u);
    k.lens = LensModel::fisheye;
    ViewRays view{0, k, look_at({4, 1, 1}, {0, 0, 0.3})};
    view.directions = make_lens_directions(k, 1);
    EXPECT_GT(renderer.view(view).depth().size(), 0u);
  }
}

TEST(Renderer, ReportsProgressUpToOne) {
  SoftwareDevice device;
  std::vector<double> fractions;
  Renderer renderer(device, make_heap(20, 1), small(1), [&](double f) { fractions.push_back(f); });
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
}

std::string error_of(const Scene& scene, const Intrinsics& k = pinhole(32, 32, 30)) {
  try {
    SoftwareDevice device;
    RenderOptions options = small(1);
    options.bake = false;
    Renderer renderer(device, scene, options);
    renderer.render({}, k, 0, 0);
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(Looks, AnUnknownOneIsNamedBesideTheKnown) {
  Scene scene;
  scene.meshes.push_back(share(make_box({1, 1, 1}, "marzipan")));
  scene.instances.push_back({});
  const std::string error = error_of(scene);
  EXPECT_NE(error.find("\"marzipan\""), std::string::npos) << error;
  for (const std::string& name : known_surface_appearances())
    EXPECT_NE(error.find(name), std::string::npos);
  for (const std::string& name : known_surface_appearances()) {
    Scene good = scene;
    good.meshes[0] = share(make_box({1, 1, 1}, name.c_str()));
    EXPECT_EQ(error_of(good), "") << name;
  }
}

TEST(Renderer, RefusesWhatItCannotDraw) {
  Scene scene;
  scene.instances.push_back({3, 1, {}, 0});
  EXPECT_NE(error_of(scene).find("mesh 3"), std::string::npos);
  Intrinsics distorted = pinhole(32, 32, 30);
  distorted.distortion[0] = 0.1;
  EXPECT_NE(error_of(Scene{}, distorted).find("distortion"), std::string::npos);
  EXPECT_NE(error_of(Scene{}, pinhole(32, 32, 0)).find("positive"), std::string::npos);
}

std::string context_error(int device) {
  try {
    GlContext context({device, 0});
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

TEST(GlContext, NamesWhatItFoundAndWhatToInstall) {
  const std::string error = context_error(99);
  EXPECT_NE(error.find("no EGL device 99"), std::string::npos) << error;
  EXPECT_NE(error.find("libgl1-mesa-dri"), std::string::npos) << error;
}

TEST(GlContext, DescribesItself) {
  const GlContext context;
  EXPECT_FALSE(context.info().renderer.empty());
  EXPECT_FALSE(context.info().vendor.empty());
  EXPECT_EQ(context.info().version.find("4."), 0u);
}

}  // namespace renderer_test
}  // namespace rubble::testing
