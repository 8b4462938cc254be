// Members that are cut and bonded again, and the loads at which they break, against beam theory.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "tests/kernel/member_scenes.h"

namespace rubble {
namespace beam_theory_test {

// A mast under a force across its top: breaks at its foot at f_t W / L.
TEST(BeamTheory, CantileverBreaksAtItsFootAtTheLoadOfItsSection) {
  for (const double roughness : {0.0, 0.3}) {
    const Structure s = build_structure({make_mast(4, 0.3, 12, roughness)}, 5);
    const double arm = s.pieces[11].centre.z;
    const double expected = 2.6e6 * 0.3 * 0.09 / 6 / arm;
    const auto loads = [&](double force) {
      std::vector<PieceLoad> l(s.pieces.size());
      l[11].force = {force, 0, 0};
      return l;
    };
    const auto breaks = [&](const std::vector<PieceLoad>& l) { return !load(s, l).failures.empty(); };
    const double limit = find_limit(0, 10 * expected, loads, breaks);
    EXPECT_NEAR(limit / expected, 1, roughness > 0 ? 0.05 : 1e-6) << "roughness " << roughness;
    const Outcome outcome = load(s, loads(1.01 * limit), {}, 1);
    ASSERT_EQ(outcome.failures.size(), 1u);
    EXPECT_EQ(s.bonds[outcome.failures[0].bond].piece_b, kFoundation);
    EXPECT_EQ(outcome.failures[0].mode, FailureMode::bending);
  }
}

// A force in the middle, half of it at each end: breaks in the middle at 4 f_t W / L.
TEST(BeamTheory, SimplySupportedBeamBreaksInTheMiddle) {
  const double length = 6;
  const Structure s = build_structure({make_beam(length, 0.3, 0.5, 20)}, 1);
  const double expected = 4 * 2.6e6 * 0.3 * 0.25 / 6 / length;
  const auto loads = [&](double force) {
    std::vector<PieceLoad> l(s.pieces.size());
    const auto put = [&](int piece, double x, double f) {
      l[piece].force.z += f;
      l[piece].moment.y -= (x - s.pieces[piece].centre.x) * f;
    };
    put(0, -length / 2, force / 2), put(19, length / 2, force / 2);
    put(9, 0, -force / 2), put(10, 0, -force / 2);
    return l;
  };
  const auto breaks = [&](const std::vector<PieceLoad>& l) { return !load(s, l).failures.empty(); };
  const double limit = find_limit(0, 10 * expected, loads, breaks);
  EXPECT_NEAR(limit / expected, 1, 1e-6);
  const Outcome outcome = load(s, loads(1.001 * limit), {}, 1);
  ASSERT_EQ(outcome.failures.size(), 1u);
  EXPECT_EQ(s.bonds[outcome.failures[0].bond].piece_a, 9);
  EXPECT_EQ(s.bonds[outcome.failures[0].bond].piece_b, 10);
}

// Of a force P at a L from one end the largest moment, P a (1 - a) L, is below it; of two at L/4 and at
// 3L/4, half each, it is P L / 8 anywhere between them; of an even load W L / 8 in the middle.
TEST(BeamTheory, SimplySupportedBeamBreaksWhereItsMomentIsLargest) {
  const double length = 6;
  constexpr int kPieces = 24;
  const Structure s = build_structure({make_beam(length, 0.3, 0.5, kPieces)}, 1);
  const double moment = 2.6e6 * 0.3 * 0.25 / 6;
  struct Scene {
    const char* name;
    std::vector<std::pair<double, double>> forces;  // place and share
    double expected, from, to;                      // load at failure; where it breaks, along x
  };
  std::vector<std::pair<double, double>> even;
  for (int i = 0; i < 2 * kPieces; ++i) {
    even.push_back({-length / 2 + (i + 0.5) * length / (2 * kPieces), 0.5 / kPieces});
  }
  const Scene scenes[] = {
      {"quarter", {{-1.5, 1}}, moment / (0.25 * 0.75 * length), -1.5, -1.5},
      {"sixth", {{-2, 1}}, moment / (1.0 / 6 * 5 / 6 * length), -2, -2},
      {"third, other side", {{1, 1}}, moment / (1.0 / 3 * 2 / 3 * length), 1, 1},
      {"two", {{-1.5, 0.5}, {1.5, 0.5}}, 8 * moment / length, -1.5, 1.5},
      {"even", even, 8 * moment / length, 0, 0},
  };
  for (const Scene& scene : scenes) {
    SCOPED_TRACE(scene.name);
    const auto loads = [&](double force) {
      std::vector<PieceLoad> l(s.pieces.size());
      const auto put = [&](double x, double f) {
        // A force above a joint goes to both sides of it.
        for (const double side : {-1e-9, 1e-9}) {
          const int piece = std::min(kPieces - 1, std::max(0, int((x + side + length / 2) / length * kPieces)));
          l[piece].force.z += f / 2;
          l[piece].moment.y -= (x - s.pieces[piece].centre.x) * f / 2;
        }
      };
      double left = 0;
      for (const auto& [x, share] : scene.forces) {
        put(x, -force * share);
        left += force * share * (length / 2 - x) / length;
      }
      put(-length / 2, left), put(length / 2, force - left);
      return l;
    };
    const auto breaks = [&](const std::vector<PieceLoad>& l) { return !load(s, l).failures.empty(); };
    const double limit = find_limit(0, 10 * scene.expected, loads, breaks);
    EXPECT_NEAR(limit / scene.expected, 1, 0.05);
    const Outcome outcome = load(s, loads(1.001 * limit), {}, 1);
    ASSERT_FALSE(outcome.failures.empty());
    const double place = s.bonds[outcome.failures[0].bond].section.centroid.x;
    EXPECT_GE(place, scene.from - 1e-6);
    EXPECT_LE(place, scene.to + 1e-6);
  }
}

TEST(BeamTheory, DeflectionOfACantileverConverges) {
  const Structure s = build_structure({make_mast(4, 0.3, 20)}, 5);
  std::vector<PieceLoad> l(s.pieces.size());
  l[19].force = {1000, 0, 0};
  std::vector<BondStatus> status(s.bonds.size());
  GroupStress stress(s, find_groups(s, status)[0]);
  const StressResult result = stress.solve(status, l);
  double turned = 0;  // the top's rotation is the sum of all: P L^2 / (2 E I), plus shear's, which is none
  for (const double r : result.rotation_t) turned += std::abs(r);
  for (const double r : result.rotation_s) turned += std::abs(r);
  const double arm = s.pieces[19].centre.z, inertia = 0.3 * 0.027 / 12;
  EXPECT_NEAR(turned / (1000 * arm * arm / (2 * 31e9 * inertia)), 1, 0.02);
}

TEST(BeamTheory, ColumnCrushesAtItsStrength) {
  Member m = make_mast(2, 0.3, 8);
  for (const bool barred : {false, true}) {
    if (barred) m.bars = bars(0.02);
    const Structure s = build_structure({m}, 1);
    const double steel = barred ? 0.02 * 0.09 : 0;
    // Plain: the strength. Barred: the larger of the uncracked section and the squash load.
    const double expected = std::max(33e6 * 0.09, 0.85 * 33e6 * (0.09 - steel) + steel * 550e6);
    const auto loads = [&](double force) {
      std::vector<PieceLoad> l(s.pieces.size());
      l[7].force = {0, 0, -force};
      return l;
    };
    const auto breaks = [&](const std::vector<PieceLoad>& l) { return !load(s, l).failures.empty(); };
    EXPECT_NEAR(find_limit(0, 3 * expected, loads, breaks) / expected, 1, 1e-6);
    EXPECT_EQ(load(s, loads(1.01 * expected), {}, 1).failures[0].mode, FailureMode::compression);
  }
}

// The secant formula, of a mast that stands free: P/A (1 + e c/r^2 sec(L sqrt(P / E I))) = fc.
TEST(BeamTheory, SlenderColumnUnderAnEccentricLoad) {
  Member m = make_mast(10, 0.3, 30);
  m.material.tension = 1e9;  // pressure decides
  const Structure s = build_structure({m}, 1);
  const double e = 0.05, length = s.pieces[29].centre.z, area = 0.09, inertia = 0.3 * 0.027 / 12;
  const auto stress_at = [&](double p) {
    const double k = length * std::sqrt(p / (31e9 * inertia));
    return p / area * (1 + e * 0.15 * area / inertia / portable::cos(k));
  };
  const double euler = portable::kPi * portable::kPi * 31e9 * inertia / (4 * length * length);
  double low = 0, high = 0.999 * euler;
  for (int i = 0; i < 60; ++i) (stress_at((low + high) / 2) > 33e6 ? high : low) = (low + high) / 2;
  const auto loads = [&](double p) {
    std::vector<PieceLoad> l(s.pieces.size());
    l[29].force = {0, 0, -p};
    l[29].moment = {0, p * e, 0};
    return l;
  };
  const auto breaks = [&](const std::vector<PieceLoad>& l) {
    std::vector<BondStatus> status(s.bonds.size());
    const BondGroup group = find_groups(s, status)[0];
    GroupStress stress(s, group, {true});
    const StressResult result = stress.solve(status, l);
    return !result.stable || find_worst(s, group, result, status).utilization > 1;
  };
  const double limit = find_limit(0, 2 * euler, loads, breaks);
  EXPECT_NEAR(limit / low, 1, 0.05);
  EXPECT_LT(limit, 0.5 * 33e6 * area);  // far below crushing: slenderness decides
}

TEST(BeamTheory, FreeColumnBucklesAtEulersLoad) {
  Member m = make_mast(10, 0.3, 30);
  m.material.compression = m.material.tension = 1e12;
  const Structure s = build_structure({m}, 1);
  const double length = s.pieces[29].centre.z, inertia = 0.3 * 0.027 / 12;
  const double euler = portable::kPi * portable::kPi * 31e9 * inertia / (4 * length * length);
  const auto loads = [&](double p) {
    std::vector<PieceLoad> l(s.pieces.size());
    l[29].force = {0, 0, -p};
    return l;
  };
  const auto buckles = [&](const std::vector<PieceLoad>& l) {
    std::vector<BondStatus> status(s.bonds.size());
    GroupStress stress(s, find_groups(s, status)[0], {true});
    return !stress.solve(status, l).stable;
  };
  EXPECT_NEAR(find_limit(0, 3 * euler, loads, buckles) / euler, 1, 0.02);
}

// Evenly loaded between two walls: the ends yield at 12 Mp / L^2, the middle at 16 Mp / L^2.
TEST(BeamTheory, FixedBeamYieldsAtTheEndsAndFallsAfterThreeHinges) {
  const double length = 6;
  Member m = make_beam(length, 0.3, 0.5, 24);
  m.bars = bars(0.02);
  Structure s = build_structure({m}, 1);
  clamp_end(s, 0, -length / 2, -1);
  clamp_end(s, 23, length / 2, 1);
  const double yield = calc_yield_moment(s.bonds[0].section, 0, true);
  const auto loads = [&](double per_metre) {
    std::vector<PieceLoad> l(s.pieces.size());
    for (PieceLoad& p : l) p.force.z = -per_metre * length / 24;
    return l;
  };
  const auto yields = [&](const std::vector<PieceLoad>& l) { return !load(s, l).failures.empty(); };
  const auto falls = [&](const std::vector<PieceLoad>& l) {
    const Outcome o = load(s, l);
    return std::any_of(o.status.begin(), o.status.end(), [](const BondStatus& b) { return b.broken; });
  };
  const double unit = yield / (length * length);
  EXPECT_NEAR(find_limit(0, 40 * unit, loads, yields) / unit, 12, 0.6);
  EXPECT_NEAR(find_limit(0, 40 * unit, loads, falls) / unit, 16, 0.8);
  // Two hinges stand, at the ends.
  const Outcome two = load(s, loads(14 * unit));
  ASSERT_EQ(two.failures.size(), 2u);
  for (const BondFailure& f : two.failures) {
    EXPECT_TRUE(f.hinge);
    EXPECT_EQ(s.bonds[f.bond].piece_b, kFoundation);
  }
}

// A slab's strip, twisted: with the polar moment of its section it would be fourteen times as stiff.
TEST(BeamTheory, TwistOfACantileverIsThatOfSaintVenant) {
  const double length = 6, width = 1.2, depth = 0.18;
  Member m = make_beam(length, width, depth, 24);
  Structure s = build_structure({m}, 1);
  clamp_end(s, 0, -length / 2, -1);
  std::vector<PieceLoad> loads(s.pieces.size());
  loads[23].moment.x = 1000;
  const std::vector<BondStatus> status(s.bonds.size());
  GroupStress stress(s, find_groups(s, status)[0]);
  const StressResult result = stress.solve(status, loads);
  double turned = 0;
  for (const double rotation : result.rotation_n) turned += std::abs(rotation);
  const double slim = depth / width, g = m.material.youngs_modulus / 2.4;
  const double constant = width * depth * depth * depth / 3 * (1 - 0.63 * slim);
  // From the clamp to the middle of the last piece.
  EXPECT_NEAR(turned, 1000 * (length - length / 48) / (g * constant), 0.02 * turned);
}

// What twists a section with bars and stirrups cracks it and turns it on, but does not break it.
TEST(BeamTheory, BarsAndStirrupsYieldInTorsionAndHold) {
  Member m = make_beam(6, 0.3, 0.5, 24);
  m.material = find_structural_material("concrete", "test");
  m.bars = bars(0.02);
  m.bars.stirrups = 0.8e6;
  Structure s = build_structure({m}, 1);
  clamp_end(s, 0, -3, -1);
  clamp_end(s, 23, 3, 1);
  const Section& section = s.bonds[0].section;
  const auto loads = [&](double torque) {
    std::vector<PieceLoad> l(s.pieces.size());
    l[11].moment.x = l[12].moment.x = torque;
    return l;
  };
  const auto fails = [](const Outcome& o, bool broken) {
    return std::any_of(o.failures.begin(), o.failures.end(), [&](const BondFailure& f) { return f.hinge != broken; });
  };
  const auto yields = [&](const std::vector<PieceLoad>& l) { return fails(load(s, l), false); };
  // Each half of the beam carries one of the two torques to its end.
  const double cracks = (section.shear + section.steel.stirrups) * section.torsion_modulus;
  const double first = std::max(cracks, calc_yield_torque(section));
  EXPECT_NEAR(find_limit(0, 4 * first, loads, yields) / first, 1, 0.02);
  const Outcome o = load(s, loads(1.02 * first), {}, 1);
  ASSERT_FALSE(o.failures.empty());
  EXPECT_EQ(o.failures[0].mode, FailureMode::torsion);
  EXPECT_NEAR(std::abs(o.status[o.failures[0].bond].torque), calc_yield_torque(section), 1);
  // A plain one breaks where the bars' one cracks, at the strength of its concrete alone.
  m.bars = {};
  Structure plain = build_structure({m}, 1);
  clamp_end(plain, 0, -3, -1);
  clamp_end(plain, 23, 3, 1);
  const auto breaks = [&](const std::vector<PieceLoad>& l) { return fails(load(plain, l), true); };
  const double limit = section.shear * section.torsion_modulus;
  EXPECT_NEAR(find_limit(0, 4 * limit, loads, breaks) / limit, 1, 0.02);
}

}  // namespace beam_theory_test
}  // namespace rubble
