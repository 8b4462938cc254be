// Voids inside placed pipes and rooms, whose sizes, doors and throats are known.
#include "kernel/voids/void_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "void_scenes.h"

namespace rubble {
namespace void_map_test {

using testing::VoidScene;
constexpr double kPi = 3.14159265358979323846;

VoidMap map_of(const VoidScene& scene, double voxel, std::vector<double> radii,
               double rolling = 0.8) {
  VoidSpaceOptions options;
  options.voxel = voxel;
  options.rolling_radius = rolling;
  return find_voids(calc_void_space(scene.pile, scene.pointers(), options), radii);
}

// A pipe along X through the point (0, 0, 1.5), from x = -1.5 to 1.5.
VoidScene pipe_scene(double inner, double outer) {
  VoidScene scene;
  Pose pose;
  pose.translation = {-1.5, 0.007, 1.503};
  scene.add(testing::make_pipe(3, inner, outer), pose);
  return scene;
}

TEST(VoidMap, APipeIsOneVoidWithTwoEntrances) {
  const double inner = 0.4;
  const VoidMap map = map_of(pipe_scene(inner, 0.5), 0.03, {0.2});
  const RobotVoids& robot = map.robots.at(0);
  ASSERT_EQ(robot.voids.size(), 1u);
  const Void& v = robot.voids[0];
  EXPECT_NEAR(v.widest_radius, inner, map.space.grid.voxel);
  ASSERT_EQ(v.entrances.size(), 2u);
  for (const Entrance& e : v.entrances) {
    EXPECT_NEAR(e.radius, inner, 2 * map.space.grid.voxel);
    EXPECT_NEAR(std::abs(e.position.x), 1.5, 0.15) << "where the rolling ball dips into the mouth";
    EXPECT_GT(-e.inward.x * e.position.x, 0.95 * std::abs(e.position.x)) << "points into the pipe";
    EXPECT_NEAR(e.area, kPi * 0.2 * 0.2, 0.15 * kPi * 0.2 * 0.2) << "for the robot's centre";
  }
  // The middle of the pipe is the farthest from both mouths.
  EXPECT_NEAR(v.deepest.x, 0, 0.1);
  EXPECT_NEAR(v.path_length, 1.5 - 0.08, 0.12);
  EXPECT_NEAR(v.bottleneck_radius, inner, 2 * map.space.grid.voxel);
}

TEST(VoidMap, ARobotLargerThanTheBoreFindsNothing) {
  const VoidMap map = map_of(pipe_scene(0.4, 0.5), 0.04, {0.2, 0.45});
  EXPECT_EQ(map.robots[0].voids.size(), 1u);
  EXPECT_EQ(map.robots[1].voids.size(), 0u);
  EXPECT_EQ(map.robots[1].volume, 0);
}

// A room of 2 x 2 x 1 m with walls of 0.2 m and a door of the given width and height in the wall at
// x = 2, or none.
VoidScene room_with_door(double width, double height) {
  VoidScene scene;
  const double t = 0.2;
  scene.add(testing::make_box({-t, -t, 0}, {0, 2 + t, 1 + t}));
  scene.add(testing::make_box({-t, -t, 0}, {2 + t, 0, 1 + t}));
  scene.add(testing::make_box({-t, 2, 0}, {2 + t, 2 + t, 1 + t}));
  scene.add(testing::make_box({-t, -t, 1}, {2 + t, 2 + t, 1 + t}));
  scene.add(testing::make_box({2, -t, 0}, {2 + t, 1 - width / 2, 1 + t}));
  if (width > 0) {
    scene.add(testing::make_box({2, 1 + width / 2, 0}, {2 + t, 2 + t, 1 + t}));
    scene.add(testing::make_box({2, 0, height}, {2 + t, 2, 1 + t}));
  } else {
    scene.add(testing::make_box({2, 0, 0}, {2 + t, 2, 1 + t}));
  }
  return scene;
}

TEST(VoidMap, ARoomIsReachedThroughItsDoorByRobotsThatFit) {
  const VoidMap map = map_of(room_with_door(0.6, 0.6), 0.03, {0.1, 0.2, 0.4});
  for (const std::size_t i : {0u, 1u}) {
    ASSERT_GE(map.robots[i].voids.size(), 1u);
    const Void& v = map.robots[i].voids[0];
    ASSERT_EQ(v.entrances.size(), 1u) << "robot " << i;
    EXPECT_NEAR(v.entrances[0].position.x, 2.1, 0.15);
    EXPECT_NEAR(v.entrances[0].position.y, 1, 0.05);
    EXPECT_LT(v.entrances[0].inward.x, -0.9);
    EXPECT_NEAR(v.bottleneck_radius, 0.3, map.space.grid.voxel);
    EXPECT_NEAR(v.bottleneck.x, 2.1, 0.12);
  }
  // A robot of 0.4 m has room inside, yet no way in.
  ASSERT_EQ(map.robots[2].voids.size(), 1u);
  const Void& sealed = map.robots[2].voids[0];
  EXPECT_TRUE(sealed.entrances.empty());
  EXPECT_EQ(map.robots[2].reachable_volume, 0);
  EXPECT_NEAR(sealed.bottleneck_radius, 0.3, map.space.grid.voxel);
  EXPECT_NEAR(sealed.widest_radius, 0.5, map.space.grid.voxel);
}

// What a ball of radius r can cover in a box: all but the rounding of its edges and corners.
double opened_box(const Vec3& size, double r) {
  const double a = size.x - 2 * r, b = size.y - 2 * r, c = size.z - 2 * r;
  return a * b * c + 2 * r * (a * b + b * c + c * a) + kPi * r * r * (a + b + c) +
         4.0 / 3 * kPi * r * r * r;
}

TEST(VoidMap, TheVolumeOfASealedRoomIsWhatTheRobotCovers) {
  for (const double voxel : {0.03, 0.04}) {
    const VoidMap map = map_of(room_with_door(0, 0), voxel, {0.15});
    ASSERT_EQ(map.robots[0].voids.size(), 1u);
    const double expected = opened_box({2, 2, 1}, 0.15);
    EXPECT_NEAR(map.robots[0].voids[0].volume, expected, 0.02 * expected) << voxel;
    EXPECT_NEAR(map.void_volume, 4, 0.02 * 4) << voxel;
    EXPECT_EQ(map.robots[0].voids[0].bottleneck_radius, 0);
  }
}

TEST(VoidMap, TwoRoomsAndTheDoorBetweenThemAreTwoChambersAndAThroat) {
  VoidScene scene;
  const double t = 0.2;
  testing::add_room(scene, {0, 0, 0}, {3.2, 1.6, 0.8}, t);
  scene.add(testing::make_box({1.5, 0, 0}, {1.7, 0.6, 0.8}));
  scene.add(testing::make_box({1.5, 1.0, 0}, {1.7, 1.6, 0.8}));
  const VoidMap map = map_of(scene, 0.02, {0.1});
  ASSERT_EQ(map.graph.chambers.size(), 2u);
  for (const Chamber& c : map.graph.chambers) EXPECT_NEAR(c.radius, 0.4, 0.02);
  ASSERT_EQ(map.graph.throats.size(), 1u);
  EXPECT_NEAR(map.graph.throats[0].radius, 0.2, 0.02);
  EXPECT_NEAR(map.graph.throats[0].position.x, 1.6, 0.12);
  EXPECT_NEAR(map.graph.throats[0].position.y, 0.8, 0.03);
}

TEST(VoidMap, DepthIsWhatLiesAbove) {
  const VoidMap map = map_of(room_with_door(0.6, 0.6), 0.03, {0.2});
  // The robot's centre may be as low as 0.2 m; the roof's top is at 1.2 m.
  EXPECT_NEAR(map.robots[0].voids[0].depth, 1.0, 0.03);
}

TEST(VoidMap, ResultsAreStableUnderTheVoxel) {
  const VoidScene scene = room_with_door(0.6, 0.6);
  const VoidMap fine = map_of(scene, 0.03, {0.2}), coarse = map_of(scene, 0.045, {0.2});
  EXPECT_NEAR(fine.robots[0].voids[0].volume, coarse.robots[0].voids[0].volume,
              0.03 * fine.robots[0].voids[0].volume);
  EXPECT_NEAR(fine.robots[0].voids[0].bottleneck_radius,
              coarse.robots[0].voids[0].bottleneck_radius, 0.045);
  EXPECT_EQ(fine.robots[0].voids[0].entrances.size(), coarse.robots[0].voids[0].entrances.size());
}

TEST(VoidMap, IsTheSameWithLittleOfTheOutside) {
  VoidSpaceOptions options;
  options.voxel = 0.04;
  options.rolling_radius = 0.8;
  const VoidScene scene = pipe_scene(0.4, 0.5);
  const VoidSpace whole = calc_void_space(scene.pile, scene.pointers(), options);
  const VoidSpace part = crop_to_pile(whole, 0);
  EXPECT_LT(part.grid.count(), whole.grid.count() / 4);
  for (std::size_t i = 0; i < part.kind.size(); i += 7) {
    const std::size_t k = whole.grid.index(whole.grid.find_cell(part.grid.centre(i)));
    ASSERT_EQ(part.kind[i], whole.kind[k]);
    ASSERT_EQ(part.clearance[i], whole.clearance[k]);
  }
  options.margin = 0.2;
  const VoidSpace small = calc_void_space(scene.pile, scene.pointers(), options);
  EXPECT_EQ(crop_to_pile(small, 0.1).clearance[0], 0) << "not kept";
  const VoidMap a = find_voids(whole, {0.2});
  for (const VoidSpace& other : {part, small}) {
    const VoidMap b = find_voids(other, {0.2});
    EXPECT_EQ(a.void_volume, b.void_volume);
    EXPECT_EQ(a.robots[0].volume, b.robots[0].volume);
    ASSERT_EQ(a.robots[0].voids.size(), b.robots[0].voids.size());
    const Void &v = a.robots[0].voids[0], &w = b.robots[0].voids[0];
    EXPECT_EQ(v.path_length, w.path_length);
    EXPECT_EQ(v.depth, w.depth);
    EXPECT_EQ(v.bottleneck_radius, w.bottleneck_radius);
    ASSERT_EQ(v.entrances.size(), w.entrances.size());
    for (std::size_t i = 0; i < v.entrances.size(); ++i) {
      EXPECT_EQ(v.entrances[i].radius, w.entrances[i].radius);
      EXPECT_NEAR(v.entrances[i].area, w.entrances[i].area, 1e-12);
    }
    EXPECT_EQ(a.graph.throats.size(), b.graph.throats.size());
  }
}

TEST(VoidMap, RefusesARobotSmallerThanAVoxel) {
  try {
    map_of(room_with_door(0, 0), 0.05, {0.04});
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("radius[1]"), std::string::npos) << e.what();
  }
}

}  // namespace void_map_test
}  // namespace rubble
