// Lenses against OpenCV, and images drawn through them against OpenCV's geometry.
#include "render/camera/lens.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace lens_test {

Intrinsics lens_of(LensModel model, const std::array<double, 5>& distortion, double focal) {
  Intrinsics k = pinhole(320, 240, focal);
  k.fy *= 1.02, k.cx += 3.25, k.cy -= 2.5;
  k.lens = model;
  k.distortion = distortion;
  return k;
}

// Mild and strong barrels, a pincushion, a decentred lens, two fisheyes.
std::vector<Intrinsics> lenses() {
  return {lens_of(LensModel::plumb_bob, {}, 200),
          lens_of(LensModel::plumb_bob, {-0.28, 0.07, 0.0003, -0.0002, 0}, 220),
          lens_of(LensModel::plumb_bob, {-0.38, 0.18, 0, 0, -0.045}, 150),
          lens_of(LensModel::plumb_bob, {0.2, 0.05, 0, 0, 0.01}, 300),
          lens_of(LensModel::plumb_bob, {-0.1, 0.02, 0.004, -0.006, 0}, 200),
          lens_of(LensModel::fisheye, {}, 110),
          lens_of(LensModel::fisheye, {-0.013, 0.021, -0.012, 0.002, 0}, 105)};
}

cv::Mat matrix_of(const Intrinsics& k) {
  return (cv::Mat_<double>(3, 3) << k.fx, 0, k.cx, 0, k.fy, k.cy, 0, 0, 1);
}

PixelPoint project_with_opencv(const Intrinsics& k, const Vec3& p) {
  const std::vector<cv::Point3d> points{{p.x, p.y, p.z}};
  std::vector<cv::Point2d> pixels;
  const cv::Vec3d none(0, 0, 0);
  const auto& d = k.distortion;
  if (k.lens == LensModel::fisheye)
    cv::fisheye::projectPoints(points, pixels, none, none, matrix_of(k),
                               cv::Vec4d(d[0], d[1], d[2], d[3]));
  else
    cv::projectPoints(points, none, none, matrix_of(k), cv::Vec<double, 5>(d.data()), pixels);
  return {pixels[0].x, pixels[0].y};
}

TEST(Lens, ProjectsAsOpenCvDoes) {
  for (const Intrinsics& k : lenses()) {
    const Lens lens(k);
    for (double x = -0.6; x <= 0.6; x += 0.15) {
      for (double y = -0.5; y <= 0.5; y += 0.125) {
        const Vec3 p(x * 2, y * 2, 2);
        const auto ours = lens.project(p);
        const PixelPoint theirs = project_with_opencv(k, p);
        ASSERT_TRUE(ours) << x << " " << y;
        ASSERT_NEAR(ours->u, theirs.u, 1e-9);
        ASSERT_NEAR(ours->v, theirs.v, 1e-9);
      }
    }
  }
}

TEST(Lens, EveryPixelsDirectionProjectsBackOntoIt) {
  for (const Intrinsics& k : lenses()) {
    const Lens lens(k);
    int seen = 0;
    for (int v = 0; v < k.height; v += 7) {
      for (int u = 0; u < k.width; u += 7) {
        const auto d = lens.direction(u, v);
        if (!d) continue;
        ++seen;
        ASSERT_NEAR(norm(*d), 1, 1e-12);
        const auto back = lens.project(*d);
        ASSERT_TRUE(back);
        ASSERT_NEAR(back->u, u, 1e-6);
        ASSERT_NEAR(back->v, v, 1e-6);
        if (d->z < 0.02) continue;  // OpenCV divides by Z
        const PixelPoint theirs = project_with_opencv(k, *d);
        ASSERT_NEAR(theirs.u, u, 1e-5);
        ASSERT_NEAR(theirs.v, v, 1e-5);
      }
    }
    EXPECT_GT(seen, 1000) << "of 1610";
  }
}

// Beyond the circle where r (1 + k1 r2) stops growing, at r = 1 / sqrt(-3 k1), there is no image.
TEST(Lens, EndsWhereItFoldsBack) {
  Intrinsics k = lens_of(LensModel::plumb_bob, {-0.4, 0, 0, 0, 0}, 100);
  const Lens lens(k);
  const double fold = 1 / std::sqrt(1.2);
  EXPECT_TRUE(lens.project({fold * 0.999, 0, 1}));
  EXPECT_FALSE(lens.project({fold * 1.001, 0, 1}));
  const double rim = fold * (1 - 0.4 * fold * fold);
  EXPECT_TRUE(lens.direction(k.cx + k.fx * rim * 0.999, k.cy));
  EXPECT_FALSE(lens.direction(k.cx + k.fx * rim * 1.001, k.cy));
  EXPECT_FALSE(Lens(pinhole(32, 32, 20)).project({0, 0, -1}));
}

TEST(Lens, AFisheyeSeesBehindItself) {
  const Intrinsics k = lens_of(LensModel::fisheye, {}, 50);
  const auto d = Lens(k).direction(k.cx + k.fx * 2.0, k.cy);  // 2 rad from the axis
  ASSERT_TRUE(d);
  EXPECT_NEAR(d->z, std::cos(2.0), 1e-12);
  EXPECT_NEAR(d->x, std::sin(2.0), 1e-12);
}

RenderOptions plain() {
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 64;
  options.texture_size = 16;
  return options;
}

ViewRays view_through(const Intrinsics& k, const Pose& pose) {
  ViewRays view{0, k, pose};
  view.directions = make_lens_directions(k, 1);
  return view;
}

// A tilted wall: each pixel's depth, put onto OpenCV's ray, must lie on it as exactly as a twentieth
// of a pixel asks.
TEST(DistortedImage, HasTheDepthOfOpenCvsRays) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_box({1, 200, 200})));
  const Quat turn = portable::quat_from_rpy(0, 0.35, 0.5);
  const Vec3 normal = turn.rotate({-1, 0, 0}), corner = Vec3(3, 0, 0);
  scene.instances.push_back({0, 1, {turn, corner - normal * 0.5}, 1});
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  for (const Intrinsics& k : lenses()) {
    const Frame frame = renderer.render(view_through(k, {}), 0);
    std::vector<cv::Point2d> pixels, slopes;
    for (int v = 0; v < k.height; v += 5)
      for (int u = 0; u < k.width; u += 5) pixels.push_back({double(u), double(v)});
    const auto& d = k.distortion;
    const cv::TermCriteria tight(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
    if (k.lens == LensModel::fisheye)
      cv::fisheye::undistortPoints(pixels, slopes, matrix_of(k),
                                   cv::Vec4d(d[0], d[1], d[2], d[3]));
    else
      cv::undistortPoints(pixels, slopes, matrix_of(k), cv::Vec<double, 5>(d.data()),
                          cv::noArray(), cv::noArray(), tight);
    int seen = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const double z =
          double(frame.depth[std::size_t(pixels[i].y * k.width + pixels[i].x)]);
      const Vec3 slope(slopes[i].x, slopes[i].y, 1);
      if (std::isnan(z) || norm(slope) > 3) continue;
      const Vec3 point = camera_from_optical * (slope * z);
      const double off = dot(point - corner, normal);
      const double pixel = z * norm(slope) / k.fx;  // its size there
      ASSERT_LT(std::fabs(off), 0.05 * pixel) << pixels[i].x << " " << pixels[i].y;
      ++seen;
    }
    EXPECT_GT(seen, 1000);
  }
}

// Small balls at known places: the middle of each ball's pixels is where OpenCV projects it.
TEST(DistortedImage, HasObjectsWhereOpenCvProjectsThem) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_sphere(60)));
  constexpr double kRadius = 0.28;
  std::vector<Vec3> centres;
  for (int i = -2; i <= 2; ++i)
    for (int j = -1; j <= 1; ++j) {
      centres.push_back({4, 0.62 * i, 0.7 * j});
      scene.instances.push_back(
          {0, float(kRadius), {{}, centres.back()}, std::uint32_t(scene.instances.size())});
    }
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const StreamSet channels{find_image_stream("instance")};
  const std::vector<Intrinsics> all = lenses();
  for (Intrinsics k : {all[1], all[4], all[6]}) {
    k.width *= 3, k.height *= 3, k.fx *= 3, k.fy *= 3, k.cx *= 3, k.cy *= 3;
    const Frame frame = renderer.view(view_through(k, {})).into_frame(0, channels);
    std::vector<double> u(centres.size()), v(centres.size()), n(centres.size());
    for (std::size_t i = 0; i < instances_of(frame).size(); ++i) {
      const std::uint32_t id = instances_of(frame)[i];
      if (id >= centres.size()) continue;
      u[id] += double(i % std::size_t(k.width)), v[id] += double(i / std::size_t(k.width)), ++n[id];
    }
    int checked = 0;
    double sum_u = 0, sum_v = 0;
    for (std::size_t b = 0; b < centres.size(); ++b) {
      // A ball's outline is not quite centred on its centre's image; the mean over the cone of rays
      // that touch it is.
      const Vec3 c = camera_from_optical.inverse() * centres[b];
      const Vec3 side = normalized(cross(c, Vec3(0, 1, 0))), up = normalized(cross(side, c));
      double area = 0, mu = 0, mv = 0;
      std::vector<PixelPoint> rim;
      const double reach = norm(c) * std::tan(std::asin(kRadius / norm(c)));
      for (int i = 0; i < 400; ++i) {
        const double a = 2 * portable::kPi * i / 400;
        rim.push_back(project_with_opencv(
            k, c + (side * std::cos(a) + up * std::sin(a)) * reach));
      }
      for (std::size_t i = 0; i < rim.size(); ++i) {
        const PixelPoint &p = rim[i], &q = rim[(i + 1) % rim.size()];
        const double w = p.u * q.v - q.u * p.v;
        area += w / 2, mu += (p.u + q.u) * w / 6, mv += (p.v + q.v) * w / 6;
      }
      const bool inside = std::all_of(rim.begin(), rim.end(), [&](const PixelPoint& p) {
        return p.u > 0 && p.v > 0 && p.u < k.width - 1 && p.v < k.height - 1;
      });
      if (!inside) continue;
      ++checked;
      const double du = u[b] / n[b] - mu / area, dv = v[b] / n[b] - mv / area;
      // So many whole pixels centre a disc to about 0.06; a lens that is wrong moves all of them.
      EXPECT_LT(std::hypot(du, dv), 0.15) << "ball " << b;
      sum_u += du, sum_v += dv;
      EXPECT_NEAR(n[b] / std::fabs(area), 1, 0.01);
    }
    EXPECT_GE(checked, 9);
    EXPECT_LT(std::hypot(sum_u, sum_v) / checked, 0.05);
  }
}

// A pinhole, rasterised and cast: the same pieces, depths and colours but for rounding.
TEST(CastRays, DrawWhatRasterisingDraws) {
  const Scene scene = make_heap(150, 9);
  SoftwareDevice device;
  RenderOptions options = plain();
  options.fixed_exposure = 1;
  Renderer renderer(device, scene, options);
  const Intrinsics k = pinhole(160, 120, 100);
  const Pose pose = look_at({4, 1, 1.2}, {0, 0, 0.6});
  const LinearFrame a = renderer.render_linear(pose, k);
  const LinearFrame b = renderer.render_linear(view_through(k, pose));
  int pieces = 0, depths = 0, colours = 0;
  for (std::size_t i = 0; i < a.depth.size(); ++i) {
    pieces += a.instance[i] != b.instance[i];
    if (a.instance[i] != b.instance[i]) continue;
    depths += std::fabs(a.depth[i] - b.depth[i]) > 1e-4f * a.depth[i];
    float off = 0;
    for (std::size_t c = 0; c < 3; ++c)
      off = std::max(off, std::fabs(a.rgb[i * 3 + c] - b.rgb[i * 3 + c]) /
                              (a.rgb[i * 3 + c] + 1e-3f));
    colours += off > 0.02f;
  }
  const int all = int(a.depth.size());
  EXPECT_LE(pieces, all / 500);
  EXPECT_LE(depths, all / 500);
  EXPECT_LE(colours, all / 100);
}

// A camera that moves sideways while its rows are read: a vertical edge slants by speed times
// readout, seen at its distance.
TEST(RollingShutter, SlantsAnEdgeByTheMotionDuringReadout) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_box({1, 20, 40})));
  scene.instances.push_back({0, 1, {{}, {4.5, 10, 0}}, 5});  // its right edge is at y = 0, 4 m away
  const Intrinsics k = pinhole(160, 120, 120);
  ViewRays view{0, k, {}};
  // To the left, where the box's end is not seen.
  const auto eye_at = [&](int v) { return 0.3 + 0.4 * (v - k.cy) / k.height; };
  for (int v = 0; v < k.height; ++v)
    view.row_poses.push_back(Pose{{}, {0, eye_at(v), 0}} * camera_from_optical);
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const LinearFrame frame = renderer.render_linear(view);
  for (int v = 0; v < k.height; ++v) {
    const double edge = k.cx + k.fx * eye_at(v) / 4;  // y = 0 seen from there
    int first = 0;  // columns grow to the right, where the box ends
    while (first < k.width && frame.instance[std::size_t(v * k.width + first)] == 5) ++first;
    ASSERT_EQ(first, int(std::floor(edge)) + 1) << "row " << v;
  }
}

}  // namespace lens_test
}  // namespace rubble::testing
