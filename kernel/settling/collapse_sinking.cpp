// Footings that go down: what they unload, what they leave hanging, and what goes down with them.
//
// The ground under a footing gives way, it does not pull: where the structure would have to be pulled down, the
// footing hangs from it and carries nothing. A body that stands on such footings alone is fixed to them and follows
// the one that is down least. One that comes off the rest of the structure stands on its footings again.
#include <algorithm>
#include <limits>

#include "kernel/settling/collapse_impl.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

// Of a body that came off late: as fast as a footing of 2 m within its 2 s. unit: m/s
constexpr double kDescent = 1;
// A way left that is no more than rounding: nothing rests while its footings go on and on. unit: m
constexpr double kArrived = 1e-9;

}  // namespace

double Collapse::Impl::lowered(std::int32_t piece) const {
  return structure.pieces[piece].position.z - world.piece(first + piece).world_from_body.translation.z;
}

// Of the bonds of a group that hold.
bool Collapse::Impl::stands_on_sinking_only(const BondGroup& group) const {
  bool stands = false;
  for (const std::int32_t i : group.bonds) {
    if (status[i].broken || structure.bonds[i].piece_b != kFoundation) continue;
    if (!sinking.count(i)) return false;
    stands = true;
  }
  return stands;
}

// Whether footings of the group were pulled, and carry nothing from now on. One anchor stays.
bool Collapse::Impl::lift(const BondGroup& group, const StressResult& result) {
  if (!group.anchored || sinking.empty()) return false;
  int anchors = 0;
  for (const std::int32_t i : group.bonds) anchors += !status[i].broken && structure.bonds[i].piece_b == kFoundation;
  bool lifted = false;
  for (std::size_t k = 0; k < group.bonds.size(); ++k) {
    const std::int32_t i = group.bonds[k];
    if (status[i].broken || !sinking.count(i) || !(result.forces[k].axial > 0) || anchors <= 1) continue;
    status[i].broken = lifted = true;
    --anchors;
  }
  return lifted;
}

// What nothing else holds up stands on the footings that hung from it.
void Collapse::Impl::set_down(std::vector<BondGroup>& groups) {
  for (BondGroup& group : groups) {
    if (group.anchored) continue;
    for (const auto& footing : sinking) {
      const std::int32_t piece = structure.bonds[footing.first].piece_a;
      if (!std::binary_search(group.pieces.begin(), group.pieces.end(), piece)) continue;
      status[footing.first] = {};
      group.bonds.push_back(footing.first);
      group.anchored = true;
    }
    std::sort(group.bonds.begin(), group.bonds.end());
  }
}

// How far a group may go down until a piece that is no footing meets the ground; unit: m.
double Collapse::Impl::height_above_ground(const BondGroup& group) const {
  double height = std::numeric_limits<double>::max();
  for (const std::int32_t i : group.pieces) {
    const StructurePiece& piece = structure.pieces[i];
    if (structure.members[piece.member].place.footing) continue;
    for (const Vec3& p : structure.types[piece.type].parts[0].points) height = std::min(height, piece.position.z + p.z);
  }
  return height;
}

void Collapse::Impl::ride() {
  rides = false;
  for (const auto& [lead, part] : parts) {
    const BondGroup& group = part.stress->group();
    if (!group.anchored || !stands_on_sinking_only(group)) continue;
    double depth = height_above_ground(group);
    for (const std::int32_t i : group.bonds) {
      const auto footing = sinking.find(i);
      if (footing != sinking.end() && !status[i].broken) depth = std::min(depth, footing->second);
    }
    const double down = std::min(depth - lowered(lead), kDescent * options.step);
    if (!(down > kArrived)) continue;
    world.structures().move_fixed(first + lead, {0, 0, -down});
    rides = true;
  }
  for (const auto& [bond, depth] : sinking) {
    const double below = std::min(0.0, lowered(structure.bonds[bond].piece_a) - depth);
    if (status[bond].broken || status[bond].sunk.z == below) continue;
    status[bond].sunk.z = below;
    sinks = true;
  }
}

void Collapse::sink(int member, double depth) {
  for (std::size_t i = 0; i < impl_->structure.bonds.size(); ++i) {
    const Bond& bond = impl_->structure.bonds[i];
    if (bond.piece_b != kFoundation || impl_->structure.pieces[bond.piece_a].member != member) continue;
    impl_->sinking[std::int32_t(i)] = depth;
  }
}

}  // namespace rubble
