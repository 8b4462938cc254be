// Buildings that stand, fall, and keep the loads and energies that statics gives them.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "kernel/base/error.h"
#include "kernel/settling/building_collapse.h"
#include "kernel/settling/collapse.h"
#include "kernel/settling/settle.h"
#include "kernel/structure/building.h"
#include "kernel/structure/failure.h"
#include "building_scenes.h"

namespace rubble {
namespace collapse_test {

using testing::pile_of;
using testing::small_building;

// The four columns of one bay carry a quarter of the weight each, whatever the cuts.
TEST(Building, ColumnLoadsAreTributaryWeights) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    BuildingSpec b = small_building();
    b.seed = seed;
    b.piece = 0.8, b.roughness = 0.15;
    const Structure s = build_building(b);
    const std::vector<SectionForces> forces = check_stands(s, 9.81);
    double weight = 0, sum = 0;
    for (const StructurePiece& p : s.pieces) weight += p.mass * 9.81;
    for (std::size_t i = 0; i < s.bonds.size(); ++i) {
      if (s.bonds[i].piece_b != kFoundation) continue;
      EXPECT_NEAR(-forces[i].axial / (weight / 4), 1, 0.02) << describe_bond(s, i);
      sum -= forces[i].axial;
    }
    EXPECT_NEAR(sum / weight, 1, 1e-6);
  }
}

TEST(Building, StandsForAMinuteWithoutACause) {
  const BuildingSpec b = small_building();
  const Pile pile = pile_of(b);
  World world(pile.types, calc_world_options({}));
  BuildingCollapse collapse(world, pile, {});
  for (int i = 0; i < 3600; ++i) {
    collapse.before_step();
    world.step();
    collapse.after_step();
  }
  EXPECT_EQ(collapse.report().broken + collapse.report().hinges, 0);
  for (int i = 0; i < world.size(); ++i) EXPECT_EQ(world.piece(i).status, PieceStatus::fixed) << i;
}

TEST(Building, ThatDoesNotStandIsNamedWithItsWorstBond) {
  BuildingSpec b = small_building();
  b.span_x = b.span_y = 12;
  b.slab = 0.1;
  b.slab_bars = 0.001;
  try {
    check_stands(build_building(b), 9.81);
    FAIL() << "it stands";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("does not stand before its cause"), std::string::npos) << text;
    EXPECT_NE(text.find("times its strength"), std::string::npos) << text;
    EXPECT_NE(text.find("of storey"), std::string::npos) << text;
  }
}

TEST(Building, KeysOutOfRangeAreNamed) {
  BuildingSpec b = small_building();
  b.slab = 0.4;  // deeper than its beams
  b.cause.removed = {{0, 5, 0}};
  try {
    validate(b);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("pile.building.slab"), std::string::npos) << text;
    EXPECT_NE(text.find("pile.building.removed"), std::string::npos) << text;
  }
}

// Without the two ground columns of one side the floors turn down about the other two.
TEST(Building, FallsWhereAColumnLineIsTakenAwayTheSameBitsOnAnyThreads) {
  BuildingSpec b = small_building();
  b.cause.removed = {{0, 0, 0}, {0, 0, 1}};
  Pile pile = pile_of(b);
  SettleOptions options;
  options.final_time_limit = 12;
  std::uint64_t hashes[2];
  for (const int threads : {1, 2}) {
    options.threads = threads;
    // Structures that were made before are those that it makes itself.
    if (threads == 2) pile.structures = std::make_shared<const BuildingStructures>(build_structures(b));
    CollapseReport report;
    const PileState state = settle_pile(pile, options, [&](const SettleProgress& p) {
      report = p.collapse;
      EXPECT_FALSE(p.make_checkpoint);
      return true;
    });
    hashes[threads - 1] = state.state_hash();
    EXPECT_GT(report.broken, 0);
    EXPECT_EQ(state.lost, 0);
    double top = 0;
    for (const PieceState& piece : state.pieces) {
      if (piece.world_from_body.translation.x < -1) top = std::max(top, piece.world_from_body.translation.z);
    }
    EXPECT_LT(top, 0.7 * 2 * b.storey_height) << "what lost its columns came down";
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// A plate falls on a table. What the legs' bonds take to break is more than the fall brings, or less.
// Bars of this ruin once kept a beam pressed 10 mm into a column, for ever.
TEST(Building, RestsAlthoughItsBarsPressPiecesTogether) {
  BuildingSpec b;
  b.storeys = 4, b.bays_x = b.bays_y = 2;
  b.column = 0.3, b.piece = 1.3;
  b.seed = 3;
  b.cause.overloaded_floor = 1, b.cause.overload = 2500;
  SettleOptions options;
  options.threads = 2;
  options.final_time_limit = 30;
  const PileState state = settle_pile(pile_of(b), options);
  EXPECT_TRUE(state.settled);
  EXPECT_EQ(state.lost, 0);
  EXPECT_LT(state.deepest_overlap.depth, 0.005);
}

TEST(Collapse, AnImpactBreaksOnlyWhatItHasTheEnergyFor) {
  Member leg;
  leg.kind = MemberKind::column;
  leg.size = {0.2, 0.2, 2};
  leg.material = find_structural_material("concrete", "test");
  leg.cut.counts[2] = 3;
  leg.cut.roughness = 0;
  leg.bars.ratio = 0.05, leg.bars.side_ratio = 0.025;
  leg.bars.steel.rupture_rotation = 0.1;  // tough
  std::vector<Member> members;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      leg.name = "leg";
      leg.centre = {x, y, 1};
      members.push_back(leg);
    }
  }
  Member top = leg;
  top.name = "top", top.kind = MemberKind::slab;
  top.size = {2.2, 2.2, 0.3}, top.centre = {0, 0, 2.15};
  top.cut.counts[2] = 1;
  members.push_back(top);
  const Structure s = build_structure(members, 1);
  PieceType plate;
  plate.name = "plate";
  plate.density = 19000;  // slow and heavy: much force, little energy
  plate.parts.emplace_back();
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      for (const double z : {-0.25, 0.25}) plate.parts[0].points.push_back({x, y, z});
    }
  }
  double arrested = 0, broke = 0, taken = 0;
  for (double height = 0.05; height < 40 && broke == 0; height *= 1.3) {
    std::vector<PieceType> types = s.types;
    types.push_back(plate);
    World world(types);
    Collapse collapse(world, s, 0, {});
    NewPiece piece;
    piece.placement.kind = int(types.size()) - 1;
    piece.placement.world_from_body.translation = {0, 0, 2.3 + 0.25 + 0.002};
    piece.linear_velocity = {0, 0, -std::sqrt(2 * 9.81 * height)};
    const int number = world.add({piece});
    for (int i = 0; i < 20; ++i) {
      collapse.begin_step();
      world.step();
      collapse.end_step();
    }
    const double energy = world.mass(number) * 9.81 * height;
    if (collapse.report().broken == 0 && collapse.arrests() > 0) arrested = energy;
    if (collapse.report().broken > 0) broke = energy, taken = collapse.report().energy_taken;
  }
  EXPECT_GT(arrested, 0) << "a force above the strength, an energy below what breaking takes";
  ASSERT_GT(broke, 0);
  EXPECT_LE(taken, broke);
  EXPECT_GT(taken, arrested / 2);
}

// In front of a wall: panels are blown in, away from the charge, and the frame stands.
TEST(Collapse, ABlastBreaksAllThatItBreaksInItsStep) {
  BuildingSpec b = small_building();
  b.infill = Infill::brick;
  b.cause.blast = 8000;
  b.cause.blast_at = {0, -4, 1.5};
  const Pile pile = pile_of(b);
  World world(pile.types, calc_world_options({}));
  BuildingCollapse collapse(world, pile, {});
  collapse.before_step();
  world.step();
  collapse.after_step();
  EXPECT_GT(collapse.report().broken, 10);
  int free = 0;
  double away = 0, fastest = 0;
  for (int i = 0; i < world.size(); ++i) {
    if (world.piece(i).status != PieceStatus::moving) continue;
    ++free;
    away += world.piece(i).linear_velocity.y;
    fastest = std::max(fastest, world.piece(i).linear_velocity.y);
  }
  EXPECT_GT(free, 2);
  EXPECT_GT(away / free, 0.1) << "m/s";
  EXPECT_GT(fastest, 1) << "m/s";
}

// The vehicle's force by EN 1991-1-7, C.2.1, against what two sections of a column carry in shear.
TEST(Collapse, AVehicleKnocksOutWhatItIsStrongerThanAndDrivesItNoFasterThanItself) {
  BuildingSpec b = small_building();
  b.cause.vehicle.speed = 10;
  const double sections = 2 * 0.09 * (0.98e6 + 0.8e6);
  for (const double share : {0.9, 1.1}) {
    const double force = share * sections;
    b.cause.vehicle.mass = force * force / (b.cause.vehicle.stiffness * 100);
    const Pile pile = pile_of(b);
    World world(pile.types, calc_world_options({}));
    BuildingCollapse collapse(world, pile, {});
    EXPECT_EQ(collapse.report().broken, share > 1 ? 2 : 0) << share;
    double fastest = 0;
    for (int step = 0; step < 20; ++step) {
      collapse.before_step();
      world.step();
      collapse.after_step();
      for (int i = 0; i < world.size(); ++i) fastest = std::max(fastest, norm(world.piece(i).linear_velocity));
    }
    if (share < 1) continue;
    EXPECT_GT(fastest, 5) << "m/s";
    EXPECT_LE(fastest, 10.5) << "m/s";
  }
}

// A shake that gives no piece as much as the least change of load that is looked at elsewhere still counts, or a weak quake would do
// nothing to the weakest house.
TEST(BuildingCollapse, AWeakShakeBreaksAWeakHouse) {
  for (const double weakness : {0.002, 1.0}) {
    BuildingSpec b = small_building();
    b.cause.weak_storey = 0, b.cause.weakness = weakness;
    b.cause.shake = 1.2, b.cause.accelerogram.assign(60, 1.0), b.cause.accelerogram_step = 0.02;
    const Pile pile = pile_of(b);
    World world(pile.types, calc_world_options({}));
    BuildingCollapse collapse(world, pile, {});
    const int before = collapse.report().broken;
    for (int step = 0; step < 60; ++step) {
      collapse.before_step();
      world.step();
      collapse.after_step();
    }
    EXPECT_EQ(collapse.report().broken > before, weakness < 1) << weakness;
  }
}

TEST(GroundMotion, ReadsAnAccelerogramBetweenItsSamples) {
  CollapseCause cause;
  cause.shake = 4;
  cause.accelerogram = {0, 2, -8, 1};
  cause.accelerogram_step = 0.1;
  const GroundMotion motion(cause, 5, 0.05);
  const double expected[] = {0, 0.5, 1, -1.5, -4, -1.75, 0.5, 0.25};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(motion.at(i).x, expected[i], 1e-12) << i;
  EXPECT_TRUE(motion.over(8));
}

// What a column carried goes to its neighbours when its footing sinks, before anything breaks.
TEST(Stress, ASinkingFootingUnloadsItsColumn) {
  BuildingSpec b = small_building();
  const Structure s = build_building(b);
  std::vector<BondStatus> status(s.bonds.size());
  GroupStress stress(s, find_groups(s, status)[0]);
  const std::vector<PieceLoad> weights = calc_weights(s, 9.81);
  const auto at_foundation = [&](const StressResult& r, double& sum) {
    std::vector<double> loads;
    for (std::size_t i = 0; i < s.bonds.size(); ++i) {
      if (s.bonds[i].piece_b == kFoundation) loads.push_back(-r.forces[i].axial), sum += loads.back();
    }
    return loads;
  };
  double before_sum = 0, after_sum = 0;
  const auto before = at_foundation(stress.solve(status, weights), before_sum);
  for (std::size_t i = 0; i < s.bonds.size(); ++i) {
    if (s.bonds[i].piece_b != kFoundation) continue;
    status[i].sunk = {0, 0, -0.0005};
    break;
  }
  const auto after = at_foundation(stress.solve(status, weights), after_sum);
  EXPECT_LT(after[0], 0.98 * before[0]);
  EXPECT_GT(after[1], before[1]);
  EXPECT_NEAR(after_sum / before_sum, 1, 1e-9);
}

TEST(GroundMotion, PeaksAtItsLargestAccelerationAndEnds) {
  CollapseCause cause;
  cause.shake = 3, cause.shake_seconds = 6, cause.shake_direction_deg = 90;
  const GroundMotion motion(cause, 5, 1.0 / 60), other(cause, 6, 1.0 / 60);
  double most = 0, differs = 0;
  for (int i = 0; i < 360; ++i) {
    most = std::max(most, norm(motion.at(i)));
    differs = std::max(differs, distance(motion.at(i), other.at(i)));
    EXPECT_NEAR(motion.at(i).x, 0, 1e-12);
  }
  EXPECT_NEAR(most, 3, 1e-12);
  EXPECT_GT(differs, 0.5);
  EXPECT_TRUE(motion.over(360));
  EXPECT_FALSE(motion.over(359));
}

}  // namespace collapse_test
}  // namespace rubble
