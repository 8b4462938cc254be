// Ways through free space, their clearance checked by exact queries.
#include "kernel/voids/void_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "kernel/queries/queries.h"
#include "void_scenes.h"

namespace rubble {
namespace void_path_test {

using testing::VoidScene;

// A wall across X at 0 with a window of 0.6 x 0.6 m whose middle is at y = 1, z = 1.
VoidScene wall_with_window() {
  VoidScene scene;
  scene.add(testing::make_box({-0.1, -3, 0}, {0.1, 0.7, 2.6}));
  scene.add(testing::make_box({-0.1, 1.3, 0}, {0.1, 3, 2.6}));
  scene.add(testing::make_box({-0.1, -3, 0}, {0.1, 3, 0.7}));
  scene.add(testing::make_box({-0.1, -3, 1.3}, {0.1, 3, 2.6}));
  return scene;
}

VoidSpace space_of(const VoidScene& scene, double voxel) {
  VoidSpaceOptions options;
  options.voxel = voxel;
  return calc_void_space(scene.pile, scene.pointers(), options);
}

double smallest_clearance(const PileQueries& exact, const std::vector<Vec3>& points) {
  double smallest = 1e9;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    for (int s = 0; s <= 200; ++s) {
      smallest = std::min(smallest,
                          exact.clearance(points[k] + (points[k + 1] - points[k]) * (s / 200.0)));
    }
  }
  return smallest;
}

TEST(VoidPath, GoesThroughTheWindowAndKeepsItsDistance) {
  const VoidScene scene = wall_with_window();
  const VoidSpace space = space_of(scene, 0.04);
  const PileQueries exact(scene.pile, scene.pointers());
  const FoundPath path = find_path(space, {-0.8, 0, 1}, {0.8, 0, 1}, 0.2);
  ASSERT_TRUE(path.found);
  EXPECT_GE(smallest_clearance(exact, path.points), 0.2 - 1e-6);
  EXPECT_GE(path.length, 1.6);
  // Around the window's corner: by way of y = 0.9 at the wall, as the crow flies.
  EXPECT_LT(path.length, 2 * std::hypot(0.8, 1.0) + 0.1);
  EXPECT_LT(path.points.size(), 20u) << "pulled tight";
}

TEST(VoidPath, GoesOverTheWallWhenTheWindowIsTooNarrow) {
  const VoidScene scene = wall_with_window();
  const FoundPath path = find_path(space_of(scene, 0.04), {-0.8, 0, 1}, {0.8, 0, 1}, 0.35);
  ASSERT_TRUE(path.found);
  double highest = 0;
  for (const Vec3& p : path.points) highest = std::max(highest, p.z);
  const bool around = path.length > 4;
  EXPECT_TRUE(highest > 2.9 || around);
}

TEST(VoidPath, SaysHowWideTheNarrowestGapIs) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {2, 2, 1.4}, 0.2);
  // A pipe of 0.5 m bore stuck through the wall would be a way; here a slit of 0.3 m does it.
  scene.meshes[0] = testing::make_box({-0.2, -0.2, 0}, {0, 0.9, 1.6});
  scene.add(testing::make_box({-0.2, 1.2, 0}, {0, 2.2, 1.6}));
  const FoundPath path = find_path(space_of(scene, 0.03), {-0.8, 1, 0.7}, {1, 1, 0.7}, 0.3);
  EXPECT_FALSE(path.found);
  EXPECT_NEAR(path.narrowest_radius, 0.15, 0.03);
  EXPECT_NEAR(path.narrowest.x, -0.1, 0.15);
  EXPECT_NEAR(path.narrowest.y, 1.05, 0.03);
}

TEST(VoidPath, FindsNoWayIntoASealedRoom) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {1, 1, 1}, 0.1);
  const FoundPath path = find_path(space_of(scene, 0.05), {-0.6, 0.5, 0.5}, {0.5, 0.5, 0.5}, 0.1);
  EXPECT_FALSE(path.found);
  EXPECT_EQ(path.narrowest_radius, 0);
}

TEST(VoidPath, RefusesPointsOutsideOfTheGrid) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {1, 1, 1}, 0.1);
  EXPECT_THROW(find_path(space_of(scene, 0.05), {-60, 0, 0}, {0.5, 0.5, 0.5}, 0.1),
               std::invalid_argument);
}

TEST(VoidPath, FindsTheNearestPlaceWithRoom) {
  VoidScene scene;
  testing::add_room(scene, {0, 0, 0}, {1, 1, 1}, 0.1);
  const VoidSpace space = space_of(scene, 0.05);
  const NearestPlace place = find_nearest_place(space, {0.02, 0.5, 0.5}, 0.2, 0.5);
  ASSERT_TRUE(place.found);
  EXPECT_NEAR(place.position.x, 0.2, 0.05);
  EXPECT_FALSE(find_nearest_place(space, {0.5, 0.5, 0.5}, 0.8, 0.3).found);
}

}  // namespace void_path_test
}  // namespace rubble
