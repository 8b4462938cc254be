// Sleep must not change mechanics: what loses its supports falls, what is far away does not matter.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "closed_forms.h"
#include "kernel/base/hash.h"
#include "kernel/settling/generator.h"

namespace rubble {
namespace closed_forms_sleep_test {

using namespace testing;

// A plank of 2 m, of timber or concrete, asleep on bricks spread along it.
World make_shelf(int bricks, double density) {
  PieceType plank = box_type("plank", 2, 0.15, 0.03), brick = box_type("brick", 0.1, 0.2, 0.065);
  plank.density = density, brick.density = 1900;
  World world({plank, brick});
  std::vector<NewPiece> pieces{at(0, {0, 0, 0.065 + 0.015 + 0.002})};
  for (int i = 0; i < bricks; ++i) {
    pieces.push_back(at(1, {-0.9 + 1.8 * i / (bricks - 1), 0, 0.0335}));
  }
  world.add(pieces);
  run(world, 4);
  EXPECT_EQ(world.awake_count(), 0);
  EXPECT_NEAR(world.piece(0).world_from_body.translation.z, 0.08, 0.003);
  return world;
}

// At 20 m/s a brick is out from under the plank in a hundredth of a second.
void throw_brick(World& world, int brick) {
  world.set_velocity(brick, {0, brick % 2 == 0 ? 20.0 : -20.0, 0}, {});
}

// It takes sqrt(2 h / g) = 0.115 s to fall 6.5 cm, and then lies flat.
TEST(ClosedFormSleep, APlankFallsWhenItsBricksFlyOff) {
  for (const double density : {500.0, 2400.0}) {
    for (int bricks = 2; bricks <= 6; ++bricks) {
      World world = make_shelf(bricks, density);
      for (int i = 1; i <= bricks; ++i) throw_brick(world, i);
      run(world, 2);
      EXPECT_NEAR(world.piece(0).world_from_body.translation.z, 0.015, 0.003)
          << bricks << " bricks, " << density << " kg/m3";
    }
  }
}

TEST(ClosedFormSleep, APlankFallsWhenItsBricksFlyOffOneByOne) {
  for (const double density : {500.0, 2400.0}) {
    for (int bricks = 2; bricks <= 6; ++bricks) {
      World world = make_shelf(bricks, density);
      for (int i = 1; i <= bricks; ++i) {
        throw_brick(world, i);
        run(world, 0.05);
      }
      run(world, 2);
      EXPECT_NEAR(world.piece(0).world_from_body.translation.z, 0.015, 0.003)
          << bricks << " bricks, " << density << " kg/m3";
    }
  }
}

// Only one end loses its brick: the plank turns down about the other.
TEST(ClosedFormSleep, APlankThatLosesOneOfTwoBricksTips) {
  World world = make_shelf(2, 500);
  throw_brick(world, 1);
  run(world, 2);
  EXPECT_NEAR(std::abs(tilt_of(world, 0)), 0.065 / 1.85, 0.005);
}

// A slab of 460 t creeps against a brick of 2.5 kg that is asleep: pushed along or woken, the brick goes no faster than what
// pushes it. As it is solved as immovable at first, it gets as much as stops the slab.
TEST(ClosedFormSleep, AHeavySlabDoesNotThrowASleepingBrick) {
  PieceType slab = box_type("slab", 24, 20, 0.4), brick = box_type("brick", 0.1, 0.2, 0.065);
  slab.density = 2400, brick.density = 1900;
  for (const double speed : {0.02, 0.04, 0.06, 0.08, 0.1, 0.2, 0.4}) {
    World world({slab, brick});
    world.add({at(0, {0, 0, 0.2}), at(1, {12.0505, 0, 0.0325})});
    run(world, 4);
    ASSERT_EQ(world.awake_count(), 0);
    world.set_velocity(0, {speed, 0, 0}, {0, 0, 0.3 * speed});
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
      world.step();
      fastest = std::max(fastest, norm(world.piece(1).linear_velocity));
    }
    EXPECT_LT(fastest, 3 * speed + 0.2) << speed;
  }
}

// Bit patterns of the first `count` pieces.
std::uint64_t hash_of_first(const World& world, int count) {
  PileState state;
  for (int i = 0; i < count; ++i) state.pieces.push_back(world.piece(i));
  return state.state_hash();
}

// A falling pile; then `extra` pieces that fall far away from it.
World make_pile(int extra, const Vec3& away) {
  const Pile pile = generate_pile(small_pile(3, 1, 50));
  WorldOptions options;
  options.threads = 1;
  World world(pile.types, options);
  std::vector<NewPiece> pieces;
  for (const Placement& p : pile.layers[0].pieces) {
    pieces.push_back({});
    pieces.back().placement = p;
    pieces.back().placement.world_from_body.translation.z += 0.5;
  }
  for (int i = 0; i < extra; ++i) {
    pieces.push_back(at(2 + i % 6, away + Vec3{0.1 * (i % 3), 0.15 * (i % 2), 0.6 + 0.5 * i},
                        turned({1, 2, 3}, 0.3 * i)));
  }
  world.add(pieces);
  return world;
}

// Step after step the same bits as without the far ones, and so they are for other offsets.
TEST(ClosedFormSleep, AFallThirtyMetresAwayDoesNotChangeAPile) {
  const int steps = 240;
  World alone = make_pile(0, {});
  const int size = alone.size();
  std::vector<std::uint64_t> expected;
  for (int i = 0; i < steps; ++i) {
    alone.step();
    expected.push_back(hash_of_first(alone, size));
  }
  for (const auto& [extra, away] : {std::pair(1, Vec3{30, 0, 0}),
                                    {3, Vec3{0, -30, 0}},
                                    {7, Vec3{-45, 20, 0}},
                                    {24, Vec3{25, 30, 0}}}) {
    World world = make_pile(extra, away);
    for (int i = 0; i < steps; ++i) {
      world.step();
      ASSERT_EQ(hash_of_first(world, size), expected[std::size_t(i)])
          << "step " << i << " with " << extra << " pieces far away";
    }
  }
}

}  // namespace closed_forms_sleep_test
}  // namespace rubble
