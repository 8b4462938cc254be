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

std::vector<BondGroup> find_groups(const Structure& structure, const std::vector<BondStatus>& status,
                                   const std::vector<std::uint8_t>& gone) {
  const std::size_t count = structure.pieces.size();
  const auto is_gone = [&gone](std::int32_t piece) { return !gone.empty() && gone[piece] != 0; };
  const auto holds = [&](std::size_t i) {
    const Bond& bond = structure.bonds[i];
    return !status[i].broken && !is_gone(bond.piece_a) &&
           (bond.piece_b == kFoundation || !is_gone(bond.piece_b));
  };
  JoinedSets sets(count);
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    const Bond& bond = structure.bonds[i];
    if (holds(i) && bond.piece_b != kFoundation) sets.join(bond.piece_a, bond.piece_b);
  }
  std::vector<std::int32_t> number(count, -1);
  std::vector<BondGroup> groups;
  for (std::int32_t i = 0; i < std::int32_t(count); ++i) {
    if (is_gone(i)) continue;
    std::int32_t& group = number[sets.find(i)];
    if (group < 0) {
      group = std::int32_t(groups.size());
      groups.emplace_back();
    }
    groups[group].pieces.push_back(i);
  }
  for (std::size_t i = 0; i < structure.bonds.size(); ++i) {
    if (!holds(i)) continue;
    BondGroup& group = groups[number[sets.find(structure.bonds[i].piece_a)]];
    group.bonds.push_back(std::int32_t(i));
    group.anchored = group.anchored || structure.bonds[i].piece_b == kFoundation;
  }
  return groups;
}

}  // namespace rubble
