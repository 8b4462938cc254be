// Motors on trees against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/robot/parts.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_robots.h"
#include "scenes.h"

namespace rubble {
namespace robot_motor_test {

constexpr double kStep = 1.0 / 240;
constexpr int kSubsteps = 4;
constexpr double kG = 9.81;

WorldOptions options_with(double gravity) {
  WorldOptions options;
  options.gravity = gravity;
  return options;
}

World make_world(double gravity, std::vector<PieceType> types = {}) {
  World world(std::move(types), options_with(gravity));
  world.set_step(kStep, kSubsteps);
  return world;
}

// Two boxes on a hinge about Z in the middle of both: link 1 hangs on link 0 at their common centre.
RobotModel make_spinner(const RobotMotor& motor) {
  RobotModel model;
  model.name = "spinner";
  for (const char* name : {"base", "rotor"}) {
    RobotLink link;
    link.name = name;
    link.parts = {make_box({0.2, 0.2, 0.1})};
    set_mass(link.name == "base" ? 3 : 1, link);
    model.links.push_back(link);
  }
  RobotJoint joint;
  joint.name = "spin";
  joint.motor = motor;
  model.joints = {joint};
  return model;
}

// A heavy plate on the ground with an arm of 0.5 m on a hinge about Y, level at 0.
RobotModel make_arm(const RobotMotor& motor) {
  RobotModel model;
  model.name = "arm";
  RobotLink base;
  base.name = "base";
  base.parts = {make_box({1, 1, 0.2}, {0, 0, 0.1})};
  set_mass(200, base);
  RobotLink arm;
  arm.name = "arm";
  arm.parts = {make_box({0.5, 0.05, 0.05}, {0.25, 0, 0})};
  set_mass(2, arm);
  model.links = {base, arm};
  RobotJoint joint;
  joint.name = "shoulder";
  joint.parent_from_child.translation = {0, 0, 1};
  joint.axis = {0, 1, 0};
  joint.motor = motor;
  model.joints = {joint};
  return model;
}

RobotCommand ask(MotorMode mode, double target) { return {{{mode, target}}, {}}; }

void run(World& world, double seconds) {
  for (int i = 0; i < int(seconds / kStep + 0.5); ++i) world.step();
}

TEST(RobotMotor, ATorqueTurnsBothSidesAndKeepsTheMomentum) {
  World world = make_world(0);
  const RobotModel model = make_spinner({5, 0, 0, 0});
  const int robot = world.robots().add(model, {{}, {0, 0, 1}});
  world.robots().set_command(robot, ask(MotorMode::torque, 0.02));
  run(world, 1);
  const double a = model.links[0].inertia.rows[2].z, b = model.links[1].inertia.rows[2].z;
  const RobotState state = world.robots().state(robot);
  EXPECT_NEAR(state.joints[0].speed, 0.02 * (1 / a + 1 / b), 1e-6 * state.joints[0].speed);
  EXPECT_NEAR(state.joints[0].torque, 0.02, 1e-8);  // the step is a float
  EXPECT_NEAR(norm(world.diagnostics().angular_momentum()), 0, 1e-12);
  EXPECT_NEAR(norm(world.diagnostics().linear_momentum()), 0, 1e-12);
  // What the motor gave is there.
  EXPECT_NEAR(state.joints[0].work, world.diagnostics().kinetic_energy(), 0.01 * world.diagnostics().kinetic_energy());
}

TEST(RobotMotor, TheTorqueNeverExceedsTheEffort) {
  World world = make_world(0);
  const RobotModel model = make_spinner({0.01, 0, 50, 5});
  const int robot = world.robots().add(model, {{}, {0, 0, 1}});
  const double a = model.links[0].inertia.rows[2].z, b = model.links[1].inertia.rows[2].z;
  for (const RobotCommand& command :
       {ask(MotorMode::torque, 3), ask(MotorMode::velocity, 100), ask(MotorMode::position, 1e4)}) {
    const double before = world.robots().state(robot).joints[0].speed;
    world.robots().set_command(robot, command);
    run(world, 0.5);
    const RobotState state = world.robots().state(robot);
    EXPECT_NEAR(state.joints[0].torque, 0.01, 1e-8);
    EXPECT_NEAR(state.joints[0].speed - before, 0.005 * (1 / a + 1 / b), 1e-6 * state.joints[0].speed);
  }
}

TEST(RobotMotor, AVelocityIsReachedAndLimited) {
  World world = make_world(0);
  const int robot = world.robots().add(make_spinner({5, 4, 0, 2}), {{}, {0, 0, 1}});
  world.robots().set_command(robot, ask(MotorMode::velocity, 2));
  run(world, 1);
  EXPECT_NEAR(world.robots().state(robot).joints[0].speed, 2, 1e-3);
  world.robots().set_command(robot, ask(MotorMode::velocity, 9));
  run(world, 1);
  EXPECT_NEAR(world.robots().state(robot).joints[0].speed, 4, 1e-3);
}

// What turns faster by another cause is not braked, and a torque the other way has its full effect.
TEST(RobotMotor, ATorqueDrivesUpToTheSpeedLimit) {
  World world = make_world(0);
  const int robot = world.robots().add(make_spinner({5, 4, 0, 0}), {{}, {0, 0, 1}});
  const auto speed = [&] { return world.robots().state(robot).joints[0].speed; };
  world.robots().set_command(robot, ask(MotorMode::torque, 0.5));
  run(world, 2);
  EXPECT_NEAR(speed(), 4, 1e-3);
  EXPECT_NEAR(world.robots().state(robot).joints[0].torque, 0, 1e-3);
  world.robots().set_command(robot, ask(MotorMode::torque, -0.5));
  run(world, 2);
  EXPECT_NEAR(speed(), -4, 1e-3);
  // Spun up without a limit, it keeps its speed.
  World free = make_world(0);
  const RobotModel model = make_spinner({5, 0, 0, 0});
  const int spun = free.robots().add(model, {{}, {0, 0, 1}});
  free.robots().set_command(spun, ask(MotorMode::torque, 0.5));
  run(free, 2);
  EXPECT_GT(free.robots().state(spun).joints[0].speed, 40);
}

// However low its limit of speed, a position motor has all of its effort against a load: it lifts at that speed, and what is too
// heavy sinks no faster than its effort allows.
TEST(RobotMotor, ALowSpeedLimitTakesNothingOfTheEffort) {
  for (const double speed : {0.1, 0.2, 0.5}) {
    World world = make_world(kG);
    const double stiffness = 12 / 0.07;
    const int robot = world.robots().add(make_arm({12, speed, stiffness, 0.05 * stiffness}), {{}, {0, 0, 0.001}});
    world.robots().set_command(robot, ask(MotorMode::position, -1));  // up: the axis is Y
    run(world, 0.5 / speed);
    double most = 0;
    for (int i = 0; i < 60; ++i) {
      world.step();
      most = std::max(most, std::abs(world.robots().state(robot).joints[0].speed));
    }
    EXPECT_NEAR(most, speed, 0.02 * speed);
    EXPECT_NEAR(world.robots().state(robot).joints[0].position, -0.5 - speed * 60 * kStep, 0.06) << speed;
    run(world, 1 / speed);
    EXPECT_NEAR(world.robots().state(robot).joints[0].position, -1, 0.04) << speed;
  }
}

// Level, its weight pulls with m g 0.25: the spring gives way by that over its stiffness.
TEST(RobotMotor, APositionHoldsAgainstGravityWithItsStiffness) {
  World world = make_world(kG);
  const RobotModel model = make_arm({50, 2, 80, 4});
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  world.robots().set_command(robot, ask(MotorMode::position, 0));
  run(world, 4);
  const RobotState state = world.robots().state(robot);
  const double q = state.joints[0].position;
  EXPECT_NEAR(q, 2 * kG * 0.25 * std::cos(q) / 80, 1e-5);
  EXPECT_NEAR(state.joints[0].torque, -2 * kG * 0.25 * std::cos(q), 1e-3);
  EXPECT_NEAR(state.joints[0].speed, 0, 1e-4);
  // The joint carries the arm's weight; the ground all of it.
  EXPECT_NEAR(state.joints[0].load_force.z, 2 * kG, 0.02);
  EXPECT_NEAR(state.joints[0].load_moment.y, -2 * kG * 0.25 * std::cos(q), 0.01);
  EXPECT_NEAR(state.links[0].contact_force.z, model.mass() * kG, 0.2);
}

TEST(RobotMotor, AWeakMotorLetsTheArmFallToItsStop) {
  RobotModel model = make_arm({3, 2, 80, 4});  // needs 4.9
  model.joints[0].upper = 0.4;
  World world = make_world(kG);
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  world.robots().set_command(robot, ask(MotorMode::position, 0));
  run(world, 3);
  EXPECT_NEAR(world.robots().state(robot).joints[0].position, 0.4, 0.01);
}

// Towards a position the joint turns no faster than the motor may.
TEST(RobotMotor, APositionIsApproachedAtTheSpeedLimit) {
  World world = make_world(0);
  const int robot = world.robots().add(make_spinner({5, 0.5, 100, 2}), {{}, {0, 0, 1}});
  world.robots().set_command(robot, ask(MotorMode::position, 2));
  run(world, 2);
  const double half = world.robots().state(robot).joints[0].position;
  EXPECT_NEAR(half, 1, 0.02);
  EXPECT_NEAR(world.robots().state(robot).joints[0].speed, 0.5, 1e-3);
  run(world, 4);
  EXPECT_NEAR(world.robots().state(robot).joints[0].position, 2, 1e-3);
}

// Gains far beyond what a step could resolve by explicit forces.
TEST(RobotMotor, NoGainMakesItUnstable) {
  World world = make_world(kG);
  const int robot = world.robots().add(make_arm({1e6, 0, 1e8, 1e6}), {{}, {0, 0, 0.001}});
  world.robots().set_command(robot, ask(MotorMode::position, -0.3));
  run(world, 2);
  EXPECT_NEAR(world.robots().state(robot).joints[0].position, -0.3, 1e-4);
  EXPECT_LT(world.diagnostics().kinetic_energy(), 1e-6);
}

TEST(RobotMotor, ACommandThatIsNotANumberIsRefused) {
  World world = make_world(0);
  const int robot = world.robots().add(make_spinner({5, 0, 0, 2}), {{}, {0, 0, 1}});
  try {
    world.robots().set_command(robot, ask(MotorMode::velocity, std::nan("")));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].key, "robots[1].spin");
  }
}

TEST(RobotModel, MistakesAreNamed) {
  const auto key_of = [](const RobotModel& model) {
    try {
      validate(model, "robot");
    } catch (const InputError& error) {
      return error.diagnostics()[0].key;
    }
    return std::string("none");
  };
  const RobotModel good = make_spinner({5, 0, 0, 2});
  EXPECT_EQ(key_of(good), "none");
  RobotModel bad = good;
  bad.links[1].inertia = {};
  EXPECT_EQ(key_of(bad), "robot.links[1].inertia");
  bad = good;
  bad.links[1].inertia = Mat3::diagonal({1, 1, 3});
  EXPECT_EQ(key_of(bad), "robot.links[1].inertia");
  bad = good;
  bad.joints[0].axis = {0, 0, 2};
  EXPECT_EQ(key_of(bad), "robot.joints[0].axis");
  bad = good;
  bad.joints[0].parent = 1;
  EXPECT_EQ(key_of(bad), "robot.joints[0].parent");
}

}  // namespace robot_motor_test
}  // namespace rubble
