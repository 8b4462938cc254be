// How members are cut into pieces, what their sections carry, and the forces in their bonds.
#include <gtest/gtest.h>

#include <cmath>

#include "kernel/base/error.h"
#include "kernel/geometry/shape.h"
#include "tests/kernel/member_scenes.h"

namespace rubble {
namespace {

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

TEST(Stress, OldFactorGivesWhatANewOneGives) {
  Member m = make_beam(6, 0.3, 0.5, 12);
  m.cut.counts[2] = 2, m.cut.roughness = 0.3;
  Structure s = build_structure({m}, 4);
  clamp_end(s, 0, -3, -1);
  std::vector<BondStatus> status(s.bonds.size());
  const BondGroup group = find_groups(s, status)[0];
  const std::vector<PieceLoad> weights = calc_weights(s, 9.81);
  GroupStress old(s, group);
  old.solve(status, weights);
  status[8].broken = true;
  const StressResult updated = old.solve(status, weights);
  GroupStress fresh(s, group);
  const StressResult direct = fresh.solve(status, weights);
  for (std::size_t i = 0; i < direct.forces.size(); ++i) {
    EXPECT_NEAR(updated.forces[i].moment_s, direct.forces[i].moment_s, 1.0) << i;
    EXPECT_NEAR(updated.forces[i].axial, direct.forces[i].axial, 1.0) << i;
  }
}

TEST(Stress, BalancedLoadsOfAFreeGroupNeedNoSupport) {
  const Structure s = build_structure({make_beam(6, 0.3, 0.5, 12)}, 1);
  std::vector<BondStatus> status(s.bonds.size());
  GroupStress stress(s, find_groups(s, status)[0]);
  std::vector<PieceLoad> loads(s.pieces.size());
  loads[0].force = {-5000, 0, 0}, loads[11].force = {5000, 0, 0};
  for (const SectionForces& f : stress.solve(status, loads).forces) EXPECT_NEAR(f.axial, 5000, 1e-3);
}

}  // namespace
}  // namespace rubble
