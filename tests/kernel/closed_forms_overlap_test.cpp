// Rest is not all: what is wedged into something else is not a settled pile.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "closed_forms.h"
#include "kernel/base/portable_math.h"
#include "kernel/settling/settle.h"
#include "kernel/world/world_diagnostics.h"

namespace rubble {
namespace closed_forms_overlap_test {

using namespace testing;

// Cubes of 0.4 m side by side on the ground of a fixed shaft, `length` by 0.402 m wide and 2 m
// high.
Pile make_shaft(int cubes, double length) {
  Pile pile;
  pile.types = {box_type("cube", 0.4, 0.4, 0.4), box_type("wall", 1, 2, 2)};
  for (const double side : {-1.0, 1.0}) {
    const double along = side * (length / 2 + 0.5), across = side * (0.201 + 0.5);
    pile.placed.push_back(at(1, {along, 0, 1}, {}, true).placement);
    pile.placed.push_back(at(1, {0, across, 1}, turned({0, 0, 1}, 1.5707963), true).placement);
  }
  for (int i = 0; i < cubes; ++i) {
    pile.placed.push_back(at(0, {length * ((i + 0.5) / cubes - 0.5), 0, 0.201}).placement);
  }
  return pile;
}

bool settles(const Pile& pile) {
  SettleOptions options;
  options.final_time_limit = 6;
  options.rest_overlap = 0.005;
  return settle_pile(pile, options).settled;
}

// `depth` deep in each wall, the cube cannot part from them and lies still for ever.
TEST(ClosedFormOverlap, AWedgedPieceIsNotSettled) {
  EXPECT_TRUE(settles(make_shaft(1, 0.402)));
  for (const double depth : {0.008, 0.02}) {
    EXPECT_FALSE(settles(make_shaft(1, 0.4 - 2 * depth))) << depth;
  }
}

// Two cubes that have too little room share 6 cm of overlap between three contacts: a pile that counts as
// settled is one where they no longer do, as one has been led out and lies on the other.
TEST(ClosedFormOverlap, TwoWedgedPiecesAreNotSettledSideBySide) {
  EXPECT_TRUE(settles(make_shaft(2, 0.803)));
  SettleOptions options;
  options.final_time_limit = 6;
  const PileState state = settle_pile(make_shaft(2, 0.74), options);
  const double upper = std::max(state.pieces[4].world_from_body.translation.z,
                                state.pieces[5].world_from_body.translation.z);
  EXPECT_TRUE(!state.settled || upper > 0.55) << upper;
  if (state.settled) {
    EXPECT_LT(state.deepest_overlap.depth, 0.005);
  }
}

// Four bars side by side and two across, 10 mm thick with openings of 90 mm: a mat of rebar.
PieceType make_mat() {
  PieceType mat;
  mat.name = "mat";
  for (int i = 0; i < 4; ++i) mat.parts.push_back(box_part(0.4, 0.01, 0.01, {0, -0.15 + 0.1 * i, 0}));
  for (const double x : {-0.15, 0.15}) mat.parts.push_back(box_part(0.01, 0.4, 0.01, {x, 0, 0}));
  return mat;
}

double sink_of(const std::vector<PieceType>& types, const NewPiece& lower, const NewPiece& upper) {
  World world(types);
  world.add({lower, upper});
  run(world, 4);
  return world.diagnostics().deepest_overlap().depth;
}

// A post through an opening that is too narrow for it: the bars beside it push it to and fro, and only
// upwards leads out.
TEST(ClosedFormOverlap, APostLeavesTheOpeningThatIsTooNarrow) {
  const std::vector<PieceType> types{make_mat(), box_type("post", 0.1, 0.098, 0.5), box_type("block", 1, 1, 0.2)};
  for (const double depth : {0.004, 0.02}) {
    World world(types);
    NewPiece post = at(1, {0, 0, 0.205 + 0.25 - depth});
    world.add({at(2, {0, 0, 0.1}, {}, true), at(0, {0, 0, 0.205}, {}, true), post});
    run(world, 4);
    EXPECT_LT(world.diagnostics().deepest_overlap().depth, 0.001) << depth;
  }
}

// A sheet that has sunk into a table made of two boards: each board alone would push it off sideways,
// into the other board.
TEST(ClosedFormOverlap, ASheetLeavesTheSeamOfTwoBoards) {
  PieceType table;
  table.name = "table";
  for (const double x : {-0.5, 0.5}) table.parts.push_back(box_part(1, 1, 0.1, {x, 0, 0}));
  const std::vector<PieceType> types{table, box_type("sheet", 0.01, 0.6, 0.3)};
  for (const double depth : {0.01, 0.03, 0.045}) {
    for (const double x : {0.0, 0.003, 0.02}) {
      const NewPiece sheet = at(1, {x, 0, 0.55 + 0.15 - depth}, {});
      EXPECT_LT(sink_of(types, at(0, {0, 0, 0.5}, {}, true), sheet), 0.001) << depth << " at " << x;
    }
  }
}

// 300 bricks on a slab that lies on two posts push it down, each a little; it must not sink.
TEST(ClosedFormOverlap, ASlabUnderManyBricksDoesNotSinkIntoItsSupports) {
  World world({box_type("slab", 4, 4, 0.2), box_type("post", 0.3, 4, 1), box_type("brick", 0.2, 0.2, 0.2)});
  std::vector<NewPiece> pieces{at(1, {-1.7, 0, 0.5}, {}, true), at(1, {1.7, 0, 0.5}, {}, true),
                               at(0, {0, 0, 1.1})};
  for (int i = 0; i < 300; ++i) {  // 20 mm deep in the slab, two layers
    pieces.push_back(at(2, {-1.8 + 0.25 * (i % 15), -1.2 + 0.25 * (i / 15 % 10), 1.28 + 0.2 * (i / 150)}));
  }
  world.add(pieces);
  double lowest = 2;
  for (int i = 0; i < 240; ++i) {
    world.step();
    lowest = std::min(lowest, world.piece(2).world_from_body.translation.z);
  }
  EXPECT_GT(lowest, 1.1 - 0.02);
  EXPECT_LT(world.diagnostics().deepest_overlap().depth, 0.0025);
}

// Three bars in a ring, each over the next and 60 mm deep in it: nothing below holds them up, though each lies on
// another. Their centre of mass falls as if they did not touch, and does not leave its vertical.
TEST(ClosedFormOverlap, WhatIsInTheAirFallsAsOneWhateverItsPiecesDoToEachOther) {
  std::vector<PieceType> types;
  for (const double density : {400.0, 2000.0, 10000.0}) {
    types.push_back(box_type("bar" + std::to_string(types.size()), 1.8, 0.2, 0.2));
    types.back().density = density;
  }
  World world(types, awake_options());
  constexpr double kSide = 1.2, kRise = 0.14;  // between crossings, along and up
  std::vector<NewPiece> bars;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * portable::kPi * k / 3;
    const double radius = kSide / (2 * std::sqrt(3.0));
    NewPiece bar = at(k, {radius * std::cos(angle), radius * std::sin(angle), 20});
    bar.placement.world_from_body.rotation =
        portable::quat_from_rpy(0, -std::atan2(kRise, kSide), angle + portable::kPi / 2);
    bars.push_back(bar);
  }
  world.add(bars);
  const auto centre = [&] {
    Vec3 sum;
    double mass = 0;
    for (int i = 0; i < 3; ++i) {
      sum += world.piece(i).world_from_body.translation * world.mass(i), mass += world.mass(i);
    }
    return sum * (1 / mass);
  };
  const Vec3 before = centre();
  run(world, 1);
  const Vec3 moved = centre() - before;
  EXPECT_NEAR(moved.z, -kG / 2, 0.01 * kG / 2);
  EXPECT_NEAR(moved.x, 0, 0.015);  // the limits on kicks take a little
  EXPECT_NEAR(moved.y, 0, 0.015);
}

}  // namespace closed_forms_overlap_test
}  // namespace rubble
