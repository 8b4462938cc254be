// Ties between pieces: what they carry at rest, how they swing, yield and tear.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"
#include "kernel/world/world_snapshot.h"
#include "kernel/world/world_structures.h"
#include "scenes.h"

namespace rubble {
namespace ties_test {

constexpr double kGravity = 9.81, kStep = 1.0 / 60;

PieceType make_box(const Vec3& size, double density) {
  PieceType type = testing::box_type("box", size.x, size.y, size.z);
  type.density = density;
  return type;
}

NewPiece at(int type, const Vec3& place, bool fixed = false) { return testing::at(type, place, {}, fixed); }

// A box of 100 kg below a beam that does not move, on a bar of a metre.
struct Hanging {
  World world;
  double mass = 0;
  explicit Hanging(double strength, double stretch, const Vec3& from = {0, 0, 4}, int threads = 1)
      : world({make_box({0.2, 0.2, 0.2}, 12500), make_box({1, 1, 0.2}, 2400)}, options(threads)) {
    world.add({at(1, {0, 0, 5.1}, true), at(0, from)});
    mass = world.mass(1);
    world.structures().add_tie({0, 1, {0, 0, -0.1}, {}, 1, strength, stretch});
  }
  static WorldOptions options(int threads) {
    WorldOptions o;
    o.threads = threads;
    return o;
  }
  void run(double seconds) {
    for (int i = 0; i < int(seconds / kStep + 0.5); ++i) world.step();
  }
  Vec3 place() const { return world.piece(1).world_from_body.translation; }
};

TEST(Ties, CarryTheWeightOfWhatHangsOnThemAndLetItSleep) {
  Hanging h(1e5, 0.1);
  h.run(3);
  ASSERT_EQ(h.world.structures().ties().size(), 1u);
  EXPECT_NEAR(h.world.structures().tie_force(0) / (h.mass * kGravity), 1, 0.01);
  EXPECT_NEAR(h.place().z, 4, 0.002);
  EXPECT_EQ(h.world.awake_count(), 0);
  EXPECT_EQ(h.world.structures().ties()[0].stretch, 0.1);
  h.world.rest().begin_verification();
  h.run(1.5);
  EXPECT_TRUE(h.world.rest().verified(0.05, 0.2));
}

TEST(Ties, OfASlackBarDoNothing) {
  Hanging h(1e5, 0.1, {0, 0, 4.5});
  h.run(0.25);
  EXPECT_EQ(h.world.structures().tie_force(0), 0);
  EXPECT_NEAR(h.place().z, 4.5 - kGravity * 0.25 * 0.25 / 2, 1e-9);
  h.run(3);
  EXPECT_NEAR(h.place().z, 4, 0.02);
}

// Of a weight whose own inertia is 2/5 (a/L)^2/... of the whole: its anchor is its centre.
TEST(Ties, LetAWeightSwingLikeAPendulum) {
  const double angle = 0.1;
  Hanging h(1e6, 0.1, {std::sin(angle), 0, 5 - std::cos(angle)});
  int crossings = 0;
  double last = h.place().x, first_time = 0, time = 0;
  while (crossings < 5 && time < 20) {
    h.world.step();
    time += kStep;
    const double x = h.place().x;
    if ((x > 0) != (last > 0)) {
      if (++crossings == 1) first_time = time;
    }
    last = x;
  }
  ASSERT_EQ(crossings, 5);
  const double period = 2 * 3.14159265 * std::sqrt(1 / kGravity) * (1 + angle * angle / 16);
  EXPECT_NEAR((time - first_time) / 2 / period, 1, 0.02);
  EXPECT_GT(h.world.size(), 1);
}

// m v^2 / 2 = (F - m g) s: a fall is stopped by a bar that yields.
TEST(Ties, StopAFallByYieldingAsTheEnergySays) {
  const double drop = 0.9;
  Hanging h(8000, 1, {0, 0, 4 + drop});
  h.run(3);
  ASSERT_EQ(h.world.structures().ties().size(), 1u);
  const double stretched = h.world.structures().ties()[0].length - 1;
  const double expected = h.mass * kGravity * drop / (8000 - h.mass * kGravity);
  EXPECT_NEAR(stretched / expected, 1, 0.05);
  EXPECT_NEAR(h.world.structures().tie_energy() / (8000 * stretched), 1, 1e-9);
  EXPECT_NEAR(h.place().z, 4 - stretched, 0.003);
}

// What is left is the energy of the fall less that of tearing.
TEST(Ties, TearWhenTheyAreStretchedOutAndTakeTheirEnergy) {
  const double drop = 0.9, stretch = 0.05;
  Hanging h(4000, stretch, {0, 0, 4 + drop});
  double speed = 0;
  while (!h.world.structures().ties().empty() && h.world.time() < 2) {
    h.world.step();
    speed = -h.world.piece(1).linear_velocity.z;
  }
  ASSERT_TRUE(h.world.structures().ties().empty());
  EXPECT_NEAR(h.world.structures().tie_energy() / (4000 * stretch), 1, 1e-6);
  const double fallen = 4 + drop - h.place().z;
  const double left = h.mass * kGravity * fallen - 0.5 * h.mass * speed * speed;
  EXPECT_NEAR(left / (4000 * stretch), 1, 0.25) << "to a step's share";
  const double z = h.place().z;
  h.run(0.1);
  EXPECT_LT(h.place().z, z - 0.3) << "it falls on";
}

TEST(Ties, ThatAreTooWeakYieldUntilTheyTear) {
  Hanging h(500, 0.05);
  h.run(0.1);
  // (m g - F) / m
  const double a = kGravity - 500 / h.mass;
  EXPECT_NEAR((4 - h.place().z) / (0.5 * a * 0.01), 1, 0.2);
  h.run(0.5);
  EXPECT_TRUE(h.world.structures().ties().empty());
}

TEST(Ties, KeepMomentumWhereTwoBodiesPullEachOther) {
  WorldOptions options;
  options.gravity = 0;
  World world({make_box({0.3, 0.2, 0.2}, 2400), make_box({0.2, 0.4, 0.2}, 3000)}, options);
  NewPiece flying = at(1, {0, 0.6, 50.2});
  flying.linear_velocity = {3, 2, 1};
  world.add({at(0, {0, 0, 50}), flying});
  world.structures().add_tie({0, 1, {0.15, 0.1, 0.1}, {0, -0.2, 0}, 0.8, 5e4, 0.3});
  const Vec3 p = world.diagnostics().linear_momentum(), l = world.diagnostics().angular_momentum();
  const double energy = world.diagnostics().kinetic_energy();
  double pulled = 0;
  for (int i = 0; i < 120; ++i) {
    world.step();
    if (!world.structures().ties().empty()) pulled = std::max(pulled, world.structures().tie_force(0));
    EXPECT_LT(world.diagnostics().kinetic_energy(), energy * 1.0001);
  }
  EXPECT_GT(pulled, 100) << "it was taut";
  EXPECT_LT(norm(world.diagnostics().linear_momentum() - p), 1e-3 * norm(p));
  EXPECT_LT(norm(world.diagnostics().angular_momentum() - l), 0.02 * norm(l));
}

// A plate that lay level between two bars of its edge turns down about that edge.
TEST(Ties, LetAPlateHangByItsEdge) {
  World world({make_box({2, 2, 0.3}, 2400), make_box({1.2, 1.2, 0.15}, 2400)});
  world.add({at(0, {0, 0, 4}, true), at(1, {1.605, 0, 4})});
  for (const double y : {-0.4, 0.4}) {
    world.structures().add_tie({0, 1, {0.9, y, 0}, {-0.5, y, 0}, 0.29, 1e5, 0.05, 300});
  }
  for (int i = 0; i < 1200; ++i) world.step();
  EXPECT_EQ(world.structures().ties().size(), 2u);
  const Vec3 outwards = world.piece(1).world_from_body.rotation.rotate({1, 0, 0});
  EXPECT_LT(outwards.z, -0.8) << "bent bars hold it back a little";
  EXPECT_EQ(world.awake_count(), 0);
  EXPECT_NEAR((world.structures().tie_force(0) + world.structures().tie_force(1)) / (world.mass(1) * kGravity), 1, 0.35)
      << "it leans on the edge as well";
}

// A bar that is bent stops what swings, as friction does: M t is the angular momentum that is lost.
TEST(Ties, BrakeTheTurningOfWhatHangsOnThem) {
  World world({make_box({0.4, 0.4, 0.4}, 2400), make_box({2, 2, 0.3}, 2400)});
  NewPiece spinning = at(0, {0, 0, 4});
  spinning.angular_velocity = {0, 0, 6};
  world.add({at(1, {0, 0, 5.15}, true), spinning});
  world.structures().add_tie({0, 1, {0, 0, -0.15}, {0, 0, 0.2}, 0.8, 1e6, 0.05, 20});
  const double inertia = world.mass(1) * 0.16 / 6, expected = 6 * inertia / 20;
  double time = 0;
  while (std::abs(world.piece(1).angular_velocity.z) > 0.01 && time < 60) world.step(), time += kStep;
  EXPECT_NEAR(time / expected, 1, 0.05);
}

TEST(Ties, GoOnFromASnapshotToTheSameBits) {
  const auto hash = [](World& world) {
    std::vector<std::uint8_t> bytes = encode_snapshot(*world.snapshot());
    std::uint64_t h = 1469598103934665603u;
    for (const std::uint8_t b : bytes) h = (h ^ b) * 1099511628211u;
    return h;
  };
  Hanging whole(8000, 1, {0.3, 0, 4.9});
  whole.run(0.7);
  const auto bytes = encode_snapshot(*whole.world.snapshot());
  Hanging resumed(8000, 1, {0, 0, 4}, 2);
  resumed.world.restore(*decode_snapshot(bytes));
  whole.run(0.5), resumed.run(0.5);
  EXPECT_EQ(hash(whole.world), hash(resumed.world));
  Hanging other(8000, 0.9, {0.3, 0, 4.9});
  other.run(1.2);
  EXPECT_NE(hash(whole.world), hash(other.world)) << "what is left of a bar counts";
}

TEST(Ties, OutOfRangeAreRefusedByTheirKey) {
  Hanging h(1e4, 0.1);
  const auto message = [&](const TieState& tie) {
    try {
      h.world.structures().add_tie(tie);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(message({0, 7, {}, {}, 1, 1, 1}).find("tie.piece_b"), std::string::npos);
  EXPECT_NE(message({0, 1, {}, {}, 0, 1, 1}).find("tie.length"), std::string::npos);
  EXPECT_NE(message({0, 1, {}, {}, 1, -1, 1}).find("tie.strength"), std::string::npos);
}

}  // namespace ties_test
}  // namespace rubble
