// The judge of overlaps against closed forms: both of its ways to find a depth must be right before
// they may judge the kernel.
#include "bench/penetration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"

namespace rubble {
namespace penetration_test {

constexpr double kExact = 1e-12;  // unit: m
constexpr double kCcd = 2e-6;     // what libccd is trusted to in these simple cases; unit: m

std::vector<Vec3> box_corners(const Vec3& half) {
  std::vector<Vec3> corners;
  for (double x : {-half.x, half.x}) {
    for (double y : {-half.y, half.y}) {
      for (double z : {-half.z, half.z}) corners.push_back({x, y, z});
    }
  }
  return corners;
}

double calc_depth_exact(const PlacedHull& a, const PlacedHull& b) {
  return calc_penetration(a, b).depth;
}

PlacedHull place_box(const Vec3& half, const Pose& pose) {
  return place_hull(make_true_hull(box_corners(half)), 1.0, pose);
}

std::vector<Vec3> random_lump(RandomStream& random, int count) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.push_back(random.direction() * random.uniform(0.8, 1.0));
  return points;
}

TEST(TrueHull, HasTheDirectionsOfABox) {
  const TrueHull hull = make_true_hull(box_corners({1, 2, 3}));
  EXPECT_EQ(hull.corners.size(), 8U);
  EXPECT_EQ(hull.face_normals.size(), 3U);
  EXPECT_EQ(hull.edge_directions.size(), 3U);
}

TEST(TrueHull, HasTheDirectionsOfATetrahedron) {
  const TrueHull hull = make_true_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  EXPECT_EQ(hull.face_normals.size(), 4U);
  EXPECT_EQ(hull.edge_directions.size(), 6U);
}

TEST(TrueHull, LeavesOutPointsInside) {
  std::vector<Vec3> points = box_corners({1, 1, 1});
  points.push_back({0.5, 0.5, 0.2});
  EXPECT_EQ(make_true_hull(points).corners.size(), 8U);
}

TEST(TrueHull, RefusesFlatPoints) {
  EXPECT_THROW(make_true_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(make_true_hull({}), std::invalid_argument);
}

// Two boxes of half edge 0.5, 0.4, 0.3, one pushed into the other along z, the whole turned at
// will.
TEST(Penetration, OfStackedBoxesIsTheirKnownDepthInAnyOrientation) {
  RandomStream random(1, "stacked boxes");
  const Vec3 half{0.5, 0.4, 0.3};
  for (double depth : {1e-4, 1e-3, 5e-3, 1e-2, 0.05}) {
    for (int i = 0; i < 20; ++i) {
      const Pose world{random.rotation(), random.direction() * 5.0};
      const Pose above{{}, {random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), 0.6 - depth}};
      const PlacedHull a = place_box(half, world), b = place_box(half, world * above);
      EXPECT_NEAR(calc_depth_exact(a, b), depth, kExact);
      EXPECT_NEAR(calc_depth_exact(b, a), depth, kExact);
      EXPECT_NEAR(calc_depth_ccd(a, b), depth, kCcd);
    }
  }
}

// A cube of half edge h stands on an edge, turned 45 degrees, over a wide slab: the edge is h
// sqrt(2) below its middle.
TEST(Penetration, OfAnEdgeInAFace) {
  const double h = 0.2, depth = 0.004;
  const double angle = portable::kPi / 8;  // half of 45 degrees
  const Pose turned{{std::cos(angle), std::sin(angle), 0, 0},
                    {0.1, 0.05, h * std::sqrt(2.0) - depth}};
  const PlacedHull slab = place_box({2, 2, 0.5}, {{}, {0, 0, -0.5}});
  const PlacedHull cube = place_box({h, h, h}, turned);
  EXPECT_NEAR(calc_depth_exact(slab, cube), depth, kExact);
  EXPECT_NEAR(calc_depth_ccd(slab, cube), depth, kCcd);
}

// Two cubes of half edge h on edge, the edges crossing at right angles: no face normal parts them
// as cheaply as the common normal of the edges.
TEST(Penetration, OfTwoCrossingEdges) {
  const double h = 0.2, depth = 0.003;
  const double angle = portable::kPi / 8, reach = h * std::sqrt(2.0);
  const Pose below{{std::cos(angle), std::sin(angle), 0, 0}, {0, 0, 0}};
  const Pose above{{std::cos(angle), 0, std::sin(angle), 0}, {0.01, 0.02, 2 * reach - depth}};
  const PlacedHull a = place_box({h, h, h}, below), b = place_box({h, h, h}, above);
  EXPECT_NEAR(calc_depth_exact(a, b), depth, kExact);
  EXPECT_NEAR(calc_depth_ccd(a, b), depth, kCcd);
}

TEST(Penetration, OfABoxInsideAnotherIsTheWayOut) {
  const PlacedHull outer = place_box({1, 1, 1}, {});
  const PlacedHull inner = place_box({0.1, 0.1, 0.1}, {{}, {0.5, 0, 0}});
  EXPECT_NEAR(calc_depth_exact(outer, inner), 0.6, kExact);  // its left side, at 0.4, to 1
  EXPECT_NEAR(calc_depth_ccd(outer, inner), 0.6, 1e-5);
}

TEST(Penetration, OfBoxesApartIsNegative) {
  const PlacedHull a = place_box({0.5, 0.5, 0.5}, {});
  const PlacedHull b = place_box({0.5, 0.5, 0.5}, {{}, {0, 0, 1.003}});
  EXPECT_NEAR(calc_depth_exact(a, b), -0.003, kExact);
  EXPECT_EQ(calc_depth_ccd(a, b), 0);
}

// The depth is a translation that parts the hulls, and libccd, which knows no faces, finds none
// much shorter. Lumps of 20 corners are what the standard work is made of.
TEST(Penetration, OfLumpsIsTheSameByBothWays) {
  RandomStream random(2, "lumps");
  int overlapping = 0;
  for (int i = 0; i < 200; ++i) {
    const TrueHull hull_a = make_true_hull(random_lump(random, 20));
    const TrueHull hull_b = make_true_hull(random_lump(random, 20));
    const Pose turned{random.rotation(), random.direction() * random.uniform(0.35, 0.5)};
    const PlacedHull a = place_hull(hull_a, 0.3, {});
    const PlacedHull b = place_hull(hull_b, 0.3, turned);
    const double depth = calc_depth_exact(a, b);
    if (depth <= 0) {
      EXPECT_EQ(calc_depth_ccd(a, b), 0);
      continue;
    }
    ++overlapping;
    EXPECT_NEAR(calc_depth_ccd(a, b), depth, 1e-4);
    const Vec3 out = calc_penetration(a, b).direction * depth;
    const PlacedHull parted = place_hull(hull_b, 0.3, {turned.rotation, turned.translation + out});
    EXPECT_NEAR(calc_depth_exact(a, parted), 0, kExact);
  }
  EXPECT_GT(overlapping, 50);
}

TEST(CloserThan, KnowsTouchingFromApart) {
  RandomStream random(3, "touching boxes");
  for (int i = 0; i < 20; ++i) {
    const Pose world{random.rotation(), random.direction() * 5.0};
    const PlacedHull a = place_box({0.5, 0.4, 0.3}, world);
    for (double gap : {0.0, 0.001, 0.0019}) {
      const PlacedHull b = place_box({0.5, 0.4, 0.3}, world * Pose{{}, {0.1, 0.1, 0.6 + gap}});
      EXPECT_TRUE(closer_than_ccd(a, b, 0.002)) << gap;
    }
    const PlacedHull b = place_box({0.5, 0.4, 0.3}, world * Pose{{}, {0.1, 0.1, 0.6021}});
    EXPECT_FALSE(closer_than_ccd(a, b, 0.002));
  }
}

// Corner to corner along the diagonal, where a separating plane alone would call them closer.
TEST(CloserThan, MeasuresCornersByTheirTrueDistance) {
  const PlacedHull a = place_box({0.5, 0.5, 0.5}, {});
  const auto at = [](double gap) {
    const double d = 1 + gap / std::sqrt(3.0);
    return place_box({0.5, 0.5, 0.5}, {{}, {d, d, d}});
  };
  EXPECT_TRUE(closer_than_ccd(a, at(0.0019), 0.002));
  EXPECT_FALSE(closer_than_ccd(a, at(0.0021), 0.002));
}

}  // namespace penetration_test
}  // namespace rubble
