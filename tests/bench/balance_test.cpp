// The judge of balance against closed forms: problems whose forces are known by hand.
#include "bench/equilibrium/balance.h"

#include <gtest/gtest.h>

#include <cmath>

namespace rubble {
namespace balance_test {

constexpr double kWeight = 100;  // of every body here; unit: N
constexpr double kSolved = 1e-5;  // a residual below this is none

BalanceBody make_body(const Vec3& centre, double length, double weight = kWeight) {
  return {centre, weight, length, {0, 0, -weight}, {}};
}

Vec3 normal_of_slope(double angle) { return {-std::sin(angle), 0, std::cos(angle)}; }

// A cube of 1 m on a slope that rises along X.
BalanceProblem make_slope(double angle, double friction) {
  BalanceProblem p;
  const Vec3 n = normal_of_slope(angle), along{std::cos(angle), 0, std::sin(angle)};
  p.bodies = {make_body(n * 0.5, 0.5)};
  for (double x : {-0.5, 0.5})
    for (double y : {-0.5, 0.5})
      p.contacts.push_back({kImmovable, 0, along * x + Vec3{0, y, 0}, n, friction});
  return p;
}

TEST(Balance, ABoxOnASlopeHoldsUpToTheFrictionAngle) {
  const double friction = 0.6, angle = std::atan(friction);
  EXPECT_LT(solve_balance(make_slope(angle - 1e-4, friction)).residual[0], kSolved);
  const BalanceResult beyond = solve_balance(make_slope(angle + 0.02, friction));
  EXPECT_TRUE(beyond.optimal);
  // What friction cannot carry, w (sin - mu cos), at least.
  const double missing = std::sin(angle + 0.02) - friction * std::cos(angle + 0.02);
  EXPECT_GT(beyond.residual[0], 0.8 * missing);
  EXPECT_LT(beyond.residual[0], 1.5 * missing);
}

// Round cones: a slope that falls in a direction between any four or sixteen facets.
TEST(Balance, FrictionIsTheSameInEveryDirection) {
  const double friction = 0.5, angle = std::atan(friction) - 1e-4;
  for (int i = 0; i < 16; ++i) {
    const double turn = 0.13 + 0.4 * i;
    BalanceProblem p = make_slope(0, friction);
    // The same as a slope: gravity leans over, by an angle that no first direction knows of.
    p.bodies[0].force = Vec3{std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn),
                             -std::cos(angle)} * kWeight;
    EXPECT_LT(solve_balance(p).residual[0], kSolved) << turn;
  }
}

TEST(Balance, ABoxTallerThanItsBaseAllowsTipsBeforeItSlides) {
  const auto make = [](double angle) {
    BalanceProblem p = make_slope(angle, 10);
    p.bodies[0].centre = normal_of_slope(angle) * 1.0;  // twice as high: tips at atan(0.5 / 1)
    return p;
  };
  EXPECT_LT(solve_balance(make(std::atan(0.5) - 1e-4)).residual[0], kSolved);
  EXPECT_GT(solve_balance(make(std::atan(0.5) + 0.02)).residual[0], 0.01);
}

TEST(Balance, ABeamOnTwoSupportsSharesItsWeightByTheLever) {
  BalanceProblem p;
  p.bodies = {make_body({0, 0, 1}, 0.6)};
  for (double x : {-0.4, 1.2}) p.contacts.push_back({kImmovable, 0, {x, 0, 0.9}, {0, 0, 1}, 0.5});
  const BalanceResult result = solve_balance(p);
  EXPECT_LT(result.residual[0], kSolved);
  EXPECT_NEAR(result.contact_force[0].z, 75, 0.01);
  EXPECT_NEAR(result.contact_force[1].z, 25, 0.01);
}

// A plank of 2 m whose centre is `past` beyond the edge that it lies on.
BalanceProblem make_plank(double past) {
  BalanceProblem p;
  p.bodies = {make_body({past, 0, 1}, 2 / std::sqrt(12))};
  for (double x : {-1 + past, 0.0})
    for (double y : {-0.1, 0.1}) p.contacts.push_back({kImmovable, 0, {x, y, 1}, {0, 0, 1}, 0.5});
  return p;
}

TEST(Balance, APlankFiveMillimetresPastItsEdgeIsFoundOut) {
  EXPECT_LT(solve_balance(make_plank(-0.005)).residual[0], kSolved);
  EXPECT_NEAR(solve_balance(make_plank(0.005)).residual[0], 0.005 / (2 / std::sqrt(12)), 1e-5);
}

// A ladder on a smooth wall: the floor must give mu >= half the cotangent of its angle.
BalanceProblem make_ladder(double angle, double floor_friction) {
  BalanceProblem p;
  const Vec3 top{2 * std::cos(angle), 0, 2 * std::sin(angle)};
  p.bodies = {make_body(top * 0.5, 2 / std::sqrt(12))};
  p.contacts = {{kImmovable, 0, {}, {0, 0, 1}, floor_friction},
                {kImmovable, 0, top, {-1, 0, 0}, 0}};
  return p;
}

TEST(Balance, ALadderOnASmoothWallNeedsHalfTheCotangent) {
  const double angle = 1.0, needed = 0.5 / std::tan(angle);
  const BalanceResult held = solve_balance(make_ladder(angle, needed + 1e-4));
  EXPECT_LT(held.residual[0], kSolved);
  EXPECT_NEAR(held.contact_force[1].x, -kWeight * needed, 0.01);
  EXPECT_GT(solve_balance(make_ladder(angle, needed * 0.9)).residual[0], 0.01);
}

// Two blocks that lean on each other over a gap: a three-hinged arch.
BalanceProblem make_arch(double friction) {
  BalanceProblem p;
  const double half_span = 1, rise = 0.5, x = 0.5;  // centres half way
  p.bodies = {make_body({-x, 0, 0.4}, 0.3), make_body({x, 0, 0.4}, 0.3)};
  for (double y : {-0.2, 0.2}) {
    p.contacts.push_back({kImmovable, 0, {-half_span, y, 0}, {0, 0, 1}, friction});
    p.contacts.push_back({kImmovable, 1, {half_span, y, 0}, {0, 0, 1}, friction});
    p.contacts.push_back({0, 1, {0, y, rise}, {1, 0, 0}, 0.3});
  }
  return p;
}

TEST(Balance, AnArchStandsWhileItsFeetCanThrust) {
  // Moments of one block about its foot: thrust * rise = weight * 0.5; the foot carries one weight.
  const double thrust = 0.5 / 0.5;  // in weights
  const BalanceResult stands = solve_balance(make_arch(thrust + 1e-4));
  EXPECT_LT(stands.residual[0], kSolved);
  EXPECT_LT(stands.residual[1], kSolved);
  EXPECT_NEAR(stands.contact_force[2].x + stands.contact_force[5].x, kWeight * thrust, 0.1);
  const BalanceResult falls = solve_balance(make_arch(thrust * 0.9));
  EXPECT_GT(falls.residual[0] + falls.residual[1], 0.02);
}

TEST(Balance, AHeavyBodyOnALightOneIsNoHarder) {
  BalanceProblem p;
  p.bodies = {make_body({0, 0, 0.05}, 0.05, 1), make_body({0, 0, 0.6}, 0.5, 1e5)};
  for (double x : {-0.1, 0.1}) {
    for (double y : {-0.1, 0.1}) {
      p.contacts.push_back({kImmovable, 0, {x, y, 0}, {0, 0, 1}, 0.5});
      p.contacts.push_back({0, 1, {x, y, 0.1}, {0, 0, 1}, 0.5});
    }
  }
  const BalanceResult result = solve_balance(p);
  EXPECT_LT(result.residual[0], 1e-3);  // of the light one's weight: 1e-8 of what it carries
  EXPECT_LT(result.residual[1], kSolved);
  EXPECT_EQ(result.largest_island, 2);
}

// A door of 1 m on a hinge about an upright axis needs nothing else; lying, it hangs down.
BalanceProblem make_door(const Vec3& axis) {
  BalanceProblem p;
  p.bodies = {make_body({0.5, 0, 1}, 0.3)};
  const Vec3 hinge{0, 0, 1};
  for (const Vec3& d : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
    p.reactions.push_back({kImmovable, 0, d, {}, hinge, false});
    if (dot(d, axis) == 0) p.reactions.push_back({kImmovable, 0, {}, d, hinge, false});
  }
  return p;
}

TEST(Balance, AHingeCarriesAllButTheTorqueAboutItsAxis) {
  EXPECT_LT(solve_balance(make_door({0, 0, 1})).residual[0], kSolved);
  BalanceProblem flap = make_door({0, 1, 0});
  EXPECT_GT(solve_balance(flap).residual[0], 0.1);
  flap.bodies[0].torque = {0, -kWeight * 0.5, 0};  // a spring that lifts its free end
  EXPECT_LT(solve_balance(flap).residual[0], kSolved);
}

TEST(Balance, AStopPushesOneWayOnly) {
  for (const double direction : {1.0, -1.0}) {
    BalanceProblem flap = make_door({0, 1, 0});
    flap.reactions.push_back({kImmovable, 0, {}, {0, direction, 0}, {0, 0, 1}, true});
    const double residual = solve_balance(flap).residual[0];
    if (direction < 0) {
      EXPECT_LT(residual, kSolved);
    } else {
      EXPECT_GT(residual, 0.1);
    }
  }
}

TEST(Balance, WhatFloatsIsOffByItsWholeWeight) {
  BalanceProblem p = make_slope(0, 0.5);
  p.bodies.push_back(make_body({0, 0, 9}, 0.5));
  const BalanceResult result = solve_balance(p);
  EXPECT_LT(result.residual[0], kSolved);
  EXPECT_DOUBLE_EQ(result.residual[1], 1);
  EXPECT_EQ(result.count_above(0.5), 1);
  EXPECT_NEAR(result.mean_residual(), 0.5, kSolved);
}

}  // namespace balance_test
}  // namespace rubble
