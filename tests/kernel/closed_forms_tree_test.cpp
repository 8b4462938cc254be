// Slow articulated debris loses nothing that friction does not take.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_forms.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace closed_forms_tree_test {

using namespace testing;

const Quat kAboutY{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};  // takes Z to Y

// A block, then `count` bars of 1 m that hang from it one below the other, on hinges about Y.
AssemblyType make_hanging(int count) {
  AssemblyType chain;
  chain.name = "hanging";
  chain.links.push_back({0, {}, 1});
  for (int i = 0; i < count; ++i) {
    chain.links.push_back({1, {{}, {0, 0, -0.5 - i}}, 1});
    JointType joint;
    joint.parent = i;
    joint.child = i + 1;
    joint.kind = JointKind::hinge;
    joint.assembly_from_joint = {kAboutY, {0, 0, -double(i)}};
    chain.joints.push_back(joint);
  }
  return chain;
}

// The share of the energy of a swing that is left after so many seconds.
double swing(int count, double angle, double seconds) {
  World world({box_type("block", 0.1, 0.1, 0.1), box_type("bar", 0.04, 0.04, 1)}, awake_options(),
              {make_hanging(count)});
  world.add({at(PieceKind::assembly(0), {0, 0, 6}, turned({0, 1, 0}, angle), true)});
  const double bar = world.mass(1);
  double lowest = 0;  // all bars upright
  for (int i = 0; i < count; ++i) lowest += bar * kG * (6 - 0.5 - i);
  const auto energy = [&] { return world.diagnostics().kinetic_energy() + world.diagnostics().potential_energy() - lowest; };
  const double at_first = energy();
  EXPECT_GT(at_first, 0);
  run(world, seconds);
  return energy() / at_first;
}

// Ten periods each, of 1.64 s and 3.4 s in the slowest mode.
TEST(ClosedFormTree, ASlowPendulumKeepsItsEnergy) {
  for (const double angle : {0.02, 0.1, 0.5}) EXPECT_NEAR(swing(1, angle, 17), 1, 0.03) << angle;
}

TEST(ClosedFormTree, ASlowChainKeepsItsEnergy) {
  for (const double angle : {0.02, 0.1}) EXPECT_NEAR(swing(4, angle, 35), 1, 0.03) << angle;
}

// Two slabs joined by a hinge across them, flat on ground without friction.
World make_sliding(const Vec3& speed, double spin, bool sleeping) {
  PieceType slab = box_type("slab", 0.8, 0.6, 0.1);
  slab.friction = 0;
  AssemblyType pair;
  pair.name = "pair";
  pair.links = {{0, {}, 1}, {0, {{}, {0.85, 0, 0}}, 1}};
  JointType hinge;
  hinge.kind = JointKind::hinge;
  hinge.assembly_from_joint = {kAboutY, {0.425, 0, 0}};
  pair.joints = {hinge};
  WorldOptions options;
  options.sleeping = sleeping;
  World world({slab}, options, {pair});
  world.add({at(PieceKind::assembly(0), {0, 0, 0.051})});
  const Vec3 arm{-0.425, 0, 0};  // of the first link from the middle
  world.set_velocity(0, speed + cross(Vec3{0, 0, spin}, arm), {0, 0, spin});
  return world;
}

TEST(ClosedFormTree, ASlowTreeWithoutFrictionSlidesOn) {
  for (const bool sleeping : {false, true}) {
    World world = make_sliding({0.05, 0, 0}, 0, sleeping);
    const double start = world.piece(0).world_from_body.translation.x;
    const double momentum = world.diagnostics().linear_momentum().x;
    run(world, 5);
    EXPECT_TRUE(world.is_touching(0));
    EXPECT_NEAR(world.diagnostics().linear_momentum().x, momentum, 0.01 * momentum) << sleeping;
    EXPECT_NEAR(world.piece(0).world_from_body.translation.x - start, 0.25, 0.0025) << sleeping;
  }
}

TEST(ClosedFormTree, ASlowTreeWithoutFrictionTurnsOn) {
  World world = make_sliding({}, 0.2, false);
  const double turning = world.diagnostics().angular_momentum().z;
  run(world, 5);
  EXPECT_TRUE(world.is_touching(0));
  EXPECT_NEAR(world.diagnostics().angular_momentum().z, turning, 0.01 * turning);
}

// An arm on a ball joint that lies on a smooth ramp of 5 degrees and swings there like a pendulum
// under g sin(a), half its weight on the ramp: nothing takes its energy.
TEST(ClosedFormTree, ASlowPendulumThatLiesOnASmoothRampSwingsOn) {
  const double slope = 0.0873, angle = 0.2, length = 1, thick = 0.1, from_joint = 0.55;
  PieceType arm = box_type("arm", length, thick, thick), ramp = box_type("ramp", 6, 6, 1);
  arm.friction = ramp.friction = 0;
  AssemblyType swing;
  swing.name = "swing";
  swing.links = {{0, {}, 1}, {1, {{}, {from_joint, 0, 0}}, 1}};
  swing.joints = {JointType{}};
  swing.joints[0].kind = JointKind::ball;
  World world({box_type("post", 0.05, 0.05, 0.05), arm, ramp}, awake_options(), {swing});
  const Quat down = turned({0, 1, 0}, slope);
  world.add({at(2, {0, 0, 3}, down, true),
             at(PieceKind::assembly(0), Vec3{0, 0, 3} + down.rotate({0, 0, 0.5 + thick / 2 + 0.001}),
                down * turned({0, 0, 1}, angle), true)});
  const double gyration_squared = (length * length + thick * thick) / 12 + from_joint * from_joint;
  const double period = 2 * 3.14159265358979 * (1 + angle * angle / 16) *
                        std::sqrt(gyration_squared / (kG * std::sin(slope) * from_joint));
  bool touched = true;
  const double end = 2 * period;
  double highest = 0;  // of the second swing to this side
  while (world.time() < end) {
    world.step();
    touched = touched && world.is_touching(2);
    const double side = world.piece(2).world_from_body.translation.y / from_joint;
    if (world.time() > 1.5 * period) highest = std::max(highest, side);
  }
  EXPECT_TRUE(touched);
  EXPECT_NEAR(highest, std::sin(angle), 0.04 * angle);  // its amplitude
  EXPECT_NEAR(world.piece(2).world_from_body.translation.y / from_joint, std::sin(angle),
              0.05 * angle);  // at the end of a period
}

}  // namespace closed_forms_tree_test
}  // namespace rubble
