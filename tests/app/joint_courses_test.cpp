// Where joints are to be by the trajectories of /joint_trajectory.
#include <gtest/gtest.h>

#include "app/control/joint_courses.h"
#include "kernel/base/error.h"
#include "scripting/robots/crawler.h"
#include "scripting/robots/vine.h"

namespace rubble {
namespace joint_courses_test {

using Point = JointTrajectoryCommand::Point;

// A crawler, whose joints with motors are its flippers.
class JointCoursesOfACrawler : public ::testing::Test {
 protected:
  JointCoursesOfACrawler() {
    for (const RobotJoint& joint : model_.joints) {
      state_.joints.push_back({});
      if (joint.motor.effort <= 0) continue;
      if (names_.empty()) first_ = state_.joints.size() - 1;
      names_.push_back(joint.name);
    }
  }
  double at(double time, std::size_t joint = 0) const {
    RobotLeg leg;
    courses_.ask(time, leg);
    for (std::size_t i = 0; i < leg.joints.size(); ++i)
      if (leg.joint_names[i] == names_[joint]) return leg.joints[i];
    return -100;
  }
  std::string mistake(const JointTrajectoryCommand& trajectory) {
    try {
      courses_.begin(trajectory, model_, state_, 0);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  void begin(const std::vector<Point>& points, double time = 0, std::size_t joint = 0) {
    courses_.begin({{names_[joint]}, points}, model_, state_, time);
  }

  const RobotModel model_ = make_crawler();
  RobotState state_;
  std::vector<std::string> names_;  // of the joints with motors
  std::size_t first_ = 0;           // the index of the first of them
  JointCourses courses_;
};

TEST_F(JointCoursesOfACrawler, GoOnStraightLinesFromWhereTheJointStands) {
  state_.joints[first_].position = 0.5;
  begin({{{1.5}, {}, 2}, {{-0.5}, {}, 3}}, 10);
  EXPECT_DOUBLE_EQ(at(10), 0.5);
  EXPECT_DOUBLE_EQ(at(11), 1);
  EXPECT_DOUBLE_EQ(at(12), 1.5);
  EXPECT_DOUBLE_EQ(at(12.25), 1);
  EXPECT_DOUBLE_EQ(at(13), -0.5);
  EXPECT_DOUBLE_EQ(at(1000), -0.5) << "it stays at the last point";
  EXPECT_EQ(at(11, 1), -100) << "a joint that is not named is not asked for anything";
}

// t^3 is its own cubic.
TEST_F(JointCoursesOfACrawler, WithVelocitiesGoOnTheCubicThatHasThem) {
  state_.joints[first_].position = 0;
  begin({{{0}, {0}, 0}, {{0.125}, {0.75}, 0.5}, {{1}, {3}, 1}});
  for (const double t : {0.1, 0.25, 0.5, 0.7, 0.9, 1.0}) EXPECT_NEAR(at(t), t * t * t, 1e-14) << t;
}

TEST_F(JointCoursesOfACrawler, GoOnFromAnEarlierTrajectoryWithItsSpeed) {
  state_.joints[first_].position = 0;
  begin({{{1}, {}, 1}});
  state_.joints[first_].position = 0.4;  // it lags behind
  begin({{{1}, {0}, 1}}, 0.5);
  EXPECT_DOUBLE_EQ(at(0.5), 0.5);
  EXPECT_NEAR((at(0.5 + 1e-6) - at(0.5)) / 1e-6, 1, 1e-5);  // that of the first
  EXPECT_DOUBLE_EQ(at(1.5), 1);
  begin({{{0.25}, {}, 0}}, 0.75);
  EXPECT_DOUBLE_EQ(at(0.75), 0.25) << "a point at 0 s is asked for at once";
}

TEST_F(JointCoursesOfACrawler, OfOtherJointsStayUntilATrajectoryWithoutPoints) {
  begin({{{1}, {}, 1}});
  begin({{{0.5}, {}, 1}}, 0, 1);
  EXPECT_DOUBLE_EQ(at(2), 1);
  EXPECT_DOUBLE_EQ(at(2, 1), 0.5);
  begin({});
  EXPECT_EQ(at(2), -100);
  EXPECT_TRUE(courses_.empty());
}

TEST_F(JointCoursesOfACrawler, MistakesSayWhatIsExpectedAndChangeNothing) {
  begin({{{1}, {}, 1}});
  const auto said = [this](const JointTrajectoryCommand& trajectory, const char* text) {
    const std::string mistake_text = mistake(trajectory);
    EXPECT_NE(mistake_text.find(text), std::string::npos) << mistake_text;
  };
  said({{"elbow"}, {{{1}, {}, 1}}}, "joint_names: the robot has no joint of this name with a motor: expected one of "
                                    "front_left_flipper_joint, front_right_flipper_joint, rear_left_flipper_joint, "
                                    "rear_right_flipper_joint, found \"elbow\"");
  said({{names_[0], names_[0]}, {{{1, 1}, {}, 1}}}, "joint_names: a joint is named twice");
  said({{names_[0]}, {{{1, 2}, {}, 1}}}, "points[0].positions: wrong number of positions: expected 1, as joint_names has, found 2");
  said({{names_[0]}, {{{1}, {1, 2}, 1}}}, "points[0].velocities: wrong number of velocities");
  said({{names_[0]}, {{{1}, {}, 1}, {{1}, {}, 1}}}, "points[1].time_from_start: not in order: expected more than 1 s, found 1 s");
  said({{names_[0]}, {{{1}, {}, -1}}}, "points[0].time_from_start: not in order: expected 0 s or more, found -1 s");
  said({{names_[0]}, {{{1001}, {}, 1}}}, "points[0].positions: beyond the limits of front_left_flipper_joint");
  said({{}, {{{}, {}, 1}}}, "joint_names: no joint is named");
  EXPECT_DOUBLE_EQ(at(2), 1);
}

TEST(JointCourses, AVineHasNone) {
  JointCourses courses;
  try {
    courses.begin({{"growth"}, {{{1}, {}, 1}}}, make_vine(), {}, 0);
    FAIL() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("/cmd_vel makes it grow"), std::string::npos) << error.what();
  }
}

}  // namespace joint_courses_test
}  // namespace rubble
