// A vine that is wound back goes where it came from.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/robot/robot_run.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace vine_retraction_test {

using testing::kRobotStep;
using testing::make_robot_world;

RobotModel make_short_vine() {
  VineOptions options;
  options.tube.links = count_vine_links(2, options.tube.link_length);
  return make_vine(options);
}

struct Growth {
  double speed = 0, curve_left = 0, curve_up = 0;  // unit: m/s, 1/m
};

void move(World& world, double seconds, const Growth& growth, const std::function<void(const RobotState&)>& look = {}) {
  const RobotModel model = world.robots().model(0);
  for (int i = 0; i < int(seconds / kRobotStep + 0.5); ++i) {
    if (i % 4 == 0) world.robots().set_command(0, grow_tube(model, growth.speed, growth.curve_left, growth.curve_up));
    world.step();
    if (look) look(world.robots().state(0));
  }
}

// The length goes down by speed times time, what has not been reached yet lies still, and the end is that of the start.
TEST(VineRetraction, TakesBackTheLengthThatTheReelWinds) {
  World world = make_robot_world();
  const RobotModel model = make_short_vine();
  world.robots().add(model, {{}, {0, 0, 0.051}});
  move(world, 0.5, {});
  const RobotState start = world.robots().state(0);
  move(world, 6, {0.2, 0, 0});
  move(world, 0.5, {});
  const RobotState grown = world.robots().state(0);
  move(world, 4, {-0.15, 0, 0});
  move(world, 0.5, {});
  const RobotState half = world.robots().state(0);
  // The motor holds the speed against the losses of eversion by its gain.
  const double gain = model.joints.back().motor.damping;
  EXPECT_NEAR(half.length, grown.length - 4 * 0.15 * gain / (gain + model.tube->speed_loss()), 0.001);
  const auto left = std::size_t(half.length / model.tube->link_length);
  for (std::size_t i = 1; i <= left; ++i)
    EXPECT_LT(distance(grown.links[i].world_from_link.translation, half.links[i].world_from_link.translation), 0.001) << i;
  EXPECT_NEAR(half.links.back().world_from_link.translation.x, half.length, 0.002);
  move(world, 12, {-0.15, 0, 0});
  const RobotState end = world.robots().state(0);
  EXPECT_NEAR(end.length, model.tube->start_links * model.tube->link_length, 1e-6) << "no shorter than it began";
  EXPECT_NEAR(norm(end.links.back().world_from_link.translation - start.links.back().world_from_link.translation), 0,
              0.002);
}

// Without weight the tip is, at each length, where it was at that length, and looks the same way.
TEST(VineRetraction, TheTipReturnsAlongItsPath) {
  World world = make_robot_world({}, 1, 0);
  const RobotModel model = make_short_vine();
  world.robots().add(model, {{}, {0, 0, 3}});
  std::vector<std::pair<double, Pose>> way;
  const auto note = [&](const RobotState& state) {
    way.push_back({state.length, state.links.back().world_from_link});
  };
  move(world, 3, {0.2, 1.2, 0}, note);
  move(world, 4, {0.2, -0.5, 0.8}, note);
  move(world, 1, {});
  const RobotState grown = world.robots().state(0);
  double farthest = 0, most_turned = 0;
  std::size_t compared = 0;
  move(world, 8, {-0.2, 0.7, 0.7}, [&](const RobotState& state) {  // curvature is of what grows
    const auto same = std::find_if(way.begin(), way.end(), [&](const auto& then) { return then.first >= state.length; });
    if (same == way.end()) return;
    const Pose tip = state.links.back().world_from_link;
    farthest = std::max(farthest, distance(tip.translation, same->second.translation));
    const Vec3 x{1, 0, 0};
    most_turned = std::max(most_turned, norm(tip.rotation.rotate(x) - same->second.rotation.rotate(x)));
    ++compared;
  });
  EXPECT_GT(grown.length, 1.4);
  EXPECT_GT(grown.links.back().world_from_link.translation.y, 0.3) << "it was to be bent";
  EXPECT_NEAR(world.robots().state(0).length, model.tube->start_links * model.tube->link_length, 1e-6);
  EXPECT_GT(compared, 1500U);
  // A step is 0.8 mm, bends lag by 20 ms (0.01 rad, there and back), and the tube swings when the reel sets in.
  EXPECT_LT(farthest, 0.006);
  EXPECT_LT(most_turned, 0.02);
}

// What lay on the tube falls when it is gone.
TEST(VineRetraction, LetsGoOfWhatLiesOnIt) {
  World world = make_robot_world({testing::box_type("plate", 0.4, 0.4, 0.02)});
  world.robots().add(make_short_vine(), {{}, {0, 0, 0.051}});
  move(world, 5, {0.2, 0, 0});
  const int plate = world.add({testing::at(0, {0.6, 0, 0.12})});
  move(world, 1, {});
  const double on = world.piece(plate).world_from_body.translation.z;
  EXPECT_GT(on, 0.09);
  move(world, 6, {-0.2, 0, 0});
  move(world, 1, {});
  const Vec3 at = world.piece(plate).world_from_body.translation;
  EXPECT_NEAR(at.z, 0.01, 0.002) << "it lies flat on the ground, at " << at.x << ' ' << at.y;
}

// Grown again after it was wound back, and kept in between.
TEST(VineRetraction, ASnapshotInMidRetractionGoesOnWithTheSameBits) {
  const auto make = [] {
    World world = make_robot_world({testing::box_type("brick", 0.22, 0.105, 0.065)});
    world.add({testing::at(0, {0.5, 0.03, 0.033}), testing::at(0, {0.62, -0.02, 0.1})});
    world.robots().add(make_short_vine(), {{}, {0, 0, 0.051}});
    return world;
  };
  World world = make();
  move(world, 3, {0.25, 0.3, 0.1});
  move(world, 1.01, {-0.25, 0, 0});
  const auto snapshot = world.snapshot();
  const auto go_on = [](World& from) {
    move(from, 0.7, {-0.2, 0, 0});
    move(from, 1.5, {0.3, 0.1, 0.4});
    return testing::hash_of(from);
  };
  const auto hash = go_on(world);
  World other = make();
  other.restore(*snapshot);
  EXPECT_EQ(go_on(other), hash);
}

}  // namespace vine_retraction_test
}  // namespace rubble
