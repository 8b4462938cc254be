// The robot that grows from its tip, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>

#include "kernel/base/error.h"
#include "kernel/robot/robot_run.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world_robots.h"
#include "robot_scenes.h"

namespace rubble {
namespace vine_test {

using testing::kRobotStep;
using testing::make_robot_world;

constexpr double kG = 9.81, kPi = 3.14159265358979;

VineOptions vine_of(double pressure, double radius, double length) {
  VineOptions options;
  options.tube.pressure = pressure;
  options.tube.radius = radius;
  options.tube.links = count_vine_links(length, options.tube.link_length);
  return options;
}

struct Growth {
  double speed = 0, curve_left = 0, curve_up = 0;  // unit: m/s, 1/m
};

// Grows for some seconds; `look` after each step, false to stop.
void grow(World& world, int robot, double seconds, const Growth& growth,
          const std::function<bool(const RobotState&)>& look = {}) {
  const RobotModel model = world.robots().model(robot);
  for (int i = 0; i < int(seconds / kRobotStep + 0.5); ++i) {
    if (i % 4 == 0) world.robots().set_command(robot, grow_tube(model, growth.speed, growth.curve_left, growth.curve_up));
    world.step();
    if (look && !look(world.robots().state(robot))) return;
  }
}

// A tube that grows out over an edge until its own weight folds it at the root.
struct Overhang {
  double most = 0;    // moment at the root; N m
  double length = 0;  // when the root has folded by 0.15 rad; m
};

double collapse_length(const VineOptions& options) {
  // m g L + w g L^2 / 2 = pi P R^3; the tip's centre of mass is near the end.
  const double m = options.tip_mass, w = options.tube.mass_per_length();
  return (-m + std::sqrt(m * m + 2 * w * options.tube.collapse_moment() / kG)) / w;
}

Overhang grow_over_an_edge(VineOptions options) {
  options.tube.start_links = int(0.6 * collapse_length(options) / options.tube.link_length);
  World world = make_robot_world();
  const int robot = world.robots().add(make_vine(options), {{}, {0, 0, 50}});
  grow(world, robot, 1, {});
  Overhang result;
  grow(world, robot, 60, {0.06, 0, 0}, [&](const RobotState& state) {
    result.most = std::max(result.most, -state.joints[0].load_moment.y);
    result.length = state.length;
    return state.joints[0].position < 0.15;
  });
  return result;
}

// The length goes with the diameter and with the root of the pressure.
TEST(VineCollapse, CollapsesUnderItsOwnWeight) {
  double first = 0;
  for (const auto& [pressure, radius] : {std::pair{10e3, 0.05}, {20e3, 0.05}, {10e3, 0.04}}) {
    VineOptions options = vine_of(pressure, radius, 6);
    options.tip_mass = 0.001;
    options.tube.membrane_stiffness = 1e6;  // else it bends far before it collapses
    const Overhang overhang = grow_over_an_edge(options);
    const double collapse = kPi * pressure * radius * radius * radius, length = collapse_length(options);
    EXPECT_NEAR(overhang.most, collapse, 0.02 * collapse) << pressure << ' ' << radius;
    EXPECT_NEAR(overhang.length, length, 0.04 * length) << pressure << ' ' << radius;
    if (first == 0) first = overhang.length;
    const double ratio = std::sqrt(pressure / 10e3) * radius / 0.05;
    EXPECT_NEAR(overhang.length / first, ratio, 0.02 * ratio) << pressure << ' ' << radius;
  }
}

// Loaded by a weight at its end, the root bends in proportion up to pi P R^3 / 2, and more from there on.
TEST(VineCollapse, WrinklesAtHalfTheCollapseMoment) {
  for (const auto& [pressure, radius] : {std::pair{10e3, 0.05}, {20e3, 0.05}, {10e3, 0.04}}) {
    for (const double share : {0.98, 1.02}) {
      VineOptions options = vine_of(pressure, radius, 0.6);
      options.tube.start_links = options.tube.links;
      const double length = options.tube.length();
      const double wanted = share * 0.5 * kPi * pressure * radius * radius * radius;
      const double own = 0.5 * options.tube.mass_per_length() * kG * length * length;
      const double arm = length + make_vine(options).links.back().centre_of_mass.x;
      options.tip_mass = (wanted - own) / (kG * arm);
      World world = make_robot_world();
      const int robot = world.robots().add(make_vine(options), {{}, {0, 0, 5}});
      grow(world, robot, 5, {});
      const RobotState::Joint root = world.robots().state(robot).joints[0];
      const double moment = -root.load_moment.y;
      EXPECT_NEAR(moment, wanted, 0.002 * wanted);
      const double stiffness = options.tube.bending_stiffness() / options.tube.link_length;
      const double more = root.position * stiffness / moment - 1;
      if (share < 1) {
        EXPECT_NEAR(more, 0, 1e-4);
      } else {
        EXPECT_GT(more, 1e-3);
      }
    }
  }
}

// F L^3 / 3 E I and w L^4 / 8 E I.
TEST(Vine, ATautTubeBendsAsABeam) {
  VineOptions options = vine_of(30e3, 0.05, 1.5);
  options.tube.start_links = options.tube.links;
  World world = make_robot_world();
  const RobotModel model = make_vine(options);
  const int robot = world.robots().add(model, {{}, {0, 0, 5}});
  grow(world, robot, 4, {});
  const double l = options.tube.length(), ei = options.tube.bending_stiffness();
  const double w = options.tube.mass_per_length() * kG, f = options.tip_mass * kG;
  const double expected = f * l * l * l / (3 * ei) + w * l * l * l * l / (8 * ei);
  const double found = 5 - world.robots().state(robot).links.back().world_from_link.translation.z;
  EXPECT_NEAR(found, expected, 0.03 * expected);
}

TEST(Vine, WhatHasGrownDoesNotSlide) {
  const VineOptions options = vine_of(10e3, 0.05, 2);
  World world = make_robot_world();
  const RobotModel model = make_vine(options);
  const int robot = world.robots().add(model, {{}, {0, 0, options.tube.radius + 0.001}});
  std::vector<Vec3> laid;  // where each link was laid, by link
  double most = 0;
  grow(world, robot, 8, {0.2, 0, 0}, [&](const RobotState& state) {
    const std::size_t links = std::size_t(state.length / options.tube.link_length + 1e-9);
    for (std::size_t i = laid.size(); i < links; ++i) {
      laid.push_back(state.links[i + 1].world_from_link.translation);
    }
    for (std::size_t i = 0; i < laid.size(); ++i) {
      most = std::max(most, distance(laid[i], state.links[i + 1].world_from_link.translation));
    }
    return true;
  });
  EXPECT_NEAR(world.robots().state(robot).length, 0.1 + 8 * 0.2, 0.02);
  EXPECT_GT(laid.size(), 30u);
  EXPECT_LT(most, 0.001);
}

// Against a wall that does not give way.
TEST(Vine, StopsGrowingAtTheForceOfItsPressure) {
  for (const auto& [pressure, radius] : {std::pair{10e3, 0.05}, {25e3, 0.03}}) {
    World world = make_robot_world({testing::box_type("wall", 0.5, 2, 2)});
    world.add({testing::at(0, {0.9, 0, 1}, {}, true)});  // its face is 0.65 m away
    const VineOptions options = vine_of(pressure, radius, 1.5);
    const RobotModel model = make_vine(options);
    const int robot = world.robots().add(model, {{}, {0, 0, radius + 0.001}});
    double force = 0, length = 0;
    int count = 0;
    grow(world, robot, 5, {0.2, 0, 0}, [&](const RobotState& state) {
      if (world.time() < 4) length = state.length;
      if (world.time() < 4) return true;
      force += -state.links.back().contact_force.x;
      ++count;
      return true;
    });
    const RobotState state = world.robots().state(robot);
    const EvertingTube& tube = options.tube;
    const double expected = (pressure - tube.yield_pressure) * kPi * radius * radius - tube.tail_drag * state.length;
    EXPECT_NEAR(force / count, expected, 0.02 * expected);
    EXPECT_NEAR(state.length, length, 1e-4) << "it was to stand still";
    EXPECT_NEAR(state.length + 0.95 * radius, 0.65, 0.01);
  }
}

// With less pressure than turns the wall inside out, it does not grow; beyond, as fast as the losses allow.
TEST(Vine, GrowsAsFastAsThePressureAllows) {
  VineOptions options = vine_of(1.4e3, 0.05, 1.5);
  for (const double pressure : {1.4e3, 4e3}) {
    options.tube.pressure = pressure;
    World world = make_robot_world();
    const int robot = world.robots().add(make_vine(options), {{}, {0, 0, 0.051}});
    grow(world, robot, 1, {0.3, 0, 0});
    const double start = world.robots().state(robot).length;
    grow(world, robot, 2, {0.3, 0, 0});
    const EvertingTube& tube = options.tube;
    const double drag = tube.tail_drag * (start + 0.1) / tube.area();
    const double expected = std::max(0.0, tube.extensibility * (pressure - tube.yield_pressure - drag));
    EXPECT_NEAR((world.robots().state(robot).length - start) / 2, expected, 0.03 * expected + 1e-6) << pressure;
  }
}

// Pinned by its tip against a wall and clamped in its base: 20.19 E I / L^2. Below, it stops; above, it gives
// way to the side and goes on growing.
TEST(VineCollapse, BucklesBetweenBaseAndWallAtEulersLength) {
  for (const double pressure : {10e3, 20e3}) {
    VineOptions options = vine_of(pressure, 0.05, 5);
    options.tube.membrane_stiffness = 2e4;
    const double force = options.tube.tip_force(1.5, 0);
    const double euler = std::sqrt(20.19 * options.tube.bending_stiffness() / force);
    for (const double share : {0.85, 1.2}) {
      World world = make_robot_world({testing::box_type("wall", 0.5, 4, 4)}, 1, 0.05);
      const double wall = share * euler;
      world.add({testing::at(0, {wall + 0.25, 0, 2}, {}, true)});
      const int robot = world.robots().add(make_vine(options), {{}, {0, 0, 2}});
      grow(world, robot, wall / 0.2 + 6, {0.2, 0, 0});
      const double beyond = world.robots().state(robot).length - wall;
      EXPECT_EQ(beyond > 0.1, share > 1) << pressure << ' ' << beyond;
    }
  }
}

// What grows is curved as commanded.
TEST(Vine, SteersByTheCurvatureOfWhatGrows) {
  World world = make_robot_world({}, 1, 0);
  const int robot = world.robots().add(make_vine(vine_of(10e3, 0.05, 2)), {{}, {0, 0, 3}});
  grow(world, robot, 5, {0.2, 0.8, 0.5});
  grow(world, robot, 1, {});
  const RobotState state = world.robots().state(robot);
  const Vec3 x = state.links.back().world_from_link.rotation.rotate({1, 0, 0});
  const double grown = state.length - 0.1, turned = std::acos(x.x);
  EXPECT_NEAR(turned, grown * std::hypot(0.8, 0.5), 0.04 * turned);
  EXPECT_NEAR(std::atan2(x.z, x.y), std::atan2(0.5, 0.8), 0.06);
  EXPECT_GT(x.y, 0);
  EXPECT_GT(x.z, 0);
}

TEST(Vine, ASnapshotInMidGrowthGoesOnWithTheSameBits) {
  const VineOptions options = vine_of(10e3, 0.05, 2);
  const auto make = [&] {
    World world = make_robot_world({testing::box_type("brick", 0.22, 0.105, 0.065)});
    world.add({testing::at(0, {0.5, 0.03, 0.033}), testing::at(0, {0.62, -0.02, 0.1})});
    world.robots().add(make_vine(options), {{}, {0, 0, 0.051}});
    return world;
  };
  const Growth growth{0.25, 0.3, 0.1};
  World world = make();
  grow(world, 0, 2.1, growth);
  const auto snapshot = world.snapshot();
  const double half = world.robots().state(0).length;
  grow(world, 0, 2, growth);
  EXPECT_GT(world.robots().state(0).length, half + 0.2);
  World other = make();
  other.restore(*snapshot);
  grow(other, 0, 2, growth);
  EXPECT_EQ(testing::hash_of(world), testing::hash_of(other));
  grow(other, 0, 0.1, {0.2, 0.3, 0.1});
  grow(world, 0, 0.1, {0.2, 0.3, 0.2});
  EXPECT_NE(testing::hash_of(world), testing::hash_of(other)) << "the hash was to see the steering";
}

// A base is immovable, and so is what sleeps or is fixed: their overlap is found all the same.
void expect_base_in_brick(bool fixed) {
  Pile pile;
  pile.types = {testing::box_type("brick", 0.22, 0.105, 0.065)};
  pile.placed.push_back({0, 1, {{}, {-0.15, 0.1, 0.034}}, fixed});
  const PileState state = settle_pile(pile);
  RobotRunOptions options;
  options.duration = 0.1;
  options.threads = 1;
  RobotRun run(pile, state, options);
  const RobotModel model = make_vine();
  run.add(model, {{}, {0, 0, 0.051}}, [&](const RobotSense&) { return grow_tube(model, 0); });
  try {
    run.run();
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.diagnostics()[0].text();
    EXPECT_NE(text.find("base_link stands 0.0"), std::string::npos) << text;
    EXPECT_NE(text.find("deep in brick (piece 0)"), std::string::npos) << text;
    EXPECT_NE(text.find("move it by"), std::string::npos) << text;
  }
}

TEST(Vine, ABaseInAPieceIsNamed) { expect_base_in_brick(false); }
TEST(Vine, ABaseInAFixedPieceIsNamed) { expect_base_in_brick(true); }

// The same place without the brick has room.
TEST(Vine, ABaseBesideAFixedPieceHasRoom) {
  Pile pile;
  pile.types = {testing::box_type("brick", 0.22, 0.105, 0.065)};
  pile.placed.push_back({0, 1, {{}, {-0.15, 0.2, 0.034}}, true});
  RobotRunOptions options;
  options.duration = 0.1;
  options.threads = 1;
  RobotRun run(pile, settle_pile(pile), options);
  const RobotModel model = make_vine();
  run.add(model, {{}, {0, 0, 0.051}}, [&](const RobotSense&) { return grow_tube(model, 0); });
  EXPECT_NO_THROW(run.run());
}

TEST(Vine, MistakesAreNamed) {
  const auto mistake_of = [](const VineOptions& options) {
    try {
      validate(make_vine(options), "vine");
    } catch (const InputError& error) {
      return error.diagnostics()[0].text();
    }
    return std::string("none");
  };
  EXPECT_EQ(mistake_of({}), "none");
  VineOptions bad;
  bad.tube.pressure = 0;
  EXPECT_NE(mistake_of(bad).find("tube.pressure"), std::string::npos) << mistake_of(bad);
  bad = {};
  bad.tube.start_links = 99;
  EXPECT_NE(mistake_of(bad).find("tube.start_links"), std::string::npos) << mistake_of(bad);
}

// CPU time, of all steps and of the longest quarter second: also where links are laid.
TEST(NightlyVine, AStepWith100LinksTakesLessThan10Milliseconds) {
  World world = make_robot_world();
  VineOptions options = vine_of(10e3, 0.05, 5.2);
  options.tube.start_links = 100;
  const int robot = world.robots().add(make_vine(options), {{}, {0, 0, 0.051}});
  grow(world, robot, 0.5, {0.2, 0, 0});
  const std::clock_t start = std::clock();
  grow(world, robot, 1, {0.2, 0, 0});
  const double step = double(std::clock() - start) / CLOCKS_PER_SEC * kRobotStep;
  std::printf("%.2f ms a step\n", 1e3 * step);
  EXPECT_LT(step, 0.010);
}

}  // namespace vine_test
}  // namespace rubble
