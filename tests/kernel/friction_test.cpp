// The axes of friction: solved side by side, the two answer each other's impulses unless they are
// the principal ones, and a bar that lies still creeps away.
#include <gtest/gtest.h>

#include <cfenv>
#include <cmath>
#include <string>

#include "kernel/base/random.h"
#include "kernel/solver/contact_law.h"
#include "kernel/solver/friction_axes.h"
#include "kernel/world/world.h"
#include "scenes.h"

namespace rubble {
namespace friction_test {

using testing::at;
using testing::bar_type;
using testing::box_type;
using testing::run;
using testing::turned;

TEST(FrictionAxes, AreThoseOfTheMatrix) {
  RandomStream random(1, "friction axes");
  for (int i = 0; i < 1000; ++i) {
    const double k00 = random.uniform(0.1, 10), k11 = random.uniform(0.1, 10);
    const double k01 = random.uniform(-1, 1) * std::sqrt(k00 * k11);
    const PlaneTurn<double> turn = find_friction_axes(k00, k01, k11);
    EXPECT_NEAR(turn.cosine * turn.cosine + turn.sine * turn.sine, 1, 1e-14);
    EXPECT_GE(turn.cosine, std::sqrt(0.5) - 1e-14);  // 45 degrees at most
    // K in the turned axes: R K R^T.
    double first[2] = {k00, k01}, second[2] = {k01, k11};  // rows of K
    turn.apply(first[0], second[0]);
    turn.apply(first[1], second[1]);
    turn.apply(first[0], first[1]);
    turn.apply(second[0], second[1]);
    EXPECT_NEAR(first[1], 0, 1e-13 * (k00 + k11));
    EXPECT_NEAR(first[0] + second[1], k00 + k11, 1e-13 * (k00 + k11));
    EXPECT_NEAR(first[0] * second[1], k00 * k11 - k01 * k01, 1e-12 * (k00 + k11) * (k00 + k11));
  }
}

TEST(FrictionAxes, StayWhereNothingIsCoupled) {
  for (const auto& [k00, k11] : {std::pair(1.0, 2.0), {2.0, 1.0}, {1.0, 1.0}, {0.0, 0.0}}) {
    const PlaneTurn<double> turn = find_friction_axes(k00, 0.0, k11);
    EXPECT_EQ(turn.cosine, 1);
    EXPECT_EQ(turn.sine, 0);
  }
}

// Subnormal numbers cost some processors a hundred times the time of others. Where hardly anything of one component is
// left beside the others, there are some.
TEST(FrictionLaw, ComputesWithNormalNumbers) {
  RandomStream random(2, "friction law");
  constexpr int kCases = 100000;
  int subnormal = 0;
  for (int i = 0; i < kCases; ++i) {
    const float size = std::pow(10.0F, float(random.uniform(-2, 5)));
    float masses[3], sticking[3], most = 0;
    for (int k = 0; k < 3; ++k) {
      masses[k] = size * float(random.uniform(0.1, 1));
      const float speed = std::pow(10.0F, float(random.uniform(-12, 2)));
      sticking[k] = contact_law::drop_tiny(masses[k] * speed, masses[k]);
      most = std::max(most, sticking[k]);
    }
    const float limit = i % 2 == 0 ? 0 : most * std::pow(10.0F, float(random.uniform(-6, 0)));
    std::feclearexcept(FE_ALL_EXCEPT);
    const contact_law::Slip<float> slip = contact_law::find_slip(limit, masses, sticking);
    EXPECT_TRUE(std::isfinite(slip.slide) && std::isfinite(slip.twist));
    subnormal += std::fetestexcept(FE_UNDERFLOW) != 0;
  }
  EXPECT_LT(subnormal, kCases / 20);
}

// Next to nothing, very much and zero: no slip becomes infinite, and the impulse shrinks.
TEST(FrictionLaw, TakesNumbersOfAnySize) {
  RandomStream random(1, "friction law");
  const auto number = [&random](int lowest, int highest) {
    const bool nothing = random.uniform(0, 1) < 0.1;
    const double size = random.uniform(lowest, highest), sign = random.uniform(-1, 1);
    return nothing ? 0.0F : float(std::copysign(std::pow(10.0, size), sign));
  };
  for (int i = 0; i < 100000; ++i) {
    const float limit = std::abs(number(-44, 6));
    float masses[3], sticking[3];
    for (float& mass : masses) mass = std::abs(number(-6, 6));
    for (float& impulse : sticking) impulse = number(-44, 6);
    const contact_law::Slip<float> slip = contact_law::find_slip(limit, masses, sticking);
    ASSERT_TRUE(std::isfinite(slip.slide) && std::isfinite(slip.twist)) << i;
    ASSERT_GE(slip.slide, 0) << i;
    ASSERT_GE(slip.twist, 0) << i;
  }
}

// A hexagonal bar across two supports, all tilted and turned at random; what it moves in 1 s, awake,
// when 6 s have passed. Infinite: it fell off.
double creep(std::uint64_t seed) {
  RandomStream random(seed, "bar across edges");
  const auto tilt = [&random] {
    const double x = random.uniform(-1, 1);
    const double y = random.uniform(-1, 1);
    return turned({x, y, 0}, random.uniform(0, 0.3));
  };
  const double rise = random.uniform(0, 0.3), yaw = random.uniform(-0.2, 0.2);
  const double roll = random.uniform(-3, 3), turn = random.uniform(0, 1.5);
  const Quat along = turned({0, 0, 1}, yaw) * turned({0, -1, 0}, std::atan(rise / 0.9));
  std::vector<NewPiece> pieces{at(0, {-0.45, 0, 1}, tilt(), true),
                               at(0, {0.45, 0, 1 + rise}, tilt(), true),
                               at(1, {0, 0, 1.22 + rise / 2}, along * turned({1, 0, 0}, roll))};
  const Pose around{turned({0, 0, 1}, turn), {}};
  for (NewPiece& piece : pieces) {
    piece.placement.world_from_body = around * piece.placement.world_from_body;
  }
  WorldOptions options;
  options.sleeping = false;
  options.threads = 1;
  World world({box_type("support", 0.4, 0.4, 0.2), bar_type(1.5, 0.02)}, options);
  world.add(pieces);
  run(world, 6);
  const Vec3 before = world.piece(2).world_from_body.translation;
  if (before.z < 0.8) return INFINITY;
  run(world, 1);
  return distance(world.piece(2).world_from_body.translation, before);
}

TEST(Friction, BarsAcrossTiltedEdgesStayWhereTheyLie) {
  int lying = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const double moved = creep(seed);
    if (moved == INFINITY) continue;
    ++lying;
    EXPECT_LT(moved, 2e-5) << "seed " << seed;
  }
  EXPECT_GT(lying, 80);
}

// How far a box slides down a fixed slab in 1 s.
double slide(double box_friction, double slab_friction, double slope) {
  std::vector<PieceType> types{box_type("slab", 6, 2, 0.2), box_type("box", 0.4, 0.4, 0.2)};
  types[0].friction = slab_friction, types[1].friction = box_friction;
  WorldOptions options;
  options.sleeping = false;
  options.threads = 1;
  World world(types, options);
  const Quat tilt = turned({0, 1, 0}, std::atan(slope));
  const Pose slab{tilt, {0, 0, 3}};
  world.add({at(0, slab.translation, tilt, true), at(1, slab * Vec3{-1, 0, 0.2}, tilt)});
  const Vec3 before = world.piece(1).world_from_body.translation;
  run(world, 1);
  return distance(world.piece(1).world_from_body.translation, before);
}

// 0.2 on 0.8 is 0.4, whichever of the two is below.
TEST(Friction, OfAPairIsTheGeometricMean) {
  for (const auto& [box, slab] : {std::pair(0.2, 0.8), {0.8, 0.2}}) {
    EXPECT_LT(slide(box, slab, 0.37), 0.002);
    const double slope = 0.6, cosine = 1 / std::sqrt(1 + slope * slope);
    EXPECT_NEAR(slide(box, slab, slope), 0.5 * 9.81 * (slope - 0.4) * cosine, 0.05);
  }
}

}  // namespace friction_test
}  // namespace rubble
