// Motion against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kernel/settling/generator.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "scenes.h"

namespace rubble {
namespace dynamics_test {

using testing::at;
using testing::box_type;
using testing::run;
using testing::turned;

TEST(FreeFall, FollowsTheParabola) {
  World world({box_type("b", 0.2, 0.2, 0.2)});
  world.add({at(0, {1, 2, 100})});
  run(world, 2);
  const double g = 9.81;
  EXPECT_NEAR(world.piece(0).linear_velocity.z, -2 * g, 1e-9);
  EXPECT_NEAR(world.piece(0).world_from_body.translation.z, 100 - 0.5 * g * 4, 1e-9);
  EXPECT_EQ(world.piece(0).world_from_body.translation.x, 1);
}

TEST(FreeFall, SpinKeepsAngularMomentumAndNeverGainsEnergy) {
  WorldOptions options;
  options.gravity = 0;
  World world({box_type("b", 0.5, 0.2, 0.1)}, options);
  NewPiece piece = at(0, {0, 0, 5});
  piece.angular_velocity = {1, 6, 0.5};  // near the unstable middle axis
  world.add({piece});
  const double energy = world.diagnostics().kinetic_energy();
  const Vec3 before = world.diagnostics().angular_momentum();
  double last = energy;
  for (int i = 0; i < 120; ++i) {
    world.step();
    EXPECT_LE(world.diagnostics().kinetic_energy(), last * (1 + 1e-6));
    last = world.diagnostics().kinetic_energy();
  }
  EXPECT_GT(last, 0.5 * energy);
  EXPECT_NEAR(norm(world.diagnostics().angular_momentum() - before) / norm(before), 0, 0.25);
}

// A box on a fixed slope of the given angle; returns how far it slid and its final speed.
struct Slide {
  double distance, speed;
};
Slide slide(double angle, double seconds) {
  World world({box_type("ramp", 40, 4, 1), box_type("box", 0.4, 0.4, 0.2)});
  const Quat q = turned({0, 1, 0}, angle);  // +X goes down
  const Vec3 middle{0, 0, 20};
  world.add({at(0, middle, q, true), at(1, middle + q.rotate({-15, 0, 0.601}), q)});
  run(world, 0.2);
  const Vec3 start = world.piece(1).world_from_body.translation;
  run(world, seconds);
  return {distance(world.piece(1).world_from_body.translation, start),
          norm(world.piece(1).linear_velocity)};
}

TEST(Friction, HoldsJustUnderTheAngle) {
  const Slide s = slide(std::atan(0.6 * 0.98), 2);
  EXPECT_LT(s.distance, 0.002);
  EXPECT_LT(s.speed, 0.002);
}

TEST(Friction, SlidesJustOverTheAngle) {
  const double angle = std::atan(0.6 * 1.03);
  const Slide s = slide(angle, 2);
  const double a = 9.81 * (std::sin(angle) - 0.6 * std::cos(angle));
  EXPECT_NEAR(s.speed, a * 2.2, 0.1 * a * 2.2);
}

TEST(Friction, SlidesAsFastAsCoulombSays) {
  const double angle = 0.8;
  const Slide s = slide(angle, 1);
  const double a = 9.81 * (std::sin(angle) - 0.6 * std::cos(angle));
  EXPECT_NEAR(s.speed, a * 1.2, 0.02 * a * 1.2);
}

TEST(Friction, PairsTakeTheGeometricMean) {
  // 0.9 on 0.4 is 0.6: holds under atan(0.6), slides over it.
  for (double factor : {0.97, 1.03}) {
    std::vector<PieceType> types{box_type("ramp", 40, 4, 1), box_type("box", 0.4, 0.4, 0.2)};
    types[0].friction = 0.9;
    types[1].friction = 0.4;
    World world(types);
    const Quat q = turned({0, 1, 0}, std::atan(0.6 * factor));
    world.add({at(0, {0, 0, 20}, q, true), at(1, Vec3{0, 0, 20} + q.rotate({-15, 0, 0.601}), q)});
    run(world, 1.5);
    const double speed = norm(world.piece(1).linear_velocity);
    if (factor < 1) {
      EXPECT_LT(speed, 0.002);
    } else {
      EXPECT_GT(speed, 0.1);
    }
  }
}

TEST(Collision, MomentumIsKept) {
  WorldOptions options;
  options.gravity = 0;
  PieceType light = box_type("light", 0.3, 0.3, 0.3), heavy = box_type("heavy", 0.5, 0.4, 0.3);
  light.density = 54;  // 1 : 99
  World world({light, heavy}, options);
  NewPiece a = at(0, {-1, 0.05, 5}, turned({1, 2, 3}, 0.4));
  a.linear_velocity = {4, 0, 0};
  NewPiece b = at(1, {0, 0, 5.05}, turned({3, 1, 0}, 1.1));
  b.linear_velocity = {-1, 0.2, 0};
  world.add({a, b});
  const Vec3 before = world.diagnostics().linear_momentum(), turning = world.diagnostics().angular_momentum();
  const double energy = world.diagnostics().kinetic_energy();
  bool touched = false;
  for (int i = 0; i < 60; ++i) {
    world.step();
    touched = touched || world.is_touching(0);
  }
  EXPECT_TRUE(touched);
  EXPECT_LT(norm(world.diagnostics().linear_momentum() - before), 1e-4 * norm(before));
  EXPECT_LT(norm(world.diagnostics().angular_momentum() - turning), 0.02 * norm(turning));
  EXPECT_LT(world.diagnostics().kinetic_energy(), 0.9 * energy);  // plastic
}

TEST(Collision, HeadOnPlasticImpactHasTheCommonSpeed) {
  WorldOptions options;
  options.gravity = 0;
  World world({box_type("b", 0.4, 0.4, 0.4)}, options);
  NewPiece a = at(0, {-0.5, 0, 5}), b = at(0, {0.5, 0, 5});
  a.linear_velocity = {2, 0, 0};
  world.add({a, b});
  run(world, 1);
  EXPECT_NEAR(world.piece(0).linear_velocity.x, 1, 0.01);
  EXPECT_NEAR(world.piece(1).linear_velocity.x, 1, 0.01);
}

TEST(Collision, NothingTunnels) {
  // Through a plate of 5 cm that nothing falls off: a brick at 0.67 m a step, and a thin bar, tip first, at 0.25 m.
  World world({box_type("plate", 40, 40, 0.05), box_type("brick", 0.215, 0.1025, 0.065),
               testing::bar_type(1.0, 0.01)});
  NewPiece brick = at(1, {1, 1, 4}, turned({1, 2, 3}, 1.3));
  brick.linear_velocity = {0, 0, -40};
  NewPiece bar = at(2, {-1, -1, 4}, turned({0, 1, 0}, 1.3));
  bar.linear_velocity = {0, 0, -15};
  world.add({at(0, {0, 0, 2}, {}, true), brick, bar});
  run(world, 1);
  EXPECT_GT(world.piece(1).world_from_body.translation.z, 2.0);
  EXPECT_GT(world.piece(2).world_from_body.translation.z, 2.0);
}

struct EnergyOfFall {
  double rises = 0, end = 0;  // sum of all that it rose from step to step; shares of the start's
};

EnergyOfFall drop_pile(std::uint64_t seed) {
  const Pile pile = generate_pile(testing::small_pile(seed, 1, 80));
  WorldOptions options;
  options.threads = 1;
  World world(pile.types, options);
  std::vector<NewPiece> pieces;
  for (const Placement& p : pile.layers[0].pieces) {
    pieces.push_back({});
    pieces.back().placement = p;
    pieces.back().placement.world_from_body.translation.z += 0.5;
  }
  world.add(pieces);
  const double start = world.diagnostics().kinetic_energy() + world.diagnostics().potential_energy();
  EnergyOfFall fall;
  double last = start;
  for (int i = 0; i < 240; ++i) {
    world.step();
    const double now = world.diagnostics().kinetic_energy() + world.diagnostics().potential_energy();
    fall.rises += std::max(0.0, now - last) / start;
    last = now;
  }
  fall.end = last / start;
  return fall;
}

// It may rise in a step: pushing overlaps apart lifts pieces, and an impact's one sweep of impulses
// is not the exact answer. All rises of a fall together stay below 1 % of what is lost (the worst of
// 120 seeds had 0.3 %), and most falls have far less.
TEST(Energy, HardlyRisesWhileAPileFalls) {
  double mean = 0;
  const int falls = 24;
  for (int seed = 1; seed <= falls; ++seed) {
    const EnergyOfFall fall = drop_pile(std::uint64_t(seed));
    EXPECT_LT(fall.rises, 0.009) << "seed " << seed;
    EXPECT_LT(fall.end, 0.1) << "seed " << seed;
    mean += fall.rises / falls;
  }
  EXPECT_LT(mean, 5e-4);
}

TEST(WorldStep, SaysWhichOfItsStagesBegins) {
  World world({box_type("brick", 0.215, 0.1025, 0.065)});
  world.add({at(0, {0, 0, 0.04})});
  std::vector<StepStage> stages;
  world.diagnostics().set_on_stage([&stages](StepStage stage) { stages.push_back(stage); });
  world.step();
  const std::vector<StepStage> expected{StepStage::pairs,  StepStage::points, StepStage::impulses,
                                        StepStage::rest,   StepStage::motion, StepStage::rest,
                                        StepStage::none};
  EXPECT_EQ(stages, expected);
  world.diagnostics().set_on_stage({});
  world.step();
  EXPECT_EQ(stages.size(), expected.size());
}

}  // namespace dynamics_test
}  // namespace rubble
