// The moment of a bent inflated cylinder against its wall, summed piece by piece.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/multibody/springs/tree_springs.h"

namespace rubble {
namespace inflated_bend_test {

// The tube of radius 1 with P = 2 and E t = 1: it wrinkles at a curvature of 1 with a moment of pi. At
// a curvature k the wall at angle a has the strain e - k cos a, and no tension where that is negative.
struct WallSum {
  double force = 0, moment = 0;
};
WallSum sum_wall(double mean, double curvature) {
  constexpr int kPieces = 40000;
  const double width = 2 * std::acos(-1.0) / kPieces;
  WallSum sum;
  for (int i = 0; i < kPieces; ++i) {
    const double a = (i + 0.5) * width, tension = std::max(0.0, mean - curvature * std::cos(a));
    sum.force += tension * width;
    sum.moment -= tension * std::cos(a) * width;
  }
  return sum;
}

// The strain at which the wall carries the pressure on the tube's end, P pi R^2.
double find_mean(double curvature) {
  double low = -curvature, high = curvature + 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sum_wall(middle, curvature).force < 2 * std::acos(-1.0) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

TEST(InflatedBend, IsTheMomentOfAWallThatTakesNoPressure) {
  for (const double bend : {0.3, 0.99, 1.01, 1.5, 3.0, 10.0, 60.0}) {
    const double expected = sum_wall(find_mean(bend), bend).moment / std::acos(-1.0);
    EXPECT_NEAR(calc_inflated_bend(bend).moment, expected, 2e-4) << bend;
  }
}

TEST(InflatedBend, WrinklesAtOneAndCollapsesAtTwice) {
  EXPECT_EQ(calc_inflated_bend(1).moment, 1);
  EXPECT_LT(calc_inflated_bend(1.2).moment, 1.19);
  EXPECT_LT(calc_inflated_bend(1e5).moment, 2);
  EXPECT_GT(calc_inflated_bend(1e5).moment, 1.999);
}

TEST(InflatedBend, TheMomentIsTheSlopeOfTheEnergyAndTheTangentThatOfTheMoment) {
  constexpr double kH = 1e-4;
  for (const double bend : {0.5, 1.1, 2.0, 7.0, 40.0}) {
    const InflatedBend less = calc_inflated_bend(bend - kH), more = calc_inflated_bend(bend + kH),
                       here = calc_inflated_bend(bend);
    EXPECT_NEAR((more.energy - less.energy) / (2 * kH), here.moment, 1e-6) << bend;
    EXPECT_NEAR((more.moment - less.moment) / (2 * kH), here.tangent, 1e-6) << bend;
  }
}

}  // namespace inflated_bend_test
}  // namespace rubble
