// How members are cut into pieces, what their sections carry, and the forces in their bonds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/geometry/shape.h"
#include "tests/kernel/member_scenes.h"

namespace rubble {
namespace structure_test {

TEST(Fragments, FillTheirBoxButForTheGaps) {
  CutOptions cut;
  cut.counts[0] = 4, cut.counts[1] = 3, cut.counts[2] = 2;
  cut.gap = 0;
  RandomStream random(3, "test");
  double volume = 0;
  for (const Fragment& f : cut_box({2, 1.5, 0.4}, cut, random)) {
    volume += calc_volume_properties({f.corners}).volume;
  }
  EXPECT_NEAR(volume, 2 * 1.5 * 0.4, 1e-9);
}

TEST(Fragments, OfAColumnMeetOnSlopesThroughItsAxis) {
  CutOptions options;
  options.counts[2] = 3;
  options.slope = 1.5;
  RandomStream random(3, "test");
  const Vec3 size{0.3, 0.3, 2.6};
  int cuts = 0;
  double volume = 0, steepest = 0;
  for (const Fragment& fragment : cut_box(size, options, random)) {
    volume += calc_volume_properties(ConvexPart{fragment.corners}).volume;
    for (const FragmentFace& face : fragment.faces) {
      if (face.neighbour < 0) continue;
      ++cuts;
      const Vec3& n = face.plane.normal;
      const double slope = std::sqrt(n.x * n.x + n.y * n.y) / std::abs(n.z);
      EXPECT_GT(slope, 0.5);
      EXPECT_LT(std::abs(face.plane.offset / n.z), 1.3) << "it meets the axis inside of the box";
      steepest = std::max(steepest, slope);
    }
  }
  EXPECT_EQ(cuts, 4);
  EXPECT_NEAR(steepest, 1.5, 1e-9);
  EXPECT_NEAR(volume / (0.09 * 2.6), 1, 0.01);
}

TEST(Fragments, DependOnTheSeedAlone) {
  CutOptions cut;
  cut.counts[0] = 5;
  const auto corners = [&](std::uint64_t seed) {
    RandomStream random(seed, "test");
    return cut_box({5, 0.4, 0.5}, cut, random)[2].corners;
  };
  EXPECT_TRUE(corners(1) == corners(1));
  EXPECT_FALSE(corners(1) == corners(2));
}

TEST(Section, OfARectangleHasItsSecondMoments) {
  const Polygon p{{0, -0.1, 1}, {0, 0.1, 1}, {0, 0.1, 1.5}, {0, -0.1, 1.5}};
  const Section s = make_section(p, {1, 0, 0}, brittle(), {});
  EXPECT_NEAR(s.area, 0.1, 1e-12);
  EXPECT_NEAR(s.inertia_s, 0.2 * 0.125 / 12, 1e-12);
  EXPECT_NEAR(s.inertia_t, 0.5 * 0.008 / 12, 1e-12);
  EXPECT_NEAR(s.centroid.z, 1.25, 1e-12);
}

// The table of Timoshenko and Goodier, art. 109.
TEST(Section, OfARectangleTwistsAsTheTableSays) {
  struct Row {
    double sides, modulus, constant;  // b/a; W / (b a^2), J / (b a^3)
  };
  for (const Row& row : {Row{1, 0.208, 0.1406}, Row{1.5, 0.231, 0.196}, Row{2, 0.246, 0.229}, Row{4, 0.282, 0.281},
                         Row{10, 0.312, 0.312}}) {
    const double a = 0.2, b = a * row.sides;
    const Polygon p{{0, -a / 2, 0}, {0, a / 2, 0}, {0, a / 2, b}, {0, -a / 2, b}};
    const Section s = make_section(p, {1, 0, 0}, brittle(), {});
    EXPECT_NEAR(s.torsion_modulus / (b * a * a), row.modulus, 0.02 * row.modulus) << row.sides;
    EXPECT_NEAR(s.torsion_constant / (b * a * a * a), row.constant, 0.02 * row.constant) << row.sides;
  }
}

TEST(Section, YieldTorqueOfBarsIsThatOfAThinTube) {
  SectionSteel steel;
  steel.area = 2e-3, steel.cover = 0.05, steel.yield = 500e6, steel.stirrups = 0.8e6;
  const Polygon p{{0, -0.15, 0}, {0, 0.15, 0}, {0, 0.15, 0.5}, {0, -0.15, 0.5}};
  const Section s = make_section(p, {1, 0, 0}, brittle(), steel);
  // Bars of 1 MN around 1.2 m, and one of two legs that carry 0.8 MPa on a width of 0.3 m.
  EXPECT_NEAR(calc_yield_torque(s), 2 * 0.2 * 0.4 * std::sqrt(1e6 / 1.2 * 0.8e6 * 0.15), 1);
  steel.stirrups = 0;
  EXPECT_EQ(calc_yield_torque(make_section(p, {1, 0, 0}, brittle(), steel)), 0);
}

TEST(Section, YieldMomentOfBarsIsForceTimesLever) {
  SectionSteel steel;
  steel.area = 2e-3, steel.area_s = steel.area_t = 1e-3, steel.cover = 0.05, steel.yield = 500e6;
  const Polygon p{{0, -0.15, 0}, {0, 0.15, 0}, {0, 0.15, 0.5}, {0, -0.15, 0.5}};
  const Section s = make_section(p, {1, 0, 0}, brittle(), steel);
  EXPECT_NEAR(calc_yield_moment(s, 0, true), 1e-3 * 500e6 * 0.4, 1);
  // A compressive force well below balance adds N (h - a) / 2.
  const double n = 500e3, a = n / (0.85 * 33e6 * 0.3);
  EXPECT_NEAR(calc_yield_moment(s, -n, true), 200e3 + n * (0.5 - a) / 2, 1);
  EXPECT_EQ(calc_yield_moment(s, 2e-3 * 500e6, true), 0);
}

TEST(Structure, PiecesWeighWhatTheMemberWeighs) {
  Member m = make_mast(3, 0.4, 6, 0.3);
  m.cut.gap = 0;
  const Structure s = build_structure({m}, 1);
  double mass = 0;
  for (const StructurePiece& p : s.pieces) mass += p.mass;
  EXPECT_NEAR(mass, 3 * 0.16 * 2400, 1e-6);
  EXPECT_EQ(s.bonds.size(), 6u);  // five within and the foot
}

TEST(Structure, MembersInTheSamePlaceAreNamed) {
  Member other = make_mast(3, 0.4, 6);
  other.name = "another";
  try {
    build_structure({make_mast(3, 0.4, 6), other}, 1);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("another"), std::string::npos) << error.what();
  }
}

TEST(Stress, ReactionsCarryTheWeightAndSymmetryIsKept) {
  // A table on four legs.
  std::vector<Member> members;
  for (const double x : {-2.0, 2.0}) {
    for (const double y : {-1.5, 1.5}) {
      Member leg = make_mast(3, 0.3, 5);
      leg.centre = {x, y, 1.5};
      leg.name = "leg";
      members.push_back(leg);
    }
  }
  Member top;
  top.name = "top", top.kind = MemberKind::slab;
  top.size = {4.3, 3.3, 0.2}, top.centre = {0, 0, 3.1};
  top.material = brittle();
  top.cut.counts[0] = 8, top.cut.counts[1] = 6, top.cut.roughness = 0;
  members.push_back(top);
  const Structure s = build_structure(members, 1);
  std::vector<BondStatus> status(s.bonds.size());
  const auto groups = find_groups(s, status);
  ASSERT_EQ(groups.size(), 1u);
  GroupStress stress(s, groups[0]);
  const StressResult result = stress.solve(status, calc_weights(s, 9.81));
  double weight = 0, carried = 0;
  for (const StructurePiece& p : s.pieces) weight += p.mass * 9.81;
  for (std::size_t i = 0; i < groups[0].bonds.size(); ++i) {
    if (s.bonds[groups[0].bonds[i]].piece_b != kFoundation) continue;
    carried -= result.forces[i].axial;
    EXPECT_NEAR(-result.forces[i].axial / (weight / 4), 1, 1e-6);
  }
  EXPECT_NEAR(carried / weight, 1, 1e-9);
}

// A plate that sticks out of a wall: 360 pieces, most of which have six neighbours.
struct Plate {
  Structure structure;
  std::vector<BondStatus> status;
  std::vector<PieceLoad> loads;

  Plate() {
    static const Structure kBuilt = build();
    structure = kBuilt;
    status.resize(structure.bonds.size());
    loads = calc_weights(structure, 9.81);
  }
  static Structure build() {
    Member m = make_beam(12, 6, 0.4, 24);
    m.cut.counts[1] = 15, m.cut.roughness = 0.3;
    Structure built = build_structure({m}, 4);
    for (std::int32_t i = 0; i < std::int32_t(built.pieces.size()); ++i) {
      if (built.pieces[i].centre.x < -5.7) clamp_end(built, i, -6, -1);
    }
    return built;
  }
  // Breaks all bonds of the pieces beyond a place to the others.
  void cut(double x, double y) {
    const auto beyond = [&](std::int32_t i) {
      return structure.pieces[i].centre.x > x && structure.pieces[i].centre.y > y;
    };
    for (std::size_t i = 0; i < status.size(); ++i) {
      const Bond& bond = structure.bonds[i];
      if (bond.piece_b != kFoundation && beyond(bond.piece_a) != beyond(bond.piece_b)) status[i].broken = true;
    }
  }
  BondGroup largest() const {
    std::vector<BondGroup> groups = find_groups(structure, status);
    return *std::max_element(groups.begin(), groups.end(), [](const BondGroup& a, const BondGroup& b) {
      return a.pieces.size() < b.pieces.size();
    });
  }
};

// Against a factor of its own, relative to the largest of each kind.
void expect_as_from_a_new_factor(const Plate& plate, GroupStress& old, const char* what) {
  GroupStress anew(plate.structure, old.group());
  const StressResult a = old.solve(plate.status, plate.loads), b = anew.solve(plate.status, plate.loads);
  ASSERT_TRUE(a.stable && b.stable) << what;
  double force = 0, moment = 0;
  for (const SectionForces& f : b.forces) {
    force = std::max({force, std::abs(f.axial), std::abs(f.shear_s), std::abs(f.shear_t)});
    moment = std::max({moment, std::abs(f.torque), std::abs(f.moment_s), std::abs(f.moment_t)});
  }
  for (std::size_t i = 0; i < b.forces.size(); ++i) {
    EXPECT_NEAR(a.forces[i].axial, b.forces[i].axial, 1e-7 * force) << what << i;
    EXPECT_NEAR(a.forces[i].shear_t, b.forces[i].shear_t, 1e-7 * force) << what << i;
    EXPECT_NEAR(a.forces[i].moment_s, b.forces[i].moment_s, 1e-7 * moment) << what << i;
    EXPECT_NEAR(a.forces[i].torque, b.forces[i].torque, 1e-7 * moment) << what << i;
    EXPECT_NEAR(a.rotation_s[i], b.rotation_s[i], 1e-7 * std::abs(b.rotation_s[i]) + 1e-12) << what << i;
  }
}

TEST(Stress, OldFactorGivesWhatANewOneGives) {
  Plate plate;
  GroupStress stress(plate.structure, plate.largest());
  ASSERT_EQ(stress.group().pieces.size(), 360u);
  stress.solve(plate.status, plate.loads);
  plate.status[8].broken = true;
  expect_as_from_a_new_factor(plate, stress, "broken ");
  plate.status[300].hinge_s = true, plate.status[300].moment_s = 900;
  plate.status[301].hinge_t = true, plate.status[301].moment_t = -300;
  plate.status[302].hinge_n = true, plate.status[302].torque = 500;
  expect_as_from_a_new_factor(plate, stress, "yielded ");
  EXPECT_EQ(stress.factors_made(), 1);
}

TEST(Stress, WhatIsLeftOfAGroupGoesOnWithItsFactor) {
  Plate plate;
  GroupStress whole(plate.structure, plate.largest());
  whole.solve(plate.status, plate.loads);
  plate.cut(5.5, 2.6);
  GroupStress first(std::move(whole), plate.largest());
  ASSERT_LT(first.group().pieces.size(), 360u);
  expect_as_from_a_new_factor(plate, first, "a corner came off ");
  plate.cut(5.5, 1.8);
  plate.status[20].broken = true;
  GroupStress second(std::move(first), plate.largest());
  expect_as_from_a_new_factor(plate, second, "and what was beside it ");
  EXPECT_EQ(second.factors_made(), 1);
}

// Cut along its whole length, a plate loses more bonds than a factor follows.
TEST(Stress, WhatIsLeftAfterManyCutsHasANewFactor) {
  Plate plate;
  GroupStress whole(plate.structure, plate.largest());
  whole.solve(plate.status, plate.loads);
  GroupStress left = std::move(whole);
  for (const double x : {5.5, 4.6, 3.7, 2.8}) {
    plate.cut(x, -10);
    left = GroupStress(std::move(left), plate.largest());
    expect_as_from_a_new_factor(plate, left, "strip after strip ");
  }
  EXPECT_GT(left.factors_made(), 1);
}

// Its loads must balance then.
TEST(Stress, WhatCameOffItsFoundationGoesOnWithItsFactor) {
  Plate plate;
  GroupStress whole(plate.structure, plate.largest());
  whole.solve(plate.status, plate.loads);
  for (std::size_t i = 0; i < plate.status.size(); ++i) {
    if (plate.structure.bonds[i].piece_b == kFoundation) plate.status[i].broken = true;
  }
  std::fill(plate.loads.begin(), plate.loads.end(), PieceLoad{});
  const std::int32_t a = 0, b = 359;
  const Vec3 force{2e4, 1e4, 0}, arm = plate.structure.pieces[b].centre - plate.structure.pieces[a].centre;
  plate.loads[a].force = -force, plate.loads[b].force = force;
  plate.loads[b].moment = -cross(arm, force);
  GroupStress loose(std::move(whole), plate.largest());
  ASSERT_FALSE(loose.group().anchored);
  expect_as_from_a_new_factor(plate, loose, "loose ");
  EXPECT_EQ(loose.factors_made(), 1);
}

TEST(Stress, BalancedLoadsOfAFreeGroupNeedNoSupport) {
  const Structure s = build_structure({make_beam(6, 0.3, 0.5, 12)}, 1);
  std::vector<BondStatus> status(s.bonds.size());
  GroupStress stress(s, find_groups(s, status)[0]);
  std::vector<PieceLoad> loads(s.pieces.size());
  loads[0].force = {-5000, 0, 0}, loads[11].force = {5000, 0, 0};
  for (const SectionForces& f : stress.solve(status, loads).forces) EXPECT_NEAR(f.axial, 5000, 1e-3);
}

}  // namespace structure_test
}  // namespace rubble
