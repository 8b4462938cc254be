// Fixed surfaces of triangles: pieces slide, rest and gather on them as on what they stand for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "kernel/base/error.h"
#include "kernel/geometry/height_field.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"
#include "kernel/world/world_snapshot.h"
#include "scenes.h"

namespace rubble {
namespace terrain_test {

using testing::at;
using testing::box_type;
using testing::run;
using testing::run_to_rest;
using testing::hilly_types;
using testing::terrain_type;
using testing::turned;

// A box on a plane of 0.25 m triangles that goes down along X; returns how far it slid and how fast
// it was, step by step.
struct Slide {
  double distance = 0, speed = 0, worst = 0;  // worst: change of speed in a step, off the closed form
  double bounce = 0;                          // farthest from the plane, or across the slope; m
};
Slide slide(double angle, double seconds, double turn = 0.3) {
  const double slope = std::tan(angle), mu = 0.6;
  World world({terrain_type(60, 0.25, [&](double x, double) { return 40 - slope * x; }),
               box_type("box", 0.4, 0.4, 0.2)});
  const Quat down = turned({0, 1, 0}, angle), q = down * turned({0, 0, 1}, turn);
  const Vec3 start = Vec3{-20, 0.07, 40 + slope * 20} + down.rotate({0, 0, 0.101});
  world.add({at(0, {}, {}, true), at(1, start, q)});
  const double a = std::max(0.0, 9.81 * (std::sin(angle) - mu * std::cos(angle)));
  Slide s;
  run(world, 0.2);
  double last = norm(world.piece(1).linear_velocity);
  const double end = world.time() + seconds - 1e-9;
  while (world.time() < end) {
    world.step();
    const PieceState piece = world.piece(1);
    const double now = norm(piece.linear_velocity);
    s.worst = std::max(s.worst, std::abs(now - last - a / 60));
    const Vec3 moved = down.conjugate().rotate(piece.world_from_body.translation - start);
    s.bounce = std::max({s.bounce, std::abs(moved.z), std::abs(moved.y)});
    s.distance = moved.x;
    last = s.speed = now;
  }
  return s;
}

TEST(Terrain, ABoxSlidesOverTrianglesAsFastAsCoulombSays) {
  for (const double turn : {0.0, 0.3, 0.7853981634}) {
    const double angle = 0.8, time = 1.5 + 0.2;
    const Slide s = slide(angle, 1.5, turn);
    const double a = 9.81 * (std::sin(angle) - 0.6 * std::cos(angle));
    EXPECT_NEAR(s.speed, a * time, 0.02 * a * time) << turn;
    EXPECT_NEAR(s.distance, 0.5 * a * time * time, 0.03 * 0.5 * a * time * time) << turn;
    EXPECT_GT(s.distance, 3.0);  // over more than twelve cells, two edges each
    EXPECT_LT(s.worst, 0.02) << turn;  // no step kicks or brakes it
    EXPECT_LT(s.bounce, 0.002) << turn;
  }
}

TEST(Terrain, FrictionHoldsJustUnderTheAngleAndNotOverIt) {
  EXPECT_LT(slide(std::atan(0.6 * 0.98), 2).distance, 0.003);
  const double angle = std::atan(0.6 * 1.03), a = 9.81 * (std::sin(angle) - 0.6 * std::cos(angle));
  EXPECT_NEAR(slide(angle, 2).speed, a * 2.2, 0.1 * a * 2.2);
}

// A ball (a fine polyhedron) and a thin plate, fast over level triangles: nothing turns them aside.
TEST(Terrain, NoEdgeBetweenLevelTrianglesCatchesWhatSlides) {
  PieceType ground = terrain_type(40, 0.2, [](double, double) { return 1.0; });
  ground.friction = 0;
  PieceType plate = box_type("plate", 0.9, 0.5, 0.03);
  World world({ground, plate});
  NewPiece piece = at(1, {-12, 0.03, 1.0161}, turned({0, 0, 1}, 0.4));
  piece.linear_velocity = {8, 0.5, 0};
  world.add({at(0, {}, {}, true), piece});
  for (int i = 0; i < 120; ++i) {
    world.step();
    const Vec3 v = world.piece(1).linear_velocity;
    ASSERT_NEAR(v.x, 8, 0.02) << i;
    ASSERT_NEAR(v.y, 0.5, 0.02) << i;
    ASSERT_LT(std::abs(v.z), 0.02) << i;
    ASSERT_LT(norm(world.piece(1).angular_velocity), 0.05) << i;
  }
}

TEST(Terrain, PiecesGatherAtTheBottomOfABowl) {
  std::vector<PieceType> types{
      terrain_type(16, 0.25, [](double x, double y) { return 0.5 + 0.12 * (x * x + y * y); }),
      testing::chunk_type("chunk", 3), box_type("brick", 0.215, 0.1025, 0.065)};
  types[0].friction = types[1].friction = types[2].friction = 0.1;
  World world(types);
  std::vector<NewPiece> pieces{at(0, {}, {}, true)};
  for (int i = 0; i < 12; ++i) {
    const double angle = 0.5236 * i, r = 3 + 0.2 * (i % 3);
    NewPiece piece = at(1 + i % 2, {r * std::cos(angle), r * std::sin(angle), 3.2},
                        turned({1, double(i), 2}, 0.4 * i));
    if (i % 2 == 0) piece.placement.scale = 0.2;
    pieces.push_back(piece);
  }
  world.add(pieces);
  ASSERT_TRUE(run_to_rest(world, 25));
  for (int i = 1; i < world.size(); ++i) {
    const Vec3 p = world.piece(i).world_from_body.translation;
    // Up to where the slope 0.24 r is that of friction, and the heap's own size.
    EXPECT_LT(std::hypot(p.x, p.y), 1.3) << i;
    EXPECT_GT(p.z, 0.5) << i;
    EXPECT_EQ(world.piece(i).status == PieceStatus::lost, false);
  }
}

// A wavy sheet without thickness, turned and scaled: a mesh, not a height field.
PieceType wavy_sheet() {
  auto mesh = std::make_shared<TriangleMesh>();
  const int n = 41;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double x = (i - 20) * 0.1, y = (j - 20) * 0.1;
      mesh->positions.push_back(Vec3f(Vec3{x, y, 0.05 * ((i * 7 + j * 13) % 5)}));
    }
  }
  for (std::uint32_t j = 0; j + 1 < n; ++j) {
    for (std::uint32_t i = 0; i + 1 < n; ++i) {
      const std::uint32_t a = j * n + i;
      mesh->triangles.push_back({a, a + 1, a + n + 1});
      mesh->triangles.push_back({a, a + n + 1, a + n});
    }
  }
  PieceType type;
  type.name = "sheet";
  type.friction = 0.6;
  type.surface = mesh;
  return type;
}

// Of the thin bars one in twenty tumbles past an edge: docs/development/performance.md, "Where the physics gives way".
TEST(Terrain, NothingButThinBarsFallsThroughAMeshAtTenMetresASecond) {
  constexpr int kBar = 3;
  std::set<std::pair<int, int>> bars_below;
  std::vector<PieceType> types{wavy_sheet(), testing::chunk_type("chunk", 3),
                               box_type("brick", 0.215, 0.1025, 0.065), testing::bar_type(1, 0.01),
                               box_type("slab", 1.2, 0.8, 0.12), box_type("pebble", 0.04, 0.03, 0.03)};
  for (int run = 0; run < 8; ++run) {
    World world(types);
    NewPiece sheet = at(0, {0, 0, 3}, turned({0, 0, 1}, 0.5), true);
    sheet.placement.scale = 2;
    std::vector<NewPiece> pieces{sheet};
    for (int i = 0; i < 25; ++i) {
      NewPiece piece = at(1 + i % 5, {-1.6 + 0.8 * (i % 5) + 1e-3 * run, -1.6 + 0.8 * (i / 5), 5.0},
                          turned({1, double(i % 7) - 3, 2}, 0.7 * i));
      if (i % 5 == 0) piece.placement.scale = 0.2;
      piece.linear_velocity = {1.0, 0, -10.0};
      pieces.push_back(piece);
    }
    world.add(pieces);
    for (int i = 0; i < 120; ++i) {
      world.step();
      for (int k = 1; k < world.size(); ++k) {
        const Vec3 p = world.piece(k).world_from_body.translation;
        const bool above = std::max(std::abs(p.x), std::abs(p.y)) < 2.5;
        if (!above || p.z > 2.95) continue;
        if (world.piece(k).type == kBar) {
          bars_below.insert({run, k});
          continue;
        }
        FAIL() << k << " in step " << i << " of run " << run << " at " << p.z;
      }
    }
  }
  EXPECT_LE(bars_below.size(), 4u) << "of 40";
}

// A heap on a height field that is level lies as well as one on the ground.
TEST(Terrain, ALevelFieldIsAsGoodAsTheGround) {
  double deepest[2];
  for (const bool field : {false, true}) {
    PileSpec spec = testing::small_pile(5, 2, 50);
    if (field) {
      spec.types.push_back(terrain_type(16, 0.25, [](double, double) { return 1.0; }));
      spec.types.back().friction = 0.6;
      Placement terrain;
      terrain.kind = int(spec.types.size()) - 1;
      terrain.fixed = true;
      spec.placed.push_back(terrain);
      spec.spawn_position.z += 1;
    }
    const PileState state = settle_pile(generate_pile(spec));
    EXPECT_TRUE(state.settled) << field;
    EXPECT_EQ(state.lost, 0);
    EXPECT_LT(state.simulated, 24) << field;
    deepest[field] = 0;
    for (const PieceState& piece : state.pieces) {
      const PieceType& type = spec.types[std::size_t(piece.type)];
      for (const ConvexPart& part : type.parts) {
        for (const Vec3& p : part.points) {
          deepest[field] =
              std::max(deepest[field], (field ? 1.0 : 0.0) - (piece.world_from_body * (p * piece.scale)).z);
        }
      }
    }
  }
  EXPECT_LT(deepest[0], 0.005);
  EXPECT_LT(deepest[1], 0.005);
}

std::uint64_t hash_on_hills(int threads) {
  WorldOptions options;
  options.threads = threads;
  World world(hilly_types(), options);
  world.add(testing::pieces_on_hills());
  run(world, 1.5);
  return testing::hash_of(world);
}

TEST(Terrain, GivesTheSameBitsForAnyNumberOfThreads) {
  const std::uint64_t one = hash_on_hills(1);
  EXPECT_EQ(one, hash_on_hills(2));
  EXPECT_EQ(one, hash_on_hills(5));
}

TEST(Terrain, GoesOnFromASnapshotAsIfItHadNeverStopped) {
  World world(hilly_types());
  world.add(testing::pieces_on_hills());
  run(world, 0.8);
  const auto bytes = encode_snapshot(*world.snapshot());
  World other(hilly_types());
  other.restore(*decode_snapshot(bytes));
  run(world, 0.7);
  run(other, 0.7);
  EXPECT_EQ(testing::hash_of(world), testing::hash_of(other));
}

TEST(Terrain, ASnapshotIsOfItsOwnTerrain) {
  World world(hilly_types());
  world.add(testing::pieces_on_hills());
  std::vector<PieceType> types = hilly_types();
  auto mesh = std::make_shared<TriangleMesh>(*types[8].surface);
  mesh->positions[5].z += 1e-6F;
  types[8].surface = mesh;
  World other(types);
  EXPECT_THROW(other.restore(*world.snapshot()), RunError);
}

TEST(Terrain, TreesOfBodiesRestOnIt) {
  std::vector<PieceType> types = hilly_types();
  World world(types, {}, testing::assemblies());
  world.add({at(8, {}, {}, true), at(PieceKind::assembly(0), {-1, 0, 2.4}), at(PieceKind::assembly(1), {-1, 1.5, 2.4})});
  ASSERT_TRUE(run_to_rest(world, 10));
  for (int i = 1; i < world.size(); ++i) EXPECT_GT(world.piece(i).world_from_body.translation.z, 0.9);
}

TEST(Terrain, RefusesWhatIsNoSurfaceAndToMove) {
  PieceType type = wavy_sheet();
  type.parts.push_back(testing::box_part(1, 1, 1));
  EXPECT_THROW(World({type}), InputError);
  type.parts.clear();
  World world({type});
  EXPECT_THROW(world.add({at(0, {})}), InputError);
  type.surface = std::make_shared<const TriangleMesh>();
  EXPECT_THROW(World({type}), InputError);
  HeightField field;
  field.columns = field.rows = 2;
  field.heights = {0, 0, 0};
  EXPECT_THROW(make_height_field_mesh(field, 1, "ground"), InputError);
}

TEST(HeightField, IsAClosedBlock) {
  const PieceType type = terrain_type(6, 0.5, [](double x, double y) { return 2 + 0.1 * x * y; });
  EXPECT_TRUE(is_closed(*type.surface));
  // 6 x 6 m, on average 2 m high, down to 1 m below the lowest corner (1.1 m); and over the diagonals,
  // where x y is above its triangles, 0.1 * 0.5^2 / 12 on average.
  EXPECT_NEAR(calc_volume_properties(*type.surface).volume, 36 * (2 - 0.1 + 0.1 * 0.25 / 12), 1e-4);
}

}  // namespace terrain_test
}  // namespace rubble
