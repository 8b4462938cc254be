#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/structure/building.h"
#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

bool is_column(const MemberPlace& place, int storey, int i, int j, const std::string& part) {
  if (!place.bearing || place.storey != storey) return false;
  return part.empty() ? place.i == i && place.j == j && i >= 0 : place.part == part;
}

// A soft storey is open: walls would carry what its columns do not.
bool is_removed(const BuildingSpec& b, const Member& member) {
  if (member.place.infill && member.place.storey == b.cause.weak_storey) return true;
  return std::any_of(b.cause.removed.begin(), b.cause.removed.end(), [&](const ColumnPlace& c) {
    return is_column(member.place, c.storey, c.i, c.j, c.part);
  });
}

void weaken(Section& s, double share) {
  s.compression *= share, s.tension *= share, s.shear *= share;
  s.steel.yield *= share, s.steel.stirrups *= share;
}

// What lies on thin boards would make them denser than a piece may be.
[[noreturn]] void fail_overload(double overload, double density, const Member& member) {
  char expected[128];
  std::snprintf(expected, sizeof expected, "at most %.0f kg/m2 on a floor %.3g m thick, whose pieces carry it as their own mass",
                std::floor((kMostDensity - density) * member.size.z), member.size.z);
  throw InputError({"", 0, "pile.building.cause.overload", "more than this floor can have", expected,
                    brief_text(overload), ""});
}

// A floor's overload is carried, and falls, with its slabs: they become denser.
void add_overload(const BuildingSpec& b, Structure& s) {
  std::map<std::int32_t, std::int32_t> heavy;
  for (StructurePiece& piece : s.pieces) {
    const Member& member = s.members[piece.member];
    if (member.kind != MemberKind::slab || member.place.storey != b.cause.overloaded_floor) continue;
    const auto [at, is_new] = heavy.insert({piece.type, std::int32_t(s.types.size())});
    if (is_new) {
      PieceType type = s.types[piece.type];
      type.name += "_loaded";
      type.density += b.cause.overload / member.size.z;
      if (type.density > kMostDensity) fail_overload(b.cause.overload, s.types[piece.type].density, member);
      s.types.push_back(type);
      s.type_materials.push_back(s.type_materials[piece.type]);
      s.type_bars.push_back(s.type_bars[piece.type]);
    }
    const double ratio = s.types[at->second].density / s.types[piece.type].density;
    piece.type = at->second;
    piece.mass *= ratio;
    piece.inertia = piece.inertia * ratio;
  }
}

std::vector<Member> make_members(const BuildingSpec& b) {
  if (b.planned()) return make_planned(b);
  switch (b.kind) {
    case BuildingKind::masonry: return make_masonry(b);
    case BuildingKind::precast: return make_precast(b);
    case BuildingKind::bridge: return make_bridge(b);
    case BuildingKind::frame: break;
  }
  return make_frame(b);
}

}  // namespace

bool is_ground_column(const Member& member, int i, int j, const std::string& part) {
  return is_column(member.place, 0, i, j, part);
}

std::vector<Member> list_members(const BuildingSpec& b) {
  std::vector<Member> members = make_members(b);
  add_footings(b, members);
  return members;
}

Structure build_building(const BuildingSpec& building) {
  return build_structure(list_members(building), building.seed);
}

Structure build_damaged(const BuildingSpec& b, const Structure& whole) {
  Structure damaged = whole;
  damaged.pieces.clear(), damaged.bonds.clear();
  std::vector<std::int32_t> number(whole.pieces.size(), -2);
  for (std::size_t i = 0; i < whole.pieces.size(); ++i) {
    if (is_removed(b, whole.members[whole.pieces[i].member])) continue;
    number[i] = std::int32_t(damaged.pieces.size());
    damaged.pieces.push_back(whole.pieces[i]);
  }
  for (const Bond& bond_before : whole.bonds) {
    Bond bond = bond_before;
    const Member& one = whole.members[whole.pieces[bond.piece_a].member];
    const Member& other =
        bond.piece_b == kFoundation ? one : whole.members[whole.pieces[bond.piece_b].member];
    bond.piece_a = number[bond.piece_a];
    bond.piece_b = bond.piece_b == kFoundation ? kFoundation : number[bond.piece_b];
    if (bond.piece_a == -2 || bond.piece_b == -2) continue;
    const auto is_weak = [&](const Member& m) {
      return m.place.bearing && m.place.storey == b.cause.weak_storey;
    };
    if (is_weak(one) || is_weak(other)) weaken(bond.section, b.cause.weakness);
    damaged.bonds.push_back(bond);
    damaged.from_bond.push_back(std::int32_t(&bond_before - whole.bonds.data()));
  }
  if (b.cause.overloaded_floor >= 0 && b.cause.overload > 0) add_overload(b, damaged);
  return damaged;
}

BuildingStructures build_structures(const BuildingSpec& building) {
  validate(building);
  BuildingStructures made{build_building(building), {}};
  made.damaged = build_damaged(building, made.whole);
  return made;
}

}  // namespace rubble
