// Where hulls touch, against closed forms.
#include "bench/equilibrium/contact_patch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bench/equilibrium/contact_finder.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace contact_patch_test {

std::vector<Vec3> box_points(const Vec3& half) {
  std::vector<Vec3> points;
  for (double x : {-half.x, half.x})
    for (double y : {-half.y, half.y})
      for (double z : {-half.z, half.z}) points.push_back({x, y, z});
  return points;
}

PlacedHull make_box(const Vec3& half, const Pose& pose) {
  return place_hull(make_true_hull(box_points(half)), 1, pose);
}

Aabb bounds_of(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  return box;
}

const Vec3 kUp{0, 0, 1};

TEST(TrueHull, KnowsTheFacesOfABox) {
  const TrueHull hull = make_true_hull(box_points({1, 2, 3}));
  ASSERT_EQ(hull.faces.size(), 6U);
  for (const TrueHull::Face& face : hull.faces) {
    ASSERT_EQ(face.loop.size(), 4U);
    const Vec3 &a = hull.corners[std::size_t(face.loop[0])],
               &b = hull.corners[std::size_t(face.loop[1])],
               &c = hull.corners[std::size_t(face.loop[2])];
    EXPECT_NEAR(distance(normalized(cross(b - a, c - b)), face.normal), 0, 1e-12);
    EXPECT_GT(dot(face.normal, a), 0.9);  // outwards
  }
}

TEST(ContactPatch, OfTwoBoxesIsWhereTheirFacesMeet) {
  const PlacedHull below = make_box({1, 1, 0.5}, {{}, {0, 0, 0.5}});
  const PlacedHull above = make_box({0.5, 0.5, 0.5}, {{}, {0.8, 0.1, 1.501}});
  const auto patch = find_patch(make_region(below), make_region(above), kUp, 0.002);
  ASSERT_EQ(patch.size(), 4U);
  const Aabb box = bounds_of(patch);
  EXPECT_NEAR(box.min.x, 0.3, 1e-9);
  EXPECT_NEAR(box.max.x, 1.0, 1e-9);
  EXPECT_NEAR(box.min.y, -0.4, 1e-9);
  EXPECT_NEAR(box.max.y, 0.6, 1e-9);
  EXPECT_NEAR(box.min.z, 1.0005, 1e-9);  // midway in the gap of 1 mm
  EXPECT_TRUE(find_patch(make_region(below), make_region(above), kUp, 0.0009).empty());
}

TEST(ContactPatch, OfATiltedBoxIsTheStripWithinTheTolerance) {
  const double tilt = 0.02, tolerance = 0.002;
  const Pose pose{portable::quat_from_rpy(0, tilt, 0), {}};
  PlacedHull box = make_box({0.5, 0.5, 0.5}, pose);
  const double lift = 0.001 - box.box.min.z;  // its lowest edge 1 mm above the ground
  box = make_box({0.5, 0.5, 0.5}, {pose.rotation, {0, 0, lift}});
  const auto patch = find_patch({{{kUp, 0}}, {}}, make_region(box), kUp, tolerance);
  const Aabb bounds = bounds_of(patch);
  // Of the lower face, and of the upright one beside it.
  EXPECT_NEAR(bounds.max.x - bounds.min.x, 0.001 / std::tan(tilt) + 0.001 * std::tan(tilt), 1e-9);
  EXPECT_NEAR(bounds.max.y - bounds.min.y, 1, 1e-9);
}

TEST(ContactPatch, OfCrossedEdgesIsSmallAndAtTheCrossing) {
  const Pose on_edge{portable::quat_from_rpy(portable::kPi / 4, 0, 0), {0, 0, 0}};
  const Pose across{portable::quat_from_rpy(0, portable::kPi / 4, 0), {0.1, 0.2, std::sqrt(2.0) + 0.001}};
  const auto patch = find_patch(make_region(make_box({2, 0.5, 0.5}, on_edge)),
                                make_region(make_box({0.5, 2, 0.5}, across)), kUp, 0.002);
  ASSERT_GE(patch.size(), 3U);
  for (const Vec3& p : patch) {
    EXPECT_NEAR(p.x, 0.1, 0.0011);
    EXPECT_NEAR(p.y, 0.0, 0.0011);
    EXPECT_NEAR(p.z, std::sqrt(0.5) + 0.0005, 0.001);
  }
}

PieceType make_type(const Vec3& half) {
  PieceType type;
  type.name = "box";
  type.parts.push_back({box_points(half)});
  return type;
}

PieceState at(int type, const Pose& pose, PieceStatus status = PieceStatus::resting) {
  PieceState piece;
  piece.type = type;
  piece.world_from_body = pose;
  piece.status = status;
  return piece;
}

TEST(ContactFinder, FindsGroundAndNeighboursButNotPairsKeptApart) {
  const std::vector<PieceType> types{make_type({0.5, 0.5, 0.5})};
  PileState state;
  state.pieces = {at(0, {{}, {0, 0, 0.501}}), at(0, {{}, {0, 0, 1.502}}),
                  at(0, {{}, {3, 0, 0.51}})};
  EXPECT_EQ(find_touch_points(types, state, {}, 0.002).size(), 8U);
  EXPECT_EQ(find_touch_points(types, state, {{0, 1}}, 0.002).size(), 4U);
  EXPECT_EQ(find_touch_points(types, state, {}, 0.011).size(), 12U);
  for (const TouchPoint& t : find_touch_points(types, state, {}, 0.002))
    EXPECT_NEAR(distance(t.normal, kUp), 0, 1e-12) << t.a << " " << t.b;
}

// Two triangles that rise along X by 45 degrees.
PieceType make_slope() {
  TriangleMesh mesh;
  mesh.positions = {{-2, -2, 0}, {2, -2, 4}, {2, 2, 4}, {-2, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  PieceType type;
  type.name = "slope";
  type.surface = std::make_shared<TriangleMesh>(mesh);
  return type;
}

TEST(ContactFinder, FindsWhereABoxLiesOnTriangles) {
  const double turn = -portable::kPi / 4;
  const Vec3 normal = normalized(Vec3{-1, 0, 1});
  const std::vector<PieceType> types{make_type({0.3, 0.3, 0.1}), make_slope()};
  PileState state;
  state.pieces = {at(1, {}, PieceStatus::fixed),
                  at(0, {portable::quat_from_rpy(0, turn, 0), Vec3{0, 0, 2} + normal * 0.101})};
  const auto touches = find_touch_points(types, state, {}, 0.002);
  ASSERT_GE(touches.size(), 6U);  // a triangle on each side of the diagonal
  Aabb bounds;
  for (const TouchPoint& t : touches) {
    EXPECT_EQ(t.a, 0);
    EXPECT_EQ(t.b, 1);
    EXPECT_NEAR(distance(t.normal, normal), 0, 1e-6);
    bounds.include(t.point);
  }
  EXPECT_NEAR(bounds.max.y - bounds.min.y, 0.6, 1e-6);
  EXPECT_NEAR(bounds.max.x - bounds.min.x, 0.6 / std::sqrt(2.0), 1e-6);
  EXPECT_EQ(find_surface_depth(types, state).depth, 0);
  state.pieces[1].world_from_body.translation -= normal * 0.031;
  EXPECT_NEAR(find_surface_depth(types, state).depth, 0.030, 1e-6);
  EXPECT_EQ(find_surface_depth(types, state).piece, 1);
}

TEST(ContactFinder, SeesAPeakThatReachesIntoAPiece) {
  TriangleMesh mesh;  // a pyramid on a plane, 20 mm into the box
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0.5f}};
  mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  PieceType peak;
  peak.surface = std::make_shared<TriangleMesh>(mesh);
  PileState state;
  state.pieces = {at(1, {}, PieceStatus::fixed), at(0, {{}, {0, 0, 0.58}})};
  EXPECT_NEAR(find_surface_depth({make_type({0.3, 0.3, 0.1}), peak}, state).depth, 0.020, 1e-6);
}

}  // namespace contact_patch_test
}  // namespace rubble
