#include "kernel/geometry/hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/geometry/lattice_hull.h"
#include "kernel/geometry/shape.h"
#include "kernel/geometry/simplify_hull.h"
#include "scenes.h"

namespace rubble {
namespace hull_test {

using testing::box_part;

TEST(Hull, BoxHasSixSquares) {
  const Hull hull = calc_hull(box_part(1, 2, 3).points);
  EXPECT_EQ(hull.points.size(), 8u);
  ASSERT_EQ(hull.faces.size(), 6u);
  for (const auto& face : hull.faces) EXPECT_EQ(face.size(), 4u);
}

TEST(Hull, TurnedBoxHasSixSquaresToo) {
  RandomStream random(4, "test");
  for (int i = 0; i < 50; ++i) {
    const Quat q = random.rotation();
    std::vector<Vec3> points = box_part(0.215, 0.1025, 0.065, {1, 2, 3}).points;
    for (Vec3& p : points) p = q.rotate(p);
    const Hull hull = calc_hull(points);
    EXPECT_EQ(hull.points.size(), 8u);
    EXPECT_EQ(hull.faces.size(), 6u);
  }
}

TEST(Hull, PointsInsideAndOnFacesAreDropped) {
  std::vector<Vec3> points = box_part(2, 2, 2).points;
  points.push_back({0, 0, 0});
  points.push_back({0, 0, 1});
  points.push_back({0, 1, 1});
  points.push_back(points[0]);
  EXPECT_EQ(calc_hull(points).points.size(), 8u);
}

TEST(Hull, EveryPointOfARandomSetIsInside) {
  RandomStream random(5, "test");
  for (int n : {4, 5, 20, 200}) {
    std::vector<Vec3> points;
    for (int i = 0; i < n; ++i) points.push_back(random.direction() * random.uniform(0.1, 1.0));
    const Hull hull = calc_hull(points);
    std::size_t edges = 0;
    for (const auto& face : hull.faces) {
      edges += face.size();
      const Vec3 a = hull.points[face[0]], b = hull.points[face[1]], c = hull.points[face[2]];
      const Vec3 normal = normalized(cross(b - a, c - a));
      for (const Vec3& p : points) EXPECT_LE(dot(normal, p - a), 0.02);
    }
    // Euler: corners - edges + faces = 2.
    EXPECT_EQ(hull.points.size() + hull.faces.size(), edges / 2 + 2);
  }
}

// Of points in planes and lines, and of many: each is on or below all faces, without rounding.
TEST(Hull, OfALatticeIsExact) {
  RandomStream random(6, "test");
  for (const int steps : {1, 2, 4, 64, 100000}) {
    SCOPED_TRACE(steps);
    std::vector<GridPoint> points;
    for (int i = 0; i < 400; ++i) {
      const auto coordinate = [&] { return std::int64_t(random.uniform(0, steps + 1)); };
      points.push_back({coordinate(), coordinate(), coordinate()});
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    const std::vector<Polygon> faces = calc_lattice_hull(points);
    if (steps <= 4) {
      EXPECT_EQ(faces.size(), 6u) << "a cube, all of whose lattice points are there";
    }
    for (const Polygon& face : faces) {
      EXPECT_EQ(*std::min_element(face.begin(), face.end()), face[0]);
      const auto side = [&](int a, int b, int c, const GridPoint& p) {
        const GridPoint &u = points[std::size_t(a)], &v = points[std::size_t(b)], &w = points[std::size_t(c)];
        const std::int64_t x1 = v.x - u.x, y1 = v.y - u.y, z1 = v.z - u.z, x2 = w.x - u.x, y2 = w.y - u.y, z2 = w.z - u.z;
        return (y1 * z2 - z1 * y2) * (p.x - u.x) + (z1 * x2 - x1 * z2) * (p.y - u.y) + (x1 * y2 - y1 * x2) * (p.z - u.z);
      };
      for (const GridPoint& p : points) ASSERT_LE(side(face[0], face[1], face[2], p), 0);
      for (const int corner : face) ASSERT_EQ(side(face[0], face[1], face[2], points[std::size_t(corner)]), 0);
    }
    const FaceOfEdge face_of_edge(faces);
    for (const Polygon& face : faces)
      for (std::size_t i = 0; i < face.size(); ++i)
        EXPECT_NO_THROW(face_of_edge.find(FaceOfEdge::key(face[(i + 1) % face.size()], face[i]))) << "two faces an edge";
  }
  EXPECT_THROW(calc_lattice_hull({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(calc_lattice_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), std::invalid_argument);
}

// Results of runs depend on the order of faces and corners.
TEST(Hull, FacesComeInTheirOrder) {
  const std::vector<GridPoint> octahedron = {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
  const std::vector<Polygon> expected = {{0, 1, 3}, {0, 3, 4}, {0, 4, 2}, {0, 2, 1},
                                         {1, 2, 5}, {1, 5, 3}, {2, 4, 5}, {3, 5, 4}};
  EXPECT_EQ(calc_lattice_hull(octahedron), expected);
}

// Of a face's corners, from the plane of its area.
double calc_bend(const Hull& hull, const std::vector<int>& face) {
  Vec3 area, middle;
  for (std::size_t i = 0; i < face.size(); ++i) {
    const Vec3 &p = hull.points[face[i]], &q = hull.points[face[(i + 1) % face.size()]];
    area += cross(p - hull.points[face[0]], q - hull.points[face[0]]);
    middle += p * (1.0 / double(face.size()));
  }
  double bend = 0;
  for (const int p : face) {
    bend = std::max(bend, std::abs(dot(normalized(area), hull.points[p] - middle)));
  }
  return bend;
}

// Sides of 1.2 to 0.72 degrees: each is a face of its own, and plane.
TEST(Hull, ADrumKeepsItsSidesHoweverMany) {
  for (const int sides : {300, 363, 400, 500}) {
    for (const double radius : {0.3, 1.0, 4.0}) {
      std::vector<Vec3> points;
      for (int i = 0; i < 2 * sides; ++i) {
        const auto [s, c] = portable::sincos(portable::kPi * (i / 2 * 2 + 1) / sides);
        points.push_back({radius * s, i % 2 - 0.5, radius * c});
      }
      const Hull hull = calc_hull(points);
      EXPECT_EQ(hull.points.size(), points.size()) << sides;
      EXPECT_EQ(hull.faces.size(), std::size_t(sides) + 2) << sides << " " << radius;
      for (const auto& face : hull.faces) ASSERT_LT(calc_bend(hull, face), 2e-5 * radius) << sides;
    }
  }
}

// A box whose corners are off by up to 0.01 mm is a box still.
TEST(Hull, CornersWrittenToAHundredthOfAMillimetreAreStillPlane) {
  RandomStream random(6, "test");
  for (int i = 0; i < 50; ++i) {
    const Quat q = random.rotation();
    std::vector<Vec3> points = box_part(0.5, 0.2, 0.1).points;
    for (Vec3& p : points) {
      p = q.rotate(p);
      for (int k = 0; k < 3; ++k) p[k] = std::round(p[k] * 1e5) * 1e-5;
    }
    EXPECT_EQ(calc_hull(points).faces.size(), 6u);
  }
}

TEST(Hull, FlatSetsAreRefused) {
  EXPECT_THROW(calc_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), std::invalid_argument);
  EXPECT_THROW(calc_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), std::invalid_argument);
  EXPECT_THROW(calc_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}), std::invalid_argument);
}

TEST(Shape, BoxInertiaIsTheClosedForm) {
  const VolumeProperties v = calc_volume_properties(box_part(1, 2, 3, {5, 6, 7}));
  EXPECT_NEAR(v.volume, 6, 1e-12);
  EXPECT_NEAR(v.centre_of_mass.y, 6, 1e-12);
  EXPECT_NEAR(v.inertia.rows[0][0], 6.0 * (4 + 9) / 12, 1e-10);
  EXPECT_NEAR(v.inertia.rows[1][1], 6.0 * (1 + 9) / 12, 1e-10);
  EXPECT_NEAR(v.inertia.rows[0][1], 0, 1e-10);
}

TEST(Shape, PartsAddUp) {
  // A box cut in two has the properties of the whole.
  PieceType type;
  type.parts = {box_part(1, 2, 3, {-0.5, 0, 0}), box_part(1, 2, 3, {0.5, 0, 0})};
  const Shape shape = compile_shape(type, "t");
  EXPECT_NEAR(shape.volume.volume, 12, 1e-12);
  EXPECT_NEAR(shape.volume.inertia.rows[2][2], 12.0 * (4 + 4) / 12, 1e-10);
}

TEST(Shape, PipeVolumeIsThatOfItsPolygons) {
  const Shape shape = compile_shape(testing::pipe_type(1.0, 0.15, 0.2), "t");
  const double area = 12 * 0.5 * portable::sin(portable::kPi / 6) * (0.04 - 0.0225);
  EXPECT_NEAR(shape.volume.volume, area, 1e-12);
}

TEST(Shape, BadTypesAreNamed) {
  PieceType type = testing::box_type("b", 1, 1, 1);
  type.density = 5;
  try {
    compile_shape(type, "types[3]");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].key, "types[3].density");
  }
  type = PieceType{};
  type.parts = {ConvexPart{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}}};
  try {
    compile_shape(type, "types[0]");
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics()[0].key, "types[0].parts[0]");
  }
}

// A ball of 2,000 points: corners within the stated error, and no more than are asked for.
TEST(SimplifyHull, KeepsItsErrorAndItsLength) {
  std::vector<Vec3> ball;
  for (int i = 0; i < 2000; ++i) {
    const double z = 1 - 2 * (i + 0.5) / 2000, level = std::sqrt(1 - z * z);
    const auto [s, c] = portable::sincos(2.399963229728653 * i);
    ball.push_back(Vec3{level * c, level * s, z} * 0.5);
  }
  const SimpleHull fine = simplify_hull(ball, 1000, 0.0025), coarse = simplify_hull(ball, 64, 0);
  EXPECT_LE(fine.error, 0.0025);
  EXPECT_LT(fine.points.size(), 1000u);
  EXPECT_EQ(coarse.points.size(), 64u);
  EXPECT_GT(coarse.error, fine.error);
  for (const SimpleHull* hull : {&fine, &coarse}) {
    const std::vector<HullPlane> planes = calc_planes(calc_hull(hull->points));
    double outside = 0;
    for (const Vec3& p : ball) {
      double height = -1;
      for (const HullPlane& plane : planes)
        height = std::max(height, dot(plane.normal, p) - plane.offset);
      outside = std::max(outside, height);
    }
    EXPECT_NEAR(outside, hull->error, 1e-5);
    Aabb box, all;
    for (const Vec3& p : hull->points) box.include(p);
    for (const Vec3& p : ball) all.include(p);
    EXPECT_EQ(box.min, all.min);
    EXPECT_EQ(box.max, all.max);
  }
  const double whole = calc_hull_volume(ball);
  EXPECT_LT(calc_hull_volume(coarse.points), 0.95 * whole);
  EXPECT_NEAR(calc_hull_volume(restore_volume(coarse, ball)), whole, 0.005 * whole);
}

TEST(SimplifyHull, ABoxKeepsItsEightCorners) {
  std::vector<Vec3> points = box_part(1, 2, 3).points;
  points.push_back({0, 0, 0}), points.push_back({0.5, 0.1, 0.2});
  const SimpleHull box = simplify_hull(points, 64, 1e-4);
  EXPECT_EQ(box.points.size(), 8u);
  EXPECT_NEAR(calc_hull_volume(box.points), 6, 1e-9);
  EXPECT_THROW(simplify_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, 64, 1e-4), std::invalid_argument);
}

}  // namespace hull_test
}  // namespace rubble
