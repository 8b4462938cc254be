// What moves in a scene, against closed forms: where it is seen, how it flows, what it shades.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kernel/base/portable_math.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace motion_test {

constexpr double kGravity = 9.81;
constexpr std::int64_t kSecond = 1'000'000'000;

RenderOptions plain() {
  RenderOptions options = cached_options();
  options.bake = false;
  options.shadow_size = 512;
  options.texture_size = 16;
  return options;
}

double seconds(std::int64_t stamp_ns) { return double(stamp_ns) * 1e-9; }

// The scene with its last `poses` instances moving as the function says.
using Motion = std::function<std::optional<Pose>(std::size_t i, double t)>;
void set_moving(Scene& scene, std::size_t count, const Motion& motion, const Aabb& reach) {
  for (std::size_t i = scene.instances.size() - count; i < scene.instances.size(); ++i)
    scene.motion.moving.push_back(std::uint32_t(i));
  scene.motion.reach = reach;
  scene.motion.poses_at = [count, motion](std::int64_t stamp_ns) {
    std::vector<std::optional<Pose>> poses;
    for (std::size_t i = 0; i < count; ++i) poses.push_back(motion(i, seconds(stamp_ns)));
    return poses;
  };
}

Scene slab_scene(const Vec3& size) {
  Scene scene;
  scene.meshes = {share(make_box(size))};
  scene.instances.push_back({0, 1, {}, 7, 2});
  return scene;
}

ViewRays view_at(const Pose& pose, const Intrinsics& k, std::int64_t stamp_ns) {
  return {stamp_ns, k, pose};
}

// Seen from straight below, a box that falls has the depth of its lower face.
TEST(Motion, AFallingBoxIsAsDeepAsFreeFallSays) {
  Scene scene = slab_scene({1, 1, 1});
  scene.ground = false;
  const auto height = [](double t) { return 12 - 0.5 * kGravity * t * t; };
  set_moving(scene, 1, [&](std::size_t, double t) { return Pose{{}, {0, 0, height(t)}}; },
             {{0, 0, 0}, {0, 0, 12}});
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const Pose up{portable::quat_from_rpy(0, -portable::kPi / 2, 0), {0, 0, 1}};
  const Intrinsics k = pinhole(65, 65, 60);
  for (const double t : {0.0, 0.4, 1.1, 0.7}) {
    const Frame frame = renderer.render(view_at(up, k, std::llround(t * 1e9)), 0);
    EXPECT_NEAR(double(frame.depth[32 * 65 + 32]), height(t) - 0.5 - 1, 2e-6) << t;
  }
}

// A slab facing the camera that slides sideways and turns about the axis of view: each of its points
// goes where that motion takes it, and the camera itself flies on meanwhile.
TEST(Motion, FlowIsThePointsOwnMotion) {
  Scene scene = slab_scene({0.2, 2, 2});
  const auto pose_at = [](double t) {
    return Pose{portable::quat_from_rpy(0.9 * t, 0, 0), {5 - 0.5 * t, 0.8 * t, 3}};
  };
  set_moving(scene, 1, [&](std::size_t, double t) { return pose_at(t); }, {{0, -3, 0}, {8, 3, 4}});
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const Intrinsics k = pinhole(80, 60, 70);
  const Pose now{{}, {0, 0, 3}}, then{portable::quat_from_rpy(0, 0, 0.02), {0.1, 0.05, 3}};
  const ViewRays next = view_at(then, k, kSecond / 10);
  const StreamSet channels{find_image_stream("flow"), find_image_stream("instance")};
  const Frame frame = renderer.view(view_at(now, k, 0), &next).into_frame(0, channels);
  int on_slab = 0, on_ground = 0;
  for (int v = 0; v < k.height; ++v) {
    for (int u = 0; u < k.width; ++u) {
      const std::size_t i = std::size_t(v * k.width + u);
      if (std::isnan(frame.depth[i])) continue;
      const double z = double(frame.depth[i]);
      const Vec3 optical{(u - k.cx) / k.fx * z, (v - k.cy) / k.fy * z, z};
      const Vec3 world = now * camera_from_optical * optical;
      const bool slab = instances_of(frame)[i] == 7;
      const Vec3 later = slab ? pose_at(0.1) * (pose_at(0).inverse() * world) : world;
      const Vec3 seen = (then * camera_from_optical).inverse() * later;
      EXPECT_NEAR(double(flow_of(frame)[i * 2]), k.fx * seen.x / seen.z + k.cx - u, 2e-4);
      EXPECT_NEAR(double(flow_of(frame)[i * 2 + 1]), k.fy * seen.y / seen.z + k.cy - v, 2e-4);
      (slab ? on_slab : on_ground) += 1;
    }
  }
  EXPECT_GT(on_slab, 500);
  EXPECT_GT(on_ground, 500);
}

TEST(Motion, WhatWillNotBeThereHasNoFlow) {
  Scene scene = slab_scene({0.2, 2, 2});
  set_moving(scene, 1,
             [](std::size_t, double t) -> std::optional<Pose> {
               if (t >= 0.1) return std::nullopt;
               return Pose{{}, {5, 0, 3}};
             },
             {{5, 0, 3}, {5, 0, 3}});
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const Intrinsics k = pinhole(80, 60, 70);
  const Pose pose{{}, {0, 0, 3}};
  const ViewRays next = view_at(pose, k, kSecond / 10);
  const StreamSet channels{find_image_stream("flow"), find_image_stream("instance")};
  const Frame frame = renderer.view(view_at(pose, k, 0), &next).into_frame(0, channels);
  const std::size_t middle = 30 * 80 + 40, below = 55 * 80 + 40;
  EXPECT_EQ(instances_of(frame)[middle], 7u);
  EXPECT_TRUE(std::isnan(flow_of(frame)[middle * 2]));
  EXPECT_EQ(instances_of(frame)[below], kGroundInstance);
  EXPECT_EQ(flow_of(frame)[below * 2], 0);
  EXPECT_TRUE(std::isnan(renderer.render(next, 1).depth[middle]) ||
              renderer.render(next, 1).depth[middle] > 20);
}

// A heap of which half moves is drawn as a heap that stands where they are: the same surface at every
// pixel, by either way of drawing, and however the frames are ordered.
Scene heap_at(double t, bool moving) {
  Scene scene = make_heap(60, 3);
  const std::size_t half = scene.instances.size() / 2;
  const std::vector<SceneInstance> start = scene.instances;
  const auto pose_of = [start, half](std::size_t i, double time) {
    const Pose& from = start[start.size() - half + i].world_from_body;
    const Pose turn{portable::quat_from_rpy(0.3 * time, 0.2 * time, time), {0, 0, 0.4 * time}};
    return Pose{turn.rotation * from.rotation, from.translation + turn.translation};
  };
  if (moving) {
    set_moving(scene, half, pose_of, {{-3, -3, 0}, {3, 3, 4}});
    return scene;
  }
  for (std::size_t i = 0; i < half; ++i)
    scene.instances[start.size() - half + i].world_from_body = pose_of(i, t);
  return scene;
}

Frame draw_heap(Renderer& renderer, double t, const Intrinsics& k) {
  const Pose pose = look_at({3.5, 1, 2}, {0, 0, 0.5});
  ViewRays view = view_at(pose, k, std::llround(t * 1e9));
  if (k.distortion[0] != 0) view.directions = make_lens_directions(k, 1);
  const StreamSet channels{find_image_stream("instance"), find_image_stream("label"),
                           find_image_stream("normals")};
  return renderer.view(view).into_frame(0, channels);
}

TEST(Motion, IsSeenAsIfItStoodThere) {
  SoftwareDevice device;
  Intrinsics k = pinhole(96, 72, 80);
  Renderer moving(device, heap_at(0, true), plain());
  for (const double lens : {0.0, 0.05}) {
    k.distortion[0] = lens;
    for (const double t : {0.5, 0.0, 1.5}) {
      Renderer standing(device, heap_at(t, false), plain());
      const Frame a = draw_heap(moving, t, k), b = draw_heap(standing, t, k);
      EXPECT_EQ(instances_of(a), instances_of(b)) << t;
      EXPECT_EQ(labels_of(a), labels_of(b));
      for (std::size_t i = 0; i < a.depth.size(); ++i) {
        if (std::isnan(a.depth[i]) && std::isnan(b.depth[i])) continue;
        ASSERT_NEAR(a.depth[i], b.depth[i], 1e-5f * b.depth[i]) << t << " at " << i;
        ASSERT_NEAR(normals_of(a)[i * 3], normals_of(b)[i * 3], 1e-4);
      }
    }
  }
}

TEST(Motion, AFrameDoesNotDependOnThoseBefore) {
  SoftwareDevice device;
  const Intrinsics k = pinhole(96, 72, 80);
  Renderer forth(device, heap_at(0, true), plain()), back(device, heap_at(0, true), plain());
  std::vector<Frame> first, second;
  for (const double t : {0.0, 0.5, 1.0}) first.push_back(draw_heap(forth, t, k));
  for (const double t : {1.0, 0.5, 0.0}) second.insert(second.begin(), draw_heap(back, t, k));
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].rgb, second[i].rgb) << i;
    EXPECT_EQ(instances_of(first[i]), instances_of(second[i])) << i;
  }
  EXPECT_NE(first[0].rgb, first[2].rgb);  // the negative control
}

// Mean radiance of the ground under the middle of the image.
double ground_at(Renderer& renderer, double t) {
  const Pose down{portable::quat_from_rpy(0, portable::kPi / 2, 0), {0, 0, 3}};
  const LinearFrame image =
      renderer.render_linear(view_at(down, pinhole(33, 33, 60), std::llround(t * 1e9)));
  double sum = 0;
  for (int v = 14; v < 19; ++v)
    for (int u = 14; u < 19; ++u) {
      EXPECT_EQ(image.instance[std::size_t(v * 33 + u)], kGroundInstance);
      sum += double(image.rgb[std::size_t(v * 33 + u) * 3 + 1]);
    }
  return sum / 25;
}

// A slab passes above the camera: under it the sun is gone, and a share of the sky.
TEST(Motion, ThrowsAShadowWhereItIs) {
  Scene scene = slab_scene({6, 6, 0.3});
  scene.light.rpy_deg = {0, 90, 0};  // straight down
  scene.lamp.on = false;
  set_moving(scene, 1,
             [](std::size_t, double t) -> std::optional<Pose> {
               if (t < 1) return std::nullopt;
               return Pose{{}, {20.0 * (t - 2), 0, 4}};
             },
             {{-20, 0, 4}, {20, 0, 4}});
  SoftwareDevice device;
  RenderOptions options = plain();
  options.shadow_size = 2048;
  Renderer renderer(device, scene, options);
  const double open = ground_at(renderer, 0), under = ground_at(renderer, 2);
  EXPECT_NEAR(ground_at(renderer, 1), open, 0.03 * open);
  EXPECT_LT(under, 0.25 * open);
  EXPECT_GT(under, 0);
  EXPECT_NEAR(ground_at(renderer, 3), open, 0.03 * open);
}

// In the open, what moves is lit as what rests is.
TEST(Motion, IsLitAsIfItRestedThere) {
  const Vec3 size{2, 2, 2};
  Scene moving = slab_scene(size), resting = slab_scene(size);
  moving.lamp.on = resting.lamp.on = false;
  resting.instances[0].world_from_body = {{}, {0, 0, 4}};
  set_moving(moving, 1, [](std::size_t, double) { return Pose{{}, {0, 0, 4}}; },
             {{0, 0, 4}, {0, 0, 4}});
  SoftwareDevice device;
  RenderOptions options = plain();
  options.bake = true;
  Renderer a(device, moving, options), b(device, resting, options);
  for (const Vec3& eye : {Vec3(6, 1, 5), Vec3(-6, 1, 5), Vec3(1, 7, 2), Vec3(1, 1, 9)}) {
    const ViewRays view = view_at(look_at(eye, {0, 0, 4}), pinhole(64, 48, 60), 0);
    const LinearFrame x = a.render_linear(view), y = b.render_linear(view);
    double of_moving = 0, of_resting = 0;
    for (std::size_t i = 0; i < x.instance.size(); ++i) {
      if (x.instance[i] != 7) continue;
      of_moving += double(x.rgb[i * 3 + 1]), of_resting += double(y.rgb[i * 3 + 1]);
    }
    ASSERT_GT(of_resting, 0);
    EXPECT_NEAR(of_moving / of_resting, 1, 0.12) << eye.x << " " << eye.y << " " << eye.z;
  }
}

// With a few movers, light is found anew only where these are; with more than 200, everywhere. Here the many lie under
// the ground, where nothing meets them, or are not there.
TEST(Motion, LightFoundWhereItMovesIsThatFoundEverywhere) {
  constexpr std::size_t kBuried = 210;
  const auto scene_with = [](bool buried) {
    Scene scene;
    scene.lamp.on = false;
    scene.meshes = {share(make_box({3, 3, 0.3})), share(make_box({0.8, 0.8, 0.8})), share(make_box({1e-4, 1e-4, 1e-4}))};
    for (const double z : {0.15, 1.8}) scene.instances.push_back({0, 1, {{}, {0, 0, z}}, std::uint32_t(10 * z), 2});
    scene.instances.push_back({1, 1, {{}, {1.4, -1.2, 0.7}}, 20, 2});
    scene.instances.push_back({1, 1, {}, 21, 2});
    for (std::size_t i = 0; i < kBuried; ++i) scene.instances.push_back({2, 1, {}, std::uint32_t(30 + i), 2});
    const auto pose_of = [buried](std::size_t i, double t) -> std::optional<Pose> {
      if (i > 0 && !buried) return std::nullopt;
      if (i == 0) return Pose{portable::quat_from_rpy(0, 0, t), {-1.2 + 1.5 * t, 0.3, 0.7}};
      return Pose{{}, {0.03 * double(i) - 1, 0, -0.001}};
    };
    set_moving(scene, kBuried + 1, pose_of, {{-2, -2, 0}, {2, 2, 2}});
    return scene;
  };
  RenderOptions options = plain();
  options.bake = true;
  SoftwareDevice device;
  Renderer few(device, scene_with(false), options), many(device, scene_with(true), options);
  const Intrinsics k = pinhole(64, 48, 80);
  const Pose eye{portable::quat_from_rpy(0, 0.15, 0.3), {-4, -1.2, 1.5}};
  double moved = 0;
  LinearFrame before;
  for (const double t : {0.2, 0.9, 1.6}) {
    const LinearFrame a = few.render_linear(view_at(eye, k, std::llround(t * 1e9)));
    const LinearFrame b = many.render_linear(view_at(eye, k, std::llround(t * 1e9)));
    EXPECT_EQ(a.rgb, b.rgb) << t;
    for (std::size_t i = 0; i < before.rgb.size(); ++i) moved += std::abs(double(a.rgb[i]) - double(before.rgb[i]));
    before = a;
  }
  EXPECT_GT(moved, 0);
}

TEST(Motion, ShiftsAreThoseOfThePoints) {
  Scene scene = slab_scene({0.2, 2, 2});
  set_moving(scene, 1, [](std::size_t, double t) { return Pose{{}, {5, 0.5 * t, 3}}; },
             {{5, -1, 3}, {5, 1, 3}});
  SoftwareDevice device;
  Renderer renderer(device, scene, plain());
  const ViewRays view = view_at({{}, {0, 0, 3}}, pinhole(80, 60, 70), 0);
  const std::vector<Vec3f> shifts = renderer.view(view).shifts(kSecond / 2);
  EXPECT_NEAR(shifts[30 * 80 + 40].y, 0.25, 1e-6);
  EXPECT_EQ(norm(shifts[55 * 80 + 40]), 0);
  Renderer still(device, slab_scene({1, 1, 1}), plain());
  EXPECT_TRUE(still.view(view).shifts(kSecond).empty());
}

}  // namespace motion_test
}  // namespace rubble::testing
