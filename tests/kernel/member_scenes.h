// Masts and beams, cut and bonded, and the loads at which they fail.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "kernel/structure/failure.h"
#include "kernel/structure/structure.h"

namespace rubble {

inline StructuralMaterial brittle() {
  StructuralMaterial m = find_structural_material("concrete", "test");
  m.shear = 1e9;  // bending alone decides
  return m;
}

inline Member make_mast(double height, double width, int count, double roughness = 0) {
  Member m;
  m.name = "mast";
  m.kind = MemberKind::column;
  m.size = {width, width, height};
  m.centre = {0, 0, height / 2};
  m.material = brittle();
  m.cut.counts[2] = count;
  m.cut.roughness = roughness;
  return m;
}

inline Member make_beam(double length, double width, double depth, int count) {
  Member m;
  m.name = "beam";
  m.kind = MemberKind::beam;
  m.size = {length, width, depth};
  m.centre = {0, 0, 3};
  m.material = brittle();
  m.cut.counts[0] = count;
  m.cut.roughness = 0;
  return m;
}

inline Reinforcement bars(double ratio) {
  Reinforcement r;
  r.ratio = ratio;
  r.side_ratio = ratio / 2;
  r.cover = 0.05;
  return r;
}

// Holds the beam's end by what does not move.
inline void clamp_end(Structure& s, std::int32_t piece, double x, double outwards) {
  const Member& m = s.members[0];
  Bond bond;
  bond.piece_a = piece;
  bond.piece_b = kFoundation;
  const HalfSpace plane{{outwards, 0, 0}, x * outwards};
  const double y = m.size.y / 2, z0 = m.centre.z - m.size.z / 2, z1 = m.centre.z + m.size.z / 2;
  const Polygon polygon = cut_plane(plane, {{{0, 1, 0}, y}, {{0, -1, 0}, y}, {{0, 0, 1}, z1}, {{0, 0, -1}, -z0}}, 50);
  SectionSteel steel;
  if (m.bars.ratio > 0) steel = s.bonds[0].section.steel;
  bond.section = make_section(polygon, plane.normal, m.material, steel);
  const double length = std::abs(x - s.pieces[piece].centre.x), e = m.material.youngs_modulus;
  bond.axial_stiffness = e * bond.section.area / length;
  bond.shear_stiffness = bond.axial_stiffness / 2.4;
  bond.torsion_stiffness = e / 2.4 * bond.section.torsion_constant / length;
  bond.bending_s_stiffness = e * bond.section.inertia_s / length;
  bond.bending_t_stiffness = e * bond.section.inertia_t / length;
  s.bonds.push_back(bond);
}

struct Outcome {
  std::vector<BondFailure> failures;
  std::vector<BondStatus> status;
};

inline Outcome load(const Structure& s, const std::vector<PieceLoad>& loads, const StressOptions& options = {},
             int rounds = 1000) {
  Outcome outcome;
  outcome.status.resize(s.bonds.size());
  GroupStress stress(s, find_groups(s, outcome.status)[0], options);
  FailureOptions failure;
  failure.rounds = rounds;
  outcome.failures = let_fail(s, stress, loads, failure, outcome.status);
  return outcome;
}

// The load factor at which something breaks for good; loads(factor).
template <typename Loads, typename Broken>
double find_limit(double low, double high, Loads&& loads, Broken&& broken) {
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (broken(loads(middle)) ? high : low) = middle;
  }
  return (low + high) / 2;
}

}  // namespace rubble
