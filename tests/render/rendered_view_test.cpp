// A view gives the same channels in whatever order they are asked for, and whatever is drawn between.
#include "render/view/rendered_view.h"

#include <gtest/gtest.h>

#include <cstring>
#include <string>

#include "kernel/base/portable_math.h"
#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/renderer.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace rendered_view_test {

constexpr std::int64_t kSecond = 1'000'000'000;

RenderOptions small() {
  RenderOptions options = cached_options();
  options.bake_rays = 8;
  options.shadow_size = 256;
  options.texture_size = 16;
  return options;
}

// Half of a heap turns and rises, in smoke and dust.
Scene restless_heap() {
  Scene scene = make_heap(12, 3);
  const std::size_t half = scene.instances.size() / 2;
  std::vector<Pose> start;
  for (std::size_t i = half; i < scene.instances.size(); ++i) {
    scene.motion.moving.push_back(std::uint32_t(i));
    start.push_back(scene.instances[i].world_from_body);
  }
  scene.motion.reach = {{-3, -3, 0}, {3, 3, 4}};
  scene.motion.poses_at = [start](std::int64_t stamp_ns) {
    const double t = double(stamp_ns) / double(kSecond);
    std::vector<std::optional<Pose>> poses;
    for (const Pose& from : start)
      poses.push_back(Pose{portable::quat_from_rpy(0.3 * t, 0, t) * from.rotation,
                           from.translation + Vec3(0, 0, 0.4 * t)});
    return poses;
  };
  scene.air.fog_density = 0.2;
  scene.air.dust.period = 0.5;
  return scene;
}

// Two moments, a pinhole and a lens that is none.
std::vector<ViewRays> views() {
  const Intrinsics k = pinhole(48, 36, 40);
  Intrinsics bent = k;
  bent.distortion[0] = 0.05;
  const Pose pose = look_at({3.5, 1, 2}, {0, 0, 0.5}), beside = look_at({3, 2, 1}, {0, 0, 0.5});
  std::vector<ViewRays> all{{kSecond / 2, k, pose}, {2 * kSecond, k, beside},
                            {kSecond, bent, pose}, {3 * kSecond, bent, beside}};
  for (std::size_t i = 2; i < 4; ++i) all[i].directions = make_lens_directions(bent, 1);
  return all;
}

template <typename T>
std::string bytes(const std::vector<T>& values) {
  return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// Each channel by its number.
constexpr int kChannels = 10;
std::string ask(RenderedView& view, int channel) {
  const auto truth = [&](const char* name) {
    return std::visit([](const auto& values) { return bytes(values); },
                      view.truth(*find_image_stream(name)));
  };
  switch (channel) {
    case 0: return bytes(view.depth());
    case 1: return bytes(view.rgb());
    case 2: return bytes(view.radiance());
    case 3: return truth("normals");
    case 4: return truth("flow");
    case 5: return bytes(view.instances());
    case 6: return bytes(view.line_of_sight_mask({0, -0.1, 0}));
    case 7: return bytes(view.shifts(4 * kSecond));
    case 8: return bytes(view.rgb_at(0.3f)) + bytes(view.albedos());
    default: return bytes(view.distances());
  }
}

std::vector<std::vector<std::string>> ask_one_by_one() {
  std::vector<std::vector<std::string>> channels;
  SoftwareDevice device;
  const ViewRays next = views().back();
  for (const ViewRays& rays : views()) {
    channels.emplace_back();
    Renderer renderer(device, restless_heap(), small());
    for (int channel = 0; channel < kChannels; ++channel) {
      RenderedView view = renderer.view(rays, &next);
      channels.back().push_back(ask(view, channel));
      EXPECT_FALSE(channels.back().back().empty()) << channel;
    }
  }
  return channels;
}

TEST(RenderedView, GivesItsChannelsInAnyOrder) {
  const auto alone = ask_one_by_one();
  EXPECT_NE(alone[0][1], alone[1][1]) << "views that look alike would prove nothing";
  SoftwareDevice device;
  Renderer renderer(device, restless_heap(), small());
  const ViewRays next = views().back();
  std::vector<RenderedView> open;
  for (const ViewRays& rays : views()) open.push_back(renderer.view(rays, &next));
  const int pairs = int(open.size()) * kChannels;
  for (int i = 0; i < pairs; ++i) {
    const int pair = i * 7 % pairs;  // visits all pairs of view and channel once
    const std::size_t view = std::size_t(pair) % open.size();
    const int channel = pair / int(open.size());
    ASSERT_EQ(ask(open[view], channel), alone[view][std::size_t(channel)])
        << "view " << view << ", channel " << channel;
  }
}

// The same of a device that draws while others are asked for.
TEST(RenderedView, MayBeBegunBeforeOthersAreRead) {
  GlDevice device;
  ASSERT_TRUE(device.runs_ahead());
  const ViewRays next = views().back();
  std::vector<std::vector<std::string>> alone;
  for (const ViewRays& rays : views()) {
    Renderer renderer(device, restless_heap(), small());
    alone.emplace_back();
    for (int channel = 0; channel < kChannels; ++channel) {
      RenderedView view = renderer.view(rays, &next);
      alone.back().push_back(ask(view, channel));
    }
  }
  EXPECT_NE(alone[0][1], alone[1][1]) << "views that look alike would prove nothing";
  Renderer renderer(device, restless_heap(), small());
  std::vector<RenderedView> begun;
  for (const ViewRays& rays : views()) begun.push_back(renderer.view(rays, &next)), begun.back().begin();
  for (std::size_t view = begun.size(); view-- > 0;) {
    for (int channel = 0; channel < kChannels; ++channel)
      EXPECT_TRUE(ask(begun[view], channel) == alone[view][std::size_t(channel)])
          << "view " << view << ", channel " << channel;
  }
}

// Of two views that were begun.
std::uint64_t count_waits(Device& device, Renderer& renderer, std::size_t first) {
  std::vector<RenderedView> begun;
  const std::uint64_t before = device.traffic().waits;
  for (const ViewRays& rays : {views()[0], views()[1]}) begun.push_back(renderer.view(rays)), begun.back().begin();
  for (const std::size_t view : {first, 1 - first}) begun[view].rgb(), begun[view].depth();
  return device.traffic().waits - before;
}

TEST(RenderedView, WaitsForNoOtherThatWasBegunLater) {
  GlDevice device;
  for (const bool day : {true, false}) {
    Scene scene = restless_heap();
    // By day the lamp is left out where metering tells so, for which the processor waits.
    scene.lamp.on = !day;
    if (!day) scene.light.intensity = 0;
    Renderer renderer(device, scene, small());
    count_waits(device, renderer, 0);  // the first view of all
    EXPECT_EQ(count_waits(device, renderer, 0), 2u) << day;
    EXPECT_EQ(count_waits(device, renderer, 1), 1u) << "what was asked for earlier is there, too; by day: " << day;
  }
}

TEST(RenderedView, MakesAChannelOnce) {
  SoftwareDevice device;
  Renderer renderer(device, restless_heap(), small());
  RenderedView view = renderer.view(views().front());
  EXPECT_EQ(view.times().visibility.elapsed, 0) << "nothing is drawn before it is asked for";
  const float* const depth = view.depth().data();
  const std::uint8_t* const rgb = view.rgb().data();
  const double visibility = view.times().visibility.elapsed, resolve = view.times().resolve.elapsed;
  EXPECT_GT(visibility, 0);
  EXPECT_GT(resolve, 0);
  RenderedView other = renderer.view(views()[1]);
  other.rgb();
  EXPECT_EQ(view.depth().data(), depth);
  EXPECT_EQ(view.rgb().data(), rgb);
  EXPECT_EQ(view.times().visibility.elapsed, visibility);
  EXPECT_EQ(view.times().resolve.elapsed, resolve);
}

TEST(RenderedView, FramesHoldTheStreamsThatAreAskedFor) {
  SoftwareDevice device;
  Renderer renderer(device, restless_heap(), small());
  RenderedView view = renderer.view(views().front());
  view.truth(*find_image_stream("normals"));
  const Frame frame = std::move(view).into_frame(4, {find_image_stream("instance")});
  EXPECT_EQ(frame.index, 4);
  EXPECT_EQ(frame.truth.size(), 1u);
  EXPECT_EQ(instances_of(frame).size(), frame.depth.size());
  EXPECT_EQ(frame.rgb.size(), frame.depth.size() * 3);
}

}  // namespace rendered_view_test
}  // namespace rubble::testing
