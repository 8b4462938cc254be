// What a crawler must and must not cross, and what motors give to robot and debris.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "kernel/base/random.h"
#include "kernel/robot/parts.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_crossing_test {

using testing::drive;
using testing::make_robot_world;
using testing::position_of;

constexpr double kGravity = 9.81;

// Where a crawler is after 18 s towards a trench, between two blocks: so slowly that no swing carries it over.
double cross_gap(bool flippers, double gap) {
  const double height = 0.8;
  World world = make_robot_world({testing::box_type("block", 3, 3, height)});
  world.add({testing::at(0, {-1.5, 0, 0.5 * height}, {}, true),
             testing::at(0, {1.5 + gap, 0, 0.5 * height}, {}, true)});
  CrawlerOptions options;
  options.flippers = flippers;
  options.flipper_start = 0;
  const RobotModel model = make_crawler(options);
  const int robot = world.robots().add(model, {{}, {-0.5, 0, height + 0.001}});
  drive(world, robot, 18, [&](double) { return drive_sides(model, 0.1, 0, {0, 0, 0, 0}); });
  const Vec3 at = position_of(world, robot);
  return at.z > 0.9 * height ? at.x - gap : -1;  // how far beyond the trench; -1: it is in it
}

// Tracks stand on 0.5 m between their axles and end 0.089 m beyond them; flippers end at 0.625 m from the
// middle. Its weight is in its middle: while that is on the edge, a gap below 0.25 m is bridged by the flat of
// the track. Nothing that is longer than the robot's front half can be reached before it tips in.
TEST(Crawler, CrossesGapsOfHalfItsLengthAndWithFlippersLongerOnes) {
  EXPECT_GT(cross_gap(false, 0.24), 0.5);
  EXPECT_GT(cross_gap(true, 0.24), 0.5);
  EXPECT_EQ(cross_gap(false, 0.36), -1) << "0.339 m is the front half without flippers";
  EXPECT_GT(cross_gap(true, 0.42), 0.5);
  EXPECT_EQ(cross_gap(true, 0.65), -1) << "0.625 m is the front half with them";
}

// A step field as in the test methods of NIST for response robots: square posts of random heights, 10 cm wide,
// here 12 rows along the way of 5 to 20 cm, of which the first and the last have 5 or 10 cm.
struct StepField {
  explicit StepField(std::uint64_t seed) {
    RandomStream random(seed, "step field");
    for (int height = 1; height <= 4; ++height) types.push_back(testing::box_type("post", 0.1, 0.1, 0.05 * height));
    for (PieceType& type : types) type.friction = 0.7;
    for (int row = 0; row < 12; ++row) {
      for (int column = -6; column < 6; ++column) {
        const int height = int(random.uniform(0, row == 0 || row == 11 ? 2 : 4));
        pieces.push_back(testing::at(height, {0.05 + 0.1 * row, 0.05 + 0.1 * column, 0.025 * (height + 1)}, {}, true));
      }
    }
  }
  std::vector<PieceType> types;
  std::vector<NewPiece> pieces;
};

// Raises the flippers at the nose to climb on, and presses with all of them while the body is steep. Where it has
// not come on for four seconds it backs up a little, and tries with other angles.
class FieldDriver {
 public:
  RobotCommand drive(const RobotModel& model, const RobotState& state, double time) {
    const Pose& base = state.links[0].world_from_link;
    const Vec3 ahead = base.rotation.rotate({1, 0, 0});
    if (base.translation.x > best_ + 0.04) best_ = base.translation.x, since_ = time;
    if (time > since_ + 4) back_until_ = time + 0.7, since_ = time + 1, tries_ = (tries_ + 1) % 3;
    const bool steep = ahead.z > 0.12;
    const double fronts[] = {0.9, 0.6, 0.3}, rears[] = {0.3, -0.3, 0};
    const double front = steep ? 0.1 : fronts[tries_], rear = steep ? -0.5 : rears[tries_];
    const double speed = time < back_until_ ? -0.3 : 0.3;
    return drive_sides(model, speed, -1.5 * std::atan2(ahead.y, ahead.x), {front, front, rear, rear});
  }

 private:
  double best_ = -10, since_ = 0, back_until_ = -1;
  int tries_ = 0;
};

// How far it comes within 40 s, in the middle of the field, which ends at 1.2 m.
double cross_field(std::uint64_t seed, bool flippers) {
  const StepField field(seed);
  World world = make_robot_world(field.types);
  world.add(field.pieces);
  CrawlerOptions options;
  options.flippers = flippers;
  options.flipper_start = 0.7;
  const RobotModel model = make_crawler(options);
  const int robot = world.robots().add(model, {{}, {-0.75, 0, 0.001}});
  FieldDriver driver;
  for (int i = 0; i < 40 * 60 && position_of(world, robot).x < 1.25; ++i)
    drive(world, robot, 1.0 / 60, [&](double) { return driver.drive(model, world.robots().state(robot), i / 60.0); });
  return position_of(world, robot).x;
}

TEST(Crawler, CrossesStepFieldsWithItsFlippers) {
  int crossed = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const double with = cross_field(seed, true), bare = cross_field(seed, false);
    std::printf("  step field %d: %.2f m, without flippers %.2f m\n", int(seed), with, bare);
    crossed += with > 1.2;
    without += bare > 1.2;
  }
  std::printf("crossed: %d of 20, without flippers %d\n", crossed, without);
  EXPECT_GE(crossed, 16);  // of 40 fields, it crosses 35
  EXPECT_LT(without, crossed / 2);
}

// A rover with a plough, and the work of its motors on the way.
struct Pushed {
  double work = 0, way = 0, wheels = 0;  // of the motors, the block and the wheels' rims; unit: J, m
};
Pushed push_block(bool with_block) {
  World world = make_robot_world({testing::box_type("block", 0.1, 0.4, 0.06)});
  const int block = with_block ? world.add({testing::at(0, {0.4, 0, 0.0305})}) : -1;
  RobotModel model = make_rover();
  model.links[0].parts.push_back(make_box({0.02, 0.5, 0.12}, {0.26, 0, 0.07}));
  model.links[0].friction = 0;  // the plough slides along what it pushes
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  const auto measure = [&] {
    Pushed now;
    const RobotState state = world.robots().state(robot);
    for (const RobotState::Joint& joint : state.joints) now.work += joint.work;
    now.wheels = state.joints[0].position * kRoverWheelRadius;
    if (with_block) now.way = world.piece(block).world_from_body.translation.x;
    return now;
  };
  const auto forwards = [&](double) { return drive_sides(model, 0.3, 0); };
  drive(world, robot, 1.5, forwards);  // the block is met and moves as fast as the rover
  const Pushed from = measure();
  drive(world, robot, 4, forwards);
  const Pushed to = measure();
  return {to.work - from.work, to.way - from.way, to.wheels - from.wheels};
}

// At a steady speed, motors give what friction takes from the block, over the way that the wheels' rims run, and
// what a rover takes that pushes nothing: W - W_0 = mu m g s.
TEST(Robot, MotorsGiveWhatFrictionTakesFromTheDebris) {
  const double mu = 0.6, mass = 2400 * 0.1 * 0.4 * 0.06;
  const Pushed pushed = push_block(true), free = push_block(false);
  EXPECT_GT(pushed.way, 1);
  const double given = pushed.work - free.work, taken = mu * mass * kGravity * pushed.wheels;
  std::printf("motors gave %.2f J more than the %.2f J without a block, friction took %.2f J over %.3f m of %.3f m\n",
              given, free.work, taken, pushed.wheels, pushed.way);
  EXPECT_NEAR(given, taken, 0.03 * taken);
}

// Without contacts nothing is lost but what joints damp: a snake that thrashes about while it falls has the work
// of its motors and its weight as energy of motion.
TEST(Robot, MotorsAndWeightGiveAllEnergyOfMotion) {
  World world = make_robot_world();
  const RobotModel model = make_snake();
  const int robot = world.robots().add(model, {{}, {0, 0, 20}});
  const double top = testing::centre_of(world, robot).z;
  SnakeGait gait = lateral_undulation();
  gait.vertical_amplitude = 0, gait.lateral_amplitude = 0.3, gait.ramp = 0.5;  // no self-contact
  drive(world, robot, 1, [&](double t) { return calc_gait(model, gait, t); });
  double given = model.mass() * kGravity * (top - testing::centre_of(world, robot).z);
  for (const RobotState::Joint& joint : world.robots().state(robot).joints) given += joint.work;
  std::printf("given %.3f J, energy of motion %.3f J\n", given, world.diagnostics().kinetic_energy());
  EXPECT_NEAR(given, world.diagnostics().kinetic_energy(), 0.01 * given);
}

}  // namespace robot_crossing_test
}  // namespace rubble
