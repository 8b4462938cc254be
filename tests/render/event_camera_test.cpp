// Event pixels against known changes of light, and the whole event camera against a moving edge.
#include "render/sensors/event_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "kernel/base/portable_math.h"
#include "render/devices/gl/gl_device.h"
#include "render/devices/software/software_device.h"
#include "render/sensors/camera.h"
#include "tests/render/cached_options.h"
#include "tests/render/test_scene.h"

namespace rubble::testing {
namespace event_camera_test {

EventCameraSpec quiet() {
  EventCameraSpec spec;
  spec.on = true;
  spec.threshold_up = 0.2, spec.threshold_down = 0.25;
  spec.threshold_noise = 0, spec.background_hz = 0, spec.refractory = 0;
  spec.dark = 1e-9;
  return spec;
}

// ln(light) rises evenly by 1.1 in a second: events of 0.2 at 2/11, 4/11, ... s.
TEST(EventPixels, ReportEachThresholdOfARampAtItsTime) {
  EventPixels pixels(quiet(), 1, 1, 1);
  std::vector<Event> events;
  for (int i = 0; i <= 10; ++i)
    pixels.see(i * 100'000'000LL, {float(5 * std::exp(0.11 * i))}, events);
  ASSERT_EQ(events.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_TRUE(events[i].brighter);
    EXPECT_NEAR(double(events[i].stamp_ns), 1e9 * 0.2 * double(i + 1) / 1.1, 1e3);
  }
  // Down again from 1.1 above the start, the reference at 1.0: the first at 0.75.
  events.clear();
  for (int i = 11; i <= 20; ++i)
    pixels.see(i * 100'000'000LL, {float(5 * std::exp(1.1 - 0.11 * (i - 10)))}, events);
  ASSERT_EQ(events.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_FALSE(events[i].brighter);
    EXPECT_NEAR(double(events[i].stamp_ns), 1e9 * (1 + (0.1 + 0.25 * double(i + 1)) / 1.1), 1e3);
  }
}

// The sum of a pixel's events is its change of ln(light), to within one threshold.
TEST(EventPixels, AddUpToTheChange) {
  EventCameraSpec spec = quiet();
  spec.threshold_down = 0.2;
  EventPixels pixels(spec, 1, 1, 1);
  std::vector<Event> events;
  for (int i = 0; i <= 500; ++i) {
    const double level = 2 * std::sin(0.02 * i) + 0.7 * std::sin(0.13 * i);
    pixels.see(i * 1'000'000LL, {float(std::exp(level))}, events);
    double sum = 0;
    for (const Event& e : events) sum += e.brighter ? 0.2 : -0.2;
    ASSERT_NEAR(sum, level, 0.2 + 1e-5) << i;
  }
  EXPECT_GT(events.size(), 50u);
}

TEST(EventPixels, AreSilentForTheRefractoryTime) {
  EventCameraSpec spec = quiet();
  spec.refractory = 0.25;
  EventPixels pixels(spec, 1, 1, 1);
  std::vector<Event> events;
  pixels.see(0, {1}, events);
  pixels.see(1'000'000'000, {float(std::exp(2.05))}, events);  // crossings every 0.2 / 2.05 s
  ASSERT_EQ(events.size(), 4u);  // each third one
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_NEAR(double(events[i].stamp_ns), 1e9 * 0.2 / 2.05 * double(1 + 3 * i), 2e3);
}

TEST(EventPixels, HaveNoiseAtTheStatedRateAndThresholdsOfTheStatedSpread) {
  EventCameraSpec spec = quiet();
  spec.background_hz = 5;
  EventPixels still(spec, 100, 100, 9);
  std::vector<Event> events;
  for (int i = 0; i <= 20; ++i) still.see(i * 50'000'000LL, std::vector<float>(10000, 1), events);
  EXPECT_NEAR(double(events.size()), 50000, 1000);  // 5 Hz, 10,000 pixels, 1 s
  const auto up = std::count_if(events.begin(), events.end(), [](const Event& e) { return e.brighter; });
  EXPECT_NEAR(double(up) / double(events.size()), 0.5, 0.02);
  EXPECT_TRUE(std::is_sorted(events.begin(), events.end(),
                             [](const Event& a, const Event& b) { return a.stamp_ns < b.stamp_ns; }));
  spec.background_hz = 300;  // many between two images
  EventPixels hot(spec, 20, 20, 9);
  events.clear();
  for (int i = 0; i < 2; ++i) hot.see(i * 1'000'000'000LL, std::vector<float>(400, 1), events);
  EXPECT_NEAR(double(events.size()), 300 * 400, 1500);
  spec.background_hz = 0, spec.threshold_noise = 0.03;
  EventPixels uneven(spec, 100, 100, 9);
  events.clear();
  uneven.see(0, std::vector<float>(10000, 1), events);
  uneven.see(1'000'000'000, std::vector<float>(10000, float(std::exp(0.3))), events);
  double sum = 0, squares = 0, n = 0;
  std::vector<bool> seen(10000, false);
  for (const Event& e : events) {  // the time of a pixel's first tells its threshold
    const std::size_t pixel = std::size_t(e.y) * 100 + e.x;
    if (seen[pixel]) continue;
    seen[pixel] = true;
    ++n;
    const double threshold = 0.3 * double(e.stamp_ns) * 1e-9;
    sum += threshold, squares += threshold * threshold;
  }
  const double mean = sum / n;
  EXPECT_GT(n, 9900);
  EXPECT_NEAR(mean, 0.2, 0.002);
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 0.03, 0.001);
}

Scene edge_scene() {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.intensity = 0.5;
  scene.light.rpy_deg = {0, 30, 180};
  scene.meshes.push_back(share(make_box({1, 20, 40}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {4.5, 10, 0}}, 5});
  return scene;
}

RenderOptions edge_options() {
  RenderOptions options = cached_options();
  options.bake = false, options.shadow_size = 64, options.texture_size = 16;
  return options;
}

CameraSpec edge_camera() {
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 16, 100);
  spec.event_camera = quiet();
  spec.event_camera.most_motion = 0.5;
  return spec;
}

// times: of the frames; unit: s
Flight fly_at(const std::vector<double>& times, const std::function<Pose(double)>& pose_at) {
  Flight flight;
  flight.pose_at = [pose_at](std::int64_t ns) { return pose_at(double(ns) * 1e-9); };
  for (const double t : times) {
    flight.stamps_ns.push_back(std::llround(t * 1e9));
    flight.world_from_camera.push_back(flight.pose_at(flight.stamps_ns.back()));
  }
  return flight;
}

std::size_t count_events(Renderer& renderer, const std::function<Pose(double)>& pose_at, const std::vector<double>& times) {
  Camera camera(renderer, edge_camera(), fly_at(times, pose_at));
  std::size_t count = 0;
  for (int i = 0; i < int(times.size()); ++i) count += camera.take(i).events.size();
  return count;
}

// How many events there are does not depend on how many frames there are: also where the camera comes back to where it was, or
// turns away from all that it saw.
TEST(EventCamera, SeesAllBetweenFramesThatAreFarApart) {
  const Scene scene = edge_scene();
  SoftwareDevice device;
  Renderer renderer(device, scene, edge_options());
  const auto back = [](double t) { return Pose{{}, {0, 0.2 * std::sin(portable::kPi * t) - 0.1, 0}}; };
  const auto turns = [](double t) { return Pose{Quat{std::cos(0.75 - 1.2 * t), 0, 0, std::sin(0.75 - 1.2 * t)}, {0, 0, 0}}; };
  const std::vector<double> many{0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1}, two{0, 1};
  const std::size_t there = count_events(renderer, back, many), once = count_events(renderer, back, two);
  EXPECT_GT(there, 100u);
  EXPECT_NEAR(double(once) / double(there), 1, 0.1);
  const std::size_t turned = count_events(renderer, turns, many), at_once = count_events(renderer, turns, two);
  EXPECT_GT(turned, 100u);
  EXPECT_NEAR(double(at_once) / double(turned), 1, 0.1);
}

// A camera that moves sideways past a bright edge: where the edge passed, and only there, as many
// events as its contrast has thresholds, at the time when it passed.
void check_moving_edge(Device& device) {
  const Scene scene = edge_scene();
  Renderer renderer(device, scene, edge_options());
  CameraSpec spec = edge_camera();
  spec.event_camera.threshold_down = 0.2;
  const auto pose_at = [](double t) { return Pose{{}, {0, 2 * t - 0.1, 0}}; };
  const LinearFrame before = renderer.render_linear(pose_at(0), spec.intrinsics);
  const LinearFrame after = renderer.render_linear(pose_at(0.1), spec.intrinsics);
  const auto level = [](const LinearFrame& f, std::size_t i) {
    return std::log(1000 * (0.2126 * double(f.rgb[i * 3]) + 0.7152 * double(f.rgb[i * 3 + 1]) +
                            0.0722 * double(f.rgb[i * 3 + 2])));
  };
  Camera camera(renderer, spec, fly_at({0, 0.1}, pose_at));
  EXPECT_TRUE(camera.take(0).events.empty());
  const std::vector<Event> events = camera.take(1).events;
  ASSERT_FALSE(events.empty());
  // The image moves to the right by 100 * 2 / 4 = 50 pixels a second, 5 in all, around the middle.
  std::vector<double> sums(64 * 16, 0);
  std::vector<bool> seen(64 * 16, false);
  for (const Event& e : events) {
    EXPECT_GT(e.stamp_ns, 0);
    EXPECT_LE(e.stamp_ns, 100'000'000);
    sums[std::size_t(e.y) * 64 + e.x] += e.brighter ? 0.2 : -0.2;
    // The first event of a pixel is the edge; the wall's own texture makes others.
    const bool first = sums[std::size_t(e.y) * 64 + e.x] == (e.brighter ? 0.2 : -0.2);
    if (e.x < 29 || e.x > 33 || !first || seen[std::size_t(e.y) * 64 + e.x]) continue;
    seen[std::size_t(e.y) * 64 + e.x] = true;
    const double passed = (double(e.x) - 31.5 + 2.5) / 50;  // when the edge is at this column
    EXPECT_NEAR(double(e.stamp_ns) * 1e-9, passed, 0.6 / 50) << e.x;
  }
  int edge = 0;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    EXPECT_NEAR(sums[i], level(after, i) - level(before, i), 0.21) << i % 64 << "," << i / 64;
    edge += std::fabs(sums[i]) > 0.3;
  }
  EXPECT_NEAR(edge, 5 * 16, 16);
}

TEST(EventCamera, ReportsAMovingEdge) {
  SoftwareDevice software;
  check_moving_edge(software);
  GlDevice card;
  check_moving_edge(card);
}

// A card finds which pixels report; from its images the processor finds the same.
TEST(EventCamera, HasTheSameEventsWhereACardFindsThem) {
  const Scene heap = make_heap(60, 2);
  GlDevice device;
  Renderer renderer(device, heap, edge_options());
  EventCameraSpec spec = quiet();
  spec.threshold_noise = 0.03, spec.background_hz = 2, spec.refractory = 1e-3;
  const Intrinsics k = pinhole(100, 60, 80);
  EventPixels by_card(spec, k.width, k.height, 7), by_processor(spec, k.width, k.height, 7);
  const std::shared_ptr<LightWatch> watch = renderer.watch_light(by_card.pixels());
  ASSERT_TRUE(watch);
  std::vector<Event> card, processor;
  for (int i = 0; i < 12; ++i) {
    const ViewRays view{i * 10'000'000LL, k, look_at({5 - 0.1 * i, 1 + 0.02 * i, 1.4}, {0, 0, 0.5})};
    RenderedView seen = renderer.view(view);
    std::vector<float> light;
    const std::vector<float>& rgb = seen.radiance();
    for (std::size_t p = 0; p < rgb.size(); p += 3)
      light.push_back(1000 * (0.2126f * rgb[p] + 0.7152f * rgb[p + 1] + 0.0722f * rgb[p + 2]));
    by_processor.see(view.stamp_ns, light, processor);
    seen.depth();
    const DeviceTraffic before = device.traffic();
    const std::vector<LightChange> changes = seen.light_changes(*watch);
    EXPECT_EQ(device.traffic().taken - before.taken, 4 + changes.size() * sizeof(LightChange));
    EXPECT_EQ(device.traffic().waits - before.waits, 1u);
    by_card.see_changes(view.stamp_ns, changes, card);
  }
  const auto place = [](const Event& e) { return std::tuple(e.x, e.y, e.brighter, e.stamp_ns / 100'000); };
  std::set<std::tuple<std::uint16_t, std::uint16_t, bool, std::int64_t>> known;
  for (const Event& e : processor) known.insert(place(e));
  std::size_t same = 0;
  for (const Event& e : card) same += known.count(place(e));
  EXPECT_GT(processor.size(), 2000u);
  EXPECT_NEAR(double(card.size()) / double(processor.size()), 1, 0.005);
  EXPECT_GT(double(same) / double(card.size()), 0.98);
}

// The camera stands and the wall goes by: the edge is at each column at its time, which takes images
// between the two frames.
TEST(EventCamera, ReportsTheEdgeOfWhatMoves) {
  Scene scene;
  scene.ground = false;
  scene.lamp.on = false;
  scene.light.intensity = 0.5;
  scene.light.rpy_deg = {0, 30, 180};
  scene.meshes.push_back(share(make_box({1, 20, 40}, "plaster")));
  scene.instances.push_back({0, 1, {{}, {4.5, 10, 0}}, 5});
  scene.motion.moving = {0};
  scene.motion.reach.include({4.5, 10, 0});
  scene.motion.poses_at = [](std::int64_t ns) {
    return std::vector<std::optional<Pose>>{Pose{{}, {4.5, 10.1 - 2e-9 * double(ns), 0}}};
  };
  SoftwareDevice device;
  Renderer renderer(device, scene, edge_options());
  CameraSpec spec;
  spec.intrinsics = pinhole(64, 16, 100);
  spec.event_camera = quiet();
  spec.event_camera.most_motion = 0.5;
  Flight flight;
  flight.pose_at = [](std::int64_t) { return Pose{}; };
  flight.stamps_ns = {0, 100'000'000};
  flight.world_from_camera.resize(2);
  Camera camera(renderer, spec, flight);
  EXPECT_TRUE(camera.take(0).events.empty());
  std::vector<bool> seen(64 * 16, false);
  int edge = 0;
  for (const Event& e : camera.take(1).events) {
    if (e.x < 30 || e.x > 33 || seen[std::size_t(e.y) * 64 + e.x]) continue;
    seen[std::size_t(e.y) * 64 + e.x] = true;
    const double passed = (double(e.x) - 31.5 + 2.5) / 50;  // when the edge is at this column
    EXPECT_NEAR(double(e.stamp_ns) * 1e-9, passed, 0.6 / 50) << e.x;
    ++edge;
  }
  EXPECT_EQ(edge, 4 * 16);
}

}  // namespace event_camera_test
}  // namespace rubble::testing
