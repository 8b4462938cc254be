// Queries against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <thread>

#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "query_scenes.h"

namespace rubble {
namespace queries_test {

using testing::QueryScene, testing::box_mesh, testing::piece_at, testing::random_point, testing::random_scene,
    testing::sphere_mesh;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSame = 1e-9;  // unit: m

TEST(Queries, ABoxInClosedForm) {
  QueryScene scene;
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
  QueryScene scene;
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
  QueryScene scene;
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
  QueryScene scene;
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
  QueryScene scene;
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
  const QueryScene scene = random_scene(9, 100);
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
  QueryScene scene;
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
  const QueryScene scene;
  const PileQueries queries = scene.queries(), nothing = scene.queries(false);
  EXPECT_EQ(queries.cast_ray({0, 0, 1}, {0, 0, -1}, 2)->piece, kGroundPiece);
  EXPECT_FALSE(nothing.cast_ray({0, 0, 1}, {0, 0, -1}, 2));
  EXPECT_FALSE(nothing.find_closest({0, 0, 1}, kInfinity));
  EXPECT_TRUE(nothing.find_overlaps({0, 0, 1}, kInfinity).empty());
  EXPECT_EQ(nothing.clearance({0, 0, -1}, 3), 3);
  EXPECT_EQ(nothing.clearance({0, 0, -1}), kInfinity);
}

TEST(Queries, MistakesAreRefused) {
  QueryScene scene;
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

}  // namespace queries_test
}  // namespace rubble
