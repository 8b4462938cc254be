// Pieces of a structure as bodies of the world: what holds together, what comes apart, what touches
// it.
#include <algorithm>

#include "kernel/base/inertia.h"
#include "kernel/settling/collapse_impl.h"
#include "kernel/structure/failure.h"
#include "kernel/world/world_structures.h"

namespace rubble {
namespace {

// Contacts above this speed are impacts, which bring energy; slower contacts are loads. unit: m/s
constexpr double kImpactSpeed = 0.5;
// Duration of an impact of concrete on concrete: the mean force of a step is smaller than the
// peak. unit: s
constexpr double kImpactTime = 0.004;

}  // namespace

Collapse::Impl::Impl(World& w, const Structure& s, int first_type, const CollapseOptions& o,
                     std::vector<SectionForces> before)
    : world(w), structure(s), options(o), status(s.bonds.size()), settled(std::move(before)) {
  std::vector<NewPiece> pieces;
  for (const StructurePiece& piece : s.pieces) {
    NewPiece p;
    p.placement.kind = first_type + piece.type;
    p.placement.world_from_body.translation = piece.position;
    p.placement.fixed = true;
    p.layer = -1;
    pieces.push_back(p);
  }
  first = world.add(pieces);
  lead_of.assign(pieces.size(), 0);
  world.structures().bind(first, int(pieces.size()));
  report.bonds = int(s.bonds.size());
  // What nothing anchors from the start falls at once.
  replace(0, find_groups(structure, status), true);
}

// whole: stresses of the body that the group is left of; null: none.
void Collapse::Impl::keep(const BondGroup& group, std::unique_ptr<GroupStress> whole) {
  for (const std::int32_t piece : group.pieces) lead_of[piece] = group.pieces[0];
  if (group.pieces.size() < 2 && !(group.anchored && !group.bonds.empty())) return;
  Part part;
  for (const std::int32_t i : group.pieces) {
    part.mass += structure.pieces[i].mass;
    part.centre += structure.pieces[i].centre * structure.pieces[i].mass;
  }
  part.centre *= 1 / part.mass;
  for (const std::int32_t i : group.pieces) {
    const StructurePiece& piece = structure.pieces[i];
    const Vec3 d = piece.centre - part.centre;
    part.inertia = part.inertia + piece.inertia;
    add_offset(part.inertia, piece.mass, d);
  }
  part.stress = whole ? std::make_unique<GroupStress>(std::move(*whole), group)
                      : std::make_unique<GroupStress>(structure, group);
  parts[group.pieces[0]] = std::move(part);
}

// What still holds together of a body some bonds of which have failed.
std::vector<BondGroup> Collapse::Impl::groups_left_of(std::int32_t lead) {
  std::vector<BondGroup> groups = find_parts(structure, status, parts.at(lead).stress->group());
  set_down(groups);
  return groups;
}

void Collapse::Impl::replace(std::int32_t lead, const std::vector<BondGroup>& groups, bool always) {
  if (!always && groups.size() == 1) {
    const BondGroup &before = parts.at(lead).stress->group(), &now = groups[0];
    // A footing that was set down again may have a bond that the group before does not know.
    const bool known = std::includes(before.bonds.begin(), before.bonds.end(), now.bonds.begin(), now.bonds.end());
    if (now.anchored == before.anchored && known) return;
  }
  const auto old = parts.find(lead);
  std::unique_ptr<GroupStress> whole;
  if (old != parts.end()) {
    whole = std::move(old->second.stress);
    parts.erase(old);
  }
  const auto largest = std::max_element(
      groups.begin(), groups.end(),
      [](const BondGroup& a, const BondGroup& b) { return a.pieces.size() < b.pieces.size(); });
  std::vector<SplitPart> split;
  for (const BondGroup& group : groups) {
    // The factor of the whole has lost the bonds of footings that hung.
    keep(group, &group == &*largest && !stands_on_sinking_only(group) ? std::move(whole) : nullptr);
    SplitPart part;
    for (const std::int32_t piece : group.pieces) part.pieces.push_back(first + piece);
    part.fixed = group.anchored;
    split.push_back(std::move(part));
  }
  if (split.size() > 1 || !split[0].fixed) world.structures().split(split);
}

// What touches the pieces of each body, by its lead.
std::map<std::int32_t, Collapse::Impl::Touches> Collapse::Impl::find_touches() const {
  std::map<std::int32_t, Touches> touches;
  const int count = int(structure.pieces.size());
  for (const ContactImpulse& c : world.structures().contact_impulses()) {
    const std::int32_t piece = c.piece - first;
    if (piece < 0 || piece >= count || !parts.count(lead_of[piece])) continue;
    const Pose pose = world.piece(c.piece).world_from_body;
    const Quat back = pose.rotation.conjugate();
    Touch touch;
    touch.point = structure.pieces[piece].position + back.rotate(c.point - pose.translation);
    touch.impact = c.approach > kImpactSpeed;
    touch.force = back.rotate(c.impulse) * (1 / (touch.impact ? kImpactTime : options.step));
    touch.energy = touch.impact ? 0.5 * norm(c.impulse) * c.approach : 0;
    touch.other = c.other;
    touches[lead_of[piece]].push_back({piece, touch});
  }
  return touches;
}

// The bars of what broke hold on.
void Collapse::Impl::tie(const std::vector<BondFailure>& failures) {
  for (const BondFailure& f : failures) {
    if (f.hinge || f.mode == FailureMode::compression) continue;  // crushed: its bars have buckled
    for (TieState t : find_remaining_bars(structure, structure.bonds[f.bond], options.continuity)) {
      t.piece_a += first;
      if (t.piece_b != kFoundation) t.piece_b += first;
      if (f.mode == FailureMode::shear) t.bending = 0;  // what slides is not held sideways
      world.structures().add_tie(t);
      ++report.ties;
    }
  }
}

bool Collapse::Impl::is_free(int piece) const {
  return world.piece(piece).status == PieceStatus::moving;
}

int Collapse::Impl::lead_in_world(int piece) const {
  const int local = piece - first;
  return local >= 0 && local < int(lead_of.size()) ? first + lead_of[local] : piece;
}

// Adds to the speed of the whole body of a piece.
void Collapse::Impl::set_motion(int piece, const Vec3& gained, const Vec3& angular) {
  world.set_velocity(piece, world.structures().centre_velocity(piece) + gained, angular);
}

}  // namespace rubble
