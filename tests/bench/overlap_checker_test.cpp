#include "bench/overlap_checker.h"

#include <gtest/gtest.h>

namespace rubble {
namespace overlap_checker_test {

PieceType make_cube(double half) {
  PieceType type;
  type.name = "cube";
  ConvexPart part;
  for (double x : {-half, half}) {
    for (double y : {-half, half}) {
      for (double z : {-half, half}) part.points.push_back({x, y, z});
    }
  }
  type.parts.push_back(part);
  return type;
}

PieceState at(const Vec3& place, PieceStatus status = PieceStatus::resting, double scale = 1) {
  PieceState piece;
  piece.scale = scale;
  piece.world_from_body.translation = place;
  piece.status = status;
  return piece;
}

TEST(OverlapChecker, CountsTouchingAndOverlappingPairs) {
  PileState state;
  state.pieces = {at({0, 0, 0.5}),       // on the ground
                  at({0, 0, 1.493}),     // 7 mm in the first
                  at({0, 0, 2.494}),     // 1 mm above the second: touches
                  at({0, 0, 3.504}),     // 10 mm above the third: does not
                  at({0.98, 0, 3.504}),  // 20 mm in the fourth
                  at({9, 9, 0.496})};    // alone, 4 mm in the ground
  const OverlapReport report = check_overlaps({make_cube(0.5)}, state);
  EXPECT_EQ(report.touching_pairs, 3);
  ASSERT_EQ(report.overlaps.size(), 2U);
  EXPECT_EQ(report.overlaps[0].a, 3);
  EXPECT_EQ(report.overlaps[0].b, 4);
  EXPECT_NEAR(report.overlaps[0].depth, 0.020, 1e-12);
  EXPECT_NEAR(report.overlaps[1].depth, 0.007, 1e-12);
  EXPECT_EQ(report.count_deeper(0.005), 2);
  EXPECT_EQ(report.count_deeper(0.010), 1);
  EXPECT_NEAR(report.mean_depth(), 0.0135, 1e-12);
  EXPECT_NEAR(report.max_depth(), 0.020, 1e-12);
  EXPECT_NEAR(report.ground_max, 0.004, 1e-12);
  EXPECT_EQ(report.deepest_in_ground, 5);
  EXPECT_LT(report.largest_disagreement(), 2e-6);
}

TEST(OverlapChecker, HonoursTheScaleOfAPiece) {
  PileState state;
  state.pieces = {at({0, 0, 0.5}), at({0.9, 0, 0.5}, PieceStatus::resting, 0.78)};
  EXPECT_TRUE(check_overlaps({make_cube(0.5)}, state).overlaps.empty());
  state.pieces[1].scale = 0.82;  // 0.5 + 0.41 reaches 10 mm beyond 0.9
  EXPECT_NEAR(check_overlaps({make_cube(0.5)}, state).max_depth(), 0.010, 1e-12);
}

TEST(OverlapChecker, LeavesOutLostPiecesAndPairsOfImmovableOnes) {
  PileState state;
  state.pieces = {at({0, 0, 0.5}, PieceStatus::fixed), at({0.9, 0, 0.5}, PieceStatus::fixed),
                  at({0, 0, -5}, PieceStatus::lost)};
  const OverlapReport report = check_overlaps({make_cube(0.5)}, state);
  EXPECT_EQ(report.touching_pairs, 0);
  EXPECT_EQ(report.ground_max, 0);
  state.pieces[1].status = PieceStatus::resting;
  EXPECT_EQ(check_overlaps({make_cube(0.5)}, state).overlaps.size(), 1U);
}

// An L of two parts: the deeper pair of parts counts, once.
TEST(OverlapChecker, MergesThePartsOfAPiece) {
  PieceType ell = make_cube(0.5);
  ConvexPart second = ell.parts[0];
  for (Vec3& p : second.points) p.x += 1;
  ell.parts.push_back(second);
  PileState state;
  state.pieces = {at({0, 0, 0.5}), at({0, 0, 1.49})};
  const OverlapReport report = check_overlaps({ell}, state);
  EXPECT_EQ(report.touching_pairs, 1);
  ASSERT_EQ(report.overlaps.size(), 1U);
  EXPECT_NEAR(report.overlaps[0].depth, 0.010, 1e-12);
}

TEST(Percentile, IsTheNearestRank) {
  EXPECT_EQ(percentile({}, 50), 0);
  EXPECT_EQ(percentile({3, 1, 2}, 50), 2);
  EXPECT_EQ(percentile({4, 1, 2, 3}, 50), 2);
  EXPECT_EQ(percentile({4, 1, 2, 3}, 99), 4);
  EXPECT_EQ(percentile({7}, 0), 7);
}

}  // namespace overlap_checker_test
}  // namespace rubble
