#include "kernel/structure/bond_stiffness.h"

namespace rubble {
namespace {

constexpr double kHinge = 1e-4;  // a hinge's share of the elastic stiffness: keeps the factor regular; unit: 1

// Displacement and rotation of a piece to those at the section, in the section's axes.
Block6 at_section(const Section& s, const Vec3& arm) {
  Block6 b{};
  const Vec3 axes[3] = {s.normal, s.axis_s, s.axis_t};
  for (int i = 0; i < 3; ++i) {
    const Vec3 turned = cross(arm, axes[i]);  // axis . (rotation x arm)
    for (int k = 0; k < 3; ++k) {
      b[6 * i + k] = axes[i][k];
      b[6 * i + 3 + k] = turned[k];
      b[6 * (i + 3) + 3 + k] = axes[i][k];
    }
  }
  return b;
}

}  // namespace

BondLink make_link(const Structure& structure, const Bond& bond) {
  BondLink link;
  link.arm_a = bond.section.centroid - structure.pieces[bond.piece_a].centre;
  link.at_a = at_section(bond.section, link.arm_a);
  if (bond.piece_b == kFoundation) return link;
  link.arm_b = bond.section.centroid - structure.pieces[bond.piece_b].centre;
  link.at_b = at_section(bond.section, link.arm_b);
  return link;
}

Six calc_stiffness(const Bond& bond, const BondStatus& status) {
  if (status.broken) return {};
  return {bond.axial_stiffness,   bond.shear_stiffness,
          bond.shear_stiffness,   bond.torsion_stiffness * (status.hinge_n ? kHinge : 1.0),
          bond.bending_s_stiffness * (status.hinge_s ? kHinge : 1.0),
          bond.bending_t_stiffness * (status.hinge_t ? kHinge : 1.0)};
}

Six calc_offset(const Bond& bond, const BondStatus& status) {
  Six offset{};
  if (status.broken) return offset;
  const Section& s = bond.section;
  offset[0] = bond.axial_stiffness * dot(s.normal, status.sunk);
  offset[1] = bond.shear_stiffness * dot(s.axis_s, status.sunk);
  offset[2] = bond.shear_stiffness * dot(s.axis_t, status.sunk);
  if (status.hinge_n) offset[3] = status.torque;
  if (status.hinge_s) offset[4] = status.moment_s;
  if (status.hinge_t) offset[5] = status.moment_t;
  return offset;
}

Six multiply(const Block6& m, const Six& v) {
  Six result{};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) result[i] += m[6 * i + k] * v[k];
  }
  return result;
}

void add_transposed_product(Six& target, const Block6& m, const Six& v, double sign) {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) target[k] += sign * m[6 * i + k] * v[i];
  }
}

Block6 weighted_product(const Block6& a, const Six& d, const Block6& b) {
  Block6 result{};
  for (int r = 0; r < 6; ++r) {
    for (int i = 0; i < 6; ++i) {
      const double scaled = a[6 * r + i] * d[r];
      for (int j = 0; j < 6; ++j) result[6 * i + j] += scaled * b[6 * r + j];
    }
  }
  return result;
}

void add(Block6& target, const Block6& m, double sign) {
  for (std::size_t i = 0; i < target.size(); ++i) target[i] += sign * m[i];
}

void add_turned_force(Block6& diagonal, const Vec3& arm, const Vec3& force) {
  const double along = dot(arm, force);
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const double turned = (arm[i] * force[k] + force[i] * arm[k]) / 2 - (i == k ? along : 0.0);
      diagonal[6 * (i + 3) + k + 3] -= turned;
    }
  }
}

}  // namespace rubble
