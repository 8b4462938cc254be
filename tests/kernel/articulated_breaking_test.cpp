// Joints that yield and break: at their loads, and what falls then.
#include <gtest/gtest.h>

#include <cmath>

#include "articulated_scene.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace articulated_breaking_test {

using testing::at;
using testing::awake_options;
using testing::box_type;
using testing::hung;
using testing::joint_of;
using testing::kG;
using testing::make_chain;
using testing::make_world;
using testing::run;

// A cantilever that its spring holds, or does not: the moment of its weight is m g L / 2.
TEST(Articulated, ASpringYieldsAtItsTorque) {
  const double length = 1, mass = 2400 * length * 0.1 * 0.1;
  const double moment = mass * kG * length / 2;
  for (JointKind kind : {JointKind::hinge, JointKind::ball}) {
    for (double share : {1.05, 0.95}) {
      JointType joint = joint_of(kind);
      joint.stiffness = 100 * moment;
      joint.damping = (share > 1 ? 6 : 0.5) * moment;  // it must not swing over the yield
      joint.yield = share * moment;
      joint.upper = 1.2;
      World world = make_world(make_chain(1, length, true, joint), length, awake_options(), 0.1);
      world.add({hung({0, 0, 5})});
      run(world, 4);
      const double drop = 5 - world.piece(1).world_from_body.translation.z;
      const JointState state = world.joints().at(0);
      const double rest = kind == JointKind::hinge
                              ? std::abs(state.rest)
                              : 2 * std::sqrt(1 - state.rest_rotation.w * state.rest_rotation.w);
      if (share > 1) {
        EXPECT_NEAR(drop, 0.01 * length / 2, 1e-4) << int(kind);  // moment / stiffness
        EXPECT_LT(rest, 1e-6);
      } else {
        // It droops until the arm of its weight is short enough.
        const double angle = std::acos(0.95);
        EXPECT_NEAR(drop, std::sin(angle) * length / 2, 0.02) << int(kind);
        EXPECT_GT(rest, 0.25) << int(kind);
      }
    }
  }
}

TEST(Articulated, AWeldBreaksAtItsLoad) {
  const double length = 1, mass = 2400 * length * 0.1 * 0.1;
  const double weight = mass * kG, moment = weight * length / 2;
  const auto falls = [&](double force, double torque) {
    JointType joint = joint_of(JointKind::weld);
    joint.break_force = force;
    joint.break_torque = torque;
    World world = make_world(make_chain(1, length, true, joint), length, awake_options(), 0.1);
    world.add({hung({0, 0, 5})});
    run(world, 0.5);
    const bool broke = world.joints().empty();
    EXPECT_EQ(broke, world.piece(1).world_from_body.translation.z < 4.5);
    return broke;
  };
  EXPECT_FALSE(falls(kNever, 1.001 * moment));
  EXPECT_TRUE(falls(kNever, 0.999 * moment));
  EXPECT_FALSE(falls(1.001 * weight, kNever));
  EXPECT_TRUE(falls(0.999 * weight, kNever));
}

// Two beams in a row: the joint at the wall carries 2 m g L, that in the middle m g L / 2. What
// hangs beyond the joint that breaks falls as a tree of its own.
TEST(Articulated, ATreeSplitsWhereItBreaks) {
  const double length = 1, moment = 2400 * 0.01 * kG * length / 2;
  JointType weld = joint_of(JointKind::weld);
  weld.break_torque = 2 * moment;
  AssemblyType beam = make_chain(2, length, true, weld);
  World world = make_world(beam, length, awake_options(), 0.1);
  world.add({hung({0, 0, 5})});
  run(world, 0.5);
  ASSERT_EQ(world.joints().size(), 1u);
  EXPECT_EQ(world.joints()[0].parent, 1);
  EXPECT_EQ(world.joints()[0].child, 2);
  EXPECT_EQ(world.piece(0).status, PieceStatus::fixed);
  const Vec3 fall =
      world.piece(1).world_from_body.translation - world.piece(2).world_from_body.translation;
  EXPECT_NEAR(norm(fall), length, 1e-9);  // still together
  EXPECT_NEAR(world.piece(1).linear_velocity.z, -kG * 0.5, 0.2);
  EXPECT_EQ(world.lost_count(), 0);
}

// Two boxes that are welded 10 cm deep into each other spin until the weld breaks: they are led out of
// each other by no more than 2 cm a step, and the way out gives them no speed.
TEST(Articulated, PiecesOfABrokenJointComeApartAndGainNoEnergy) {
  const double spin = 0.01;
  WorldOptions options = awake_options();
  options.gravity = 0;
  AssemblyType pair;
  pair.name = "pair";
  pair.links = {{0, {{}, {-0.15, 0, 0}}, 1}, {0, {{}, {0.15, 0, 0}}, 1}};
  pair.joints.emplace_back();
  pair.joints[0].kind = JointKind::weld;
  for (const double strength : {1.02, 0.98}) {
    const double mass = 2400 * 0.4 * 0.2 * 0.2;
    pair.joints[0].break_force = strength * mass * spin * spin * 0.15;
    World world({box_type("box", 0.4, 0.2, 0.2)}, options, {pair});
    NewPiece piece = at(PieceKind::assembly(0), {0, 0, 5});
    piece.angular_velocity = {0, 0, spin};
    piece.linear_velocity = {0, -0.15 * spin, 0};
    world.add({piece});
    const double energy = world.diagnostics().kinetic_energy();
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      const Vec3 before = world.piece(1).world_from_body.translation;
      world.step();
      fastest = std::max(fastest, distance(world.piece(1).world_from_body.translation, before));
      ASSERT_LT(world.diagnostics().kinetic_energy(), 1.0001 * energy) << i;
    }
    const double apart = distance(world.piece(0).world_from_body.translation,
                                  world.piece(1).world_from_body.translation);
    EXPECT_EQ(world.joints().empty(), strength < 1);
    EXPECT_LT(fastest, 0.0201);
    EXPECT_LT(norm(world.diagnostics().linear_momentum()), 1e-5 * mass * spin);
    if (strength < 1) {
      EXPECT_LT(world.diagnostics().deepest_overlap().depth, 0.001);
      EXPECT_GT(apart, 0.3 + 0.05);
    } else {
      EXPECT_NEAR(apart, 0.3, 1e-9);
    }
  }
}

}  // namespace articulated_breaking_test
}  // namespace rubble
