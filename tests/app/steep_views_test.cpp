// Views of planned ways through shafts: they turn evenly, and no faster than the mission allows.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/planning/steep_views.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace steep_views_test {

constexpr double kLimit = 90;  // unit: degree/s

TrajectorySpec through(const std::vector<Vec3>& positions, double ahead = 0.5) {
  TrajectorySpec spec;
  spec.waypoints.clear();
  spec.interpolation = Interpolation::linear;
  spec.limits.max_turn_rate_deg = kLimit;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Waypoint w;
    w.position = positions[i];
    const std::size_t from = i + 1 < positions.size() ? i : i - 1;
    w.look_at = positions[i] + normalized(positions[from + 1] - positions[from]) * ahead;
    spec.waypoints.push_back(w);
  }
  return spec;
}

std::vector<bool> all_ahead(const TrajectorySpec& spec) { return std::vector<bool>(spec.waypoints.size(), true); }

double fastest_turn(const TrajectorySpec& spec) {
  const CameraPath path(spec);
  constexpr double h = 1e-3;
  double fastest = 0;
  for (double t = 0; t + h <= path.duration(); t += h) {
    const Quat d = path.at(t).rotation.conjugate() * path.at(t + h).rotation;
    const double angle = 2 * std::atan2(norm(Vec3{d.x, d.y, d.z}), std::abs(d.w));
    fastest = std::max(fastest, angle * 180 / portable::kPi / h);
  }
  return fastest;
}

// Along +X, down a shaft, and back along -X below; the shaft leans by a hair, so that its yaw is that of rounding.
std::vector<Vec3> shaft() {
  return {{-2, 0, 3}, {0, 0, 3}, {0, 0, 2.5}, {-1e-9, 1e-9, 2}, {1e-9, -1e-9, 1.5}, {0, 0, 1}, {-2, 0, 1}};
}

TEST(SteepViews, AShaftTurnsTheCameraNoFasterThanTheLimit) {
  TrajectorySpec spec = through(shaft());
  EXPECT_GT(fastest_turn(spec), 10 * kLimit);  // by its look_ats alone
  turn_steep_views(all_ahead(spec), spec.waypoints);
  EXPECT_LT(fastest_turn(spec), 1.02 * kLimit);
}

TEST(SteepViews, TheYawGoesEvenlyFromBeforeTheShaftToAfterIt) {
  TrajectorySpec spec = through(shaft());
  turn_steep_views(all_ahead(spec), spec.waypoints);
  for (std::size_t i = 1; i <= 4; ++i) {
    ASSERT_FALSE(spec.waypoints[i].look_at) << i;
    EXPECT_NEAR(spec.waypoints[i].rpy_deg.y, 90, 0.01) << i;
  }
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR(std::abs(spec.waypoints[i + 1].rpy_deg.z - spec.waypoints[i].rpy_deg.z), 180 * 0.5 / 4, 1e-6) << i;
}

// Half a turn within 2 s, without a limit: looking at a point that moves from ahead to behind, the camera turns at once in between.
TEST(SteepViews, ATurnBackIsEven) {
  TrajectorySpec spec = through({{0, 0, 1}, {1, 0, 1}, {0.5, 0.001, 1.001}});
  spec.limits = {};
  EXPECT_GT(fastest_turn(spec), 1000);
  turn_steep_views(all_ahead(spec), spec.waypoints);
  EXPECT_LT(fastest_turn(spec), 91);
}

TEST(SteepViews, LevelWaysAndViewsThatWereAskedForStayAsTheyAre) {
  const TrajectorySpec bend = through({{0, 0, 1}, {1, 0, 1}, {2, 0.5, 1.2}, {2.5, 1, 1.2}});
  TrajectorySpec same = bend;
  turn_steep_views(all_ahead(same), same.waypoints);
  for (std::size_t i = 0; i < bend.waypoints.size(); ++i) EXPECT_EQ(same.waypoints[i].look_at, bend.waypoints[i].look_at) << i;
  TrajectorySpec asked = through(shaft());
  turn_steep_views(std::vector<bool>(asked.waypoints.size(), false), asked.waypoints);
  for (const Waypoint& w : asked.waypoints) EXPECT_TRUE(w.look_at);
}

TEST(SteepViews, AWayThatIsAShaftFromEndToEndHasOneYaw) {
  TrajectorySpec spec = through({{0, 0, 3}, {0, 0, 2}, {0, 1e-12, 1}});
  turn_steep_views(all_ahead(spec), spec.waypoints);
  EXPECT_LT(fastest_turn(spec), 0.01);
}

}  // namespace steep_views_test
}  // namespace rubble
