// The parts of ros1_navigator that are not ROS, against closed forms; and all of it, with a robot on a plane in place of
// one that is heard over a network.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "app/navigate_ros1/topic_navigator.h"
#include "io/ros/ros_messages.h"
#include "kernel/base/error.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace topic_navigator_test {

constexpr auto kRos1 = ros::Version::ros1;
constexpr double kPi = portable::kPi;

Pose pose_at(double x, double y, double yaw) { return {portable::quat_from_rpy(0, 0, yaw), {x, y, 0}}; }

TEST(RobotMessages, AreReadAsTheyWereWritten) {
  const Pose pose{portable::quat_from_rpy(0.1, -0.2, 0.7), {1, 2, 3}};
  const HeardOdometry odometry =
      read_odometry(kRos1, ros::true_odometry(kRos1, {7, 1'500'000'000, "/odom"}, "base", pose, {}, {}));
  EXPECT_EQ(odometry.stamp_ns, 1'500'000'000);
  EXPECT_EQ(odometry.frame, "odom");
  EXPECT_EQ(odometry.child, "base");
  EXPECT_LT(distance(odometry.frame_from_child * Vec3{1, 1, 1}, pose * Vec3{1, 1, 1}), 1e-12);
  const auto transforms = read_transforms(kRos1, ros::transforms(kRos1, {0, 5, "a"}, {{"b", pose}, {"c", pose, "b"}}));
  ASSERT_EQ(transforms.size(), 2u);
  EXPECT_EQ(transforms[0].parent + transforms[0].child + transforms[1].parent + transforms[1].child, "abbc");
  const HeardCloud cloud = read_point_cloud(kRos1, ros::point_cloud(kRos1, {0, 9, "lidar"}, {{1, 2, 3, 4, 0.25f, 5, 6}}));
  ASSERT_EQ(cloud.points.size(), 1u);
  EXPECT_EQ(cloud.frame, "lidar");
  EXPECT_TRUE(cloud.points[0].place == Vec3f(1, 2, 3));
  EXPECT_EQ(cloud.points[0].time, 0.25f);
}

TEST(RobotMessages, PointsThatAreNotFiniteAreLeftOutAndCounted) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const HeardCloud cloud =
      read_point_cloud(kRos1, ros::point_cloud(kRos1, {}, {{nan, 0, 0, 0, 0, 0, 0}, {1, 1, 1, 0, 0, 0, 0}, {0, inf, 0, 0, 0, 0, 0}}));
  EXPECT_EQ(cloud.points.size(), 1u);
  EXPECT_EQ(cloud.left_out, 2u);
  const Pose lost{{1, 0, 0, 0}, {std::nan(""), 0, 0}};
  EXPECT_THROW(read_odometry(kRos1, ros::true_odometry(kRos1, {}, "base", lost, {}, {})), RunError);
  EXPECT_THROW(read_odometry(kRos1, ros::true_odometry(kRos1, {}, "base", {{0, 0, 0, 0}, {}}, {}, {})), RunError);
}

TEST(RobotMessages, WhatIsCutShortIsNoMessage) {
  const std::string cloud = ros::point_cloud(kRos1, {0, 9, "lidar"}, {{1, 2, 3, 4, 0, 5, 6}, {1, 2, 3, 4, 0, 5, 6}});
  for (std::size_t size = 0; size + 1 < cloud.size(); ++size)  // its last byte is not looked at
    EXPECT_THROW(read_point_cloud(kRos1, cloud.substr(0, size)), RunError) << size;
  std::string rows = cloud;
  rows[4 + 8 + 4 + 5] = '\x7f';  // the height
  EXPECT_THROW(read_point_cloud(kRos1, rows), RunError);
}

TEST(RobotMessages, AScanLiesInItsPlane) {
  LidarSpec spec;
  spec.pattern = LidarPattern::planar;
  spec.columns = 4, spec.first_azimuth_deg = -90, spec.span_deg = 360, spec.min_range = 0.1, spec.max_range = 30;
  ScanPoint left;
  left.y = 2, left.column = 2;
  RangeScan measured;
  measured.spec = std::make_shared<const LidarSpec>(spec), measured.points = {left};
  const HeardCloud scan = read_laser_scan(kRos1, ros::laser_scan(kRos1, {}, measured));
  ASSERT_EQ(scan.points.size(), 1u) << "rays without an echo are infinite";
  EXPECT_NEAR(scan.points[0].place.x, 0, 1e-6);
  EXPECT_NEAR(scan.points[0].place.y, 2, 1e-6);
  EXPECT_EQ(scan.left_out, 0u);
}

TEST(FrameTree, FollowsChainsBothWays) {
  FrameTree tree;
  tree.add({0, "base", "mast", pose_at(1, 0, kPi / 2)});
  tree.add({0, "mast", "lidar", pose_at(0, 2, 0)});
  tree.add({0, "base", "wheel", pose_at(0, -1, 0)});
  const auto base_from_lidar = tree.find("base", "lidar"), wheel_from_lidar = tree.find("wheel", "lidar");
  ASSERT_TRUE(base_from_lidar && wheel_from_lidar);
  EXPECT_LT(distance(*base_from_lidar * Vec3{1, 0, 0}, {-1, 1, 0}), 1e-12);
  EXPECT_LT(distance(*wheel_from_lidar * Vec3{1, 0, 0}, {-1, 2, 0}), 1e-12);
  EXPECT_FALSE(tree.find("base", "elsewhere"));
  tree.add({0, "lidar", "base", {}});
  EXPECT_FALSE(tree.find("base", "lidar")) << "a circle has no root";
}

TEST(OdometryTrack, TakesPosesAsTheyAreWhereNothingSkids) {
  OdometryTrack track(1);
  const double radius = 2;
  for (int k = 0; k <= 100; ++k) {
    const double a = 0.03 * k;
    track.add(k * 100'000'000LL, pose_at(5 + radius * std::sin(a), 1 + radius * (1 - std::cos(a)), a));
  }
  EXPECT_NEAR(track.last().x, radius * std::sin(3.0), 1e-9);
  EXPECT_NEAR(track.last().y, radius * (1 - std::cos(3.0)), 1e-9);
  EXPECT_NEAR(track.last().yaw, 3, 1e-9);
  EXPECT_NEAR(track.velocity().x, 0.6, 0.001);
  EXPECT_NEAR(track.velocity().yaw, 0.3, 1e-6);
  EXPECT_NEAR(track.at(50'000'000).yaw, 0.015, 1e-9);
}

// A robot that skids drives an arc of a larger radius.
TEST(OdometryTrack, ScalesTurnsAndBendsTheWay) {
  OdometryTrack track(0.4);
  const double radius = 2;  // as odometry has it; the true one is 5 m
  for (int k = 0; k <= 300; ++k) {
    const double a = 0.01 * k;
    track.add(k * 100'000'000LL, pose_at(radius * std::sin(a), radius * (1 - std::cos(a)), a));
  }
  EXPECT_NEAR(track.last().yaw, 1.2, 1e-9);
  EXPECT_NEAR(track.last().x, 5 * std::sin(1.2), 0.001);
  EXPECT_NEAR(track.last().y, 5 * (1 - std::cos(1.2)), 0.001);
}

TEST(OdometryTrack, SeesThatTheDriveBeganAnew) {
  using Heard = OdometryTrack::Heard;
  OdometryTrack track(1);
  EXPECT_EQ(track.add(10'000'000'000, pose_at(0, 0, 0)), Heard::taken);
  EXPECT_EQ(track.add(10'100'000'000, pose_at(0.1, 0, 0)), Heard::taken);
  EXPECT_EQ(track.add(10'100'000'000, pose_at(0.1, 0, 0)), Heard::ignored);
  EXPECT_EQ(track.add(10'000'000'000, pose_at(0, 0, 0)), Heard::ignored) << "a little late";
  EXPECT_EQ(track.add(1'000'000'000, pose_at(0, 0, 0)), Heard::restarted);
  EXPECT_EQ(track.add(10'200'000'000, pose_at(3, 0, 0)), Heard::restarted) << "put elsewhere";
}

// A plane seen by a robot that stands on a slope, with what lies on it.
TEST(GroundPlane, IsFoundWhereTheRobotIsTilted) {
  const double pitch = 0.12, roll = -0.06, height = 0.05;
  const Pose base_from_level = Pose{portable::quat_from_rpy(roll, pitch, 0).conjugate(), {0, 0, -height}};
  std::vector<Vec3> points;
  for (double x = -3; x <= 3; x += 0.1)
    for (double y = -3; y <= 3; y += 0.1) {
      const bool block = x > 1 && x < 1.6 && y > -1 && y < 0.5;
      points.push_back(base_from_level * Vec3{x, y, block ? 0.3 : 0});
    }
  GroundPlane ground;
  for (int scan = 0; scan < 3; ++scan) ground = find_ground(points, ground);
  const Pose level_from_base = ground.level_from_base();
  for (const Vec3& p : points) {
    const double z = (level_from_base * p).z;
    EXPECT_LT(std::min(std::fabs(z), std::fabs(z - 0.3)), 0.01);
  }
  EXPECT_NEAR(norm(level_from_base.rotation.rotate(base_from_level.rotation.rotate({0, 0, 1})) - Vec3{0, 0, 1}), 0, 0.005);
  EXPECT_EQ(find_ground({}, ground).height, ground.height) << "kept where nothing is seen";
}

std::vector<Vec3> corner_room() {
  std::vector<Vec3> points;
  for (double d = -2; d <= 2; d += 0.04) {
    points.push_back({d, -1.5, 0.4}), points.push_back({d, 1.5, 0.4});
    if (d > -1.5 && d < 1.5) points.push_back({2, d, 0.4});
    if (d > 0 && d < 0.5) points.push_back({d, 0.8, 0.4}), points.push_back({0.5, 0.3 + d, 0.4});
  }
  return points;
}

TEST(ScanMatcher, FindsThePoseWithinACell) {
  Aabb bounds;
  bounds.include({-4, -4, 0}), bounds.include({4, 4, 1});
  PlanarMap map(bounds, 0.05);
  for (const Vec3& p : corner_room()) map.add(p);
  const PlanarPose truth{0.07, -0.06, 0.09};
  std::vector<Vec3> seen;
  for (const Vec3& p : corner_room()) seen.push_back(inverse(truth) * p);
  const ScanMatch match = match_scan(map, seen, {});
  EXPECT_TRUE(match.found);
  EXPECT_NEAR(match.pose.x, truth.x, 0.045);
  EXPECT_NEAR(match.pose.y, truth.y, 0.045);
  EXPECT_NEAR(match.pose.yaw, truth.yaw, 0.015);
}

TEST(ScanMatcher, KeepsTheGuessWhereItSeesOtherThings) {
  Aabb bounds;
  bounds.include({-4, -4, 0}), bounds.include({4, 4, 1});
  PlanarMap map(bounds, 0.05);
  for (const Vec3& p : corner_room()) map.add(p + Vec3{0, 0, 1});  // a roof
  const ScanMatch match = match_scan(map, corner_room(), {0.5, 0.5, 0.5});
  EXPECT_FALSE(match.found);
  EXPECT_EQ(match.pose.x, 0.5);
}

// A robot on a plane whose tracks slide when it turns, among walls that its LiDAR sees from everywhere.
class PlaneRobot {
 public:
  static constexpr double kShare = 0.4, kPeriod = 0.2;

  void wall(double x0, double y0, double x1, double y1) {
    const double length = std::hypot(x1 - x0, y1 - y0);
    for (double d = 0; d <= length; d += 0.04)
      for (double z = 0.12; z < 0.7; z += 0.05) walls_.push_back({x0 + (x1 - x0) * d / length, y0 + (y1 - y0) * d / length, z});
  }

  void drive(double linear, double angular) { linear_ = linear, angular_ = angular; }

  // What is heard of the next period of it.
  HeardRobot go() {
    HeardRobot heard;
    if (stamp_ == 0) heard.transforms = {{0, "base", "lidar", {{1, 0, 0, 0}, {0, 0, 0.4}}}};
    for (int k = 0; k < 20; ++k) {
      stamp_ += 10'000'000;
      true_ = true_ * PlanarPose{0.01 * linear_, 0, 0.01 * angular_ * kShare};
      odometry_ = odometry_ * PlanarPose{0.01 * linear_, 0, 0.01 * angular_};
      heard.odometry.push_back({stamp_, "odom", "base", pose_at(odometry_.x, odometry_.y, odometry_.yaw)});
    }
    heard.clouds.push_back(cloud());
    wall_ += kPeriod;
    return heard;
  }
  double clock() const { return wall_; }
  const PlanarPose& truth() const { return true_; }
  std::int64_t stamp() const { return stamp_; }
  double nearest() const { return nearest_; }
  double linear() const { return linear_; }
  double angular() const { return angular_; }
  void wait(double seconds) { wall_ += seconds; }
  void jump_back() { stamp_ = 1'000'000'000; }

 private:
  HeardCloud cloud() {
    HeardCloud cloud;
    cloud.stamp_ns = stamp_, cloud.frame = "lidar";
    std::map<std::pair<int, int>, Vec3> nearest;  // by direction, in steps of 0.01 rad
    for (const Vec3& p : walls_) {
      const Vec3 local = inverse(true_) * p;
      const double in_x = std::fabs(local.x) - 0.46, in_y = std::fabs(local.y) - 0.33;
      nearest_ = std::min(nearest_, std::hypot(std::max(0.0, in_x), std::max(0.0, in_y)));
      const Vec3 ray = local - Vec3{0, 0, 0.4};
      const double flat = std::hypot(ray.x, ray.y);
      const auto [seen, first] = nearest.try_emplace(
          {int(std::lround(100 * std::atan2(ray.y, ray.x))), int(std::lround(100 * std::atan2(ray.z, flat)))}, ray);
      if (!first && dot(ray, ray) < dot(seen->second, seen->second)) seen->second = ray;
    }
    for (const auto& [direction, ray] : nearest) cloud.points.push_back({Vec3f(ray), 0});
    for (double x = -3; x < 3; x += 0.15)
      for (double y = -3; y < 3; y += 0.15) cloud.points.push_back({Vec3f(float(x), float(y), -0.4f), 0});
    return cloud;
  }

  std::vector<Vec3> walls_;
  PlanarPose true_, odometry_;
  double linear_ = 0, angular_ = 0, wall_ = 100, nearest_ = 1e9;
  std::int64_t stamp_ = 0;
};

TopicNavigatorOptions options_in(const ScratchFolder& folder) {
  TopicNavigatorOptions options;
  options.waypoints = {{6, 0.5, 0}}, options.cache_folder = folder.path().string();
  return options;
}

void furnish(PlaneRobot& robot) {
  robot.wall(-1, -1.6, 7, -1.6), robot.wall(-1, 1.8, 7, 1.8);
  robot.wall(2, -0.2, 2.5, -0.2), robot.wall(2.5, -0.2, 2.5, 0.3), robot.wall(2, 0.3, 2.5, 0.3), robot.wall(2, -0.2, 2, 0.3);
}

class TopicNavigation : public ::testing::Test {
 protected:
  TopicNavigator make(const TopicNavigatorOptions& options) {
    return {options, [this](double linear, double angular) { robot_.drive(linear, angular); }};
  }
  void drive(TopicNavigator& navigator, int periods) {
    for (int k = 0; k < periods && !navigator.has_ended(); ++k) navigator.hear(robot_.go(), robot_.clock());
  }
  const ScratchFolder folder_;
  PlaneRobot robot_;
};

TEST_F(TopicNavigation, ArrivesByOdometryThatSkids) {
  furnish(robot_);
  TopicNavigator navigator = make(options_in(folder_));
  drive(navigator, 400);
  const TopicReport& r = navigator.report();
  EXPECT_EQ(r.end, TopicEnd::arrived) << r.message;
  EXPECT_LT(std::hypot(robot_.truth().x - 6, robot_.truth().y - 0.5), 0.45);
  EXPECT_LT(std::hypot(robot_.truth().x - r.pose.x, robot_.truth().y - r.pose.y), 0.15);
  EXPECT_GT(robot_.nearest(), 0) << "it drove into a wall";
  EXPECT_EQ(r.clouds_dropped, 0);
  EXPECT_EQ(r.clouds_late, 0);
  EXPECT_EQ(robot_.linear(), 0) << "it is told to stop";
}

// The first of two places lies aside of the straight way; the goal is the last.
TEST_F(TopicNavigation, DrivesToSeveralPlacesOneAfterTheOther) {
  TopicNavigatorOptions options = options_in(folder_);
  options.waypoints = {{2, 2.5, 0}, {4, 0, 0}};
  TopicNavigator navigator = make(options);
  double nearest = 1e9;
  for (int k = 0; k < 400 && !navigator.has_ended(); ++k) {
    drive(navigator, 1);
    nearest = std::min(nearest, std::hypot(robot_.truth().x - 2, robot_.truth().y - 2.5));
  }
  EXPECT_EQ(navigator.report().end, TopicEnd::arrived) << navigator.report().message;
  EXPECT_LT(nearest, 0.75);
  EXPECT_LT(std::hypot(robot_.truth().x - 4, robot_.truth().y), 0.45);
  EXPECT_LT(navigator.report().left, 0.35);
}

// Odometry whose turns are taken as they are puts the robot elsewhere; scans put it back.
TEST_F(TopicNavigation, MatchingScansMakesUpForWrongTurns) {
  const auto error = [&](bool matches) {
    robot_ = PlaneRobot();
    furnish(robot_);
    TopicNavigatorOptions options = options_in(folder_);
    options.matches = matches;
    options.robot.turn_share = 0.5;
    TopicNavigator navigator = make(options);
    drive(navigator, 90);
    const TopicReport& r = navigator.report();
    return std::hypot(robot_.truth().x - r.pose.x, robot_.truth().y - r.pose.y);
  };
  const double matched = error(true), believed = error(false);
  EXPECT_LT(matched, 0.12);
  EXPECT_GT(believed, 1.5 * matched);
}

TEST_F(TopicNavigation, StopsWhereCloudsStopAndEndsWithAMessage) {
  TopicNavigator navigator = make(options_in(folder_));
  furnish(robot_);
  drive(navigator, 10);
  EXPECT_GT(robot_.linear(), 0.1);
  for (int k = 0; k < 4; ++k) {
    HeardRobot heard = robot_.go();
    heard.clouds.clear();
    navigator.hear(heard, robot_.clock());
    EXPECT_EQ(robot_.linear() > 0, k < 2) << "0.5 s without a cloud are between the third and the fourth period";
  }
  robot_.wait(11);
  navigator.hear({}, robot_.clock());
  EXPECT_EQ(navigator.report().end, TopicEnd::no_data);
  EXPECT_NE(navigator.report().message.find("clouds with points do not come any more"), std::string::npos);
}

TEST_F(TopicNavigation, StopsWherePosesStop) {
  TopicNavigator navigator = make(options_in(folder_));
  furnish(robot_);
  drive(navigator, 10);
  for (int k = 0; k < 5; ++k) {
    HeardRobot heard = robot_.go();
    heard.odometry.clear();
    navigator.hear(heard, robot_.clock());
    robot_.wait(0.15);
    navigator.hear({}, robot_.clock());
  }
  EXPECT_EQ(robot_.linear(), 0);
  robot_.wait(11);
  navigator.hear({}, robot_.clock());
  EXPECT_EQ(navigator.report().end, TopicEnd::no_data);
  EXPECT_NE(navigator.report().message.find("poses do not come any more"), std::string::npos) << navigator.report().message;
}

TEST_F(TopicNavigation, CountsCloudsThatAreMissing) {
  furnish(robot_);
  TopicNavigator navigator = make(options_in(folder_));
  drive(navigator, 5);
  robot_.go(), robot_.go();  // nobody hears them
  drive(navigator, 5);
  EXPECT_EQ(navigator.report().clouds_dropped, 2);
}

TEST_F(TopicNavigation, SaysWhichTopicsNeverCame) {
  const auto end_with = [&](const std::function<void(HeardRobot&)>& without) {
    TopicNavigator navigator = make(options_in(folder_));
    HeardRobot heard = robot_.go();
    without(heard);
    navigator.hear(heard, 0);
    navigator.hear({}, 29);
    EXPECT_FALSE(navigator.has_ended());
    navigator.hear({}, 31);
    EXPECT_EQ(navigator.report().end, TopicEnd::no_data);
    return navigator.report().message;
  };
  furnish(robot_);
  EXPECT_NE(end_with([](HeardRobot& h) { h.odometry.clear(); }).find("no odometry came"), std::string::npos);
  EXPECT_NE(end_with([](HeardRobot& h) { h.clouds.clear(); }).find("no cloud or scan"), std::string::npos);
  EXPECT_NE(end_with([](HeardRobot& h) { h.clouds[0].points.clear(); }).find("without one finite point"), std::string::npos);
  EXPECT_NE(end_with([](HeardRobot& h) { h.clouds[0].frame = "elsewhere"; }).find("to elsewhere"), std::string::npos);
}

TEST_F(TopicNavigation, EndsWhereTheDriveIsStartedAgain) {
  furnish(robot_);
  TopicNavigator navigator = make(options_in(folder_));
  drive(navigator, 20);
  robot_.jump_back();
  drive(navigator, 1);
  EXPECT_EQ(navigator.report().end, TopicEnd::restarted);
  EXPECT_EQ(robot_.linear(), 0);
}

TEST_F(TopicNavigation, EndsWhereTheRobotIsLost) {
  TopicNavigatorOptions options = options_in(folder_);
  options.matches = false;
  TopicNavigator navigator{options, [this](double, double) { robot_.drive(-2, 0); }};  // it drives as it likes
  furnish(robot_);
  drive(navigator, 60);
  EXPECT_EQ(navigator.report().end, TopicEnd::lost);
  EXPECT_NE(navigator.report().message.find("farther than 8 m"), std::string::npos);
}

// Of a scanner that is lower than what is matched, and than what is an obstacle.
TEST_F(TopicNavigation, ArrivesByAScanner) {
  furnish(robot_);
  TopicNavigatorOptions options = options_in(folder_);
  options.planar = true, options.robot = known_robots().back();
  TopicNavigator navigator = make(options);
  for (int k = 0; k < 400 && !navigator.has_ended(); ++k) {
    HeardRobot heard = robot_.go();
    std::vector<HeardPoint> points;
    for (const HeardPoint& p : heard.clouds[0].points)
      if (p.place.z > -0.29f && p.place.z < -0.25f) points.push_back({{p.place.x, p.place.y, -0.35f}, 0});
    heard.clouds[0].points = points;
    navigator.hear(heard, robot_.clock());
  }
  EXPECT_EQ(navigator.report().end, TopicEnd::arrived) << navigator.report().message;
  EXPECT_LT(std::hypot(robot_.truth().x - 6, robot_.truth().y - 0.5), 0.45);
  EXPECT_EQ(navigator.report().matches_failed, 0);
}

TEST_F(TopicNavigation, GoesByTransformsWhereAskedTo) {
  furnish(robot_);
  TopicNavigatorOptions options = options_in(folder_);
  options.pose = PoseSource::transforms, options.base_frame = "base", options.fixed_frame = "map";
  TopicNavigator navigator = make(options);
  for (int k = 0; k < 400 && !navigator.has_ended(); ++k) {
    HeardRobot heard = robot_.go();
    heard.odometry.clear();
    const PlanarPose& t = robot_.truth();
    heard.transforms.push_back({0, "map", "odom", pose_at(3, 4, kPi / 2)});
    heard.transforms.push_back({robot_.stamp(), "odom", "base", pose_at(t.x, t.y, t.yaw)});
    navigator.hear(heard, robot_.clock());
  }
  EXPECT_EQ(navigator.report().end, TopicEnd::arrived) << navigator.report().message;
  EXPECT_LT(std::hypot(robot_.truth().x - 6, robot_.truth().y - 0.5), 0.4);
}

}  // namespace topic_navigator_test
}  // namespace rubble::testing
