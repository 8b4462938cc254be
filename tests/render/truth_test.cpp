// Ground-truth channels against closed forms and against ray casts of the test's own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "kernel/base/portable_math.h"
#include "render/camera/lens.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace truth_test {

constexpr double kPi = portable::kPi;

RenderOptions plain() {
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 64;
  options.texture_size = 16;
  return options;
}

StreamSet all_channels() { return truth_streams(); }

Frame draw(const Scene& scene, const Pose& pose, const Intrinsics& k, const StreamSet& channels,
           const Pose* next = nullptr) {
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  ViewRays rays;
  if (next) rays.world_from_camera = *next;
  return renderer.view({0, k, pose}, next ? &rays : nullptr).into_frame(0, channels);
}

Vec3 normal_at(const Frame& frame, std::size_t i) {
  return {double(normals_of(frame)[i * 3]), double(normals_of(frame)[i * 3 + 1]),
          double(normals_of(frame)[i * 3 + 2])};
}

// The scene as a list of triangles, and the first that a ray meets: tries them all, save of pieces
// whose bounding sphere it misses.
class BruteForce {
 public:
  explicit BruteForce(const Scene& scene) : ground_(scene.ground) {
    for (const SceneInstance& piece : scene.instances) {
      const TriangleMesh& mesh = scene.meshes[piece.mesh]->levels[0];
      Part part{piece.world_from_body.translation, 0, piece.id, {}};
      for (const auto& t : mesh.triangles)
        for (const std::uint32_t v : t) {
          const Vec3 p = piece.world_from_body * (Vec3(mesh.positions[v]) * double(piece.scale));
          part.radius = std::max(part.radius, distance(p, part.centre));
          part.corners.push_back(p);
        }
      parts_.push_back(std::move(part));
    }
  }

  std::uint32_t first_hit(const Vec3& from, const Vec3& d) const {
    double nearest = 1e30;
    std::uint32_t id = kNoInstance;
    if (ground_ && d.z < 0) nearest = -from.z / d.z, id = kGroundInstance;
    for (const Part& part : parts_) {
      const Vec3 to = part.centre - from;
      if (norm(cross(to, d)) > (part.radius + 1e-6) * norm(d)) continue;
      for (std::size_t i = 0; i < part.corners.size(); i += 3)
        if (const double t = meet(from, d, &part.corners[i]); t < nearest) nearest = t, id = part.id;
    }
    return id;
  }

 private:
  struct Part {
    Vec3 centre;
    double radius;
    std::uint32_t id;
    std::vector<Vec3> corners;  // three a triangle
  };

  // Moeller and Trumbore (1997); from behind nothing is met.
  static double meet(const Vec3& from, const Vec3& d, const Vec3* p) {
    const Vec3 ab = p[1] - p[0], ac = p[2] - p[0], h = cross(d, ac), s = from - p[0];
    const double det = dot(ab, h);
    if (det <= 0) return 1e30;
    const Vec3 q = cross(s, ab);
    const double u = dot(s, h) / det, v = dot(d, q) / det, t = dot(ac, q) / det;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0.011 ? t : 1e30;
  }

  bool ground_;
  std::vector<Part> parts_;
};

TEST(Instances, AreThoseThatRaysMeet) {
  const Scene scene = make_heap(60, 4);
  const Intrinsics k = pinhole(80, 60, 50);
  const Pose pose = look_at({3.6, 1, 1.4}, {0, 0, 0.7});
  const Frame frame = draw(scene, pose, k, all_channels());
  const Pose world_from_optical = pose * camera_from_optical;
  const BruteForce rays(scene);
  int differ = 0, pieces = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const Vec3 d((u - k.cx) / k.fx, (v - k.cy) / k.fy, 1);
      const std::size_t i = std::size_t(v * k.width + u);
      differ += instances_of(frame)[i] != rays.first_hit(world_from_optical.translation,
                                                    world_from_optical.rotation.rotate(d));
      pieces += instances_of(frame)[i] < kNoInstance;
      // One label for each mesh here, as a program gives one to each asset.
      const std::uint16_t label = labels_of(frame)[i];
      EXPECT_EQ(label == kSkyLabel, instances_of(frame)[i] == kNoInstance);
      EXPECT_EQ(label == kGroundLabel, instances_of(frame)[i] == kGroundInstance);
    }
  }
  EXPECT_GT(pieces, 1000);
  EXPECT_LE(differ, 3);  // a silhouette may pass within rounding of a pixel's centre
}

TEST(Labels, AreThoseOfTheInstances) {
  Scene scene;
  scene.meshes.push_back(share(make_box({1, 1, 1})));
  scene.instances.push_back({0, 1, {{}, {3, 0.6, 0.5}}, 4, 17});
  scene.instances.push_back({0, 1, {{}, {3, -0.6, 0.5}}, 9, 300});
  const Frame frame = draw(scene, {{}, {0, 0, 0.5}}, pinhole(80, 60, 60), all_channels());
  const std::size_t row = 30 * 80;
  EXPECT_EQ(labels_of(frame)[row + 28], 17);
  EXPECT_EQ(instances_of(frame)[row + 28], 4u);
  EXPECT_EQ(labels_of(frame)[row + 51], 300);
  EXPECT_EQ(instances_of(frame)[row + 51], 9u);
  EXPECT_EQ(labels_of(frame)[5 * 80 + 40], kSkyLabel);
  EXPECT_EQ(labels_of(frame)[59 * 80 + 40], kGroundLabel);
}

TEST(Normals, OfATurnedPlane) {
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_box({1, 80, 80})));
  const Quat turn = portable::quat_from_rpy(0.2, -0.3, 0.7);
  scene.instances.push_back({0, 1, {turn, {3, 0, 0}}, 1});
  const Frame frame = draw(scene, {}, pinhole(64, 48, 60), all_channels());
  const Vec3 n = camera_from_optical.inverse().rotation.rotate(turn.rotate({-1, 0, 0}));
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const Vec3 found = normal_at(frame, i);
    ASSERT_LT(norm(found - n), 1e-6) << i << ": " << found.x << " " << found.y << " " << found.z;
  }
}

TEST(Normals, OfASphere) {
  // 200 rings: a facet's normal is at most 1.2 pi / 200 = 1.1 degrees from the sphere's.
  Scene scene;
  scene.ground = false;
  scene.meshes.push_back(share(make_sphere(200)));
  scene.instances.push_back({0, 1, {{}, {4, 0.3, 0.2}}, 1});
  const Intrinsics k = pinhole(80, 60, 70);
  const Frame frame = draw(scene, {}, k, all_channels());
  const Vec3 centre = camera_from_optical.inverse() * Vec3(4, 0.3, 0.2);
  int seen = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    const Vec3 found = normal_at(frame, i);
    ASSERT_EQ(std::isnan(found.x), std::isnan(frame.depth[i]));
    if (std::isnan(found.x)) continue;
    const Vec3 point = Vec3((double(i % 80) - k.cx) / k.fx, (double(i / 80) - k.cy) / k.fy, 1) *
                       double(frame.depth[i]);
    ASSERT_GT(dot(found, normalized(point - centre)), std::cos(1.2 * kPi / 200)) << i;
    ASSERT_LT(dot(found, point), 0) << "towards the camera";
    ++seen;
  }
  EXPECT_GT(seen, 500);
}

// The depth image, reprojected by textbook formulas into the second camera.
TEST(Flow, IsWhereTheDepthReprojects) {
  const Scene scene = make_heap(80, 6);
  const Intrinsics k = pinhole(96, 72, 60);
  const Pose a = look_at({5, 1, 1.4}, {0, 0, 0.5}), b = look_at({4.8, 1.3, 1.3}, {0.1, 0, 0.6});
  const Frame frame = draw(scene, a, k, all_channels(), &b);
  const Pose b_from_a = (b * camera_from_optical).inverse() * (a * camera_from_optical);
  double longest = 0;
  for (std::size_t i = 0; i < frame.depth.size(); ++i) {
    ASSERT_EQ(std::isnan(frame.depth[i]), std::isnan(flow_of(frame)[i * 2]));
    if (std::isnan(frame.depth[i])) continue;
    const double u = double(i % 96), v = double(i / 96), z = double(frame.depth[i]);
    const Vec3 p = b_from_a * Vec3((u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z);
    const double fu = k.fx * p.x / p.z + k.cx - u, fv = k.fy * p.y / p.z + k.cy - v;
    ASSERT_NEAR(double(flow_of(frame)[i * 2]), fu, 2e-3);
    ASSERT_NEAR(double(flow_of(frame)[i * 2 + 1]), fv, 2e-3);
    longest = std::max(longest, std::hypot(fu, fv));
  }
  EXPECT_GT(longest, 3);
}

// The flow leads to the same surface: the next frame shows the same piece there, save where
// something else comes in front.
TEST(Flow, LeadsToTheSamePiece) {
  const Scene scene = make_heap(80, 6);
  const Intrinsics k = pinhole(96, 72, 60);
  const Pose a = look_at({5, 1, 1.4}, {0, 0, 0.5}), b = look_at({4.9, 1.1, 1.4}, {0, 0, 0.5});
  const Frame first = draw(scene, a, k, all_channels(), &b), second = draw(scene, b, k, all_channels());
  int same = 0, all = 0, unmoved = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const std::size_t i = std::size_t(v * k.width + u);
      if (instances_of(first)[i] >= kNoInstance) continue;
      const int x = int(std::lround(u + double(flow_of(first)[i * 2])));
      const int y = int(std::lround(v + double(flow_of(first)[i * 2 + 1])));
      if (x < 0 || y < 0 || x >= k.width || y >= k.height) continue;
      ++all;
      same += instances_of(second)[std::size_t(y * k.width + x)] == instances_of(first)[i];
      unmoved += instances_of(second)[i] == instances_of(first)[i];
    }
  }
  EXPECT_GT(all, 1000);
  EXPECT_GT(same, all * 85 / 100);
  EXPECT_LT(unmoved, same);  // negative control
}

TEST(Flow, IsMissingInTheLastFrameAndBehindTheCamera) {
  const Intrinsics k = pinhole(32, 24, 20);
  const Pose ahead{{}, {0, 0, 1}}, back{portable::quat_from_rpy(0, 0, kPi), {0, 0, 1}};
  const Frame last = draw(Scene{}, ahead, k, all_channels());
  const Frame behind = draw(Scene{}, ahead, k, all_channels(), &back);
  ASSERT_EQ(flow_of(last).size(), 2u * 32 * 24);
  ASSERT_EQ(flow_of(behind).size(), 2u * 32 * 24);
  for (const float f : flow_of(last)) ASSERT_TRUE(std::isnan(f));
  for (const float f : flow_of(behind)) ASSERT_TRUE(std::isnan(f));
}

double mean_sky(const Frame& frame, int v) {
  double sum = 0;
  for (int u = 10; u < 54; ++u)
    sum += double(sky_of(frame)[std::size_t(v * frame.intrinsics.width + u)]);
  return sum / 44;
}

// Sky view factors of urban climatology (Oke 1981): 1 on an open plane, 1/2 at a wall, and
// (1 + cos b) / 2 on the ground before a long wall whose top is seen at the angle b.
TEST(SkyVisibility, IsTheSkyViewFactor) {
  const Intrinsics k = pinhole(64, 48, 40);
  const Pose down{portable::quat_from_rpy(0, 0.5, 0), {-4, 0, 1.5}};
  const Frame open = draw(Scene{}, down, k, all_channels());
  EXPECT_EQ(mean_sky(open, 40), 1);
  Scene wall;
  wall.meshes.push_back(share(make_box({1, 400, 2})));
  wall.instances.push_back({0, 1, {{}, {0.5, 0, 1}}, 1});
  const Frame frame = draw(wall, down, k, all_channels());
  for (const int v : {22, 28, 36, 44}) {
    const std::size_t i = std::size_t(v * k.width + 32);
    const Vec3 p = down * camera_from_optical *
                   (Vec3(0, (v - k.cy) / k.fy, 1) * double(frame.depth[i]));
    const double expected = instances_of(frame)[i] == kGroundInstance
                                ? 0.5 * (1 + std::cos(std::atan2(2, -p.x)))
                                : 0.5;
    EXPECT_NEAR(mean_sky(frame, v), expected, 0.012) << "row " << v << ", x = " << p.x;
  }
}

TEST(Channels, AreLeftOutUnlessAskedFor) {
  const StreamSet only{find_image_stream("label")};
  const Frame frame = draw(Scene{}, {{}, {0, 0, 1}}, pinhole(32, 24, 20), only);
  EXPECT_EQ(labels_of(frame).size(), 32u * 24);
  EXPECT_EQ(frame.truth.size(), 1u);
  EXPECT_TRUE(normals_of(frame).empty() && instances_of(frame).empty());
}

}  // namespace truth_test
}  // namespace rubble::testing
