#include "kernel/structure/bond_group.h"

#include <algorithm>
#include <numeric>

namespace rubble {

JoinedSets::JoinedSets(std::size_t count) : parent_(count) {
  std::iota(parent_.begin(), parent_.end(), 0);
}

std::int32_t JoinedSets::find(std::int32_t member) {
  while (parent_[member] != member) member = parent_[member] = parent_[parent_[member]];
  return member;
}

void JoinedSets::join(std::int32_t a, std::int32_t b) {
  a = find(a), b = find(b);
  parent_[std::max(a, b)] = std::min(a, b);
}

std::vector<BondGroup> find_parts(const Structure& structure, const std::vector<BondStatus>& status, const BondGroup& group) {
  JoinedSets sets(structure.pieces.size());
  for (const std::int32_t i : group.bonds) {
    const Bond& bond = structure.bonds[i];
    if (!status[i].broken && bond.piece_b != kFoundation) sets.join(bond.piece_a, bond.piece_b);
  }
  std::vector<std::int32_t> number(structure.pieces.size(), -1);
  std::vector<BondGroup> parts;
  for (const std::int32_t piece : group.pieces) {
    std::int32_t& part = number[sets.find(piece)];
    if (part < 0) {
      part = std::int32_t(parts.size());
      parts.emplace_back();
    }
    parts[part].pieces.push_back(piece);
  }
  for (const std::int32_t i : group.bonds) {
    if (status[i].broken) continue;
    BondGroup& part = parts[number[sets.find(structure.bonds[i].piece_a)]];
    part.bonds.push_back(i);
    part.anchored = part.anchored || structure.bonds[i].piece_b == kFoundation;
  }
  return parts;
}

std::vector<BondGroup> find_groups(const Structure& structure, const std::vector<BondStatus>& status) {
  BondGroup all;
  all.pieces.resize(structure.pieces.size());
  all.bonds.resize(structure.bonds.size());
  std::iota(all.pieces.begin(), all.pieces.end(), 0);
  std::iota(all.bonds.begin(), all.bonds.end(), 0);
  return find_parts(structure, status, all);
}

}  // namespace rubble
