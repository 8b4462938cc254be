// Baked light beside light that is followed path by path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/geometry/geometry.h"
#include "render/geometry/prepared_mesh.h"
#include "render/lighting/bake.h"
#include "render/lighting/light_packing.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace baked_light_test {

constexpr int kSegments = 24;

// A pipe along X about the origin: inner radius 0.5 m, 60 mm thick, 4 m long; few and long faces.
TriangleMesh make_pipe() {
  TriangleMesh mesh;
  mesh.surface_names = {"concrete_cast"};
  const auto corner = [](int i, double radius, double x) {
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (i % kSegments) / kSegments);
    return Vec3f(Vec3(x, radius * a.cos, radius * a.sin));
  };
  const auto quad = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
    const auto first = std::uint32_t(mesh.positions.size());
    for (const Vec3f& p : {a, b, c, d}) mesh.positions.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.surfaces.insert(mesh.surfaces.end(), 2, 0);
  };
  constexpr double kIn = 0.5, kOut = 0.56, kHalf = 2;
  for (int i = 0; i < kSegments; ++i) {
    quad(corner(i, kOut, -kHalf), corner(i + 1, kOut, -kHalf), corner(i + 1, kOut, kHalf), corner(i, kOut, kHalf));
    quad(corner(i, kIn, -kHalf), corner(i, kIn, kHalf), corner(i + 1, kIn, kHalf), corner(i + 1, kIn, -kHalf));
    quad(corner(i, kIn, kHalf), corner(i, kOut, kHalf), corner(i + 1, kOut, kHalf), corner(i + 1, kIn, kHalf));
    quad(corner(i, kIn, -kHalf), corner(i + 1, kIn, -kHalf), corner(i + 1, kOut, -kHalf), corner(i, kOut, -kHalf));
  }
  return mesh;
}

// The pipe on the ground by day, the camera in its bore. The sun stands across it, so that all light in it
// comes in by its mouths.
Scene bore() {
  Scene scene;
  scene.lamp.on = false;
  scene.light.type = LightType::sun;
  scene.light.elevation_deg = 45, scene.light.azimuth_deg = 90;
  scene.meshes.push_back(share(make_pipe()));
  scene.instances.push_back({0, 1, {{}, {0, 0, 0.56}}, 1});
  return scene;
}

constexpr int kSide = 96;

std::vector<double> draw(Device& device, RenderQuality quality) {
  RenderOptions options;
  options.threads = 2;
  options.texture_size = 64, options.shadow_size = 512;
  options.colour.quality = quality, options.colour.samples = 48;
  const Pose eye{{}, {-1.4, 0, 0.56}};
  const LinearFrame frame = Renderer(device, bore(), options).render_linear(eye, pinhole(kSide, kSide, 0.45 * kSide));
  std::vector<double> out;
  for (std::size_t i = 0; i < frame.rgb.size(); i += 3)
    out.push_back(0.2126 * double(frame.rgb[i]) + 0.7152 * double(frame.rgb[i + 1]) + 0.0722 * double(frame.rgb[i + 2]));
  return out;
}

// Mean light of each of 12 sectors of a ring about the image's middle, which is a ring of the bore.
std::vector<double> ring(const std::vector<double>& image, double inner, double outer) {
  std::vector<double> sum(12), count(12);
  for (int v = 0; v < kSide; ++v)
    for (int u = 0; u < kSide; ++u) {
      const double x = u - 0.5 * (kSide - 1), y = v - 0.5 * (kSide - 1), r = std::sqrt(x * x + y * y);
      if (r < inner || r >= outer) continue;
      const auto sector = std::size_t((std::atan2(y, x) / portable::kPi + 1) * 6 * 0.9999);
      sum[sector] += image[std::size_t(v * kSide + u)], count[sector] += 1;
    }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= count[i];
  return sum;
}

// In each ring of the bore: as bright as by paths, and as even.
TEST(BakedLight, IsThatOfPathsAlongTheRingsOfABore) {
  SoftwareDevice device;
  const std::vector<double> fast = draw(device, RenderQuality::fast);
  const std::vector<double> paths = draw(device, RenderQuality::reference);
  for (const double inner : {14.0, 20.0, 28.0, 38.0}) {
    const std::vector<double> found = ring(fast, inner, inner + 6), expected = ring(paths, inner, inner + 6);
    double off = 0, mean_found = 0, mean = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      off += std::fabs(found[i] - expected[i]) / expected[i] / 12;
      mean_found += found[i] / 12, mean += expected[i] / 12;
    }
    EXPECT_NEAR(mean_found / mean, 1, 0.08) << "ring at " << inner;
    EXPECT_LT(off, 0.1) << "ring at " << inner;
  }
}

// Light of 4 by 4 regions of a view aside, where no light comes from the lamp itself.
std::vector<double> beside_the_beam(Device& device, RenderQuality quality) {
  RenderOptions options;
  options.threads = 2, options.texture_size = 64;
  options.colour.quality = quality, options.colour.samples = 64;
  ViewRays view{0, pinhole(kSide, kSide, 0.5 * kSide), look_at({-1, 0, 0}, {-1, 3, 0})};
  view.world_from_rig = look_at({-1, 0, 0}, {2, 0, 0});
  const LinearFrame frame = Renderer(device, slab_room({4, 3, 2.4}), options).render_linear(view);
  std::vector<double> out(16);
  for (std::size_t i = 0; i < frame.depth.size(); ++i)
    out[i / kSide / (kSide / 4) * 4 + i % kSide / (kSide / 4)] += double(frame.rgb[i * 3 + 1]) / (kSide * kSide / 16.0);
  return out;
}

TEST(LampBounce, LightsARoomAsPathsDo) {
  SoftwareDevice device;
  const std::vector<double> fast = beside_the_beam(device, RenderQuality::fast);
  const std::vector<double> paths = beside_the_beam(device, RenderQuality::reference);
  double off = 0, sum = 0, expected = 0;
  for (std::size_t i = 0; i < fast.size(); ++i)
    off += std::fabs(fast[i] - paths[i]) / paths[i] / 16, sum += fast[i], expected += paths[i];
  EXPECT_NEAR(sum / expected, 1, 0.08);
  EXPECT_LT(off, 0.12);
}

// Light is added to what a picture shows: pictures before it, and the number of threads, change nothing.
TEST(LampBounce, DependsOnThePictureAlone) {
  SoftwareDevice device;
  const auto draw = [&](int threads, bool look_around) {
    RenderOptions options;
    options.threads = threads, options.texture_size = 64, options.bake_rays = 16;
    Renderer renderer(device, slab_room({4, 3, 2.4}), options);
    const Pose lamp = look_at({-1, 0, 0}, {2, 0, 0});
    ViewRays aside{0, pinhole(64, 64, 32), look_at({-1, 0, 0}, {-1, 3, 0})}, back = aside;
    aside.world_from_rig = back.world_from_rig = lamp;
    back.world_from_camera = look_at({1, 0.5, 0}, {-2, -1, 0.4});
    if (look_around) renderer.render_linear(back);
    return renderer.render_linear(aside).rgb;
  };
  const std::vector<float> alone = draw(1, false);
  EXPECT_GT(*std::max_element(alone.begin(), alone.end()), 0);
  EXPECT_TRUE(alone == draw(1, true));
  EXPECT_TRUE(alone == draw(2, false));
  EXPECT_TRUE(alone == draw(3, true));
}

// The light that was added goes when the lamp does, bit for bit.
TEST(LampBounce, LeavesNothingBehind) {
  SoftwareDevice device;
  RenderOptions options;
  options.threads = 2, options.texture_size = 64, options.bake_rays = 16;
  Scene scene = slab_room({4, 3, 2.4});
  scene.light.intensity = 1, scene.light.position = {1, 0, 0.5};
  Renderer renderer(device, scene, options);
  const Pose eye = look_at({-1, 0, 0}, {2, 0, 0});
  const auto draw = [&] { return renderer.render_linear(eye, pinhole(48, 48, 30)).rgb; };
  LampSpec off = scene.lamp;
  off.on = false;
  renderer.restart(off, scene.air);
  const std::vector<float> before = draw();
  renderer.restart(scene.lamp, scene.air);
  EXPECT_FALSE(before == draw());
  renderer.restart(off, scene.air);
  EXPECT_TRUE(before == draw());
}

// A black disc above black ground, under an overcast sky: about its middle all light comes from
// lower than a few degrees. E = integral of L sin(elevation) over this strip of the sky.
class LowSlit : public ::testing::TestWithParam<double> {};

TEST_P(LowSlit, LightsTheGroundAsItsSkyDoes) {
  const double height = GetParam();
  constexpr double kRadius = 3, kThick = 0.1;
  constexpr int kSides = 48;
  Scene scene;
  scene.lamp.on = false;
  scene.light.type = LightType::sun, scene.light.elevation_deg = 50, scene.sky.type = SkyType::overcast;
  TriangleMesh disc;
  disc.surface_names = {"concrete_cast"};
  const auto rim = [&](int i, double z) {
    const portable::SinCos a = portable::sincos(2 * portable::kPi * (i % kSides) / kSides);
    return Vec3f(Vec3(kRadius * a.cos, kRadius * a.sin, z));
  };
  const auto add = [&](const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const auto first = std::uint32_t(disc.positions.size());
    for (const Vec3f& p : {a, b, c}) disc.positions.push_back(p);
    disc.triangles.push_back({first, first + 1, first + 2}), disc.surfaces.push_back(0);
  };
  for (int i = 0; i < kSides; ++i) {
    add({0, 0, float(kThick)}, rim(i, kThick), rim(i + 1, kThick)),
        add({0, 0, 0}, rim(i + 1, 0), rim(i, 0));
    add(rim(i, 0), rim(i + 1, 0), rim(i + 1, kThick)),
        add(rim(i, 0), rim(i + 1, kThick), rim(i, kThick));
  }
  scene.meshes.push_back(share(disc));
  scene.instances.push_back({0, 1, {{}, {0, 0, height}}, 1});

  const PreparedScene prepared = prepare_scene(scene, 2);
  SceneRays rays(prepared);
  const LightSet light = make_lights(scene);
  BakeOptions options;
  options.threads = 2;
  const auto black = [](const RayScene::Triangle&, float, float) { return Vec3f(); };
  LightBake baked(prepared, rays, light, black, options);
  baked.light_all();

  double expected = 0;
  constexpr int kSteps = 400;
  const double top = std::atan(height / kRadius);
  for (int i = 0; i < kSteps; ++i) {
    const double up = (i + 0.5) / kSteps * top;
    const Vec3f w(Vec3(std::cos(up), 0, std::sin(up)));
    expected += double(luminance(light.sky.radiance(w))) * std::sin(up) * std::cos(up) * 2 *
                portable::kPi * top / kSteps;
  }
  double found = 0;
  int count = 0;
  for (const PlacedMesh& placed : prepared.placed) {
    if (placed.id != kGroundId) continue;
    const std::vector<LightNode>& nodes = prepared.meshes[placed.mesh].light_nodes;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Vec3f& at = nodes[i].position;
      if (at.x * at.x + at.y * at.y > 0.5f * 0.5f) continue;
      const UnpackedLight here = unpack_light(baked.nodes()[placed.first_light + i], {0, 0, 1});
      found += double(luminance(here.colour)), ++count;
    }
  }
  ASSERT_GT(count, 20);
  EXPECT_NEAR(found / count / expected, 1, 0.1);
}

INSTANTIATE_TEST_SUITE_P(BakedLight, LowSlit, ::testing::Values(0.2, 0.3, 0.5));

}  // namespace baked_light_test
}  // namespace rubble::testing
