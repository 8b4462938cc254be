// Forces in the bonds of pieces that hold together: each piece is rigid, each bond a spring in all six
// directions (rigid bodies and springs, Kawai 1978), solved directly.
//
// Displacements are small. A group that nothing anchors must carry loads that balance each other, inertia
// included; it is then held by a spring that carries nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "kernel/structure/block_cholesky.h"
#include "kernel/structure/structure.h"

namespace rubble {

// What became of a bond. A hinge carries its yield moment about its axis, whatever it turns by.
struct BondStatus {
  bool broken = false;  // it carries nothing any more
  bool hinge_s = false, hinge_t = false;  // bars yield in bending about that axis
  bool hinge_n = false;                   // bars and stirrups yield in torsion
  double moment_s = 0, moment_t = 0, torque = 0;  // of a hinge, with its sign; unit: N m
  Vec3 sunk;  // how far the foundation under it went; only of bonds to it; unit: m
};

struct PieceLoad {
  Vec3 force;   // unit: N
  Vec3 moment;  // about the piece's centre of mass; unit: N m
};

// Pieces joined by bonds that hold: one rigid body.
struct BondGroup {
  std::vector<std::int32_t> pieces;  // ascending
  std::vector<std::int32_t> bonds;   // ascending; those to the foundation too
  bool anchored = false;             // by a bond to the foundation
};

// By their lowest piece. Pieces for which `gone` is not 0 belong to none; an empty list: none is gone.
std::vector<BondGroup> find_groups(const Structure& structure, const std::vector<BondStatus>& status,
                                   const std::vector<std::uint8_t>& gone = {});

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

// Keeps the factor of a group: new loads alone cost little.
class GroupStress {
 public:
  GroupStress(const Structure& structure, BondGroup group, const StressOptions& options = {});
  ~GroupStress();
  GroupStress(GroupStress&&) noexcept;
  GroupStress& operator=(GroupStress&&) noexcept;

  const BondGroup& group() const;
  // loads: by piece of the structure. status: by bond of the structure; what broke or yielded since the
  // last call is solved on the old factor as long as that is quick.
  StressResult solve(const std::vector<BondStatus>& status, const std::vector<PieceLoad>& loads);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// The weight of every piece.
std::vector<PieceLoad> calc_weights(const Structure& structure, double gravity);

}  // namespace rubble
