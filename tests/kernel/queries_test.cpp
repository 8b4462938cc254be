// Queries against closed forms, and against trying every triangle in the world's frame by other
// formulas than the queries use.
#include "kernel/queries/queries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <thread>

#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "scenes.h"

namespace rubble {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  // unit: m

TriangleMesh box_mesh(double x, double y, double z) {
  return make_collision_meshes({testing::box_type("box", x, y, z)})[0];
}

// Latitude and longitude; with `rings` rings inscribed in the unit sphere.
TriangleMesh sphere_mesh(int rings) {
  TriangleMesh mesh;
  const int around = 2 * rings;
  for (int i = 0; i <= rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto [s, c] = portable::sincos(portable::kPi * i / rings);
      const auto [sl, cl] = portable::sincos(2 * portable::kPi * k / around);
      mesh.positions.push_back(Vec3f(Vec3{s * cl, s * sl, c}));
    }
  }
  for (int i = 0; i < rings; ++i) {
    for (int k = 0; k < around; ++k) {
      const auto at = [&](int ring, int step) {
        return std::uint32_t(ring * around + step % around);
      };
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  return mesh;
}

PieceState piece_at(int type, const Vec3& position, double scale = 1, const Quat& rotation = {}) {
  PieceState piece;
  piece.type = type;
  piece.scale = scale;
  piece.world_from_body = {rotation, position};
  piece.status = PieceStatus::resting;
  return piece;
}

struct Scene {
  PileState pile;
  std::vector<TriangleMesh> meshes;

  std::vector<const TriangleMesh*> pointers() const {
    std::vector<const TriangleMesh*> result;
    for (const TriangleMesh& mesh : meshes) result.push_back(&mesh);
    return result;
  }
  PileQueries queries(bool ground = true) const { return {pile, pointers(), ground}; }
};

// Overlapping chunks, slabs, pipes and blocks of many sizes in a heap.
Scene random_scene(std::uint64_t seed, int pieces) {
  Scene scene;
  scene.meshes = make_collision_meshes(testing::rubble_types());
  RandomStream random(seed, "query scene");
  for (int i = 0; i < pieces; ++i) {
    const Vec3 position{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(0.3, 4)};
    scene.pile.pieces.push_back(piece_at(int(random.below(scene.meshes.size())), position,
                                         random.uniform(0.1, 1.5), random.rotation()));
  }
  scene.pile.pieces[5].status = PieceStatus::lost;
  return scene;
}

struct WorldTriangle {
  Vec3 a, b, c;
  int piece;
};

std::vector<WorldTriangle> all_triangles(const Scene& scene) {
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

Vec3 random_point(RandomStream& random) {
  return {random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-0.5, 6)};
}

TEST(Queries, RaysEqualBruteForce) {
  const Scene scene = random_scene(1, 150);
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
  const Scene scene = random_scene(3, 150);
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
  const Scene scene = random_scene(5, 120);
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

TEST(Queries, ABoxInClosedForm) {
  Scene scene;
  scene.meshes = {box_mesh(2, 1, 0.5)};
  // Scaled by 3, turned by 90 degrees about Z: x and y change places.
  scene.pile.pieces = {piece_at(0, {10, 20, 5}, 3, testing::turned({0, 0, 1}, portable::kPi / 2))};
  const PileQueries queries = scene.queries();
  const auto hit = queries.cast_ray({0, 20.3, 5.1}, {2, 0, 0}, 100);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->piece, 0);
  EXPECT_NEAR(hit->distance, 10 - 1.5, kSame);
  EXPECT_LT(distance(hit->point, {8.5, 20.3, 5.1}), kSame);
  EXPECT_LT(distance(hit->normal, {-1, 0, 0}), kSame);
  // From inside: the far wall, whose normal points out.
  const auto out = queries.cast_ray({10, 20, 5}, {0, 1, 0}, 100);
  ASSERT_TRUE(out);
  EXPECT_NEAR(out->distance, 3, kSame);
  EXPECT_LT(distance(out->normal, {0, 1, 0}), kSame);
  // Beyond a corner.
  const auto corner = queries.find_closest({10 + 1.5 + 2, 20 + 3 + 3, 5 + 0.75 + 6}, 100);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->distance, 7, kSame);
  EXPECT_LT(distance(corner->point, {11.5, 23, 5.75}), kSame);
  EXPECT_NEAR(queries.clearance({10, 20, 5.75 + 0.4}), 0.4, kSame);
  EXPECT_EQ(queries.clearance({10, 20, 5}), 0);
  EXPECT_NEAR(queries.find_closest({10, 20, 5.1}, 100)->distance, 0.65, kSame);  // to the surface
  EXPECT_EQ(queries.find_overlaps({10, 20, 5}, 0), std::vector<int>{0});
  EXPECT_EQ(queries.find_overlaps({10, 20, 6}, 0.2499), std::vector<int>{});
  EXPECT_EQ(queries.find_overlaps({10, 20, 6}, 0.2501), std::vector<int>{0});
}

TEST(Queries, ASphereWithinItsTessellation) {
  Scene scene;
  const int rings = 64;
  scene.meshes = {sphere_mesh(rings)};
  scene.pile.pieces = {piece_at(0, {3, -2, 4}, 0.5, testing::turned({1, 2, 3}, 0.7))};
  const PileQueries queries = scene.queries(false);
  // An inscribed triangle sinks below the sphere by at most 1 - cos of half its angle.
  const double sag = 0.5 * 2 * (1 - std::cos(portable::kPi / rings / 2 * 1.5));
  RandomStream random(7, "sphere");
  for (int i = 0; i < 500; ++i) {
    const Vec3 d = random.direction();
    const auto hit = queries.cast_ray(Vec3{3, -2, 4} - d * 2.0, d, 10);
    ASSERT_TRUE(hit);
    EXPECT_GE(hit->distance, 1.5 - 1e-7);  // the corners are rounded to single precision
    EXPECT_LE(hit->distance, 1.5 + sag);
    EXPECT_GT(dot(hit->normal, -d), 0.99);
    const double clearance = queries.clearance(Vec3{3, -2, 4} + d * 1.25);
    EXPECT_GE(clearance, 0.75 - 1e-7);
    EXPECT_LE(clearance, 0.75 + sag);
  }
}

TEST(Queries, TheGround) {
  Scene scene;
  scene.meshes = {box_mesh(1, 1, 1)};
  scene.pile.pieces = {piece_at(0, {0, 0, 0.5})};
  const PileQueries queries = scene.queries();
  const auto hit = queries.cast_ray({5, 0, 3}, {3, 0, -3}, kInfinity);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->piece, kGroundPiece);
  EXPECT_NEAR(hit->distance, 3 * std::sqrt(2.0), 1e-12);
  EXPECT_EQ(hit->point.z, 0);
  EXPECT_LT(distance(hit->normal, {0, 0, 1}), 1e-15);
  EXPECT_FALSE(queries.cast_ray({5, 0, 3}, {3, 0, -3}, 4.2));
  EXPECT_FALSE(queries.cast_ray({5, 0, 3}, {1, 0, 0}, kInfinity));
  EXPECT_FALSE(queries.cast_ray({5, 0, 3}, {1, 0, 1e-3}, kInfinity));
  EXPECT_EQ(queries.find_closest({3, 0, 0.2}, 1)->piece, kGroundPiece);
  EXPECT_NEAR(queries.find_closest({3, 0, -0.2}, 1)->distance, 0.2, 1e-15);
  EXPECT_EQ(queries.find_closest({0.7, 0, 0.6}, 1)->piece, 0);
  EXPECT_FALSE(queries.find_closest({3, 0, 2}, 1));
  EXPECT_EQ(queries.clearance({3, 0, -0.2}), 0);
  EXPECT_NEAR(queries.clearance({3, 0, 0.2}), 0.2, 1e-15);
  const PileQueries without = scene.queries(false);
  EXPECT_FALSE(without.cast_ray({5, 0, 3}, {3, 0, -3}, kInfinity));
  EXPECT_EQ(without.find_closest({3, 0, 0.2}, 5)->piece, 0);
  EXPECT_NEAR(without.clearance({3, 0, -1}), std::sqrt(2.5 * 2.5 + 1), kSame);
}

// Boxes side by side, on each other and in the same place, numbered in every order.
TEST(Queries, TiesGoToTheLowestPiece) {
  Scene scene;
  scene.meshes = {box_mesh(1, 1, 1)};
  std::vector<Vec3> places{{0, 0, 0.5}, {1, 0, 0.5}, {0, 1, 0.5}, {1, 1, 0.5}, {0, 0, 0.5}};
  for (std::size_t first = 0; first < places.size(); ++first) {
    scene.pile.pieces.clear();
    for (std::size_t i = 0; i < places.size(); ++i) {
      scene.pile.pieces.push_back(piece_at(0, places[(first + i) % places.size()]));
      // A quarter turn changes roundings, not the box.
      if (i % 2 == 1) {
        scene.pile.pieces.back().world_from_body.rotation =
            testing::turned({0, 0, 1}, portable::kPi / 2);
      }
    }
    const PileQueries queries = scene.queries();
    const auto lowest = [&](std::set<std::size_t> which) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        if (which.count((first + i) % places.size())) return int(i);
      }
      return -2;
    };
    // Down the edge that four of them share, and onto the face of the two in one place.
    EXPECT_EQ(queries.cast_ray({0.5, 0.5, 3}, {0, 0, -1}, 5)->piece, 0);
    EXPECT_EQ(queries.cast_ray({-0.2, 0.1, 3}, {0, 0, -1}, 5)->piece, lowest({0, 4}));
    EXPECT_EQ(queries.cast_ray({1.1, 0.1, 3}, {0, 0, -1}, 5)->piece, lowest({1}));
    EXPECT_EQ(queries.find_closest({0.5, 0.5, 1.3}, 5)->piece, 0);
    EXPECT_EQ(queries.find_closest({-0.8, 0.2, 0.6}, 5)->piece, lowest({0, 4}));
    // A piece goes before the ground: upwards through both at once.
    EXPECT_EQ(queries.cast_ray({1.1, 0.1, -1}, {0, 0, 1}, 5)->piece, lowest({1}));
  }
}

// Through corners and along the diagonals of faces, where a crack would let a ray in.
TEST(Queries, NothingLeaksThroughEdges) {
  Scene scene;
  scene.meshes = {box_mesh(2, 2, 2), sphere_mesh(8)};
  RandomStream random(8, "leaks");
  for (int type : {0, 1}) {
    for (int turn = 0; turn < 50; ++turn) {
      scene.pile.pieces = {piece_at(type, {1, 2, 30}, 1, turn ? random.rotation() : Quat{})};
      const PileQueries queries = scene.queries(false);
      const TriangleMesh& mesh = scene.meshes[std::size_t(type)];
      for (const auto& t : mesh.triangles) {
        for (double along : {0.0, 0.25, 0.5}) {
          const Vec3 edge =
              Vec3(mesh.positions[t[0]]) * (1 - along) + Vec3(mesh.positions[t[1]]) * along;
          const Vec3 d = scene.pile.pieces[0].world_from_body.rotation.rotate(edge);
          const auto out = queries.cast_ray({1, 2, 30}, d, 10);
          ASSERT_TRUE(out) << "turn " << turn;
          EXPECT_NEAR(out->distance, norm(d), 1e-6);
        }
      }
    }
  }
}

TEST(Queries, TheSameFromSeveralThreadsAndFromASecondTree) {
  const Scene scene = random_scene(9, 100);
  const PileQueries queries = scene.queries(), again = scene.queries();
  const auto ask = [](const PileQueries& q) {
    RandomStream random(10, "threads");
    std::vector<double> answers;
    for (int i = 0; i < 500; ++i) {
      const Vec3 p = random_point(random);
      const auto hit = q.cast_ray(p, random.direction(), 20);
      answers.push_back(hit ? hit->distance : -1);
      answers.push_back(hit ? hit->piece : -2);
      answers.push_back(q.clearance(p));
      for (int piece : q.find_overlaps(p, 0.4)) answers.push_back(piece);
    }
    return answers;
  };
  const std::vector<double> expected = ask(queries);
  EXPECT_EQ(ask(again), expected);  // bit for bit
  std::vector<std::vector<double>> answers(4);
  std::vector<std::thread> threads;
  for (auto& answer : answers) threads.emplace_back([&] { answer = ask(queries); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& answer : answers) EXPECT_EQ(answer, expected);
}

TEST(Queries, ASettledPileLiesOnTheGroundAndNotInIt) {
  const Pile pile = generate_pile(testing::small_pile(61, 1, 40));
  Scene scene;
  scene.pile = settle_pile(pile);
  scene.meshes = make_collision_meshes(pile.types);
  const PileQueries queries = scene.queries();
  for (std::size_t i = 0; i < scene.pile.pieces.size(); ++i) {
    const Vec3 p = scene.pile.pieces[i].world_from_body.translation;
    const auto above = queries.cast_ray({p.x, p.y, 50}, {0, 0, -1}, 60);
    ASSERT_TRUE(above);
    EXPECT_GT(above->point.z, -0.01);
    EXPECT_LT(above->point.z, 4);
    const auto below = queries.cast_ray({p.x, p.y, -1}, {0, 0, 1}, 60);
    ASSERT_TRUE(below);
    EXPECT_NEAR(below->point.z, 0, 0.01);
  }
}

TEST(Queries, AnEmptyPile) {
  const Scene scene;
  const PileQueries queries = scene.queries(), nothing = scene.queries(false);
  EXPECT_EQ(queries.cast_ray({0, 0, 1}, {0, 0, -1}, 2)->piece, kGroundPiece);
  EXPECT_FALSE(nothing.cast_ray({0, 0, 1}, {0, 0, -1}, 2));
  EXPECT_FALSE(nothing.find_closest({0, 0, 1}, kInfinity));
  EXPECT_TRUE(nothing.find_overlaps({0, 0, 1}, kInfinity).empty());
  EXPECT_EQ(nothing.clearance({0, 0, -1}, 3), 3);
  EXPECT_EQ(nothing.clearance({0, 0, -1}), kInfinity);
}

TEST(Queries, MistakesAreRefused) {
  Scene scene;
  scene.meshes = {box_mesh(1, 1, 1)};
  scene.pile.pieces = {piece_at(0, {})};
  const PileQueries queries = scene.queries();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(queries.cast_ray({}, {}, 1), std::invalid_argument);
  EXPECT_THROW(queries.cast_ray({nan, 0, 0}, {1, 0, 0}, 1), std::invalid_argument);
  EXPECT_THROW(queries.cast_ray({}, {1, 0, 0}, -1), std::invalid_argument);
  EXPECT_THROW(queries.find_closest({}, nan), std::invalid_argument);
  EXPECT_THROW(queries.find_overlaps({}, -1), std::invalid_argument);
  EXPECT_THROW(PileQueries(scene.pile, {nullptr}), std::invalid_argument);
  EXPECT_THROW(PileQueries(scene.pile, {}), std::invalid_argument);
  scene.meshes[0].triangles[0][1] = 99;
  EXPECT_THROW(scene.queries(), std::invalid_argument);
}

}  // namespace
}  // namespace rubble
