// The global planner of the navigation benchmark: OMPL behind our interface, and the way that a robot keeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/navigate/route.h"
#include "io/ompl/plane_planner.h"
#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"

namespace rubble::testing {
namespace route_test {

constexpr double kCell = 0.05;

// 8 m x 8 m about the origin. solid: whether a place is.
template <typename Solid>
PlaneClearance make_plane(const Solid& solid) {
  PlaneClearance map;
  map.grid.corner = {-4, -4, 0}, map.grid.voxel = kCell, map.grid.size = {160, 160, 1};
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < map.grid.count(); ++i)
    if (solid(map.grid.centre(i))) points.push_back(map.grid.centre(i));
  map.clearance.assign(map.grid.count(), 1e6f);
  for (std::size_t i = 0; i < map.grid.count(); ++i)
    for (const Vec3& p : points) map.clearance[i] = std::min(map.clearance[i], float(distance(p, map.grid.centre(i))));
  return map;
}

double length_of(const std::vector<Vec3>& way) {
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += distance(way[i - 1], way[i]);
  return length;
}

PlanePlannerOptions options_with(double radius, std::uint64_t seed = 1) {
  PlanePlannerOptions options;
  options.radius = radius, options.seed = seed;
  return options;
}

TEST(PlanePlanner, GoesStraightInTheOpen) {
  const PlaneClearance map = make_plane([](const Vec3&) { return false; });
  const std::vector<Vec3> way = plan_in_plane(map, {-3, -1, 0.2}, {3, 2, 0}, options_with(0.4));
  ASSERT_EQ(way.size(), 2u);
  EXPECT_EQ(distance(way[0], {-3, -1, 0}), 0);
  EXPECT_EQ(distance(way[1], {3, 2, 0}), 0);
}

// A wall along x = 0 that ends at the origin. The shortest way of a disc round its end: a tangent, an arc, a tangent.
TEST(PlanePlanner, GoesRoundTheEndOfAWall) {
  const PlaneClearance map = make_plane([](const Vec3& p) { return std::fabs(p.x) < 0.03 && p.y < 0; });
  const double radius = 0.4, d = std::sqrt(5.0);  // of the ends from the origin
  const double turned = portable::kPi + 2 * std::atan2(1, 2) - 2 * std::acos(radius / d);
  const double shortest = 2 * std::sqrt(d * d - radius * radius) + radius * turned;
  const std::vector<Vec3> way = plan_in_plane(map, {-2, -1, 0}, {2, -1, 0}, options_with(radius));
  ASSERT_GT(way.size(), 2u);
  EXPECT_NEAR(length_of(way), shortest, 0.04 * shortest);
  for (std::size_t i = 1; i < way.size(); ++i) EXPECT_TRUE(is_leg_free(map, way[i - 1], way[i], radius - 0.03));
}

// A wall with a gap of 1 m: a disc of 0.4 m passes, one of 0.55 m does not.
TEST(PlanePlanner, PassesAGapThatIsWideEnough) {
  const PlaneClearance map = make_plane([](const Vec3& p) { return std::fabs(p.x) < 0.03 && std::fabs(p.y - 1.5) > 0.5; });
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::vector<Vec3> way = plan_in_plane(map, {-2, -1, 0}, {2, -1, 0}, options_with(0.4, seed));
    ASSERT_FALSE(way.empty()) << seed;
    EXPECT_LT(length_of(way), 1.1 * 2 * std::hypot(2, 2.2)) << seed;
    EXPECT_TRUE(plan_in_plane(map, {-2, -1, 0}, {2, -1, 0}, options_with(0.55, seed)).empty()) << seed;
  }
}

TEST(PlanePlanner, GivesTheSameWayWhateverCameBefore) {
  const PlaneClearance map = make_plane([](const Vec3& p) { return distance(p, {0.1, 0.3, p.z}) < 0.7; });
  const auto plan = [&](std::uint64_t seed) {
    std::vector<double> numbers;
    for (const Vec3& p : plan_in_plane(map, {-2, 0, 0}, {2, 0, 0}, options_with(0.4, seed)))
      numbers.insert(numbers.end(), {p.x, p.y});
    return numbers;
  };
  const std::vector<double> first = plan(1), other = plan(2);
  EXPECT_GT(first.size(), 4u);
  EXPECT_NE(first, other);
  EXPECT_EQ(plan(1), first);
}

TEST(PlanePlanner, LeavesAPlaceThatIsTooNearToSomethingButNotFromWithinIt) {
  const PlaneClearance map = make_plane([](const Vec3& p) { return p.x < -2; });
  EXPECT_FALSE(plan_in_plane(map, {-1.9, 0, 0}, {2, 0, 0}, options_with(0.4)).empty());
  EXPECT_TRUE(plan_in_plane(map, {-2.5, 0, 0}, {2, 0, 0}, options_with(0.4)).empty());
  EXPECT_TRUE(plan_in_plane(map, {0, 0, 0}, {9, 0, 0}, options_with(0.4)).empty()) << "it is not on the map";
  PlanePlannerOptions options = options_with(-1);
  EXPECT_THROW(plan_in_plane(map, {0, 0, 0}, {2, 0, 0}, options), InputError);
  options = options_with(0.4), options.samples = 0;
  EXPECT_THROW(plan_in_plane(map, {0, 0, 0}, {2, 0, 0}, options), InputError);
}

// 8 m x 8 m x 1 m, of which a robot has seen what it is told.
class Routes : public ::testing::Test {
 protected:
  static Aabb bounds() {
    Aabb box;
    box.include({-4, -4, 0}), box.include({4, 4, 1});
    return box;
  }
  void see_wall(double x, double y0, double y1) {
    for (double y = y0; y < y1; y += 0.5 * kCell)
      for (int hit = 0; hit < rules_.hits; ++hit) map_.add({x, y, 0.3});
  }
  Vec3 target(double time, const Vec3& base = {-3, 0, 0}) { return route_.find_target(map_, base, goal_, time); }

  NavigationRules rules_;
  ObstacleMap map_{bounds(), kCell, rules_.hits};
  Route route_{rules_, 1};
  Vec3 goal_{3, 0, 0};
};

TEST_F(Routes, AWayIsKeptUntilSomethingIsSeenInIt) {
  EXPECT_NEAR(distance(target(0), {-1, 0, 0}), 0, 0.1) << "as far ahead as it looks";
  EXPECT_NEAR(distance(target(0.2, {-2.8, 0, 0}), {-0.8, 0, 0}), 0, 0.1);
  see_wall(1, 2, 3);
  target(0.4, {-2.6, 0, 0});
  EXPECT_EQ(route_.plans(), 1) << "the wall is beside the way";
  see_wall(0, -1, 1);
  Vec3 base{-2.4, 0, 0};
  double farthest = 0;
  for (int k = 0; k < 10 && distance(base, goal_) > 0; ++k) {
    base = target(0.6 + 0.2 * k, base);
    farthest = std::max(farthest, std::fabs(base.y));
  }
  EXPECT_EQ(distance(base, goal_), 0) << "the goal itself comes last";
  EXPECT_GT(farthest, 1 + rules_.plan_radius - 0.1) << "it drives at the wall";
  EXPECT_EQ(route_.plans(), 2);
}

TEST_F(Routes, WhereThereIsNoWayTheGoalIsDrivenToAndItIsPlannedAgainASecondLater) {
  see_wall(0, -4, 4);
  EXPECT_EQ(distance(target(0), goal_), 0);
  EXPECT_EQ(route_.failed(), 1);
  target(0.4);
  EXPECT_EQ(route_.plans(), 1);
  target(1.2);
  EXPECT_EQ(route_.plans(), 2);
}

// Two gaps: the way leads through the nearer one, and through the other when the robot got stuck there.
TEST_F(Routes, WhereItIsStuckAnotherWayIsPlanned) {
  see_wall(0, -4, -2.5), see_wall(0, -1.5, 0.5), see_wall(0, 1.5, 4);
  goal_ = {3, 1, 0};
  const Vec3 base{-0.6, 1, 0};
  EXPECT_NEAR(target(0, base).y, 1, 0.3);
  route_.avoid_narrowest_ahead(map_, base);
  EXPECT_LT(target(0.2, base).y, 0.5);
  EXPECT_EQ(route_.plans(), 2);
  EXPECT_EQ(route_.failed(), 0);
}

}  // namespace route_test
}  // namespace rubble::testing
