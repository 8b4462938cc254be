// Plastic impacts between light and heavy: common speeds, momentum, and nobody passes through. At
// most 2 % of the approach speed may come back: one sweep of impulses a substep is not the exact
// answer.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "closed_forms.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace closed_forms_impact_test {

using namespace testing;

// A cube of 0.4 m of any mass that its density allows.
PieceType cube_type(double mass) {
  PieceType type = box_type("cube", 0.4, 0.4, 0.4);
  type.density = mass / (0.4 * 0.4 * 0.4);
  return type;
}

// A heavy cube runs into a light one that rests in the air: both go on at M v / (M + m).
TEST(ClosedFormImpact, HeavyAndLightGoOnAtTheCommonSpeed) {
  for (const double ratio : {1.0, 3.0, 10.0, 30.0, 150.0, 300.0, 1000.0}) {
    const double light = 1.28, speed = 8;  // 1000 times that is the densest that a type may be
    World world({cube_type(light), cube_type(light * ratio)}, weightless_options());
    NewPiece heavy = at(1, {-1, 0, 5});
    heavy.linear_velocity = {speed, 0, 0};
    world.add({at(0, {0, 0, 5}), heavy});
    const double momentum = world.diagnostics().linear_momentum().x;
    run(world, 0.5);
    const double expected = speed * ratio / (1 + ratio);
    const PieceState hit = world.piece(0), hitting = world.piece(1);
    EXPECT_NEAR(hit.linear_velocity.x, expected, 0.02 * speed) << ratio;
    EXPECT_NEAR(hitting.linear_velocity.x, expected, 0.02 * speed) << ratio;
    EXPECT_NEAR(world.diagnostics().linear_momentum().x, momentum, 1e-4 * momentum) << ratio;
    const double between =
        hit.world_from_body.translation.x - hitting.world_from_body.translation.x;
    EXPECT_GT(between, 0.39) << ratio;
    EXPECT_LT(between, 0.4 + 0.02 * speed * 0.5) << ratio;
  }
}

// The other way round: what is light does not turn back, and loses no momentum.
TEST(ClosedFormImpact, LightStaysOnHeavyWithoutABounce) {
  for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
    World world({cube_type(1.28), cube_type(1.28 * ratio)}, weightless_options());
    NewPiece light = at(0, {-1, 0, 5});
    light.linear_velocity = {8, 0, 0};
    world.add({light, at(1, {0, 0, 5})});
    const double momentum = world.diagnostics().linear_momentum().x;
    run(world, 0.5);
    const double expected = 8 / (1 + ratio);
    EXPECT_NEAR(world.piece(0).linear_velocity.x, expected, 0.02 * 8) << ratio;
    EXPECT_NEAR(world.piece(1).linear_velocity.x, expected, 0.02 * expected) << ratio;
    EXPECT_NEAR(world.diagnostics().linear_momentum().x, momentum, 1e-3 * momentum) << ratio;
  }
}

// 300 kg at 8 m/s against 2 kg: in the air, against a wall, and on the ground.
PieceType heavy_type() {
  PieceType type = box_type("heavy", 0.5, 0.5, 0.5);
  type.density = 2400;
  return type;
}
PieceType light_type() {
  PieceType type = box_type("light", 0.2, 0.2, 0.1);
  type.density = 500;
  return type;
}

TEST(ClosedFormImpact, ThreeHundredKilogramsDoNotPassThroughTwo) {
  World world({light_type(), heavy_type()}, weightless_options());
  NewPiece heavy = at(1, {-1, 0, 5});
  heavy.linear_velocity = {8, 0, 0};
  world.add({at(0, {0, 0, 5}), heavy});
  ASSERT_NEAR(world.mass(0), 2, 1e-6);
  ASSERT_NEAR(world.mass(1), 300, 1e-6);
  run(world, 1);
  const double expected = 8 * 300.0 / 302;
  EXPECT_NEAR(world.piece(0).linear_velocity.x, expected, 0.02 * 8);
  EXPECT_NEAR(world.piece(1).linear_velocity.x, expected, 0.01 * expected);
  EXPECT_GT(world.piece(0).world_from_body.translation.x,
            world.piece(1).world_from_body.translation.x + 0.34);
}

TEST(ClosedFormImpact, ThreeHundredKilogramsStopAtTwoBeforeAWall) {
  World world({light_type(), heavy_type(), box_type("wall", 1, 4, 4)}, weightless_options());
  NewPiece heavy = at(1, {-1, 0, 5});
  heavy.linear_velocity = {8, 0, 0};
  world.add({at(0, {0, 0, 5}), heavy, at(2, {0.601, 0, 5}, {}, true)});
  run(world, 1);
  EXPECT_LT(world.piece(1).linear_velocity.x, 0.05);
  // The light one stays between the two, at most 1 cm in either.
  EXPECT_NEAR(world.piece(0).world_from_body.translation.x, 0, 0.01);
  EXPECT_LT(world.piece(1).world_from_body.translation.x, -0.35 + 0.01);
}

TEST(ClosedFormImpact, ThreeHundredKilogramsFallOntoTwo) {
  World world({light_type(), heavy_type()});
  NewPiece heavy = at(1, {0, 0, 0.6});
  heavy.linear_velocity = {0, 0, -8};
  world.add({at(0, {0, 0, 0.051}), heavy});
  for (int i = 0; i < 60; ++i) {
    world.step();
    ASSERT_GT(world.piece(1).world_from_body.translation.z, 0.35 - 0.03)
        << i;  // a moment's squeeze
  }
  EXPECT_NEAR(world.piece(0).world_from_body.translation.z, 0.05, 0.005);
  EXPECT_NEAR(world.piece(1).world_from_body.translation.z, 0.35, 0.01);
}

// A light box on the ground is pushed along by a heavy one that slides, both without friction.
TEST(ClosedFormImpact, ThreeHundredKilogramsSweepTwoAlongTheGround) {
  PieceType light = light_type(), heavy = heavy_type();
  light.friction = heavy.friction = 0;
  World world({light, heavy});
  NewPiece sliding = at(1, {-1, 0, 0.251});
  sliding.linear_velocity = {8, 0, 0};
  world.add({at(0, {0, 0, 0.051}), sliding});
  run(world, 1);
  const double expected = 8 * 300.0 / 302;
  EXPECT_NEAR(world.diagnostics().linear_momentum().x, 2400, 24);
  EXPECT_GT(world.piece(0).world_from_body.translation.x,
            world.piece(1).world_from_body.translation.x + 0.34);
  EXPECT_NEAR(world.piece(1).linear_velocity.x, expected, 0.02 * expected);
}

// 1,229 kg slide into what stands on the ground, with the friction of concrete: it is pushed ahead at the speed of the
// heavy one, and no part of it ends inside. Both lose 2/3 g t by friction.
TEST(ClosedFormImpact, TwelveHundredKilogramsPushAheadWhatStandsOnTheGround) {
  for (const double rate : {60.0, 240.0}) {
    for (const double light : {2.0, 10.0, 50.0}) {
      for (const double speed : {10.0, 15.0, 20.0, 30.0}) {
        const double edge = std::cbrt(light / 2400);
        WorldOptions options = awake_options();
        options.step = 1 / rate;
        World world({box_type("heavy", 0.8, 0.8, 0.8), box_type("light", edge, edge, edge)}, options);
        NewPiece heavy = at(0, {-0.8, 0, 0.401});
        heavy.linear_velocity = {speed, 0, 0};
        world.add({heavy, at(1, {0, 0.03, edge / 2 + 0.001})});
        double overlap = 0, pushed = 0;
        while (world.time() < 0.4) {
          world.step();
          overlap = std::max(overlap, world.diagnostics().deepest_overlap().depth);
          pushed = std::max(pushed, world.piece(1).linear_velocity.x);
        }
        const PieceState hitting = world.piece(0), hit = world.piece(1);
        const std::string label =
            std::to_string(rate) + " Hz, " + std::to_string(light) + " kg, " + std::to_string(speed) + " m/s";
        EXPECT_GT(hit.world_from_body.translation.x, hitting.world_from_body.translation.x + 0.3) << label;
        EXPECT_NEAR(pushed, speed * 1229 / (1229 + light), 0.02 * speed + 0.3) << label;
        EXPECT_NEAR(hit.linear_velocity.x, hitting.linear_velocity.x, 0.04 * speed) << label;
        EXPECT_LT(overlap, 0.03) << label;
      }
    }
  }
}

// Face against face at 30 m/s, off the middle by `offset`, wherever in a step of 0.5 m the two meet.
World make_passing(double size, double offset, double phase) {
  World world({box_type("moving", 0.4, 0.4, 0.4), box_type("resting", size, size, size)}, weightless_options());
  NewPiece moving = at(0, {0, 0, 5});
  moving.linear_velocity = {30, 0, 0};
  world.add({moving, at(1, {1.2 + 0.5 * phase, offset, 5.03})});
  return world;
}

TEST(ClosedFormImpact, OffTheMiddleAtThirtyMetresPerSecondKeepsAngularMomentum) {
  for (const double size : {0.2, 0.4, 0.8}) {
    for (const double offset : {0.1, 0.15, 0.25}) {
      for (const double phase : {0.0, 0.2, 0.4, 0.6, 0.8}) {
        World world = make_passing(size, offset, phase);
        const double reduced = world.mass(0) * world.mass(1) / (world.mass(0) + world.mass(1));
        const Vec3 before = world.diagnostics().angular_momentum();
        run(world, 0.2);
        EXPECT_GT(norm(world.piece(1).angular_velocity), 1);
        EXPECT_LT(norm(world.diagnostics().angular_momentum() - before), 0.01 * reduced * 30 * std::max(offset, 0.2))
            << size << " m, off by " << offset << ", phase " << phase;
      }
    }
  }
}

// 5 cm beside each other: they pass, and nothing changes.
TEST(ClosedFormImpact, WhatPassesBesideAtThirtyMetresPerSecondTouchesNothing) {
  for (const double phase : {0.0, 0.2, 0.4, 0.6, 0.8}) {
    World world = make_passing(0.2, 0.35, phase);
    run(world, 0.2);
    EXPECT_EQ(norm(world.piece(1).linear_velocity), 0) << phase;
    EXPECT_NEAR(world.piece(0).linear_velocity.x, 30, 1e-6) << phase;
  }
}

// A heavy box sleeps on ground without friction; light ones hit it one after the other, each at the
// height of its middle. All that they bring along the ground stays.
struct Hits {
  double before = 0, after = 0;  // momentum along X; unit: kg m/s
};
Hits hit_sleeper(double mass, double speed, int count) {
  PieceType light = box_type("light", 0.2, 0.2, 0.5), heavy = heavy_type();
  light.density = mass / (0.2 * 0.2 * 0.5);
  light.friction = heavy.friction = 0;
  World world({light, heavy});
  world.add({at(1, {0, 0, 0.251})});
  run(world, 3);
  EXPECT_FALSE(world.is_awake(0));
  Hits hits;
  for (int i = 0; i < count; ++i) {
    NewPiece piece = at(0, {-0.6 - 1.0 * i, 0, 0.251});
    piece.linear_velocity = {speed, 0, 0};
    world.add({piece});
  }
  hits.before = world.diagnostics().linear_momentum().x;
  run(world, (0.3 + 1.0 * (count - 1)) / speed + 0.1);
  hits.after = world.diagnostics().linear_momentum().x;
  return hits;
}

TEST(ClosedFormImpact, ALightPieceThatHitsAHeavySleeperKeepsItsMomentum) {
  for (const double mass : {0.5, 2.0, 10.0}) {
    for (const double speed : {2.0, 5.0}) {
      const Hits hits = hit_sleeper(mass, speed, 1);
      EXPECT_NEAR(hits.after, hits.before, 0.01 * hits.before) << mass << " kg at " << speed;
    }
  }
}

// With the friction of concrete the ground takes that momentum soon anyway: whether a sleeper was woken or
// not, it ends where friction would have stopped it.
TEST(ClosedFormImpact, ASleeperWithFrictionEndsWhereAnImpactBringsIt) {
  const double friction = 0.6;
  for (const double mass : {0.5, 2.0, 10.0, 40.0}) {
    for (const double speed : {2.0, 5.0}) {
      PieceType light = box_type("light", 0.2, 0.2, 0.5), heavy = heavy_type();
      light.density = mass / (0.2 * 0.2 * 0.5);
      light.friction = 0, heavy.friction = friction;
      World world({light, heavy});
      world.add({at(1, {0, 0, 0.251})});
      run(world, 3);
      const double start = world.piece(0).world_from_body.translation.x;
      NewPiece piece = at(0, {-0.6, 0, 0.251});
      piece.linear_velocity = {speed, 0, 0};
      world.add({piece});
      run(world, 1.5);
      const double common = mass * speed / (mass + 300);
      const double brake = friction * 9.81 * 300 / (mass + 300);
      const double expected = common * common / (2 * brake);
      EXPECT_NEAR(world.piece(0).world_from_body.translation.x - start, expected,
                  0.0005 + 0.1 * expected)
          << mass << " kg at " << speed;
    }
  }
}

TEST(ClosedFormImpact, ManyLightPiecesMoveAHeavySleeper) {
  const Hits hits = hit_sleeper(2, 5, 8);
  EXPECT_NEAR(hits.after, hits.before, 0.02 * hits.before);
}

}  // namespace closed_forms_impact_test
}  // namespace rubble
