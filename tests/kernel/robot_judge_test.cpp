// Robots against MuJoCo: the same model, the same hulls, its own equations and contacts.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>

#include "kernel/robot/parts.h"
#include "kernel/world/world_robots.h"
#include "mujoco_judge.h"
#include "robot_scenes.h"

namespace rubble {
namespace robot_judge_test {

using testing::centre_of;
using testing::drive;
using testing::JudgeOptions;
using testing::make_robot_world;
using testing::MujocoJudge;

constexpr double kBefore = 2, kMeasured = 8;  // unit: s
// Its contacts are springs as stiff as the step allows: at 1/960 s a snake rolls 26 % more slowly than at
// 1/7680 s, at this step 3 %.
constexpr int kJudgeRate = 3840;  // unit: Hz

RobotModel make_judged_snake() {
  RobotModel model = make_snake();
  for (RobotJoint& joint : model.joints) {
    joint.motor.speed = 0;  // MuJoCo's servo knows no such limit,
    joint.lower = -kNever;  // and its stops give way
    joint.upper = kNever;
  }
  return model;
}

struct Scene {
  std::vector<std::pair<Vec3, Vec3>> boxes;
};

Scene flat() { return {}; }
// Low steps all over the place.
Scene boxes() {
  Scene scene;
  for (int i = -6; i <= 6; ++i) {
    for (int k = -6; k <= 6; ++k) {
      const double height = 0.01 + 0.005 * ((i * 7 + k * 3 + 100) % 4);
      scene.boxes.push_back({{0.33 * i, 0.33 * k, 0.5 * height}, {0.12, 0.2, height}});
    }
  }
  return scene;
}

std::vector<double> targets_of(const RobotCommand& command) {
  std::vector<double> targets;
  for (const MotorCommand& joint : command.joints) targets.push_back(joint.target);
  return targets;
}

// Way of the centre of mass; `phase` is another start of the same gait.
double measure_ours(const Scene& scene, SnakeGait gait, double phase) {
  std::vector<PieceType> types;
  std::vector<NewPiece> pieces;
  for (const auto& [centre, size] : scene.boxes) {
    PieceType type = testing::box_type("box", size.x, size.y, size.z);
    type.friction = 0.5;
    pieces.push_back(testing::at(int(types.size()), centre, {}, true));
    types.push_back(type);
  }
  World world = make_robot_world(types);
  world.add(pieces);
  const RobotModel model = make_judged_snake();
  const int robot = world.robots().add(model, {{}, {0, 0, 0.06}});
  const auto control = [&](double from) {
    return [&model, gait, from, phase](double t) mutable {
      SnakeGait shifted = gait;
      shifted.lateral_phase += phase;
      shifted.vertical_phase += phase;
      return calc_gait(model, shifted, from + t);
    };
  };
  drive(world, robot, kBefore, control(0));
  const Vec3 start = centre_of(world, robot);
  drive(world, robot, kMeasured, control(kBefore));
  const Vec3 way = centre_of(world, robot) - start;
  return std::hypot(way.x, way.y);
}

double measure_mujoco(const Scene& scene, SnakeGait gait, double phase) {
  JudgeOptions options;
  options.step = 1.0 / kJudgeRate;
  options.boxes = scene.boxes;
  const RobotModel model = make_judged_snake();
  MujocoJudge judge(model, {{}, {0, 0, 0.06}}, options);
  gait.lateral_phase += phase;
  gait.vertical_phase += phase;
  Vec3 start;
  for (int i = 0; i < int((kBefore + kMeasured) * kJudgeRate + 0.5); ++i) {
    if (i % (kJudgeRate / 60) == 0) {
      judge.set_positions(targets_of(calc_gait(model, gait, double(i) / kJudgeRate)));
    }
    if (i == int(kBefore * kJudgeRate)) start = judge.centre_of_mass();
    judge.step();
  }
  const Vec3 way = judge.centre_of_mass() - start;
  return std::hypot(way.x, way.y);
}

// Means over the seeds, which start the gait at other phases.
void compare(const char* name, const Scene& scene, const SnakeGait& gait, int seeds) {
  double ours = 0, mujoco = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const double phase = 6.2831853 * seed / seeds;
    const double a = measure_ours(scene, gait, phase), b = measure_mujoco(scene, gait, phase);
    std::printf("  %s seed %d: %.4f m, MuJoCo %.4f m in %g s\n", name, seed, a, b, kMeasured);
    ours += a / seeds;
    mujoco += b / seeds;
  }
  std::printf("%s: %.4f m/s, MuJoCo %.4f m/s\n", name, ours / kMeasured, mujoco / kMeasured);
  EXPECT_NEAR(ours, mujoco, 0.1 * mujoco) << name;
}

TEST(RobotJudge, SidewindingIsAsFastAsInMujoco) { compare("sidewinding", flat(), sidewinding(), 3); }
TEST(RobotJudge, RollingIsAsFastAsInMujoco) { compare("rolling", flat(), rolling(), 3); }
TEST(NightlyRobotJudge, GaitsAreAsFastAsInMujoco) {
  compare("sidewinding", flat(), sidewinding(), 10);
  compare("rolling", flat(), rolling(), 10);
  compare("undulation", flat(), lateral_undulation(), 10);
  compare("sidewinding over boxes", boxes(), sidewinding(), 10);
}

// A chain of six rods falls from level, hung at one end.
TEST(RobotJudge, AFallingChainGoesWhereMujocosGoes) {
  const double length = 0.2;
  RobotModel model;
  model.name = "chain";
  for (int i = 0; i <= 6; ++i) {
    RobotLink link;
    link.name = "rod_" + std::to_string(i);
    link.parts = {make_box({i == 0 ? 0.05 : length, 0.03, 0.02}, {i == 0 ? 0 : 0.5 * length, 0, 0})};
    set_mass(0.3, link);
    model.links.push_back(link);
    if (i == 0) continue;
    RobotJoint joint;
    joint.parent = i - 1;
    joint.child = i;
    joint.axis = i % 2 == 1 ? Vec3{0, 1, 0} : Vec3{0, 0.6, 0.8};  // not in one plane
    joint.parent_from_child.translation = {i == 1 ? 0 : length, 0, 0};
    model.joints.push_back(joint);
  }
  WorldOptions options;
  options.sleeping = false;
  options.step = testing::kRobotStep;
  World world(make_link_types(model), options, {make_assembly(model, 0)});
  world.add({testing::at(PieceKind::assembly(0), {0, 0, 3}, {}, true)});
  JudgeOptions judging;
  judging.fixed_base = true;
  judging.ground = false;
  judging.step = 1.0 / 9600;
  MujocoJudge judge(model, {{}, {0, 0, 3}}, judging);
  double worst = 0;
  for (int i = 0; i < 240; ++i) {
    world.step();
    for (int k = 0; k < 40; ++k) judge.step();
    for (int link = 1; link <= 6; ++link) {
      const Vec3 ours = world.piece(link).world_from_body.translation;
      worst = std::max(worst, distance(ours, judge.link_origin(std::size_t(link))));
    }
  }
  std::printf("falling chain: %.4f mm apart at most within 1 s\n", 1000 * worst);
  EXPECT_LT(worst, 1e-3);
}

// Step times side by side, in turns: the snake on the ground.
TEST(NightlyRobotJudge, StepTimesSideBySide) {
  const RobotModel model = make_judged_snake();
  World world = make_robot_world();
  const int robot = world.robots().add(model, {{}, {0, 0, 0.03}});
  JudgeOptions options;
  options.step = testing::kRobotStep;
  MujocoJudge judge(model, {{}, {0, 0, 0.03}}, options);
  const auto now = [] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  };
  double ours = 0, theirs = 0;
  std::size_t our_contacts = 0, their_contacts = 0;
  for (int i = 0; i < 960; ++i) {
    const RobotCommand command = calc_gait(model, rolling(), i * testing::kRobotStep);
    const double start = now();
    world.robots().set_command(robot, command);
    world.step();
    const double middle = now();
    judge.set_positions(targets_of(command));
    judge.step();
    ours += middle - start;
    theirs += now() - middle;
    our_contacts += world.robots().contacts(robot).size();
    their_contacts += std::size_t(judge.contacts());
  }
  std::printf("a step: %.1f us with %.1f manifolds, MuJoCo %.1f us with %.1f points, ratio %.2f\n",
              ours / 960 * 1e6, double(our_contacts) / 960, theirs / 960 * 1e6,
              double(their_contacts) / 960, ours / theirs);
  EXPECT_GT(our_contacts, 960u);
  EXPECT_GT(their_contacts, 960u);
}

}  // namespace robot_judge_test
}  // namespace rubble
