// Bundled robots on the ground, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/robot/parts.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_ground_test {

using testing::drive;
using testing::make_robot_world;
using testing::position_of;
using testing::yaw_of;

constexpr double kG = 9.81, kDegree = 3.14159265358979 / 180;

CrawlerOptions bare(double friction = 0.7) {
  CrawlerOptions options;
  options.flippers = false;
  options.friction = friction;
  options.speed = 5;
  return options;
}

// A slab that rises along +X at an angle, its upper face through the origin.
struct Slope {
  explicit Slope(double degrees, double friction = 0.7)
      : angle(degrees * kDegree), turn(testing::turned({0, 1, 0}, -angle)) {
    PieceType slab = testing::box_type("slab", 40, 4, 1);
    slab.friction = friction;
    types = {slab};
  }
  World make() const {
    WorldOptions options;
    options.lost_below = -100;
    options.threads = 1;
    World world(types, options);
    world.set_step(testing::kRobotStep, testing::kRobotSubsteps);
    world.add({testing::at(0, Vec3{0, 0, 50} + turn.rotate({0, 0, -0.5}), turn, true)});
    return world;
  }
  Pose base() const { return {turn, Vec3{0, 0, 50} + turn.rotate({0, 0, 0.001})}; }
  double along(const World& world, int robot) const {
    return dot(turn.rotate({1, 0, 0}), position_of(world, robot) - Vec3{0, 0, 50});
  }
  double angle;
  Quat turn;
  std::vector<PieceType> types;
};

// Belts that are much faster than the robot pull with the whole friction, to the speed of the belt.
TEST(Crawler, SpinningTracksAccelerateItByFriction) {
  World world = make_robot_world();
  const RobotModel model = make_crawler(bare());
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  drive(world, robot, 0.5, [&](double) { return drive_sides(model, 0, 0); });
  const double start = position_of(world, robot).x;
  drive(world, robot, 0.4, [&](double) { return drive_sides(model, 5, 0); });
  EXPECT_NEAR(position_of(world, robot).x - start, 0.5 * 0.7 * kG * 0.16, 0.02 * 0.55);
  drive(world, robot, 2, [&](double) { return drive_sides(model, 5, 0); });
  EXPECT_NEAR(world.robots().state(robot).links[0].linear.x, 5, 0.005);
}

TEST(Crawler, DrivesAsFastAsItsBelts) {
  World world = make_robot_world();
  const RobotModel model = make_crawler();
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  const auto forward = [&](double) { return drive_sides(model, 0.5, 0); };
  drive(world, robot, 1, forward);
  const double start = position_of(world, robot).x;
  drive(world, robot, 2, forward);
  EXPECT_NEAR(position_of(world, robot).x - start, 1, 0.002);
  EXPECT_NEAR(position_of(world, robot).y, 0, 0.002);
}

// Up to the angle whose tangent is the friction coefficient, 35 degrees; from there on it slides back by
// what friction lacks.
TEST(Crawler, ClimbsASlopeUpToItsFrictionLimit) {
  const RobotModel model = make_crawler(bare());
  for (double degrees : {20.0, 30.0, 34.0}) {
    const Slope slope(degrees);
    World world = slope.make();
    const int robot = world.robots().add(model, slope.base());
    const auto up = [&](double) { return drive_sides(model, 0.3, 0); };
    drive(world, robot, 2, up);  // at 34 degrees it takes 1.6 s to reach the belts' speed
    const double start = slope.along(world, robot);
    drive(world, robot, 2, up);
    EXPECT_NEAR(slope.along(world, robot) - start, 0.6, 0.01) << degrees;
  }
  const Slope steep(40);
  World world = steep.make();
  const int robot = world.robots().add(model, steep.base());
  const auto up = [&](double) { return drive_sides(model, 0.3, 0); };
  drive(world, robot, 0.5, up);
  const double before = world.robots().state(robot).links[0].linear.x;
  drive(world, robot, 0.5, up);
  const double gained = (world.robots().state(robot).links[0].linear.x - before) / std::cos(steep.angle);
  const double expected = 0.5 * kG * (0.7 * std::cos(steep.angle) - std::sin(steep.angle));
  EXPECT_NEAR(gained, expected, 0.01 * -expected);
}

// Across a slope: it stands while its weight falls between the tracks.
TEST(Crawler, TipsOverWhereItsWeightLeavesTheTracks) {
  RobotModel model = make_crawler(bare(2));
  model.links[0].centre_of_mass.z = 0.6;  // a load on a mast
  double height = 0, mass = 0;
  for (const RobotLink& link : model.links) {
    height += link.mass * link.centre_of_mass.z;
    mass += link.mass;
  }
  height /= mass;
  const double half_width = 0.5 * (kCrawlerTrackDistance + 0.097);
  const double limit = std::atan2(half_width, height) / kDegree;
  EXPECT_GT(limit, 25);
  for (double off : {-1.0, 1.0}) {
    const Slope slope(limit + off, 2);
    World world = slope.make();
    Pose base = slope.base();
    base.rotation = base.rotation * testing::turned({0, 0, 1}, 90 * kDegree);
    const int robot = world.robots().add(model, base);
    drive(world, robot, 3, [&](double) { return drive_sides(model, 0, 0); });
    const double up = dot(slope.turn.rotate({0, 0, 1}),
                          world.robots().state(robot).links[0].world_from_link.rotation.rotate({0, 0, 1}));
    if (off < 0) {
      EXPECT_GT(up, 0.999);
    } else {
      EXPECT_LT(up, 0.5);
    }
  }
}

// The slip of every point of the tracks and the loads that press them give the motion: that for which
// the power of friction is least. Its gradient is the balance of forces and of moments.
class SkidSteering {
 public:
  // A point under a track in the robot's frame, its load and the belt's speed.
  void add(double x, double y, double load, double belt) { points_.push_back({x, y, load, belt}); }
  // Of motion v forwards, u to the left and w about Z; unit: N m/s without the coefficient
  double power(double v, double u, double w) const {
    double sum = 0;
    for (const Point& p : points_) sum += p.load * std::hypot(v - w * p.y - p.belt, u + w * p.x);
    return sum;
  }
  double find_yaw_rate() const {
    double best[3] = {0, 0, 0};
    for (double size = 0.2; size > 1e-7; size *= 0.5) {
      for (bool better = true; better;) {
        better = false;
        for (int k = 0; k < 6; ++k) {
          double next[3] = {best[0], best[1], best[2]};
          next[k / 2] += k % 2 ? size : -size;
          if (power(next[0], next[1], next[2]) >= power(best[0], best[1], best[2])) continue;
          std::copy(next, next + 3, best);
          better = true;
        }
      }
    }
    return best[2];
  }

 private:
  struct Point {
    double x, y, load, belt;
  };
  std::vector<Point> points_;
};

// Odometry from the tracks' speeds believes in 1 rad/s; the truth is less than half of it.
TEST(Crawler, TurnsOnTheSpotAsSlipAllowsNotAsOdometrySays) {
  World world = make_robot_world();
  const RobotModel model = make_crawler(bare());
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  const auto turn = [&](double) { return drive_sides(model, 0, 1); };
  drive(world, robot, 1, turn);
  const double start = yaw_of(world, robot);
  SkidSteering steering;
  for (int i = 0; i < 60; ++i) {
    drive(world, robot, testing::kRobotStep * 4, turn);
    const RobotState state = world.robots().state(robot);
    const Pose robot_from_world = state.links[0].world_from_link.inverse();
    for (const RobotContact& c : world.robots().contacts(robot)) {
      const Vec3 p = robot_from_world * c.point;
      steering.add(p.x, p.y, c.force, state.links[std::size_t(c.link)].belt_speed);
    }
  }
  const double rate = yaw_of(world, robot) - start;
  EXPECT_NEAR(rate, steering.find_yaw_rate(), 0.05 * rate);
  EXPECT_LT(rate, 0.6);
  EXPECT_GT(rate, 0.3);
}

// A step of 25 cm is more than the tracks' height of 18 cm: only flippers get on it.
double climb(bool flippers, double height) {
  PieceType block = testing::box_type("block", 3, 3, height);
  World world = make_robot_world({block});
  world.add({testing::at(0, {2.2, 0, 0.5 * height}, {}, true)});
  CrawlerOptions options;
  options.flippers = flippers;
  const RobotModel model = make_crawler(options);
  const int robot = world.robots().add(model, {{}, {-0.3, 0, 0.001}});
  // Front flippers up at 50 degrees, then level; rear ones push down.
  drive(world, robot, 8, [&](double t) {
    const double front = t < 4 ? 0.9 : 0, rear = t < 2.5 ? 0.2 : -0.5;
    return drive_sides(model, 0.4, 0, {front, front, rear, rear});
  });
  return position_of(world, robot).z;
}

TEST(Crawler, ClimbsAStepWithItsFlippersOnly) {
  EXPECT_GT(climb(true, 0.25), 0.23);
  EXPECT_LT(climb(false, 0.25), 0.15);
}

TEST(Rover, RollsAsItsWheelsTurn) {
  World world = make_robot_world();
  const RobotModel model = make_rover();
  const int robot = world.robots().add(model, {{}, {0, 0, 0.001}});
  const auto forward = [&](double) { return drive_sides(model, 0.5, 0); };
  drive(world, robot, 1, forward);
  const double start = position_of(world, robot).x;
  const double turned = world.robots().state(robot).joints[0].position;
  drive(world, robot, 2, forward);
  const double way = position_of(world, robot).x - start;
  const double angle = world.robots().state(robot).joints[0].position - turned;
  EXPECT_NEAR(angle, 2 * 0.5 / kRoverWheelRadius, 0.02 * angle);
  EXPECT_NEAR(way, angle * kRoverWheelRadius, 0.01 * way);  // a polygon of 32 sides rolls 0.3 % farther
}

// A robot in free space that thrashes about and hits a box: the sums of both stay.
TEST(Robot, RobotAndDebrisKeepTheirMomentum) {
  World world = make_robot_world({testing::box_type("box", 0.1, 0.1, 0.1)}, 1, 0);
  const int box = world.add({testing::at(0, {-0.3, 0.075, 1})});
  const RobotModel model = make_snake();
  const int robot = world.robots().add(model, {{}, {0, 0, 1}});
  bool touched = false;
  const auto thrash = [&](double t) {
    touched = touched || world.is_touching(box);
    SnakeGait gait = sidewinding();
    gait.ramp = 0.2;
    return calc_gait(model, gait, t);
  };
  drive(world, robot, 3, thrash);
  EXPECT_TRUE(touched);
  EXPECT_GT(norm(world.piece(box).linear_velocity) * world.mass(box), 0.01);
  // Friction acts on both a millimetre apart, where they were at the start of the step.
  const double given = norm(world.piece(box).linear_velocity) * world.mass(box);
  EXPECT_LT(norm(world.diagnostics().linear_momentum()), 1e-4 * given);
  EXPECT_LT(norm(world.diagnostics().angular_momentum()), 0.01 * given);
  // What moves has been given by the motors.
  double work = 0;
  for (const RobotState::Joint& joint : world.robots().state(robot).joints) work += joint.work;
  EXPECT_GT(work, world.diagnostics().kinetic_energy());
}

// A sleeping brick in the way of a crawler wakes, and slides as friction and push say.
TEST(Robot, ASleepingPieceThatIsPushedWakesAndSlides) {
  World world = make_robot_world({testing::box_type("brick", 0.22, 0.11, 0.065)});
  const int brick = world.add({testing::at(0, {0.6, 0, 0.0335}, testing::turned({0, 0, 1}, 1.5707963))});
  for (int i = 0; i < 240; ++i) world.step();
  ASSERT_FALSE(world.is_awake(brick));
  const RobotModel model = make_crawler(bare());
  RobotModel plough = model;  // a body down to the ground
  plough.links[0].parts = {make_box({0.7, 0.3, 0.15}, {0.02, 0, 0.085})};
  const int robot = world.robots().add(plough, {{}, {0, 0, 0.001}});
  drive(world, robot, 3, [&](double) { return drive_sides(model, 0.2, 0); });
  const double pushed = world.piece(brick).world_from_body.translation.x;
  EXPECT_NEAR(pushed, position_of(world, robot).x + 0.37 + 0.055, 0.005);
  EXPECT_NEAR(world.piece(brick).linear_velocity.x, 0.2, 0.01);
  // Stopped, it sleeps again only when it lies still, and far from what is driven.
  drive(world, robot, 1, [&](double) { return drive_sides(model, -0.2, 0); });
  EXPECT_FALSE(world.is_awake(brick));
}

// Only links move: nothing is there for the sweeps, however many contacts there are.
TEST(Snake, ManyAloneMoveAlikeOnAnyNumberOfThreads) {
  SnakeOptions options;
  options.modules = 64;
  const RobotModel model = make_snake(options);
  std::vector<Vec3> centres;
  for (const int threads : {1, 2, 4, 8}) {
    World world = make_robot_world({}, threads);
    for (int i = 0; i < 6; ++i) world.robots().add(model, {{}, {0, double(i), 0.03}});
    for (int i = 0; i < 8; ++i) world.step();
    for (int i = 0; i < 6; ++i) centres.push_back(testing::centre_of(world, i));
  }
  for (std::size_t i = 6; i < centres.size(); ++i) EXPECT_EQ(centres[i], centres[i % 6]);
}

}  // namespace robot_ground_test
}  // namespace rubble
