// Paths that an inertial unit can fly: what it measures leads to where the poses are, on every bundled
// path; and how smooth they are, how far from the asked path, and within which limits.
#include "scripting/trajectory/smooth_path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/portable_math.h"
#include "tests/scripting/bundled_missions.h"
#include "tests/scripting/dead_reckoning.h"
#include "tests/scripting/test_support.h"

namespace rubble {
namespace smooth_path_test {

constexpr double kGoal = 0.01;  // after 10 s; unit: m
const std::string kScripts = RUBBLE_SOURCE_DIR "/scripts";

Scenario with_imu(Scenario scenario) {
  scenario.imus = {ImuScenario{}};
  return scenario;
}

void expect_reckoned(const Scenario& scenario, const std::string& name) {
  const DeadReckoning found = reckon(CameraPath(flown_trajectory(with_imu(scenario))));
  EXPECT_LT(found.worst, kGoal) << name << " at " << found.at << " s of " << found.seconds;
}

TEST(SmoothPath, EveryBundledScriptsUnitLeadsToItsPoses) {
  int flown = 0;
  for (const std::string& name : testing::find_bundled_missions(kScripts)) {
    const Scenario scenario = load_mission(kScripts + "/" + name).scenario;
    if (scenario.trajectory.needs_pile()) continue;  // tests/app/flight_test.cpp has those
    expect_reckoned(scenario, name);
    ++flown;
  }
  EXPECT_GE(flown, 34);
}

// Each path of the library, long and quick enough for 10 s to show.
TEST(SmoothPath, EveryPathOfTheLibraryLeadsToItsPoses) {
  for (const char* path :
       {"rubble.trajectory.orbit { radius_m = 3, speed = 1.5, max_speed = 2 }",
        "rubble.trajectory.spiral { radii = { 6, 1 }, heights = { 4, 1 }, speed = 1.5 }",
        "rubble.trajectory.push { from = { -6, 0, 0.5 }, to = { 0, 1, 0.2 }, roll_deg = 90 }",
        "rubble.trajectory.grow { from = { -3, 0, 0.5 }, towards = { { 0, 0, 0.5 }, { 1, 2, 1.5 } }, speed = 0.5 }",
        "rubble.trajectory.along(function(t) return { t, math.sin(2 * t), 1 + 0.3 * math.cos(5 * t) }, { 0, 9, 0 } "
        "end, { duration = 10 })",
        // A hand's tremor, a corner, a stop and a turn in place.
        "{ interpolation = 'linear', waypoints = { { t = 0, position = { 0, 0, 1 } }, { t = 2, position = { 3, 0, 1 } }, "
        "{ t = 3, position = { 3, 0, 1 }, rpy_deg = { 0, 20, 150 } }, { t = 5, position = { 3, 4, 2 }, rpy_deg = { 30, 0, 90 } }, "
        "{ t = 10, position = { -2, 4, 2 }, look_at = { 0, 0, 0 } } } }",
        "{ interpolation = 'linear', max_speed = 0.8, max_acceleration = 1, max_turn_rate_deg = 50, rest_at_ends = true, "
        "waypoints = { { t = 0, position = { 0, 0, 1 } }, { t = 1, position = { 3, 0, 1 }, rpy_deg = { 0, 0, 90 } }, "
        "{ t = 3, position = { 3, 4, 1 } } } }"})
    expect_reckoned(load_text(std::string("return { trajectory = ") + path + " }").scenario, path);
}

// The control: without smoothing the accelerometer does not feel a corner.
TEST(SmoothPath, WithoutSmoothingACornerIsLost) {
  const Scenario s =
      load_text("return { trajectory = { interpolation = 'linear', waypoints = { { t = 0, position = { 0, 0, 1 } }, "
                "{ t = 2, position = { 2, 0, 1 } }, { t = 7, position = { 2, 5, 1 } } } } }").scenario;
  EXPECT_GT(reckon(CameraPath(s.trajectory)).worst, 4);
  expect_reckoned(s, "smoothed");
}

Pose corner(double t) {  // 1 m/s, to the left after 2 s
  return {Quat{1, 0, 0, 0}, t < 2 ? Vec3{t, 0, 1} : Vec3{2, t - 2, 1}};
}

TEST(SmoothPath, ACornerIsRoundedAsMuchAsIsSaid) {
  const double knot = 0.1, jump = std::sqrt(2.0);
  const SmoothPath path(corner, 4, knot, PathEnds::moving);
  EXPECT_NEAR(distance(path.at(2).translation, {2, 0, 1}), 28.0 / 120 * jump * knot, 1e-9);
  EXPECT_NEAR(norm(path.motion_at(2).acceleration), 2.0 / 3 * jump / knot, 1e-9);
  EXPECT_NEAR(norm(path.motion_at(1).acceleration), 0, 1e-9);
  EXPECT_NEAR(distance(path.motion_at(1).velocity, {1, 0, 0}), 0, 1e-12);
  EXPECT_NEAR(path.largest_jerk() * knot * knot / jump, 2.0 / 3, 0.01);
  for (double t = 0; t <= 4; t += 0.013) {
    EXPECT_LE(norm(path.motion_at(t).velocity), 1 + 1e-12);
    EXPECT_LE(norm(path.motion_at(t).acceleration), 2.0 / 3 * jump / knot + 1e-9);
  }
}

TEST(SmoothPath, EndsAreTheAskedOnesMovingOrAtRest) {
  const SmoothPath moving(corner, 4, 0.1, PathEnds::moving);
  EXPECT_EQ(moving.duration(), 4);
  EXPECT_NEAR(distance(moving.at(0).translation, {0, 0, 1}), 0, 1e-12);
  EXPECT_NEAR(distance(moving.motion_at(4).velocity, {0, 1, 0}), 0, 1e-9);
  const SmoothPath rest(corner, 4, 0.1, PathEnds::at_rest);
  EXPECT_NEAR(rest.duration(), 4.4, 1e-12);
  for (const double t : {0.0, rest.duration()}) {
    EXPECT_NEAR(norm(rest.motion_at(t).velocity), 0, 1e-9);
    EXPECT_NEAR(norm(rest.motion_at(t).acceleration), 0, 1e-9);
  }
  EXPECT_NEAR(distance(rest.at(4.4).translation, {2, 2, 1}), 0, 1e-9);
}

// Derivatives of place and view, and that they do not jump.
TEST(SmoothPath, DerivativesAreThoseOfThePoses) {
  const SmoothPath path(
      [](double t) {
        const double yaw = std::fabs(t - 1), roll = t < 2 ? 0 : t - 2;  // two corners in view
        return Pose{portable::quat_from_rpy(roll, 0.2 * t, yaw), {t, std::fabs(t - 1.5), 0}};
      },
      4, 0.1, PathEnds::moving);
  const double h = 1e-4;
  for (double t = 0.01; t < 3.99; t += 0.0371) {
    const Pose a = path.at(t - h), b = path.at(t + h);
    const CameraMotion m = path.motion_at(t);
    EXPECT_LT(distance((b.translation - a.translation) * (0.5 / h), m.velocity), 1e-5);
    const Quat d = a.rotation.conjugate() * b.rotation;
    EXPECT_LT(distance(Vec3{d.x, d.y, d.z} * (1 / h), m.angular_velocity), 1e-5);
    const CameraMotion before = path.motion_at(t - h), after = path.motion_at(t + h);
    EXPECT_LT(distance((after.velocity - before.velocity) * (0.5 / h), m.acceleration), 1e-4);
    EXPECT_LT(norm(after.acceleration - before.acceleration), 2 * h * path.largest_jerk() * 1.02 + 1e-9);
    EXPECT_LT(norm(after.angular_velocity - before.angular_velocity), 2 * h * 200);
  }
}

TEST(SmoothPath, ATurnAtConstantRateStays) {
  const SmoothPath path(
      [](double t) { return Pose{portable::quat_from_rpy(0, 0, 0.7 * t), {}}; }, 3, 0.1,
      PathEnds::moving);
  for (double t = 0; t < 3; t += 0.17)
    EXPECT_LT(distance(path.motion_at(t).angular_velocity, {0, 0, 0.7}), 1e-6) << t;
}

struct Extremes {
  double speed = 0, acceleration = 0, jerk = 0;
};

Extremes measure(const CameraPath& path) {
  Extremes e;
  const double h = 1e-4;
  for (double t = h; t < path.duration() - h; t += 0.003) {
    const CameraMotion m = path.motion_at(t);
    e.speed = std::max(e.speed, norm(m.velocity));
    e.acceleration = std::max(e.acceleration, norm(m.acceleration));
    e.jerk = std::max(e.jerk, norm(path.motion_at(t + h).acceleration - path.motion_at(t - h).acceleration) / (2 * h));
  }
  return e;
}

TEST(SmoothPath, KeepsAllLimitsTogether) {
  TrajectorySpec spec = load_text("return { trajectory = { interpolation = 'linear', rest_at_ends = true, waypoints = { "
                                  "{ t = 0, position = {0, 0, 1} }, { t = 1, position = {4, 0, 1} }, "
                                  "{ t = 2, position = {4.5, 1, 1} }, { t = 3, position = {0, 1.5, 1.5} } } } }")
                            .scenario.trajectory;
  spec.limits.max_speed = 1.5, spec.limits.max_acceleration = 2;
  const Extremes without = measure(CameraPath(spec));
  for (const double most : {10.0, 3.0, 1.0}) {
    spec.limits.max_jerk = most;
    const Extremes e = measure(CameraPath(spec));
    EXPECT_LT(most, without.jerk);
    EXPECT_LE(e.jerk, most * 1.01);
    EXPECT_LE(e.acceleration, 2 * 1.1);
    EXPECT_LE(e.speed, 1.5 * 1.001);
  }
}

TEST(SmoothPath, AViewThatFlipsRefusesTheUnit) {
  // Straight over what is looked at: the yaw turns by 180 degrees at once.
  const std::string path = "trajectory = { interpolation = 'linear', waypoints = { { t = 0, position = { -2, 0, 3 }, look_at = { 0, 0, 0 } }, "
                           "{ t = 4, position = { 2, 0, 3 }, look_at = { 0, 0, 0 } } } }";
  EXPECT_NO_THROW(load_text("return { " + path + " }"));
  const std::string error = error_of([&] { load_text("return { imu = { on = true }, " + path + " }"); });
  EXPECT_NE(error.find("the view turns too fast to be made smooth"), std::string::npos) << error;
  EXPECT_NE(error.find("180 degrees at 2"), std::string::npos) << error;
}

TEST(SmoothPath, WaypointTimesAreWhenTheyArePassed) {
  TrajectorySpec spec = load_text("return { trajectory = { rest_at_ends = true, smoothing = 0.05, max_speed = 1, duration = 5, waypoints = { "
                                  "{ t = 0, position = {0, 0, 1} }, { t = 1, position = {4, 0, 1} }, { t = 2, position = {4, 3, 1} } } } }")
                            .scenario.trajectory;
  const CameraPath path(spec);
  const std::vector<double> times = path.waypoint_times();
  ASSERT_EQ(times.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_LT(distance(path.at(times[i]).translation, spec.waypoints[i].position), 0.02) << i;
  EXPECT_LT(times[2], path.duration());
}

TEST(TrajectoryErrors, TimesTooCloseToBeTold) {
  const auto error = [](const std::string& keys) {
    return error_of([&] { load_text("return { trajectory = { " + keys + " } }"); });
  };
  EXPECT_NE(error("waypoints = { { t = 0, position = { 0, 0, 1 } }, { t = 5e-324, position = { 1, 0, 1 } } }")
                .find("too soon after the waypoint before: expected at least a microsecond"),
            std::string::npos);
  EXPECT_NE(error("duration = 5e-324, waypoints = { { position = { 0, 0, 1 } }, { position = { 1, 0, 1 } } }")
                .find("trajectory.duration: too short"),
            std::string::npos);
  EXPECT_NE(error("waypoints = { { position = { 0, 0, 1 } }, { speed = 5e-324, position = { 1, 0, 1 } } }")
                .find("never reached"),
            std::string::npos);
}

}  // namespace smooth_path_test
}  // namespace rubble
