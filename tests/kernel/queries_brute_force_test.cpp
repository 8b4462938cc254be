// Queries against trying every triangle in the world's frame by other formulas than the queries use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "query_scenes.h"

namespace rubble {
namespace queries_brute_force_test {

using testing::QueryScene, testing::random_point, testing::random_scene;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  // unit: m

struct WorldTriangle {
  Vec3 a, b, c;
  int piece;
};

std::vector<WorldTriangle> all_triangles(const QueryScene& scene) {
  std::vector<WorldTriangle> result;
  for (std::size_t i = 0; i < scene.pile.pieces.size(); ++i) {
    const PieceState& piece = scene.pile.pieces[i];
    if (piece.status == PieceStatus::lost) continue;
    const TriangleMesh& mesh = scene.meshes[std::size_t(piece.type)];
    for (const auto& t : mesh.triangles) {
      const auto corner = [&](std::uint32_t k) {
        return piece.world_from_body * (Vec3(mesh.positions[k]) * piece.scale);
      };
      result.push_back({corner(t[0]), corner(t[1]), corner(t[2]), int(i)});
    }
  }
  return result;
}

// Moeller and Trumbore 1997.
double hit_distance(const WorldTriangle& t, const Vec3& o, const Vec3& d) {
  const Vec3 e1 = t.b - t.a, e2 = t.c - t.a, p = cross(d, e2), s = o - t.a, q = cross(s, e1);
  const double det = dot(e1, p);
  if (det == 0) return kInfinity;
  const double u = dot(s, p) / det, v = dot(d, q) / det, distance = dot(e2, q) / det;
  return u >= 0 && v >= 0 && u + v <= 1 && distance >= 0 ? distance : kInfinity;
}

double segment_distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double t = std::min(1.0, std::max(0.0, dot(p - a, ab) / std::max(1e-300, dot(ab, ab))));
  return distance(p, a + ab * t);
}

// The foot on the plane if it lies within, the nearest edge otherwise.
double point_distance(const WorldTriangle& t, const Vec3& p) {
  const Vec3 n = cross(t.b - t.a, t.c - t.a);
  if (dot(cross(t.b - t.a, p - t.a), n) >= 0 && dot(cross(t.c - t.b, p - t.b), n) >= 0 &&
      dot(cross(t.a - t.c, p - t.c), n) >= 0 && dot(n, n) > 0) {
    return std::abs(dot(p - t.a, n)) / norm(n);
  }
  return std::min({segment_distance(p, t.a, t.b), segment_distance(p, t.b, t.c),
                   segment_distance(p, t.c, t.a)});
}

TEST(Queries, RaysEqualBruteForce) {
  const QueryScene scene = random_scene(1, 150);
  const PileQueries queries = scene.queries(false);
  const std::vector<WorldTriangle> triangles = all_triangles(scene);
  RandomStream random(2, "rays");
  int hits = 0, misses = 0;
  for (int i = 0; i < 2000; ++i) {
    // Some from far away, where single precision would be off by millimetres.
    const Vec3 d = random.direction();
    const Vec3 o = random_point(random) - d * (i % 4 == 0 ? 3000.0 : 0.0);
    double expected = kInfinity;
    int piece = -2;
    for (const WorldTriangle& t : triangles) {
      const double at = hit_distance(t, o, d);
      if (at < expected) expected = at, piece = t.piece;
    }
    const auto hit = queries.cast_ray(o, d, kInfinity);
    ASSERT_EQ(hit.has_value(), expected < kInfinity) << "ray " << i;
    ++(hit ? hits : misses);
    if (!hit) continue;
    const double same = i % 4 == 0 ? 1e-7 : kSame;  // double precision 3 km away
    ASSERT_NEAR(hit->distance, expected, same) << "ray " << i;
    ASSERT_EQ(hit->piece, piece) << "ray " << i;
    EXPECT_LT(distance(hit->point, o + d * expected), same);
    EXPECT_NEAR(norm(hit->normal), 1, 1e-12);
    EXPECT_FALSE(queries.cast_ray(o, d, expected - 1e-6)) << "ray " << i;
    EXPECT_TRUE(queries.cast_ray(o, d * 7.0, expected + 1e-6)) << "ray " << i;
  }
  EXPECT_GT(hits, 400);
  EXPECT_GT(misses, 400);
}

TEST(Queries, ClosestPointsEqualBruteForce) {
  const QueryScene scene = random_scene(3, 150);
  const PileQueries queries = scene.queries(false);
  const std::vector<WorldTriangle> triangles = all_triangles(scene);
  RandomStream random(4, "points");
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = random_point(random) * (i % 5 == 0 ? 20.0 : 1.0);
    double expected = kInfinity;
    std::vector<double> by_piece(scene.pile.pieces.size(), kInfinity);
    for (const WorldTriangle& t : triangles) {
      double& nearest = by_piece[std::size_t(t.piece)];
      nearest = std::min(nearest, point_distance(t, p));
      expected = std::min(expected, nearest);
    }
    const auto closest = queries.find_closest(p, kInfinity);
    ASSERT_TRUE(closest);
    ASSERT_NEAR(closest->distance, expected, kSame) << "point " << i;
    EXPECT_NEAR(distance(closest->point, p), expected, kSame);
    EXPECT_NEAR(by_piece[std::size_t(closest->piece)], expected, 2 * kQueryTie);
    EXPECT_FALSE(queries.find_closest(p, expected - 1e-6)) << "point " << i;
    EXPECT_TRUE(queries.find_closest(p, expected + 1e-6)) << "point " << i;
  }
}

// Whether a point is inside a piece: how often a ray out of it leaves the piece.
bool inside(const std::vector<WorldTriangle>& triangles, int piece, const Vec3& p) {
  const Vec3 d = normalized(Vec3{0.31, -0.77, 0.53});
  int depth = 0;
  for (const WorldTriangle& t : triangles) {
    if (t.piece != piece || hit_distance(t, p, d) == kInfinity) continue;
    depth += dot(cross(t.b - t.a, t.c - t.a), d) > 0 ? 1 : -1;
  }
  return depth > 0;
}

TEST(Queries, OverlapsAndClearanceEqualBruteForce) {
  const QueryScene scene = random_scene(5, 120);
  const PileQueries queries = scene.queries();
  const std::vector<WorldTriangle> triangles = all_triangles(scene);
  RandomStream random(6, "balls");
  int inside_count = 0, found_count = 0;
  for (int i = 0; i < 400; ++i) {
    // Half of them within a piece or at its skin.
    Vec3 p = random_point(random);
    if (i % 2 == 0) {
      const std::size_t k = std::size_t(random.below(scene.pile.pieces.size()));
      p = scene.pile.pieces[k].world_from_body.translation + random.direction() * 0.05;
    }
    const double radius = random.uniform(0, 1);
    std::set<int> expected;
    double clearance = std::max(0.0, p.z);
    for (int piece = 0; piece < int(scene.pile.pieces.size()); ++piece) {
      if (scene.pile.pieces[std::size_t(piece)].status == PieceStatus::lost) continue;
      double nearest = kInfinity;
      for (const WorldTriangle& t : triangles) {
        if (t.piece == piece) nearest = std::min(nearest, point_distance(t, p));
      }
      const bool within = inside(triangles, piece, p);
      inside_count += within;
      if (nearest <= radius || within) expected.insert(piece);
      clearance = std::min(clearance, within ? 0.0 : nearest);
    }
    const std::vector<int> found = queries.find_overlaps(p, radius);
    found_count += int(found.size());
    EXPECT_EQ(found, std::vector<int>(expected.begin(), expected.end())) << "ball " << i;
    EXPECT_NEAR(queries.clearance(p), clearance, kSame) << "ball " << i;
    EXPECT_NEAR(queries.clearance(p, 0.2), std::min(0.2, clearance), kSame) << "ball " << i;
    if (queries.clearance(p) > 0) {
      EXPECT_EQ(queries.clearance_outside(p, 0.2), queries.clearance(p, 0.2)) << "ball " << i;
    }
  }
  EXPECT_GT(inside_count, 50);
  EXPECT_GT(found_count, 200);
}

}  // namespace queries_brute_force_test
}  // namespace rubble
