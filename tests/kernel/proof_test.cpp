// World::begin_rest_verification(): who rests passes; who only sleeps, creeps or hangs in the air does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "kernel/world/world.h"
#include "kernel/world/world_rest.h"
#include "kernel/world/world_serialization.h"
#include "closed_forms.h"
#include "scenes.h"

namespace rubble {
namespace proof_test {

using testing::at;
using testing::box_type;
using testing::run;
using testing::turned;

constexpr double kSpeed = 0.05, kAngularSpeed = 0.2;

// Steps until rest is proved or `seconds` are over; the seconds it took, or infinity.
double prove(World& world, double seconds) {
  world.rest().begin_verification();
  const double start = world.time();
  while (world.time() < start + seconds) {
    world.step();
    if (world.rest().verified(kSpeed, kAngularSpeed)) return world.time() - start;
  }
  return INFINITY;
}

TEST(ProofOfRest, APileAtRestPasses) {
  World world({box_type("b", 0.4, 0.4, 0.2)});
  world.add({at(0, {0, 0, 0.1}), at(0, {0.05, 0, 0.302}), at(0, {-0.05, 0, 0.504}),
             at(0, {1, 0, 0.1}, turned({0, 0, 1}, 0.3))});
  run(world, 2);
  ASSERT_EQ(world.awake_count(), 0);
  const double seconds = prove(world, 3);
  EXPECT_LE(seconds, 1.1);
  EXPECT_GE(seconds, 0.45);  // not at once: they were woken, and had to stay in place
}

TEST(ProofOfRest, WhoOnlySleepsHasProvedNothing) {
  World world({box_type("b", 0.4, 0.4, 0.2)});
  world.add({at(0, {0, 0, 0.1})});
  run(world, 2);
  ASSERT_EQ(world.awake_count(), 0);
  EXPECT_TRUE(world.rest().reached(kSpeed, kAngularSpeed));
  EXPECT_FALSE(world.rest().verifying());
  EXPECT_FALSE(world.rest().verified(kSpeed, kAngularSpeed));
  EXPECT_LT(prove(world, 2), 2);
  world.add({at(0, {2, 0, 0.1})});  // what is new has proved nothing
  EXPECT_FALSE(world.rest().verified(kSpeed, kAngularSpeed));
}

// On a slope a little steeper than friction holds it begins slowly.
TEST(ProofOfRest, WhoSlidesSlowlyDoesNotPass) {
  World world({box_type("ramp", 40, 4, 1), box_type("box", 0.4, 0.4, 0.2)});
  const Quat q = turned({0, 1, 0}, std::atan(0.6 * 1.02));
  world.add({at(0, {0, 0, 20}, q, true), at(1, Vec3{0, 0, 20} + q.rotate({-15, 0, 0.601}), q)});
  world.step();
  const Vec3 before = world.piece(1).world_from_body.translation;
  EXPECT_EQ(prove(world, 2.5), INFINITY);
  EXPECT_GT(distance(world.piece(1).world_from_body.translation, before), 0.1);
}

// Without friction on a slope of 0.6 mm in a metre: x = a t^2 / 2 is 0.75 mm after half a second, but 19 mm after
// 2.5 s. What creeps as slowly at an even pace passes, see below.
TEST(ProofOfRest, WhoSlidesFasterAndFasterDoesNotPass) {
  constexpr double kAcceleration = 0.006, kTime = 2.5;  // m/s2, s
  PieceType box = box_type("box", 0.4, 0.4, 0.2);
  box.friction = 0;
  World world({box_type("ramp", 8, 4, 1), box});
  const Quat q = turned({0, 1, 0}, kAcceleration / 9.81);
  world.add({at(0, {0, 0, 2}, q, true), at(1, Vec3{0, 0, 2} + q.rotate({0, 0, 0.6005}), q)});
  world.step();
  world.set_velocity(1, {}, {});
  const Vec3 before = world.piece(1).world_from_body.translation;
  EXPECT_EQ(prove(world, kTime), INFINITY);
  const double way = distance(world.piece(1).world_from_body.translation, before);
  EXPECT_NEAR(way, kAcceleration * kTime * kTime / 2, 0.002);
}

// However slow: what slides without friction never comes to rest, and is not damped.
TEST(ProofOfRest, WhoSlidesWithoutFrictionNeverPasses) {
  for (const double speed : {0.012, 0.03, 0.049}) {
    PieceType box = box_type("b", 0.4, 0.4, 0.2);
    box.friction = 0;
    World world({box});
    world.add({at(0, {0, 0, 0.1})});
    run(world, 1);
    world.rest().begin_verification();
    world.set_velocity(0, {speed, 0, 0}, {});
    const Vec3 start = world.piece(0).world_from_body.translation;
    for (int i = 0; i < 600; ++i) {
      world.step();
      ASSERT_FALSE(world.rest().verified(kSpeed, kAngularSpeed)) << speed;
    }
    EXPECT_NEAR(distance(world.piece(0).world_from_body.translation, start), 10 * speed, 0.02 * speed);
  }
}

// What goes more slowly than the tolerance of rest may pass, whatever else goes as slowly: twenty boxes that
// creep need not all happen to have stayed for a second at once.
TEST(ProofOfRest, ManyThatCreepWithinTheTolerancePassTogether) {
  PieceType box = box_type("b", 0.4, 0.4, 0.2);
  box.friction = 0;
  World world({box});
  std::vector<NewPiece> pieces;
  for (int i = 0; i < 20; ++i) pieces.push_back(at(0, {double(i), 0, 0.1}));
  world.add(pieces);
  run(world, 1);
  world.rest().begin_verification();
  for (int i = 0; i < 20; ++i) world.set_velocity(i, {0, 0.0015 + 0.00002 * double(i), 0}, {});
  int passed = 0;
  for (int i = 0; i < 600; ++i) {
    world.step();
    passed += world.rest().verified(kSpeed, kAngularSpeed) ? 1 : 0;
  }
  EXPECT_GT(passed, 480);
}

// A drum with weights on both sides that hang below its axis: it rocks to and fro.
PieceType rocker_type(double hangs = 0.12) {
  PieceType type = testing::drum_type(0.2, 0.2, 256);
  for (const double y : {-0.2, 0.2}) {
    type.parts.push_back(testing::box_part(0.14, 0.2, 0.1, {0, y, -hangs}));
  }
  return type;
}

double measure_tilt(const World& world) {
  const Quat q = world.piece(0).world_from_body.rotation;
  return 2 * std::atan2(std::abs(q.y), std::abs(q.w));
}

// Coulomb's law lets it rock for long. In a verification it comes to rest at the lowest place: not before
// 3 s, when the damping begins, and after 5 s with it, where it takes 11 s without.
TEST(ProofOfRest, WhatRocksIsBroughtToRestInTheEnd) {
  for (const bool verified : {false, true}) {
    World world({rocker_type()});
    world.set_sleeping(verified);
    world.add({at(0, {0, 0, 0.2}, turned({0, 1, 0}, 0.3))});
    if (verified) {
      const double seconds = prove(world, 20);
      EXPECT_GT(seconds, 3);
      EXPECT_LT(seconds, 8);
      EXPECT_LT(measure_tilt(world), 0.05);
    } else {
      double most = 0;
      for (int i = 0; i < 8 * 60; ++i) {
        world.step();
        if (i > 5 * 60) most = std::max(most, measure_tilt(world));
      }
      EXPECT_GT(most, 0.05);  // what a polygon loses at its corners
    }
  }
}

// The more slowly it swings of itself, the less damping makes it creep back instead.
TEST(ProofOfRest, WhatRocksSlowlyIsNotMadeToCreep) {
  World world({rocker_type(0.1)});
  NewPiece rocker = at(0, {0, 0, 0.8}, turned({0, 1, 0}, 0.5));
  rocker.placement.scale = 4;
  world.add({rocker});
  EXPECT_LT(prove(world, 20), 11);
}

// A drum with 480 faces on a slope, its weight 1.5 mm to the side of its axis: it rolls on by a few faces, but not
// against rolling resistance. It gets there when a verification, kept up by a box that slides, has its full
// resistance. It counts as at rest only where it stays without the resistance, too.
// limit: of the verification; unit: s. Returns how far it goes in 2 s awake after that.
double drift_of_held_drum(double limit) {
  PieceType box = box_type("box", 0.4, 0.4, 0.2);
  box.friction = 0;
  World world({box_type("ramp", 20, 4, 1), testing::drum_type(0.15, 0.2, 480), box});
  const Quat q = turned({0, 1, 0}, 0.010);
  world.add({at(0, {0, 0, 1}, q, true), at(1, {0, 8, 0.15}), at(2, {0, -8, 0.1})});
  run(world, 1);
  world.rest().begin_verification(limit);
  world.set_velocity(2, {0.04, 0, 0}, {});
  run(world, 5.5);
  world.set_pose(1, {q, Vec3{0, 0, 1} + q.rotate({0, 0, 0.6505})});
  run(world, 0.25);
  world.set_velocity(2, {}, {});
  bool verified = false;
  for (int i = 0; i < 600 && !verified; ++i) {
    world.step();
    verified = world.rest().verified(kSpeed, kAngularSpeed);
  }
  EXPECT_TRUE(verified);
  const Vec3 before = world.piece(1).world_from_body.translation;
  world.set_sleeping(false);
  run(world, 2);
  return distance(world.piece(1).world_from_body.translation, before);
}

TEST(ProofOfRest, WhatOnlyResistanceHoldsIsTriedWithoutIt) { EXPECT_LT(drift_of_held_drum(60), 0.0005); }

// A try that fails costs time: a pile that would come to rest just within its limit must not miss it by that.
TEST(ProofOfRest, NothingIsTriedShortlyBeforeTheEnd) { EXPECT_GT(drift_of_held_drum(9), 0.0007); }

// While one piece slides for seconds the others need not be computed; but rest is verified of all at once.
TEST(ProofOfRest, PiecesFarFromWhatMovesDozeAndAreVerifiedAwakeAllTheSame) {
  PieceType box = box_type("box", 0.4, 0.4, 0.2);
  box.friction = 0;
  World world({box});
  std::vector<NewPiece> pieces = {at(0, {-5, 0, 0.1})};
  for (int i = 0; i < 10; ++i) pieces.push_back(at(0, {double(i), 5, 0.1}));
  world.add(pieces);
  world.rest().begin_verification();
  world.set_velocity(0, {0.03, 0, 0}, {});
  int least = world.awake_count(), all_awake_steps = 0, steps = 0;
  ASSERT_EQ(least, 11);
  while (!world.rest().verified(kSpeed, kAngularSpeed) && ++steps < 1200) {
    if (steps == 180) world.set_velocity(0, {}, {});
    world.step();
    least = std::min(least, world.awake_count());
    all_awake_steps = world.awake_count() == 11 ? all_awake_steps + 1 : 0;
  }
  EXPECT_GT(steps, 180);  // the one that slides
  EXPECT_LT(steps, 1200);
  EXPECT_EQ(least, 1);
  EXPECT_GE(all_awake_steps, 30);  // half a second at the end
}

// What lies on others is not left out of account: they stay awake with it.
TEST(ProofOfRest, NeighboursOfWhatMovesStayAwake) {
  PieceType plate = box_type("plate", 3, 3, 0.1), box = box_type("box", 0.4, 0.4, 0.2);
  box.friction = 0;
  World world({plate, box});
  world.add({at(0, {0, 0, 0.05}), at(1, {-1, 0, 0.202}), at(1, {5, 0, 0.1}), at(1, {7, 0, 0.1})});
  run(world, 1);
  world.rest().begin_verification();
  world.set_velocity(1, {0.03, 0, 0}, {});
  run(world, 1.5);
  ASSERT_FALSE(world.rest().verified(kSpeed, kAngularSpeed));
  EXPECT_TRUE(world.is_awake(0) && world.is_awake(1));
  EXPECT_FALSE(world.is_awake(2) || world.is_awake(3));
}

TEST(ProofOfRest, WhoSleepsInTheAirDoesNotPass) {
  World world({box_type("b", 0.4, 0.4, 0.2)});
  world.add({at(0, {0, 0, 0.1}), at(0, {2, 0, 1.5})});
  run(world, 0.1);
  auto snapshot = std::make_shared<World::Snapshot>(*world.snapshot());
  for (Body& body : snapshot->data.bodies) {  // as if its support had gone and left it asleep
    body.awake = false;
    body.linear = body.angular = {};
  }
  for (FreeBody& body : snapshot->free) body.linear_velocity = body.angular_velocity = {};
  world.restore(*snapshot);
  run(world, 0.5);
  ASSERT_TRUE(world.rest().reached(kSpeed, kAngularSpeed));
  ASSERT_GT(world.piece(1).world_from_body.translation.z, 1.3);
  const double seconds = prove(world, 5);
  // It falls first, and rest is proved on the ground alone.
  EXPECT_NEAR(world.piece(1).world_from_body.translation.z, 0.1, 0.002);
  EXPECT_GT(seconds, std::sqrt(2 * 1.25 / 9.81));
  EXPECT_LT(seconds, 3);
}

}  // namespace proof_test
}  // namespace rubble
