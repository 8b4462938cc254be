// Forces in the bonds of pieces that hold together: each piece is rigid, each bond a spring in all six
// directions (rigid bodies and springs, Kawai 1978), solved directly.
//
// Displacements are small. A group that nothing anchors must carry loads that balance each other, inertia
// included; it is then held by a spring that carries nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/structure/bond_group.h"

namespace rubble {

struct PieceLoad {
  Vec3 force;   // unit: N
  Vec3 moment;  // about the piece's centre of mass; unit: N m
};

struct StressOptions {
  // Adds what axial forces do by the displacements (P-delta): slender columns buckle. Costs a second
  // factorization.
  bool second_order = false;
};

// What the bonds of a group carry, in the order of its bonds.
struct StressResult {
  bool stable = true;  // false: the structure buckles, or is held by nothing
  std::vector<SectionForces> forces;  // one a bond; unit: N, N m
  std::vector<double> rotation_s, rotation_t, rotation_n;  // of a bond's two sides against each other; unit: rad
};

// Keeps the factor of a group: new loads cost little, and so do a few bonds that break or yield and a few
// pieces that come off.
class GroupStress {
 public:
  GroupStress(const Structure& structure, BondGroup group, const StressOptions& options = {});
  // What is left of a group when pieces came off it: takes over its factor if it still has most of its
  // pieces, and what it was made from cannot be asked any more.
  GroupStress(GroupStress&& whole, BondGroup left);
  ~GroupStress();
  GroupStress(GroupStress&&) noexcept;
  GroupStress& operator=(GroupStress&&) noexcept;

  const BondGroup& group() const;
  int factors_made() const;  // so far, for this group and for those that it is left of
  // loads: by piece of the structure. status: by bond of the structure.
  StressResult solve(const std::vector<BondStatus>& status, const std::vector<PieceLoad>& loads);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The weight of every piece.
std::vector<PieceLoad> calc_weights(const Structure& structure, double gravity);

}  // namespace rubble
