// What falls, bridges, wedges or is arrested, against estimates in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/settling/collapse.h"
#include "kernel/structure/building.h"
#include "kernel/structure/failure.h"
#include "kernel/world/world_structures.h"
#include "scenes.h"

namespace rubble {
namespace collapse_forms_test {

constexpr double kGravity = 9.81;

PieceType make_box(const Vec3& size, double density) {
  PieceType type = testing::box_type("box", size.x, size.y, size.z);
  type.density = density;
  return type;
}

NewPiece at(int type, const Vec3& place, bool fixed = false) { return testing::at(type, place, {}, fixed); }

// A row of plates between two walls hangs by its bars alone. The sag d opens the joints by 8 d^2 / (3 L) in
// all; the weight gives W 2 d / 3 on its way, and the bars that yield take their force times their stretch.
// At most all of them stretch to their end; at least the two at the walls do, which carry the most.
struct Catenary {
  static constexpr int kPlates = 12;
  static constexpr double kSpan = 6, kSlack = 0.02, kStretch = 0.03;
  static constexpr int kJoints = kPlates + 1;
  World world{{make_box({kSpan / kPlates - 0.002, 0.6, 0.12}, 2400), make_box({0.5, 1, 1}, 2400)}};
  double weight = 0;

  explicit Catenary(double strength) {
    const double length = kSpan / kPlates;
    std::vector<NewPiece> pieces{at(1, {-kSpan / 2 - 0.25, 0, 5}, true), at(1, {kSpan / 2 + 0.25, 0, 5}, true)};
    for (int i = 0; i < kPlates; ++i) pieces.push_back(at(0, {-kSpan / 2 + (i + 0.5) * length, 0, 5}));
    world.add(pieces);
    for (int i = 0; i < kPlates; ++i) weight += world.mass(2 + i) * kGravity;
    for (int i = 0; i < kJoints; ++i) {
      TieState tie;
      tie.piece_a = i == 0 ? 0 : i + 1;
      tie.piece_b = i == kPlates ? 1 : i + 2;
      tie.anchor_a = {i == 0 ? 0.15 : length / 2 - 0.1, 0, 0};
      tie.anchor_b = {i == kPlates ? -0.15 : -length / 2 + 0.1, 0, 0};
      tie.length = 0.2 + kSlack;
      tie.strength = strength;
      tie.stretch = kStretch;
      tie.bending = 100;
      world.structures().add_tie(tie);
    }
  }
  void run(double seconds) {
    for (int i = 0; i < int(seconds * 60); ++i) world.step();
  }
  static double sag(double opening) { return std::sqrt(3 * kJoints * opening * kSpan / 8); }
  // The strength that stops the fall when so many bars yield.
  double stopping_strength(int yielding) const {
    const double longest = sag(kSlack + kStretch * yielding / kJoints);
    return std::max(weight * 2 / 3 * longest / (yielding * kStretch), weight * kSpan / (8 * longest));
  }
  double middle() const { return world.piece(2 + kPlates / 2).world_from_body.translation.z; }
};

TEST(Catenary, BridgesWhereItsBarsAreStrongEnoughAndFallsWhereNot) {
  Catenary strong(1.2 * Catenary(1).stopping_strength(2));
  strong.run(12);
  EXPECT_EQ(int(strong.world.structures().ties().size()), Catenary::kJoints);
  const double sagged = 5 - strong.middle();
  EXPECT_GT(sagged, 0.8 * Catenary::sag(Catenary::kSlack));
  EXPECT_LT(sagged, 1.1 * Catenary::sag(Catenary::kSlack + Catenary::kStretch));
  // H = W L / (8 d) in the middle, in the mean: long chains tremble.
  double pull = 0;
  for (int i = 0; i < 120; ++i) {
    strong.world.step();
    pull += strong.world.structures().tie_force(Catenary::kJoints / 2) / 120;
  }
  EXPECT_NEAR(pull / (strong.weight * Catenary::kSpan / (8 * (5 - strong.middle()))), 1, 0.15);
  Catenary weak(0.8 * Catenary(1).stopping_strength(Catenary::kJoints));
  weak.run(4);
  EXPECT_LT(int(weak.world.structures().ties().size()), Catenary::kJoints);
  EXPECT_LT(weak.middle(), 1) << "it fell to the ground";
}

// Two blocks without any bond wedge between walls as a flat arch: thrust from the walls' lower edges to
// the crown's upper one, H = W a / (2 d) of each block's weight W. It slips where that gives less friction
// than half of what it carries.
TEST(Arch, OfTwoBlocksHoldsByItsThrustOrSlips) {
  for (const double depth : {0.15, 0.75}) {
    const double a = 1, friction = 0.8;
    const bool holds = 2 * depth / a < friction;
    World world({make_box({a, 0.6, depth}, 2400), make_box({0.5, 1, 1.5}, 2400)});
    world.add({at(1, {-a - 0.25, 0, 3}, true), at(1, {a + 0.25, 0, 3}, true), at(0, {-a / 2, 0, 3}),
               at(0, {a / 2, 0, 3})});
    for (int i = 0; i < 300; ++i) world.step();
    const double z = world.piece(2).world_from_body.translation.z;
    if (holds) EXPECT_GT(z, 2.9) << depth;
    else EXPECT_LT(z, 2) << depth;
  }
}

// Tables on tables, of plates on four legs. The top plate loses its legs and falls by a storey: below it
// the collapse goes on if that brings more energy than the legs take (Bazant and Verdure 2007), and is
// arrested if it brings less.
struct Tower {
  static constexpr int kFloors = 3;
  static constexpr double kLeg = 1.5, kPlate = 0.3;
  Structure structure;
  double brought = 0, taken = 0;  // by the fall of the top plate; to break one storey's legs; unit: J

  explicit Tower(double toughness) {
    std::vector<Member> members;
    Member leg;
    leg.kind = MemberKind::column;
    leg.size = {0.14, 0.14, kLeg};
    leg.material = find_structural_material("concrete", "test");
    leg.cut.roughness = 0;
    leg.bars.ratio = 0.02, leg.bars.side_ratio = 0.01;
    leg.bars.steel.rupture_rotation = toughness;
    Member plate = leg;
    plate.kind = MemberKind::slab, plate.size = {2.2, 2.2, kPlate};
    plate.bars = {};
    for (int k = 0; k < kFloors; ++k) {
      const double bottom = k * (kLeg + kPlate);
      leg.name = "leg of storey " + std::to_string(k);
      for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
          leg.centre = {x, y, bottom + kLeg / 2};
          if (k + 1 < kFloors) members.push_back(leg);
        }
      }
      plate.name = "floor " + std::to_string(k);
      plate.centre = {0, 0, bottom + kLeg + kPlate / 2};
      members.push_back(plate);
    }
    structure = build_structure(members, 1);
    brought = structure.pieces.back().mass * kGravity * kLeg;
    for (const Bond& bond : structure.bonds) {
      if (bond.piece_b == kFoundation) taken += calc_breaking_energy(bond.section);
    }
  }
  void run(CollapseReport& report) const {
    World world(structure.types);
    Collapse collapse(world, structure, 0, {});
    for (int i = 0; i < 240; ++i) {
      collapse.begin_step();
      world.step();
      collapse.end_step();
    }
    report = collapse.report();
  }
};

TEST(Pancake, GoesOnOrIsArrestedAsTheEnergySays) {
  const double ratio = Tower(0.01).brought / Tower(0.01).taken;
  CollapseReport weak, tough;
  // Energies scale with the rotation at which bars tear, but for the concrete's small share.
  const Tower breaks(0.01 * ratio / 3), holds(0.01 * ratio * 3);
  EXPECT_GT(breaks.brought, 2 * breaks.taken);
  EXPECT_LT(holds.brought, 0.5 * holds.taken);
  breaks.run(weak);
  holds.run(tough);
  EXPECT_EQ(weak.broken, weak.bonds) << "the legs of both storeys, at both ends";
  EXPECT_EQ(tough.broken, 0);
  EXPECT_GT(weak.energy_taken, 0);
}

TEST(RemainingBars, HaveTheSteelOfTheirSectionAndItsPlace) {
  Member beam;
  beam.name = "beam";
  beam.size = {4, 0.3, 0.4}, beam.centre = {0, 0, 3};
  beam.material = find_structural_material("concrete", "test");
  beam.cut.counts[0] = 4, beam.cut.roughness = 0;
  beam.bars.ratio = 0.01, beam.bars.side_ratio = 0.004;
  Member slab = beam;
  slab.kind = MemberKind::slab;
  slab.size = {4, 3, 0.15}, slab.centre = {0, 0, 8};
  const Structure s = build_structure({beam, slab}, 1);
  const auto bars = find_remaining_bars(s, s.bonds[0], 0.5);
  ASSERT_EQ(bars.size(), 1u);
  EXPECT_NEAR(bars[0].strength, 0.5 * 0.01 * 0.12 * 550e6, 1);
  const Vec3 a = s.pieces[0].position + bars[0].anchor_a, b = s.pieces[1].position + bars[0].anchor_b;
  EXPECT_NEAR(distance((a + b) * 0.5, s.bonds[0].section.centroid), 0, 1e-9);
  EXPECT_LT(distance(a, b), bars[0].length) << "freed bars hang through";
  const auto wide = find_remaining_bars(s, s.bonds.back(), 1);
  ASSERT_EQ(wide.size(), 2u);
  EXPECT_NEAR(wide[0].strength + wide[1].strength, 0.01 * 0.45 * 550e6, 1);
  EXPECT_NEAR(distance(wide[0].anchor_a, wide[1].anchor_a), 1.5, 1e-6);
  EXPECT_TRUE(find_remaining_bars(s, s.bonds[0], 0).empty());
}

// Four storeys: the columns of each carry a quarter of all that is above them.
TEST(Building, OfFourStoreysHasTributaryWeightsInTheColumnsOfEach) {
  BuildingSpec b;
  b.storeys = 4, b.bays_x = b.bays_y = 1;
  b.infill = Infill::none;
  b.seed = 3, b.roughness = 0.15;
  const Structure s = build_building(b);
  const std::vector<SectionForces> forces = check_stands(s, kGravity);
  for (int k = 0; k < b.storeys; ++k) {
    const double height = (k + 0.5) * b.storey_height;
    double above = 0;
    for (const StructurePiece& p : s.pieces) {
      if (p.centre.z > k * b.storey_height + 0.5 * (b.storey_height - b.beam_depth)) above += p.mass * kGravity;
    }
    int columns = 0;
    for (std::size_t i = 0; i < s.bonds.size(); ++i) {
      const Bond& bond = s.bonds[i];
      if (bond.piece_b == kFoundation || std::abs(bond.section.normal.z) < 0.5) continue;
      const Member& one = s.members[s.pieces[bond.piece_a].member];
      const Member& other = s.members[s.pieces[bond.piece_b].member];
      const bool within = &one == &other && one.kind == MemberKind::column;
      if (!within || std::abs(bond.section.centroid.z - height) > 0.6) continue;
      double part = 0;  // what is above this section, a quarter of the floors and its own column
      for (const StructurePiece& p : s.pieces) {
        if (p.centre.z <= bond.section.centroid.z) continue;
        const bool in_column = s.members[p.member].kind == MemberKind::column && p.centre.z < (k + 1) * b.storey_height - b.beam_depth;
        if (!in_column) part += p.mass * kGravity / 4;
        else if (s.pieces[bond.piece_a].member == p.member) part += p.mass * kGravity;
      }
      EXPECT_NEAR(-forces[i].axial / part, 1, 0.02) << describe_bond(s, i);
      ++columns;
    }
    EXPECT_GE(columns, 4) << "storey " << k;
    EXPECT_GT(above, 0);
  }
}

}  // namespace collapse_forms_test
}  // namespace rubble
