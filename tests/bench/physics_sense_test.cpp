// Does a settled heap look like a heap? Figures that soil mechanics and tables of bulk goods give
// for broken stone: it lies at 30 to 45 degrees (angle of repose of crushed stone and rubble), the
// steeper the rougher it is, and fills half to two thirds of its volume (void ratio of loose
// crushed stone about 0.35 to 0.5).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "bench/workload_file.h"
#include "heap_measures.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/random.h"
#include "kernel/settling/generator.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world.h"
#include "kernel/world/world_diagnostics.h"
#include "kernel/world/world_rest.h"

namespace rubble {
namespace physics_sense_test {

constexpr int kChunkTypes = 8;  // the first eight of the standard work are broken lumps

std::vector<PieceType> make_chunks(double friction) {
  std::vector<PieceType> types = load_workload(RUBBLE_WORKLOADS "/w0.txt").types;
  types.resize(kChunkTypes);
  for (PieceType& type : types) type.friction = friction;
  return types;
}

constexpr double kScaleMin = 0.12, kScaleMax = 0.2;  // lumps of 10 to 15 cm; unit: m

// Four lumps every 25 steps, from a ring of 0.3 m radius just above the top: as from a chute that
// rises with the heap, so that it is not beaten flat.
PileState pour_heap(double friction, std::uint64_t seed) {
  constexpr int kPours = 100, kLumps = 4, kSteps = 25, kLastSteps = 200;
  constexpr double kRadius = 0.3, kAboveTop = 0.5;
  WorldOptions options;
  options.threads = 1;
  World world(make_chunks(friction), options);
  RandomStream random(seed, "pouring");
  for (int pour = 0; pour < kPours; ++pour) {
    std::vector<NewPiece> pieces(kLumps);
    const double height = world.diagnostics().highest_point(true) + kAboveTop;
    for (int i = 0; i < kLumps; ++i) {
      const double turn = 2 * portable::kPi * (i + random.uniform(0, 0.3)) / kLumps;
      pieces[i].placement.kind = int(random.below(kChunkTypes));
      pieces[i].placement.scale = random.uniform(kScaleMin, kScaleMax);
      pieces[i].placement.world_from_body = {
          random.rotation(),
          {kRadius * portable::cos(turn), kRadius * portable::sin(turn), height}};
    }
    world.add(pieces);
    for (int step = 0; step < kSteps; ++step) world.step();
  }
  world.rest().begin_verification();  // as settling does
  for (int step = 0; step < kLastSteps; ++step) world.step();
  PileState state;
  state.pieces = world.pieces();
  return state;
}

double heap_degrees(double friction, int heaps) {
  double sum = 0;
  for (int seed = 1; seed <= heaps; ++seed) sum += calc_slope(pour_heap(friction, std::uint64_t(seed)));
  return sum / heaps * 180 / portable::kPi;
}

TEST(Heap, LiesAtItsAngleOfReposeAndSteeperWithFriction) {
  const double smooth = heap_degrees(0.3, 2), middle = heap_degrees(0.6, 2);
  EXPECT_GE(middle, 30);
  EXPECT_LE(middle, 45);
  EXPECT_GT(middle, smooth + 1) << "single heaps vary by 1 to 2 degrees; see below";
}

TEST(NightlyHeap, LiesAtItsAngleOfReposeAndSteeperWithFriction) {
  constexpr int kHeaps = 6;
  const double smooth = heap_degrees(0.3, kHeaps), middle = heap_degrees(0.6, kHeaps), rough = heap_degrees(0.8, kHeaps);
  std::printf("angle of repose: %.1f, %.1f, %.1f degrees at friction 0.3, 0.6, 0.8\n", smooth,
              middle, rough);
  EXPECT_GE(middle, 30);
  EXPECT_LE(middle, 45);
  EXPECT_GE(rough, 30);
  EXPECT_LE(rough, 45);
  EXPECT_GT(middle, smooth + 2);
  // Angular lumps lock into each other: beyond 0.6 friction adds little, and single heaps
  // vary by 1 to 2 degrees (standard deviation), the mean of six by 0.7.
  EXPECT_GT(rough, middle - 1.5);
}

Placement make_wall(int type, const Vec3& place) {
  Placement wall;
  wall.kind = type;
  wall.world_from_body.translation = place;
  wall.fixed = true;
  return wall;
}

PieceType make_box(const Vec3& half) {
  PieceType type;
  type.name = "wall";
  ConvexPart part;
  for (double x : {-half.x, half.x}) {
    for (double y : {-half.y, half.y}) {
      for (double z : {-half.z, half.z}) part.points.push_back({x, y, z});
    }
  }
  type.parts.push_back(part);
  return type;
}

PileSpec make_bin() {
  PileSpec spec;
  spec.seed = 1;
  spec.types = make_chunks(0.6);
  for (int i = 0; i < kChunkTypes; ++i) spec.mix.push_back({i, 1.0, kScaleMin, kScaleMax});
  spec.layers = 18;
  spec.pieces_per_layer = 40;
  spec.spawn_bounds = {1.5, 1.5, 1.6};
  const int along_x = int(spec.types.size()), along_y = along_x + 1;
  spec.types.push_back(make_box({1.2, 0.1, 1.5}));
  spec.types.push_back(make_box({0.1, 1.2, 1.5}));
  spec.placed = {make_wall(along_x, {0, 1.1, 1.5}), make_wall(along_x, {0, -1.1, 1.5}),
                 make_wall(along_y, {1.1, 0, 1.5}), make_wall(along_y, {-1.1, 0, 1.5})};
  return spec;
}

TEST(Heap, FillsAboutSixTenthsOfABin) {
  const PileSpec spec = make_bin();
  SettleOptions options;
  options.threads = 1;
  options.layer_time_limit = 1.5;
  options.final_time_limit = 3;
  const PileState state = settle_pile(generate_pile(spec), options);
  // Away from walls, floor and surface, where lumps cannot lie as close.
  const Aabb core{{-0.7, -0.7, 0.2}, {0.7, 0.7, 0.6}};
  const double share = calc_filled_share(spec.types, state, core, 20000);
  std::printf("filled share of a bin: %.3f\n", share);
  EXPECT_GE(share, 0.50);
  EXPECT_LE(share, 0.65);
}

// The measures themselves, on shapes with known answers.
TEST(HeapMeasures, FindTheSlopeOfACone) {
  constexpr double kHeight = 1.4, kRadius = 2.0;
  RandomStream random(1, "cone");
  PileState state;
  while (state.pieces.size() < 20000) {
    PieceState piece;
    Vec3& p = piece.world_from_body.translation;
    p = {random.uniform(-kRadius, kRadius), random.uniform(-kRadius, kRadius),
         random.uniform(0, kHeight)};
    if (p.z < kHeight * (1 - std::hypot(p.x, p.y) / kRadius)) state.pieces.push_back(piece);
  }
  EXPECT_NEAR(calc_slope(state), std::atan(kHeight / kRadius), 0.01);
}

TEST(HeapMeasures, FindTheFilledShareOfAHalfFullBox) {
  PileState state;
  state.pieces.resize(1);
  const Aabb twice{{-0.5, -0.5, 0}, {0.5, 0.5, 1}};  // z 0 to 1; the piece ends at 0.5
  EXPECT_NEAR(calc_filled_share({make_box({0.5, 0.5, 0.5})}, state, twice, 20000), 0.5, 0.015);
}

}  // namespace physics_sense_test
}  // namespace rubble
