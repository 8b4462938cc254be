// Depth against closed forms: planes and a sphere, near and far.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "kernel/base/portable_math.h"
#include "render/devices/make_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace depth_test {

// Both devices must be exact.
RenderOptions plain() {
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 64;
  options.texture_size = 16;
  return options;
}

Scene scene_of(TriangleMesh mesh, const Pose& pose, float scale = 1) {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.meshes.push_back(share(std::move(mesh)));
  scene.instances.push_back({0, scale, pose, 7});
  return scene;
}

// An odd pinhole: unequal focal lengths and an off-centre principal point.
Intrinsics odd_pinhole() {
  Intrinsics k;
  k.width = 161, k.height = 120;
  k.fx = 150.25, k.fy = 141.5, k.cx = 70.3, k.cy = 66.9;
  return k;
}

// 0.1 mm to 10 m, in all cases; beyond, a hundred-thousandth.
double allowed(double depth) { return depth <= 10 ? 1e-4 : depth * 1e-5; }

using Case = std::tuple<DeviceKind, double>;
const auto kBoth = ::testing::Values(DeviceKind::gl, DeviceKind::software);

class FacingPlane : public ::testing::TestWithParam<Case> {};

TEST_P(FacingPlane, HasTheSameDepthEverywhere) {
  const auto [kind, d] = GetParam();
  const std::unique_ptr<Device> device = make_device({kind});
  // The camera looks along +X from the origin; the box's near face is the plane x = d.
  Renderer renderer(*device, scene_of(make_box({1, 100, 100}), {{}, {d + 0.5, 0, 0}}), plain());
  const Frame frame = renderer.render({}, odd_pinhole(), 0, 0);
  for (const float z : frame.depth) ASSERT_NEAR(double(z), d, allowed(d));
}

INSTANTIATE_TEST_SUITE_P(Distances, FacingPlane,
                         ::testing::Combine(kBoth, ::testing::Values(0.1, 0.3, 1.0, 3.0, 10.0, 30.0)));

class ObliquePlane : public ::testing::TestWithParam<Case> {};

TEST_P(ObliquePlane, FollowsTheRayPlaneFormula) {
  const auto [kind, d] = GetParam();
  const Pose turned{portable::quat_from_rpy(0, 0, portable::kPi / 3), {d, 0, 0}};
  const std::unique_ptr<Device> device = make_device({kind});
  // Turned by 60 degrees about the vertical, the near face passes through (d, 0, 0).
  Renderer renderer(*device,
                    scene_of(make_box({1, 80, 80}), {turned.rotation, turned * Vec3(0.5, 0, 0)}),
                    plain());
  const Intrinsics k = odd_pinhole();
  const Frame frame = renderer.render({}, k, 0, 0);
  const Vec3 normal = turned.rotation.rotate({1, 0, 0});
  int seen = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      // Pixel centres lie at whole numbers; body y is -X/Z and body z is -Y/Z.
      const Vec3 ray(1, -(u - k.cx) / k.fx, -(v - k.cy) / k.fy);
      const double z = d * normal.x / dot(ray, normal);
      if (z <= 0 || z > 30) continue;
      ASSERT_NEAR(double(frame.depth[std::size_t(v * k.width + u)]), z, allowed(z))
          << u << "," << v;
      ++seen;
    }
  }
  EXPECT_GT(seen, 5000);
}

INSTANTIATE_TEST_SUITE_P(Distances, ObliquePlane,
                         ::testing::Combine(kBoth, ::testing::Values(0.3, 1.0, 10.0)));

class SphereDepth : public ::testing::TestWithParam<Case> {};

TEST_P(SphereDepth, FollowsTheRaySphereFormula) {
  // 400 rings: the facets lie at most r (1 - cos(pi / 800)) = 8e-6 r inside the sphere.
  const auto [kind, d] = GetParam();
  const double radius = 0.3 * d;
  const std::unique_ptr<Device> device = make_device({kind});
  Renderer renderer(*device, scene_of(make_sphere(400), {{}, {d, 0.05 * d, 0}}, float(radius)),
                    plain());
  const Intrinsics k = odd_pinhole();
  const Frame frame = renderer.render({}, k, 0, 0);
  const Vec3 centre(d, 0.05 * d, 0);
  int seen = 0, beside = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Vec3 ray(1, -(u - k.cx) / k.fx, -(v - k.cy) / k.fy);
      const double a = dot(ray, ray), b = dot(ray, centre),
                   c = dot(centre, centre) - radius * radius;
      const double inside = b * b - a * c;
      const float z = frame.depth[std::size_t(v * k.width + u)];
      if (inside < -0.02 * d * d) {
        EXPECT_TRUE(std::isnan(z));
        ++beside;
      }
      if (inside < 0.01 * d * d) continue;  // the rim, where facets matter
      ASSERT_NEAR(double(z), (b - std::sqrt(inside)) / a, allowed(d) + 6e-5 * radius);
      ++seen;
    }
  }
  EXPECT_GT(seen, 3000);
  EXPECT_GT(beside, 1000);
}

INSTANTIATE_TEST_SUITE_P(Distances, SphereDepth,
                         ::testing::Combine(kBoth, ::testing::Values(0.15, 1.0, 10.0, 30.0)));

class Raster : public ::testing::TestWithParam<DeviceKind> {};
INSTANTIATE_TEST_SUITE_P(Both, Raster, kBoth);

// The convention of pixel centres, on both axes: an edge at column 40 and row 20 exactly between
// centres decides which pixels are covered.
TEST_P(Raster, HasPixelCentresAtWholeNumbers) {
  Intrinsics k;
  k.width = 96, k.height = 64;
  k.fx = 80, k.fy = 80, k.cx = 30, k.cy = 25;
  // At x = 2 m a pixel is 2/80 m wide. The box covers columns from 40.5 on and rows from 20.5 on.
  const double left = -(40.5 - k.cx) / k.fx * 2, top = -(20.5 - k.cy) / k.fy * 2;
  const std::unique_ptr<Device> device = make_device({GetParam()});
  Renderer renderer(
      *device, scene_of(make_box({1e-3, 50, 50}), {{}, {2 + 5e-4, left - 25, top - 25}}), plain());
  const Frame frame = renderer.render({}, k, 0, 0);
  for (int v = 0; v < k.height; ++v)
    for (int u = 0; u < k.width; ++u)
      ASSERT_EQ(!std::isnan(frame.depth[std::size_t(v * k.width + u)]), u >= 41 && v >= 21)
          << u << "," << v;
}

TEST_P(Raster, IsMissingWhereThereIsOnlySky) {
  Scene scene;
  scene.ground = false;
  const std::unique_ptr<Device> device = make_device({GetParam()});
  Renderer renderer(*device, scene, plain());
  const Frame frame = renderer.render({}, odd_pinhole(), 3, 42);
  EXPECT_EQ(frame.index, 3);
  EXPECT_EQ(frame.stamp_ns, 42);
  for (const float z : frame.depth) ASSERT_TRUE(std::isnan(z));
  EXPECT_EQ(frame.rgb.size(), frame.depth.size() * 3);
}

TEST_P(Raster, OfTheGroundWithoutPieces) {
  const std::unique_ptr<Device> device = make_device({GetParam()});
  Renderer renderer(*device, Scene{}, plain());
  const Intrinsics k = pinhole(64, 64, 60);
  const Frame frame = renderer.render({{}, {0, 0, 1.5}}, k, 0, 0);
  for (int v = 40; v < 64; ++v) {
    const double z = 1.5 * k.fy / (v - k.cy);
    for (int u = 0; u < 64; ++u)
      ASSERT_NEAR(double(frame.depth[std::size_t(v * 64 + u)]), z, allowed(z));
  }
}

// A rotated camera far from the origin sees what a camera at the origin does.
TEST_P(Raster, DoesNotDependOnWhereTheCameraStands) {
  const Pose moved{portable::quat_from_rpy(0.3, -0.4, 2.0), {41.5, -23.25, 7.75}};
  const Pose box{portable::quat_from_rpy(0.1, 0.2, 0.5), {3, 0.2, -0.1}};
  const std::unique_ptr<Device> device = make_device({GetParam()});
  const Intrinsics k = odd_pinhole();
  Renderer here(*device, scene_of(make_box({0.7, 0.9, 0.8}), box), plain());
  const Frame a = here.render({}, k, 0, 0);
  Renderer there(*device, scene_of(make_box({0.7, 0.9, 0.8}), moved * box), plain());
  const Frame b = there.render(moved, k, 0, 0);
  int seen = 0, differ = 0;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    if (std::isnan(a.depth[i]) != std::isnan(b.depth[i])) ++differ;
    if (std::isnan(a.depth[i]) || std::isnan(b.depth[i])) continue;
    ASSERT_NEAR(a.depth[i], b.depth[i], 2e-5);
    ++seen;
  }
  EXPECT_GT(seen, 500);
  EXPECT_LE(differ, 2);  // a silhouette may pass within rounding of a pixel's centre
}

// One triangle that begins a hand's breadth from the lens and ends far away: where interpolation
// between its corners would lose tenths of a millimetre.
TEST_P(Raster, IsExactOnATriangleFromVeryNearToFar) {
  TriangleMesh mesh;
  mesh.positions = {{0.04f, 6, -0.02f}, {0.04f, -6, -0.02f}, {40, 0, -0.1f}};
  mesh.triangles = {{0, 1, 2}};
  mesh.surfaces = {0};
  mesh.surface_names = {"concrete_cast"};
  // Refinement would cut it: a large mesh keeps edges of a twelfth of its radius.
  mesh.positions.push_back({1e4f, 0, -3000}), mesh.positions.push_back({1e4f, 1, -3000});
  mesh.positions.push_back({1e4f, 0, -2999});
  mesh.triangles.push_back({3, 4, 5});
  mesh.surfaces.push_back(0);
  const std::unique_ptr<Device> device = make_device({GetParam()});
  Renderer renderer(*device, scene_of(mesh, {}), plain());
  Intrinsics k = pinhole(200, 800, 90);
  k.fy = 3000, k.cy = 10;  // the far part is a matter of few degrees
  const Frame frame = renderer.render({}, k, 0, 0);
  const Vec3 a(mesh.positions[0]), b(mesh.positions[1]), c(mesh.positions[2]);
  const Vec3 n = cross(b - a, c - a);
  int near = 0, far = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const float z = frame.depth[std::size_t(v * k.width + u)];
      const Vec3 ray(1, -(u - k.cx) / k.fx, -(v - k.cy) / k.fy);
      const double want = dot(n, a) / dot(n, ray);
      if (!(z < 50)) continue;
      ASSERT_NEAR(double(z), want, want <= 10 ? 1e-4 : 2e-5 * want) << u << "," << v;
      near += z < 0.1f, far += z > 8;
    }
  }
  EXPECT_GT(near, 100);
  EXPECT_GT(far, 3);
}

// The two devices draw the same picture, but for pixels that an edge crosses within a grid step.
TEST(Devices, AgreeOnAHeap) {
  Scene heap = make_heap(300, 4);
  const std::unique_ptr<Device> gl = make_device({DeviceKind::gl}), software = make_device({DeviceKind::software});
  Renderer by_gl(*gl, heap, plain()), by_software(*software, heap, plain());
  for (const Vec3& eye : {Vec3(6, 2, 2), Vec3(1, 0.2, 0.6), Vec3(0.2, 0.1, 0.3)}) {
    const Pose pose = look_at(eye, {-1.5, 0.1, 0.5});
    const LinearFrame a = by_gl.render_linear(pose, pinhole(320, 240, 200));
    const LinearFrame b = by_software.render_linear(pose, pinhole(320, 240, 200));
    int differ = 0;
    for (std::size_t i = 0; i < a.depth.size(); ++i)
      differ += a.instance[i] != b.instance[i] ||
                !(std::fabs(a.depth[i] - b.depth[i]) < 1e-4f * (1 + a.depth[i]) ||
                  (std::isnan(a.depth[i]) && std::isnan(b.depth[i])));
    EXPECT_LT(differ, 100) << "of " << a.depth.size();  // a thousandth
  }
}

}  // namespace depth_test
}  // namespace rubble::testing
