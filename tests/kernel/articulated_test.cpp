// Articulated debris in the world: closed forms, conservation, yielding, breaking.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble {
namespace {

using testing::at;
using testing::box_type;
using testing::run;
using testing::turned;

constexpr double kG = 9.81;
const Quat kAboutY{std::sqrt(0.5), -std::sqrt(0.5), 0, 0};  // takes Z to Y

WorldOptions awake_options() {
  WorldOptions options;
  options.sleeping = false;
  return options;
}

// `count` boxes of size x, y, z along -Z or X, joined end to end; link 0 is a small block.
AssemblyType make_chain(int count, double length, bool along_x, const JointType& joint) {
  AssemblyType chain;
  chain.name = "chain";
  chain.links.push_back({0, {}, 1});
  const Vec3 step = along_x ? Vec3{length, 0, 0} : Vec3{0, 0, -length};
  const Quat turn = along_x ? Quat{} : turned({0, 1, 0}, 1.5707963267948966);
  for (int i = 0; i < count; ++i) {
    chain.links.push_back({1, {turn, step * (i + 0.5)}, 1});
    JointType j = joint;
    j.parent = i;
    j.child = i + 1;
    j.assembly_from_joint = {kAboutY, step * double(i)};
    chain.joints.push_back(j);
  }
  return chain;
}

JointType joint_of(JointKind kind) {
  JointType joint;
  joint.kind = kind;
  return joint;
}

World make_world(const AssemblyType& assembly, double length, const WorldOptions& options,
                 double thickness = 0.02) {
  return World({box_type("block", 0.1, 0.1, 0.1), box_type("bar", length, thickness, thickness)},
               options, {assembly});
}

NewPiece hung(const Vec3& position, const Quat& rotation = {}) {
  return at(2, position, rotation, true);
}

// Mean time between two crossings of x = 0 in the same direction.
double measure_period(World& world, int piece, double seconds) {
  double last = world.piece(piece).world_from_body.translation.x, first_time = 0, time = 0;
  int crossings = 0;
  while (world.time() < seconds) {
    world.step();
    const double x = world.piece(piece).world_from_body.translation.x;
    if (last < 0 && x >= 0) {
      time = world.time() - x / (x - last) / 60;
      if (crossings++ == 0) first_time = time;
    }
    last = x;
  }
  return (time - first_time) / (crossings - 1);
}

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
    NewPiece one = at(3, {0, 0, height}, turned({1, 2, 3}, 0.3));
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
    EXPECT_NEAR(tree.kinetic_energy(), piece.kinetic_energy(), 1e-9);
    EXPECT_LT(norm(tree.linear_momentum() - piece.linear_momentum()), 1e-9);
    run(tree, seconds);
    run(piece, seconds);
    const Vec3 expected = piece.piece(0).world_from_body * Vec3{-0.5, 0, 0};
    EXPECT_LT(distance(tree.piece(0).world_from_body.translation, expected), tolerance);
    const Quat turn = tree.piece(0).world_from_body.rotation.conjugate() *
                      piece.piece(0).world_from_body.rotation;
    EXPECT_LT(norm(Vec3{turn.x, turn.y, turn.z}), tolerance);
  };
  compare(0, 20, 1, {0.3, 0, 1}, {}, 1e-9);
  compare(kG, 20, 1, {0.3, 0, 1}, turned({1, 2, 3}, 0.3).rotate({4, 0, 0}), 1e-3);  // long axis
  compare(kG, 20, 0.5, {}, {0.5, 2, 1}, 0.02);  // a single piece's spin is of first order only
  compare(kG, 0.5, 1.0, {}, {}, 0.005);         // through its impact on the ground, to rest
}

TEST(Articulated, AFreeTreeHitByAFreePieceKeepsMomentum) {
  WorldOptions options = awake_options();
  options.gravity = 0;
  const double length = 0.6;
  World world =
      make_world(make_chain(4, length, true, joint_of(JointKind::ball)), length, options, 0.1);
  NewPiece bullet = at(1, {1.3, 0.02, 7}, turned({1, 1, 0}, 0.7));
  bullet.linear_velocity = {0.2, 0, -3};
  world.add({at(2, {0, 0, 5}), bullet});
  const Vec3 before = world.linear_momentum(), turning = world.angular_momentum();
  const double energy = world.kinetic_energy();
  double last = energy;
  bool touched = false;
  for (int i = 0; i < 120; ++i) {
    world.step();
    touched = touched || (world.is_touching(5) && world.is_touching(2));
    EXPECT_LE(world.kinetic_energy(), last * (1 + 1e-5));
    last = world.kinetic_energy();
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(norm(world.linear_momentum() - before), 1e-3 * norm(before));
  EXPECT_LT(norm(world.angular_momentum() - turning), 0.02 * norm(turning));
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
    const double floor = world.potential_energy() - 5 * world.mass(1) * kG * 1.25;
    const double swing = world.potential_energy() - floor;
    double highest = 0, last = 0;
    for (int i = 0; i < 600; ++i) {
      world.step();
      last = world.kinetic_energy() + world.potential_energy() - floor;
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
    NewPiece piece = at(1, {0, 0, 5});
    piece.angular_velocity = {0, 0, spin};
    piece.linear_velocity = {0, -0.15 * spin, 0};
    world.add({piece});
    const double energy = world.kinetic_energy();
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      const Vec3 before = world.piece(1).world_from_body.translation;
      world.step();
      fastest = std::max(fastest, distance(world.piece(1).world_from_body.translation, before));
      ASSERT_LT(world.kinetic_energy(), 1.0001 * energy) << i;
    }
    const double apart = distance(world.piece(0).world_from_body.translation,
                                  world.piece(1).world_from_body.translation);
    EXPECT_EQ(world.joints().empty(), strength < 1);
    EXPECT_LT(fastest, 0.0201);
    EXPECT_LT(norm(world.linear_momentum()), 1e-5 * mass * spin);
    if (strength < 1) {
      EXPECT_LT(world.deepest_overlap().depth, 0.001);
      EXPECT_GT(apart, 0.3 + 0.05);
    } else {
      EXPECT_NEAR(apart, 0.3, 1e-9);
    }
  }
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

std::string error_of(const AssemblyType& assembly) {
  try {
    World({box_type("block", 0.1, 0.1, 0.1), box_type("bar", 1, 0.1, 0.1)}, {}, {assembly});
  } catch (const InputError& error) {
    return error.diagnostics().front().text();
  }
  return "";
}

// Two rods of length 1 hang from a fixed block and carry a third between them; the last joint closes
// the loop. The rods lean by `angle`.
AssemblyType make_parallelogram(double angle, double break_force = kNever) {
  AssemblyType frame;
  const Quat lean = turned({0, 1, 0}, angle), upright = turned({0, 1, 0}, 1.5707963267948966);
  const Vec3 down = lean.rotate({0, 0, -1}), across{1, 0, 0};
  frame.links = {{0, {}, 1},
                 {1, {lean * upright, down * 0.5}, 1},
                 {1, {{}, down + across * 0.5}, 1},
                 {1, {lean * upright, across + down * 0.5}, 1}};
  const Vec3 places[4] = {{}, down, down + across, across};
  for (int i = 0; i < 4; ++i) {
    JointType joint = joint_of(JointKind::hinge);
    joint.parent = i < 3 ? i : 0;
    joint.child = i < 3 ? i + 1 : 3;
    joint.assembly_from_joint = {kAboutY, places[i]};
    if (i == 3) joint.break_force = break_force;
    frame.joints.push_back(joint);
  }
  return frame;
}

// w^2 = 2 g m l / (2 m l^2 / 3 + m l^2) = 1.2 g / l: the rod in the middle does not turn.
TEST(Articulated, ALoopOfHingesSwingsAsAParallelogram) {
  World world = make_world(make_parallelogram(0.05), 1, awake_options());
  world.add({hung({0, 0, 5})});
  const double expected = 2 * 3.14159265358979 / std::sqrt(1.2 * kG);
  EXPECT_NEAR(measure_period(world, 1, 20), expected, 2e-3 * expected);
  const auto place = [&](int piece, double along) {
    return world.piece(piece).world_from_body * Vec3{along, 0, 0};
  };
  EXPECT_LT(distance(place(3, -0.5), Vec3{1, 0, 5}), 1e-4);  // the joint of the loop
  const Vec3 level = place(2, 0.5) - place(2, -0.5);
  EXPECT_NEAR(level.z, 0, 1e-4);
  EXPECT_EQ(world.joints().size(), 4u);
}

// It may swing wide, and must not gain energy by that.
TEST(Articulated, ALoopNeverGainsEnergy) {
  World world = make_world(make_parallelogram(1.2), 1, awake_options());
  world.add({hung({0, 0, 5})});
  const double start = world.potential_energy(), lowest = start - 2 * world.mass(1) * kG *
                                                                      (1 - std::cos(1.2));
  double last = start;
  for (int i = 0; i < 600; ++i) {
    world.step();
    last = world.kinetic_energy() + world.potential_energy();
    EXPECT_LT(last, start + 0.01 * (start - lowest)) << "step " << i;
  }
  // Each step leaves the circle by its tangent; closing the loop again costs 3 % a second.
  EXPECT_GT(last - lowest, 0.6 * (start - lowest));
}

// At rest the joint of the loop carries its rod and half of the one in the middle.
TEST(Articulated, ALoopBreaksAtItsLoad) {
  const double weight = 1.5 * 2400 * 0.02 * 0.02 * kG;
  for (double share : {1.02, 0.98}) {
    World world = make_world(make_parallelogram(0, share * weight), 1, awake_options());
    world.add({hung({0, 0, 5})});
    run(world, 1);
    EXPECT_EQ(world.joints().size(), share > 1 ? 4u : 3u);
    EXPECT_EQ(world.piece(3).world_from_body.translation.z < 4.4, share < 1);
  }
}

TEST(Articulated, ALoopHasNoSpring) {
  AssemblyType frame = make_parallelogram(0);
  frame.joints[3].stiffness = 3;
  EXPECT_NE(error_of(frame).find("joints[3].stiffness"), std::string::npos) << error_of(frame);
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
    EXPECT_EQ(world.kinetic_energy() > 0, !dry);
  }
}

// 200 links, far more than what assemblies need: they fall in a heap and come to rest.
TEST(Articulated, ATreeOf200LinksFallsAndRests) {
  JointType joint = joint_of(JointKind::ball);
  joint.friction = 2;
  World world = make_world(make_chain(199, 0.3, true, joint), 0.3, {}, 0.1);
  world.add({at(2, {-30, 0, 0.3}, {}, false)});
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

TEST(Articulated, RefusesWhatIsNoTree) {
  const AssemblyType good = make_chain(2, 1, true, joint_of(JointKind::ball));
  EXPECT_EQ(error_of(good), "");
  AssemblyType bad = good;
  bad.joints.pop_back();
  EXPECT_NE(error_of(bad).find("assemblies[0].links[2]"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[1].parent = 2;
  EXPECT_NE(error_of(bad).find("listed before"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[1].child = 1;
  bad.joints[1].parent = 0;
  EXPECT_NE(error_of(bad).find("child of one joint"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints.push_back(bad.joints[1]);
  bad.joints.back().parent = bad.joints.back().child;
  EXPECT_NE(error_of(bad).find("two links"), std::string::npos) << error_of(bad);
  bad = good;
  bad.links[1].type = 7;
  EXPECT_NE(error_of(bad).find("no such type"), std::string::npos) << error_of(bad);
  bad = good;
  bad.joints[0].stiffness = -1;
  EXPECT_NE(error_of(bad).find("joints[0].stiffness"), std::string::npos) << error_of(bad);
}

}  // namespace
}  // namespace rubble
