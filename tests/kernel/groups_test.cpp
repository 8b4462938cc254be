// Pieces that hold together as one rigid body, and what is kept when it comes apart.
#include <gtest/gtest.h>

#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_snapshot.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace groups_test {

PieceType make_box(double x, double y, double z) {
  PieceType type;
  type.name = "box";
  ConvexPart part;
  for (const double sx : {-0.5, 0.5}) {
    for (const double sy : {-0.5, 0.5}) {
      for (const double sz : {-0.5, 0.5}) part.points.push_back({sx * x, sy * y, sz * z});
    }
  }
  type.parts = {part};
  return type;
}

// A row of boxes of two sizes, 0.2 m apart in the middle, at a height.
std::vector<NewPiece> make_row(int count, double height) {
  std::vector<NewPiece> pieces;
  for (int i = 0; i < count; ++i) {
    NewPiece p;
    p.placement.kind = i % 2;
    p.placement.fixed = true;
    p.placement.world_from_body.translation = {0.3 * i, 0.05 * i, height + 0.02 * i * i};
    pieces.push_back(p);
  }
  return pieces;
}

World make_world() { return World({make_box(0.28, 0.2, 0.3), make_box(0.25, 0.4, 0.2)}); }

std::vector<int> range(int first, int last) {
  std::vector<int> r;
  for (int i = first; i < last; ++i) r.push_back(i);
  return r;
}

TEST(Groups, StandWhileFixedAndFallWhenFreed) {
  World world = make_world();
  world.structures().bind(world.add(make_row(6, 5)), 6);
  for (int i = 0; i < 30; ++i) world.step();
  EXPECT_EQ(world.piece(4).world_from_body.translation.z, 5 + 0.02 * 16);
  EXPECT_EQ(world.piece(4).status, PieceStatus::fixed);
  world.structures().split({{range(0, 3), true}, {range(3, 6), false}});
  for (int i = 0; i < 30; ++i) world.step();
  EXPECT_EQ(world.piece(2).world_from_body.translation.z, 5 + 0.02 * 4);
  EXPECT_NEAR(world.piece(4).world_from_body.translation.z, 5 + 0.02 * 16 - 9.81 * 0.5 * 0.25, 1e-9);
  EXPECT_EQ(world.structures().bound_with(4), range(3, 6));
}

TEST(Groups, ThatComeApartKeepMassMomentumAndEnergy) {
  World world = make_world();
  world.structures().bind(world.add(make_row(7, 50)), 7);
  world.structures().split({{range(0, 7), false}});
  world.set_velocity(3, {1, -2, 0.5}, {3, 1, -2});
  for (int i = 0; i < 20; ++i) world.step();
  const Vec3 p = world.diagnostics().linear_momentum(), l = world.diagnostics().angular_momentum();
  const double kinetic = world.diagnostics().kinetic_energy(), potential = world.diagnostics().potential_energy();
  double mass = world.mass(0);
  std::vector<PieceState> before;
  for (int i = 0; i < 7; ++i) before.push_back(world.piece(i));
  world.structures().split({{{0, 1, 4}, false}, {{2}, false}, {{3, 5, 6}, false}});
  EXPECT_NEAR(distance(world.diagnostics().linear_momentum(), p) / norm(p), 0, 1e-12);
  EXPECT_NEAR(distance(world.diagnostics().angular_momentum(), l) / norm(l), 0, 1e-12);
  EXPECT_NEAR(world.diagnostics().kinetic_energy() / kinetic, 1, 1e-12);
  EXPECT_NEAR(world.diagnostics().potential_energy() / potential, 1, 1e-12);
  EXPECT_NEAR((world.mass(0) + world.mass(2) + world.mass(3)) / mass, 1, 1e-12);
  for (int i = 0; i < 7; ++i) {
    const PieceState after = world.piece(i);
    EXPECT_NEAR(distance(after.world_from_body.translation, before[i].world_from_body.translation), 0, 1e-12);
    EXPECT_NEAR(distance(after.linear_velocity, before[i].linear_velocity), 0, 1e-12);
  }
}

TEST(Groups, ASnapshotGoesOnToTheSameBits) {
  World world = make_world();
  world.structures().bind(world.add(make_row(6, 1)), 6);
  world.structures().split({{range(0, 2), true}, {range(2, 6), false}});
  for (int i = 0; i < 40; ++i) world.step();
  const auto bytes = encode_snapshot(*world.snapshot());
  World other = make_world();
  other.restore(*decode_snapshot(bytes));
  for (World* w : {&world, &other}) {
    w->structures().split({{{2, 3}, false}, {{4, 5}, false}});
    for (int i = 0; i < 60; ++i) w->step();
  }
  for (int i = 0; i < 6; ++i) {
    EXPECT_TRUE(world.piece(i).world_from_body.translation == other.piece(i).world_from_body.translation);
    EXPECT_TRUE(world.piece(i).world_from_body.rotation == other.piece(i).world_from_body.rotation);
  }
  EXPECT_GT(world.piece(5).world_from_body.translation.z, 0);
}

TEST(Groups, PressOnWhatCarriesThemWithTheirWeight) {
  World world = make_world();
  world.structures().bind(world.add(make_row(5, 0.3)), 5);
  world.structures().split({{range(0, 5), false}});
  for (int i = 0; i < 240; ++i) world.step();
  double carried = 0, weight = 0;
  for (const ContactImpulse& c : world.structures().contact_impulses()) carried += c.impulse.z * 60;
  weight = world.mass(0) * 9.81;
  EXPECT_NEAR(carried / weight, 1, 0.02);
}

// A block falls on a plate that breaks off as it is met: both go on with what momentum they had, as
// if the plate had never been held.
TEST(Groups, WhatBreaksUnderAnImpactDoesNotStopIt) {
  World world({make_box(1, 1, 0.2), make_box(0.5, 0.5, 0.5)}, {0, 1.0 / 60});
  std::vector<NewPiece> plate(2);
  for (int i = 0; i < 2; ++i) {
    plate[i].placement.fixed = true;
    plate[i].placement.world_from_body.translation = {double(i) * 1.05, 0, 2};
  }
  world.structures().bind(world.add(plate), 2);
  NewPiece block;
  block.placement.kind = 1;
  block.placement.world_from_body.translation = {0, 0, 2.4};
  block.linear_velocity = {0, 0, -6};
  const int number = world.add({block});
  bool whole = true;
  world.structures().set_on_solved([&] {
    if (!whole || world.structures().contact_impulses().empty()) return false;
    whole = false;
    world.structures().split({{{0}, false}, {{1}, true}});
    return true;
  });
  const double momentum = world.mass(number) * -6;
  for (int i = 0; i < 10; ++i) world.step();
  EXPECT_FALSE(whole);
  EXPECT_NEAR(world.diagnostics().linear_momentum().z / momentum, 1, 1e-3);
  EXPECT_LT(world.piece(0).linear_velocity.z, -1);
}

}  // namespace groups_test
}  // namespace rubble
