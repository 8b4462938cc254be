// Pieces that hold together by their bonds.
#pragma once

#include <cstdint>
#include <vector>

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

// Pieces joined by bonds that hold: one rigid body.
struct BondGroup {
  std::vector<std::int32_t> pieces;  // ascending
  std::vector<std::int32_t> bonds;   // ascending; those to the foundation too
  bool anchored = false;             // by a bond to the foundation
};

// All groups of a structure, by their lowest piece.
std::vector<BondGroup> find_groups(const Structure& structure, const std::vector<BondStatus>& status);
// What a group has come apart into since some of its bonds have broken; likewise.
std::vector<BondGroup> find_parts(const Structure& structure, const std::vector<BondStatus>& status, const BondGroup& group);

// Sets that grow together, known by their lowest member.
class JoinedSets {
 public:
  explicit JoinedSets(std::size_t count);
  std::int32_t find(std::int32_t member);
  void join(std::int32_t a, std::int32_t b);

 private:
  std::vector<std::int32_t> parent_;
};

}  // namespace rubble
