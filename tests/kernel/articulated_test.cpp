// How articulated debris moves: closed forms, conservation, friction.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "articulated_scene.h"
#include "kernel/base/random.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace articulated_test {

using testing::at;
using testing::awake_options;
using testing::box_type;
using testing::hung;
using testing::joint_of;
using testing::kG;
using testing::make_chain;
using testing::make_world;
using testing::measure_period;
using testing::run;
using testing::turned;

TEST(Articulated, ACompoundPendulumKeepsItsPeriod) {
  for (JointKind kind : {JointKind::hinge, JointKind::ball}) {
    const double length = 1;
    World world = make_world(make_chain(1, length, false, joint_of(kind)), length, awake_options());
    world.add({hung({0, 0, 5}, turned({0, 1, 0}, 0.03))});
    const double inertia = (length * length + 0.02 * 0.02) / 12 + length * length / 4;
    const double expected = 2 * 3.14159265358979 * std::sqrt(inertia / (kG * length / 2));
    EXPECT_NEAR(measure_period(world, 1, 20), expected, 1e-3 * expected) << int(kind);
    EXPECT_TRUE(world.is_touching(1));  // what hangs is held
  }
}

// Two equal thin rods: w^2 = 3 (1 - 2 / sqrt(7)) g / l in the slow mode, where the lower rod leans
// (2 sqrt(7) - 1) / 3 times as far as the upper.
TEST(Articulated, ADoublePendulumKeepsThePeriodOfItsSlowMode) {
  const double length = 1, angle = 0.02;
  const double lower = angle * (2 * std::sqrt(7.0) - 1) / 3;
  AssemblyType chain = make_chain(2, length, false, joint_of(JointKind::hinge));
  const auto rod = [&](const Vec3& top, double lean) {
    const Quat turn = turned({0, 1, 0}, lean);
    return Pose{turn * turned({0, 1, 0}, 1.5707963267948966),
                top + turn.rotate({0, 0, -0.5 * length})};
  };
  chain.links[1].assembly_from_link = rod({}, angle);
  const Vec3 knee = turned({0, 1, 0}, angle).rotate({0, 0, -length});
  chain.links[2].assembly_from_link = rod(knee, lower);
  chain.joints[1].assembly_from_joint.translation = knee;
  World world = make_world(chain, length, awake_options(), 0.01);
  world.add({hung({0, 0, 5})});
  const double w = std::sqrt(3 * (1 - 2 / std::sqrt(7.0)) * kG / length);
  EXPECT_NEAR(measure_period(world, 2, 25), 2 * 3.14159265358979 / w, 3e-3 * 6.2832 / w);
}

TEST(Articulated, ASliderFallsAlongItsGuide) {
  AssemblyType guide = make_chain(1, 0.5, true, joint_of(JointKind::slider));
  guide.joints[0].assembly_from_joint.rotation = {};
  guide.joints[0].upper = 4;
  World world = make_world(guide, 0.5, awake_options());
  const double tilt = 0.6;  // +X goes down
  world.add({hung({0, 0, 8}, turned({0, 1, 0}, tilt))});
  const Vec3 start = world.piece(1).world_from_body.translation;
  run(world, 1);
  const Vec3 moved = world.piece(1).world_from_body.translation - start;
  const double expected = 0.5 * kG * std::sin(tilt);
  EXPECT_NEAR(moved.x, expected * std::cos(tilt), 1e-9);
  EXPECT_NEAR(moved.z, -expected * std::sin(tilt), 1e-9);
  EXPECT_NEAR(norm(world.piece(1).linear_velocity), 2 * expected, 1e-9);
  run(world, 1);  // the stop at 4 m
  EXPECT_NEAR(distance(world.piece(1).world_from_body.translation, start), 4, 0.01);
}

// A dumb-bell of two welded boxes against one piece with two parts.
TEST(Articulated, WeldedLinksMoveAsOneRigidPiece) {
  PieceType dumbbell = box_type("dumbbell", 0.3, 0.3, 0.3);
  dumbbell.parts = {testing::box_part(0.3, 0.3, 0.3, {-0.5, 0, 0}),
                    testing::box_part(0.6, 0.2, 0.2, {0.5, 0, 0})};
  AssemblyType welded;
  welded.links = {{0, {{}, {-0.5, 0, 0}}, 1}, {1, {{}, {0.5, 0, 0}}, 1}};
  welded.joints = {joint_of(JointKind::weld)};
  const auto compare = [&](double gravity, double height, double seconds, const Vec3& speed,
                           const Vec3& spin, double tolerance) {
    WorldOptions options = awake_options();
    options.gravity = gravity;
    const std::vector<PieceType> types = {box_type("a", 0.3, 0.3, 0.3),
                                          box_type("b", 0.6, 0.2, 0.2), dumbbell};
    World tree(types, options, {welded}), piece(types, options);
    NewPiece one = at(PieceKind::assembly(0), {0, 0, height}, turned({1, 2, 3}, 0.3));
    NewPiece other = at(2, {0, 0, height}, turned({1, 2, 3}, 0.3));
    tree.add({one});
    piece.add({other});
    EXPECT_NEAR(tree.mass(0) + tree.mass(1), piece.mass(0), 1e-9);
    piece.set_velocity(0, speed, spin);
    // The same motion at the first link.
    const Vec3 arm = tree.piece(0).world_from_body.translation -
                     (tree.piece(0).world_from_body.translation * tree.mass(0) +
                      tree.piece(1).world_from_body.translation * tree.mass(1)) *
                         (1 / (tree.mass(0) + tree.mass(1)));
    tree.set_velocity(0, speed + cross(spin, arm), spin);
    EXPECT_NEAR(tree.diagnostics().kinetic_energy(), piece.diagnostics().kinetic_energy(), 1e-9);
    EXPECT_LT(norm(tree.diagnostics().linear_momentum() - piece.diagnostics().linear_momentum()), 1e-9);
    run(tree, seconds);
    run(piece, seconds);
    const Vec3 expected = piece.piece(0).world_from_body * Vec3{-0.5, 0, 0};
    const double apart = distance(tree.piece(0).world_from_body.translation, expected);
    EXPECT_LT(apart, tolerance);
    const Quat turn = tree.piece(0).world_from_body.rotation.conjugate() *
                      piece.piece(0).world_from_body.rotation;
    EXPECT_LT(norm(Vec3{turn.x, turn.y, turn.z}), tolerance);
    return apart;
  };
  compare(0, 20, 1, {0.3, 0, 1}, {}, 1e-9);
  compare(kG, 20, 1, {0.3, 0, 1}, turned({1, 2, 3}, 0.3).rotate({4, 0, 0}), 1e-3);  // long axis
  compare(kG, 20, 0.5, {}, {0.5, 2, 1}, 0.02);  // a single piece's spin is of first order only
  // Through its impact on the ground, to rest. It slides and tips, so a single fall says little.
  double apart = 0;
  const int falls = 9;
  for (int i = 0; i < falls; ++i) apart += compare(kG, 0.46 + 0.01 * i, 1.0, {}, {}, 0.02);
  EXPECT_LT(apart / falls, 0.006);
}

TEST(Articulated, AFreeTreeHitByAFreePieceKeepsMomentum) {
  WorldOptions options = awake_options();
  options.gravity = 0;
  const double length = 0.6;
  World world =
      make_world(make_chain(4, length, true, joint_of(JointKind::ball)), length, options, 0.1);
  NewPiece bullet = at(1, {1.3, 0.02, 7}, turned({1, 1, 0}, 0.7));
  bullet.linear_velocity = {0.2, 0, -3};
  world.add({at(PieceKind::assembly(0), {0, 0, 5}), bullet});
  const Vec3 before = world.diagnostics().linear_momentum(), turning = world.diagnostics().angular_momentum();
  const double energy = world.diagnostics().kinetic_energy();
  double last = energy;
  bool touched = false;
  for (int i = 0; i < 120; ++i) {
    world.step();
    touched = touched || (world.is_touching(5) && world.is_touching(2));
    EXPECT_LE(world.diagnostics().kinetic_energy(), last * (1 + 1e-5));
    last = world.diagnostics().kinetic_energy();
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(norm(world.diagnostics().linear_momentum() - before), 1e-3 * norm(before));
  EXPECT_LT(norm(world.diagnostics().angular_momentum() - turning), 0.02 * norm(turning));
  EXPECT_LT(last, 0.95 * energy);
  EXPECT_GT(norm(world.piece(1).linear_velocity), 0.05);  // the blow reaches both ends
}

// From horizontal, with a whip at every turn; then the same into a wall and onto the ground.
TEST(Articulated, ASwingingChainNeverGainsEnergy) {
  for (bool wall : {false, true}) {
    const double length = 0.5;
    AssemblyType chain = make_chain(5, length, true, joint_of(JointKind::hinge));
    for (int i = 1; i <= 5; ++i) {  // side by side: they do not meet each other
      chain.links[std::size_t(i)].assembly_from_link.translation.y = 0.1 * i;
    }
    World world = make_world(chain, length, awake_options(), 0.08);
    world.add({hung({0, 0, wall ? 2.2 : 4.0})});
    if (wall) world.add({at(1, {-0.4, 0.4, 1.2}, turned({0, 0, 1}, 1.5), true)});
    const double floor = world.diagnostics().potential_energy() - 5 * world.mass(1) * kG * 1.25;
    const double swing = world.diagnostics().potential_energy() - floor;
    double highest = 0, last = 0;
    for (int i = 0; i < 600; ++i) {
      world.step();
      last = world.diagnostics().kinetic_energy() + world.diagnostics().potential_energy() - floor;
      highest = std::max(highest, last);
    }
    EXPECT_LT(highest, 1.003 * swing) << wall;
    if (wall) {
      EXPECT_LT(last, 0.5 * swing);  // impacts take it
    } else {
      EXPECT_GT(last, 0.99 * swing);  // nothing takes it
    }
  }
}

TEST(Articulated, AHingeSpringSwingsAtItsFrequency) {
  WorldOptions options = awake_options();
  options.gravity = 0;
  const double length = 1;
  JointType joint = joint_of(JointKind::hinge);
  joint.stiffness = 40;
  AssemblyType arm = make_chain(1, length, false, joint);
  World world = make_world(arm, length, options);
  World bent = make_world(arm, length, options);
  world.add({hung({0, 0, 5})});
  const double inertia =
      world.mass(1) * ((length * length + 0.02 * 0.02) / 12 + length * length / 4);
  const double expected = 2 * 3.14159265358979 * std::sqrt(inertia / 40);
  // Struck by a light and fast piece.
  NewPiece bullet = at(0, {-0.3, 0, 4.1});
  bullet.placement.scale = 0.2;
  bullet.linear_velocity = {15, 0, 0};
  world.add({bullet});
  EXPECT_NEAR(measure_period(world, 1, 6 * expected + 0.2), expected, 0.01 * expected);
}

// A free piece on a hinged door pushes it open; the door pushes the piece.
TEST(Articulated, ImpulsesFlowBothWays) {
  WorldOptions options = awake_options();
  options.gravity = 0;
  AssemblyType door = make_chain(1, 1, true, joint_of(JointKind::hinge));
  World world({box_type("block", 0.1, 0.1, 0.1), box_type("leaf", 1, 0.8, 0.05)}, options, {door});
  NewPiece bullet = at(0, {0.9, 0, 3});
  bullet.placement.scale = 2;
  bullet.linear_velocity = {0, 0, 4};
  world.add({hung({0, 0, 5}), bullet});
  const double mass = world.mass(2), arm = 0.9;
  const double inertia = world.mass(1) * ((1 + 0.05 * 0.05) / 12 + 0.25);
  run(world, 0.55);
  // Plastic: the common speed at the arm follows from the moment about the hinge.
  const double turn = mass * 4 * arm / (mass * arm * arm + inertia);
  EXPECT_NEAR(std::abs(world.piece(1).angular_velocity.y), turn, 0.05 * turn);
  EXPECT_NEAR(world.piece(2).linear_velocity.z, turn * arm, 0.1 * turn * arm);
}

// An arm that dry friction holds, or lets down at (moment - friction) / inertia.
TEST(Articulated, DryFrictionHoldsAJointUpToItsTorque) {
  const double length = 1, mass = 2400 * length * 0.1 * 0.1;
  const double moment = mass * kG * length / 2;
  const double inertia = mass * ((length * length + 0.01) / 12 + length * length / 4);
  for (JointKind kind : {JointKind::hinge, JointKind::ball}) {
    for (double share : {1.02, 0.5}) {
      JointType joint = joint_of(kind);
      joint.friction = share * moment;
      World world = make_world(make_chain(1, length, true, joint), length, awake_options(), 0.1);
      world.add({hung({0, 0, 5})});
      run(world, share > 1 ? 3 : 0.2);
      const double drop = 5 - world.piece(1).world_from_body.translation.z;
      const double turn = 0.5 * (1 - share) * moment / inertia * 0.2 * 0.2;
      if (share > 1) {
        EXPECT_LT(drop, 1e-6) << int(kind);
      } else {
        EXPECT_NEAR(drop, 0.5 * length * turn, 0.03 * 0.5 * length * turn) << int(kind);
      }
    }
  }
}

// Nothing else brakes it: without friction it swings on, with it, it hangs still and sleeps.
TEST(Articulated, APendulumRestsByItsFrictionAlone) {
  for (bool dry : {false, true}) {
    JointType joint = joint_of(JointKind::hinge);
    if (dry) joint.friction = 0.03 * 2400 * 0.1 * 0.1 * kG * 0.5;
    World world = make_world(make_chain(1, 1, false, joint), 1, {}, 0.1);
    world.add({hung({0, 0, 5}, turned({0, 1, 0}, 0.4))});
    run(world, 20);
    EXPECT_EQ(world.awake_count(), dry ? 0 : 1);
    EXPECT_EQ(world.diagnostics().kinetic_energy() > 0, !dry);
  }
}

// Chains with friction or stops in their joints, which turn by a large part of a radian in a step after they have hit a slope: none
// of what they have comes from nothing.
TEST(Articulated, AChainThatTumblesDownASlopeGainsNoEnergy) {
  JointType dry = joint_of(JointKind::hinge), stopped = joint_of(JointKind::hinge), ball = joint_of(JointKind::ball);
  dry.friction = 30;
  stopped.lower = -0.5, stopped.upper = 0.5;
  ball.upper = 0.7;
  for (const JointType& joint : {dry, stopped, ball}) {
    for (int seed = 1; seed <= 6; ++seed) {
      RandomStream random(std::uint64_t(seed), "tumble");
      WorldOptions options = awake_options();
      options.sleeping = true;
      World world = make_world(make_chain(2, 1, true, joint), 1, options, 0.1);
      NewPiece slope = at(1, {0, 0, 0}, turned({0, 1, 0}, 0.5), true);
      slope.placement.scale = 40;
      world.add({slope});
      NewPiece chain = hung({0.1, 0, 8}, random.rotation());
      chain.placement.fixed = false;
      world.add({chain});
      const auto energy = [&world] {
        double sum = world.diagnostics().kinetic_energy();
        for (int i = 1; i < world.size(); ++i) sum += world.mass(i) * kG * (world.piece(i).world_from_body * world.centre_of_mass(i)).z;
        return sum;
      };
      const double all = energy();
      double before = all, gained = 0;
      for (int i = 0; i < 240; ++i) {
        world.step();
        const double now = energy();
        gained += std::max(0.0, now - before);
        before = now;
      }
      EXPECT_LT(gained, 0.02 * all) << int(joint.kind) << " seed " << seed;
    }
  }
}

// 200 links, far more than what assemblies need: they fall in a heap and come to rest.
TEST(Articulated, ATreeOf200LinksFallsAndRests) {
  JointType joint = joint_of(JointKind::ball);
  joint.friction = 2;
  World world = make_world(make_chain(199, 0.3, true, joint), 0.3, {}, 0.1);
  world.add({at(PieceKind::assembly(0), {-30, 0, 0.3}, {}, false)});
  const double length = 0.3 * 199;
  EXPECT_TRUE(testing::run_to_rest(world, 8));
  double farthest = 0;
  for (int i = 0; i < world.size(); ++i) {
    farthest = std::max(farthest, norm(world.piece(i).world_from_body.translation));
    EXPECT_LT(world.piece(i).world_from_body.translation.z, 0.5);
  }
  EXPECT_LT(farthest, length);
  EXPECT_EQ(world.lost_count(), 0);
}

}  // namespace articulated_test
}  // namespace rubble
