// Odometry of belts and wheels against the truth.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/robot/odometry.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_odometry_test {

struct Ride {
  OdometryReading last;
  double mean_slip = 0, turned = 0;  // unit: 1, rad
  Vec3 way;                          // of the base; unit: m
};

struct Twist {
  double linear = 0, angular = 0;  // unit: m/s, rad/s
};

// On the level, or against a wall at x = 0.6.
Ride ride(const RobotModel& model, const Twist& twist, double seconds, bool wall = false) {
  World world = testing::make_robot_world({testing::box_type("wall", 0.2, 4, 1)});
  if (wall) {
    NewPiece piece;
    piece.placement = {0, 1, {{}, {0.7, 0, 0.5}}, true};
    world.add({piece});
  }
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  WheelOdometry odometry(model);
  Ride result;
  const Vec3 start = testing::position_of(world, robot);
  double yaw = testing::yaw_of(world, robot);
  testing::drive(world, robot, seconds, [&](double time) {
    result.last = odometry.update(world.robots().state(robot), time);
    const double now = testing::yaw_of(world, robot);
    result.turned += std::remainder(now - yaw, 2 * portable::kPi);
    yaw = now;
    return drive_sides(model, twist.linear, twist.angular);
  });
  result.mean_slip = odometry.mean_slip();
  result.way = testing::position_of(world, robot) - start;
  return result;
}

// Encoders alone: along an arc of 90 degrees, by steps of any length.
TEST(Odometry, AnArcEndsWhereItDoes) {
  const RobotModel model = make_rover();
  for (const int steps : {3, 50}) {
    WheelOdometry odometry(model);
    RobotState state;
    state.links.resize(model.links.size());
    state.joints.resize(model.joints.size());
    OdometryReading reading;
    const double radius = 2, quarter = 0.5 * portable::kPi, half = 0.5 * model.sides.distance;
    for (int i = 0; i <= steps; ++i) {
      const double angle = quarter * i / steps;
      for (int k : model.sides.left)
        state.joints[std::size_t(k)].position = angle * (radius - half) / model.sides.radius;
      for (int k : model.sides.right)
        state.joints[std::size_t(k)].position = angle * (radius + half) / model.sides.radius;
      reading = odometry.update(state, 0.1 * i);
    }
    // Each step goes along its chord's direction by the length of its arc.
    const double tolerance = radius * quarter * quarter / (12.0 * steps * steps);
    EXPECT_NEAR(reading.x, radius, tolerance);
    EXPECT_NEAR(reading.y, radius, tolerance);
    EXPECT_NEAR(reading.yaw, quarter, 1e-12);
    EXPECT_NEAR(reading.linear, radius * quarter / (0.1 * steps), 1e-9);
  }
}

TEST(Odometry, ARoverThatRollsStraightKnowsItsWay) {
  const Ride straight = ride(make_rover(), {0.5, 0}, 4);
  EXPECT_NEAR(straight.last.x, straight.way.x, 0.01 * straight.way.x);
  EXPECT_NEAR(straight.last.yaw, 0, 0.02) << "its wheels slip a little while it lands";
  EXPECT_LT(straight.mean_slip, 0.02);
}

// What skids sideways turns less than its tracks say: users report 60 %.
TEST(Odometry, OnTheSpotTracksTurnFartherThanTheRobot) {
  const Ride spot = ride(make_crawler(), {0, 0.5}, 6);
  EXPECT_NEAR(spot.last.angular, 0.5, 1e-9) << "by the belts";
  EXPECT_GT(spot.turned, 0.3);
  EXPECT_LT(spot.turned, 0.7 * 0.5 * 6);
  EXPECT_NEAR(spot.last.true_angular, spot.turned / 6, 0.05);
  EXPECT_NEAR(spot.mean_slip, 1 - spot.turned / (0.5 * 6), 0.03);
}

TEST(Odometry, AgainstAWallAllIsSlip) {
  CrawlerOptions options;
  options.flippers = false;
  options.friction = 0.3;  // too little to climb the wall
  const Ride stuck = ride(make_crawler(options), {0.3, 0}, 6, true);
  EXPECT_GT(stuck.last.x, 1.5) << "the belts went on";
  EXPECT_LT(stuck.way.x, 0.4);
  EXPECT_GT(stuck.last.slip_left(), 0.95);
  EXPECT_LT(stuck.last.slip_left(), 1.05);
}

// A straight way of 40.5 m by tracks whose reports have the published noise, in steps of a 60th of a second.
TEST(OdometryNoise, OfTracksIsAsPublished) {
  const RobotModel model = make_crawler();
  const auto end_of = [&](double noise, std::uint64_t seed, int robot) {
    WheelOdometry odometry(model, {noise, seed, robot});
    RobotState state;
    state.links.resize(model.links.size());
    state.joints.resize(model.joints.size());
    for (const auto& side : {model.sides.left, model.sides.right})
      for (int i : side) state.links[std::size_t(i)].belt_speed = 0.5;
    OdometryReading reading;
    for (int i = 0; i <= 81 * 60; ++i) reading = odometry.update(state, i / 60.0);
    return reading;
  };
  const OdometryReading exact = end_of(0, 1, 0);
  EXPECT_NEAR(exact.x, 40.5, 1e-6);
  EXPECT_EQ(exact.angular, 0);
  constexpr int kRuns = 60;
  double error = 0;
  for (int seed = 0; seed < kRuns; ++seed) {
    const OdometryReading end = end_of(0.001, std::uint64_t(seed), 0);
    error += std::hypot(end.x - 40.5, end.y) / kRuns;
    EXPECT_NE(end.angular, 0) << "no real odometry is that exact";
  }
  EXPECT_NEAR(error, 0.43, 0.11) << "unit: m";
  EXPECT_EQ(end_of(0.001, 5, 0).y, end_of(0.001, 5, 0).y);
  EXPECT_NE(end_of(0.001, 5, 0).y, end_of(0.001, 5, 1).y) << "each robot has noise of its own";
}

// Encoders with an error, over many drives along an S: how far readings scatter is what each of them says.
TEST(Odometry, ScattersAsItsCovarianceSays) {
  const RobotModel model = make_rover();
  const double noise = 0.02, half = 0.5 * model.sides.distance;
  const int drives = 4000, steps = 40;
  std::array<double, 3> mean{}, stated{};
  std::array<std::array<double, 3>, 3> square{};
  OdometryReading reading;
  for (int drive = 0; drive < drives; ++drive) {
    WheelOdometry odometry(model, {noise, 7, drive});
    RobotState state;
    state.links.resize(model.links.size());
    state.joints.resize(model.joints.size());
    for (int i = 0; i <= steps; ++i) {
      reading = odometry.update(state, 0.1 * i);
      const double turn = i < steps / 2 ? 0.04 : -0.03, way = 0.1;
      for (int k : model.sides.left) state.joints[std::size_t(k)].position += (way - turn * half) / model.sides.radius;
      for (int k : model.sides.right) state.joints[std::size_t(k)].position += (way + turn * half) / model.sides.radius;
    }
    const std::array<double, 3> at{reading.x, reading.y, reading.yaw};
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] += at[i] / drives;
      stated[i] += reading.covariance[i][i] / drives;
      for (std::size_t j = 0; j < 3; ++j) square[i][j] += at[i] * at[j] / drives;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double variance = square[i][i] - mean[i] * mean[i];
    EXPECT_NEAR(stated[i], variance, 0.1 * variance) << i;
  }
  const double along = square[1][2] - mean[1] * mean[2];
  EXPECT_NEAR(reading.covariance[1][2], along, 0.15 * along);
  EXPECT_EQ(reading.covariance[1][2], reading.covariance[2][1]);
}

// Four wheels that are steered and driven: on the spot each goes along its own circle, and sideways (crab steering) none
// has a curve. angles: by wheel; ways: by wheel, along itself; unit: rad, m. Wheels: rear left, rear right, front left,
// front right.
OdometryReading steer(const std::array<double, 4>& angles, const std::array<double, 4>& ways) {
  RobotModel model = make_rover();
  SideDrive& sides = model.sides;
  sides.axle = 0, sides.distance = 0.6;
  sides.left = {0, 2}, sides.right = {1, 3};
  const auto wheels = int(model.joints.size());
  for (int i = 0; i < 4; ++i) sides.steered.push_back({wheels + i, 1, i < 2 ? -0.4 : 0.4, i % 2 == 0 ? 0.3 : -0.3, i});
  WheelOdometry odometry(model);
  RobotState state;
  state.links.resize(model.links.size());
  state.joints.resize(model.joints.size() + 4);
  for (std::size_t i = 0; i < 4; ++i) state.joints[std::size_t(wheels) + i].position = angles[i];
  odometry.update(state, 0);
  for (std::size_t i = 0; i < 4; ++i) state.joints[i].position = ways[i] / sides.radius;
  return odometry.update(state, 1);
}

TEST(Odometry, OfWheelsThatTurnOnTheSpotOrGoSideways) {
  const double a = std::atan2(0.4, 0.3), way = 0.5 * 0.2;  // by 0.2 rad on circles of 0.5 m
  const OdometryReading spot = steer({a, -a, -a, a}, {-way, way, -way, way});
  EXPECT_NEAR(spot.yaw, 0.2, 1e-12);
  EXPECT_NEAR(spot.x, 0, 1e-12);
  EXPECT_NEAR(spot.y, 0, 1e-12);
  for (const double angle : {0.3, 1.2, 1.5, -1.2, 2.0, 3.1}) {
    const OdometryReading crab = steer({angle, angle, angle, angle}, {1, 1, 1, 1});
    EXPECT_NEAR(crab.yaw, 0, 1e-12) << angle;
    EXPECT_NEAR(crab.x, std::cos(angle), 1e-12) << angle;
  }
}

TEST(Odometry, WithoutAnErrorItStillClaimsNoCertainty) {
  const RobotModel model = make_rover();
  WheelOdometry odometry(model);
  RobotState state;
  state.links.resize(model.links.size());
  state.joints.resize(model.joints.size());
  odometry.update(state, 0);
  for (auto& joint : state.joints) joint.position = 1 / model.sides.radius;
  const OdometryReading reading = odometry.update(state, 1);
  EXPECT_NEAR(reading.x, 1, 1e-12);
  EXPECT_NEAR(reading.covariance[0][0], 0.5 * kLeastOdometryError * kLeastOdometryError, 1e-12);
  EXPECT_GT(reading.angular_variance, 0);
}

}  // namespace robot_odometry_test
}  // namespace rubble
