// A bond as a spring in six directions between the displacements of the two pieces that it joins.
//
// The six of a section: axial, shear along s, shear along t, torque, moments about s and about t. The six of
// a piece: its displacement and its rotation.
#pragma once

#include "kernel/structure/factor/block_cholesky.h"
#include "kernel/structure/bond_group.h"

namespace rubble {

// What turns motions of the pieces into those at the section.
struct BondLink {
  Block6 at_a{}, at_b{};  // at_b: of a bond to the foundation 0
  Vec3 arm_a, arm_b;      // from the centres of mass to the section's centroid; unit: m
};

BondLink make_link(const Structure& structure, const Bond& bond);

// Stiffness by direction of the section; 0 when it is broken. unit: N/m, N m
Six calc_stiffness(const Bond& bond, const BondStatus& status);
// What the section carries without any motion: the moments of hinges, and what a sunk foundation leaves.
// unit: N, N m
Six calc_offset(const Bond& bond, const BondStatus& status);

Six multiply(const Block6& m, const Six& v);
void add_transposed_product(Six& target, const Block6& m, const Six& v, double sign);
// A^T diag(d) B.
Block6 weighted_product(const Block6& a, const Six& d, const Block6& b);
void add(Block6& target, const Block6& m, double sign = 1);

// What a force that turns with its piece adds to its block: (rotation x arm) x force, its symmetric part.
void add_turned_force(Block6& diagonal, const Vec3& arm, const Vec3& force);

}  // namespace rubble
