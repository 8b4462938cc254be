// Slow articulated debris loses nothing that friction does not take.
#include <gtest/gtest.h>

#include <cmath>

#include "closed_forms.h"

namespace rubble {
namespace {

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

// As large a share of the energy of a small swing as is left after 20 s: ten periods or more.
double swing(int count, double angle) {
  World world({box_type("block", 0.1, 0.1, 0.1), box_type("bar", 0.04, 0.04, 1)}, awake_options(),
              {make_hanging(count)});
  world.add({at(2, {0, 0, 6}, turned({0, 1, 0}, angle), true)});
  const double bar = world.mass(1);
  double lowest = 0;  // all bars upright
  for (int i = 0; i < count; ++i) lowest += bar * kG * (6 - 0.5 - i);
  const auto energy = [&] { return world.kinetic_energy() + world.potential_energy() - lowest; };
  const double at_first = energy();
  EXPECT_GT(at_first, 0);
  run(world, 20);
  return energy() / at_first;
}

TEST(ClosedFormTree, ASlowPendulumKeepsItsEnergy) {
  for (const double angle : {0.02, 0.1, 0.5}) EXPECT_NEAR(swing(1, angle), 1, 0.03) << angle;
}

TEST(ClosedFormTree, ASlowChainKeepsItsEnergy) {
  for (const double angle : {0.02, 0.1}) EXPECT_NEAR(swing(4, angle), 1, 0.03) << angle;
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
  world.add({at(1, {0, 0, 0.051})});
  const Vec3 arm{-0.425, 0, 0};  // of the first link from the middle
  world.set_velocity(0, speed + cross(Vec3{0, 0, spin}, arm), {0, 0, spin});
  return world;
}

TEST(ClosedFormTree, ASlowTreeWithoutFrictionSlidesOn) {
  for (const bool sleeping : {false, true}) {
    World world = make_sliding({0.05, 0, 0}, 0, sleeping);
    const double start = world.piece(0).world_from_body.translation.x;
    const double momentum = world.linear_momentum().x;
    run(world, 5);
    EXPECT_TRUE(world.is_touching(0));
    EXPECT_NEAR(world.linear_momentum().x, momentum, 0.01 * momentum) << sleeping;
    EXPECT_NEAR(world.piece(0).world_from_body.translation.x - start, 0.25, 0.0025) << sleeping;
  }
}

TEST(ClosedFormTree, ASlowTreeWithoutFrictionTurnsOn) {
  World world = make_sliding({}, 0.2, false);
  const double turning = world.angular_momentum().z;
  run(world, 5);
  EXPECT_TRUE(world.is_touching(0));
  EXPECT_NEAR(world.angular_momentum().z, turning, 0.01 * turning);
}

// A gate: an arm on an upright hinge whose end rests on ground without friction, turning slowly. It
// touches, and nothing takes its spin.
TEST(ClosedFormTree, ASlowGateThatTouchesTheGroundTurnsOn) {
  PieceType arm = box_type("arm", 1, 0.1, 0.1);
  arm.friction = 0;
  AssemblyType gate;
  gate.name = "gate";
  gate.links = {{0, {}, 1}, {1, {{}, {0.55, 0, 0}}, 1}};
  JointType hinge;
  hinge.kind = JointKind::ball;  // so that the ground carries a half of its weight
  gate.joints = {hinge};
  World world({box_type("post", 0.05, 0.05, 0.2), arm}, awake_options(), {gate});
  world.add({at(2, {0, 0, 0.1}, turned({0, 1, 0}, 0.04), true)});
  run(world, 1);
  world.set_velocity(1, {0, 0.3 * 0.55, 0}, {0, 0, 0.3});
  const double energy = world.kinetic_energy();
  run(world, 5);
  EXPECT_TRUE(world.is_touching(1));
  EXPECT_NEAR(world.kinetic_energy(), energy, 0.05 * energy);
}

}  // namespace
}  // namespace rubble
