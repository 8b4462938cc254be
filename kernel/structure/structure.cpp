#include "kernel/structure/structure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <tuple>

#include "kernel/base/error.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

constexpr double kSamePlane = 1e-6;    // faces of two members meet when nearer; unit: m
constexpr double kLeastJoint = 1e-4;   // smaller common faces join nothing; unit: m2

// A dry bearing turns freely: its share of the elastic stiffness keeps the factor regular. unit: 1
constexpr double kPinned = 1e-4;
// Bedding gives way against what it lies between: mortar, elastomer (G = 0.9 MPa), timber across its grain
// (370 MPa, EN 338). unit: 1
constexpr double kBedding = 1e-2;
// Nails slip by 1 mm under 1 kN (EN 1995-1-1, table 7.1), two at each crossing; grout between floor units is
// cracked, and they lie on soft strips. unit: 1
constexpr double kSlip = 1e-3;

// A joint that is weaker than what it joins. EN 1992-1-1, 6.2.5: a very smooth interface has a tenth of the
// tensile strength as cohesion, and friction of 0.5; 10.9.3 (12): grouted joints of floor units 0.15 MPa.
// Mortar of a bed: EN 1996-1-1, 3.6.4. Two nails of 1 kN at a crossing of boards: EN 1995-1-1, 8.3.
struct Joint {
  double tension, shear, friction;  // unit: Pa; the last 1
};
constexpr Joint kSeat{0.05e6, 0.26e6, 0.5};
constexpr Joint kGrout{0.05e6, 0.15e6, 0.5};
constexpr Joint kNails{0.1e6, 0.1e6, 0.3};
// Compressive strength of timber across its grain, EN 338. unit: Pa
constexpr double kTimberAcross = 2.5e6;

// Across vertical planes units interlock: bending strength 0.4 against 0.1 MPa of bed joints (EN 1996-1-1,
// 3.6.4), shear strength up to 0.065 fb = 1 MPa against 0.2 MPa (3.6.2). unit: 1
constexpr double kAcrossBeds = 4;
// Walls lie on lintels and floors in a bed of mortar that evens out their deflection, and floors and lintels that
// rest on masonry crack its uppermost joint instead of turning the wall. A deck slips a little on its girders.
// unit: 1
constexpr double kBed = 0.05;

enum class JoinedBy : std::uint8_t { nothing, casting, bed, rest, seat, grout, nails };

bool is_bearing_masonry(const Member& member) {
  const std::string& name = member.material.name;
  return member.place.bearing && (name == "brick_masonry" || name == "block_masonry");
}

bool is_cast(const Member& member) {
  return member.joint == MemberJoint::cast || member.joint == MemberJoint::bedded;
}

bool is_timber(const Member& member) { return member.material.name == "timber"; }

// normal: from a to b.
JoinedBy find_joint(const Member& a, const Member& b, const Vec3& normal) {
  const Member &upper = normal.z > 0 ? b : a, &lower = normal.z > 0 ? a : b;
  if (is_cast(a) && is_cast(b)) {
    if (std::abs(normal.z) < 0.5) return a.joint == b.joint ? JoinedBy::casting : JoinedBy::bed;
    if (lower.joint == MemberJoint::bedded || (is_bearing_masonry(upper) && lower.kind == MemberKind::slab)) {
      return JoinedBy::bed;
    }
    const bool rests = upper.kind == MemberKind::slab || upper.kind == MemberKind::beam;
    return rests && is_bearing_masonry(lower) ? JoinedBy::rest : JoinedBy::casting;
  }
  if (std::abs(normal.z) < 0.5) {
    if (a.joint != b.joint || a.kind != b.kind) return JoinedBy::nothing;
    if (a.joint == MemberJoint::laid) return JoinedBy::casting;
    const bool side_by_side = a.kind == MemberKind::slab && std::abs(normal[a.span_axis]) < 0.5;
    return side_by_side ? JoinedBy::grout : JoinedBy::nothing;
  }
  if (upper.joint == MemberJoint::seated) return JoinedBy::seat;
  if (upper.joint == MemberJoint::laid) return JoinedBy::nails;
  if (lower.joint == MemberJoint::laid) return JoinedBy::seat;
  return is_timber(lower) ? JoinedBy::nothing : JoinedBy::bed;
}

// What makes two members' pieces equal.
using CutKey = std::tuple<int, double, double, double, int, int, int, double, double, std::string, double, double, int>;

CutKey key_of(const Member& m) {
  return {int(m.kind),     m.size.x,          m.size.y,      m.size.z,          m.cut.counts[0],
          m.cut.counts[1], m.cut.counts[2],   m.cut.roughness, m.cut.gap, m.material.name,
          m.material.density, m.bars.ratio,     m.variant};
}

// The fragments of one kind of member, and the types that they became.
struct CutMember {
  std::vector<Fragment> fragments;
  std::vector<VolumeProperties> volumes;  // of the types
  std::vector<Vec3> origins;              // of the types' frames, from the member's centre
  int first_type = 0;
};

// A side of a placed piece that no fragment of its own member shares.
struct OuterFace {
  std::int32_t piece = 0;
  HalfSpace plane;
  Polygon polygon;  // in the world
  Aabb box;
};

// By axis and sign of the normal and the plane's offset, rounded; then faces are compared pair by pair.
struct PlaneKey {
  int axis = 0;
  std::int64_t offset = 0;  // unit: kSamePlane
  bool operator<(const PlaneKey& k) const {
    return std::tie(axis, offset) < std::tie(k.axis, k.offset);
  }
};

int axis_of(const Vec3& normal) {
  return std::abs(normal.x) > 0.5 ? 0 : std::abs(normal.y) > 0.5 ? 1 : 2;
}

SectionSteel bars_across(const Reinforcement& bars, double area) {
  SectionSteel steel;
  steel.area = bars.ratio * area;
  steel.area_s = steel.area_t = bars.side_ratio * area;
  steel.cover = bars.cover;
  steel.stirrups = bars.stirrups;
  steel.yield = bars.steel.yield;
  steel.rupture_rotation = bars.steel.rupture_rotation;
  return steel;
}

double extent_along(const Member& member, const Vec3& normal) {
  return std::abs(normal.x) * member.size.x + std::abs(normal.y) * member.size.y +
         std::abs(normal.z) * member.size.z;
}

// Cuts are tilted to look torn, but a member fails across: what it is not cut along does not count.
Vec3 straighten(const Member& member, Vec3 normal) {
  for (int axis = 0; axis < 3; ++axis) {
    if (member.cut.counts[axis] == 1) normal[axis] = 0;
  }
  return normalized(normal);
}

Polygon project(const Polygon& polygon, const Vec3& normal) {
  Vec3 middle;
  for (const Vec3& p : polygon) middle += p * (1 / double(polygon.size()));
  Polygon flat;
  for (const Vec3& p : polygon) flat.push_back(p - normal * dot(p - middle, normal));
  return flat;
}

class Builder {
 public:
  Builder(const std::vector<Member>& members, std::uint64_t seed) : seed_(seed) {
    structure_.members = members;
  }

  Structure build(bool foundation) {
    for (std::size_t i = 0; i < structure_.members.size(); ++i) place(std::int32_t(i));
    join_members();
    if (foundation) join_foundation();
    std::stable_sort(structure_.bonds.begin(), structure_.bonds.end(), [](const Bond& a, const Bond& b) {
      return std::tie(a.piece_a, a.piece_b) < std::tie(b.piece_a, b.piece_b);
    });
    return std::move(structure_);
  }

 private:
  const CutMember& cut(const Member& member) {
    const auto [at, is_new] = cuts_.insert({key_of(member), {}});
    CutMember& made = at->second;
    if (!is_new) return made;
    RandomStream random(seed_, "cut " + std::to_string(cuts_.size()));
    made.fragments = cut_box(member.size, member.cut, random);
    made.first_type = int(structure_.types.size());
    for (const Fragment& fragment : made.fragments) {
      PieceType type;
      type.name = std::string(member_name(member.kind)) + "_" + std::to_string(structure_.types.size());
      // About its centre of mass: where a piece is must not depend on the member that it broke from.
      const Vec3 origin = calc_volume_properties({fragment.corners}).centre_of_mass;
      ConvexPart part;
      for (const Vec3& corner : fragment.corners) part.points.push_back(corner - origin);
      type.parts = {part};
      made.origins.push_back(origin);
      type.density = member.material.density;
      type.friction = member.material.friction;
      made.volumes.push_back(calc_volume_properties(type.parts[0]));
      structure_.types.push_back(type);
      structure_.type_materials.push_back(member.material.name);
      structure_.type_bars.push_back(member.bars);
    }
    return made;
  }

  void place(std::int32_t index) {
    const Member member = structure_.members[index];
    if (!(member.size.x > 0 && member.size.y > 0 && member.size.z > 0)) {
      throw InputError({"", 0, member.name, "a member has no volume", "edges of more than 0 m",
                        "", ""});
    }
    const CutMember& made = cut(member);
    const auto first = std::int32_t(structure_.pieces.size());
    for (std::size_t i = 0; i < made.fragments.size(); ++i) {
      const VolumeProperties& volume = made.volumes[i];
      StructurePiece piece;
      piece.type = made.first_type + int(i);
      piece.member = index;
      piece.position = member.centre + made.origins[i];
      piece.centre = piece.position + volume.centre_of_mass;
      piece.mass = volume.volume * member.material.density;
      piece.inertia = volume.inertia * member.material.density;
      structure_.pieces.push_back(piece);
    }
    for (std::size_t i = 0; i < made.fragments.size(); ++i) {
      for (const FragmentFace& face : made.fragments[i].faces) {
        const auto piece = first + std::int32_t(i);
        Polygon polygon = face.polygon;
        for (Vec3& p : polygon) p += member.centre;
        if (face.neighbour < 0) {
          note_outer(piece, {face.plane.normal, dot(face.plane.normal, polygon[0])}, polygon);
        } else if (face.neighbour > int(i)) {
          const Vec3 normal = straighten(member, face.plane.normal);
          join(piece, first + face.neighbour, normal, project(polygon, normal));
        }
      }
    }
  }

  void note_outer(std::int32_t piece, const HalfSpace& plane, const Polygon& polygon) {
    OuterFace face{piece, plane, polygon, {}};
    for (const Vec3& p : polygon) face.box.include(p);
    outer_.push_back(face);
  }

  void join(std::int32_t a, std::int32_t b, const Vec3& normal, const Polygon& polygon,
            JoinedBy by = JoinedBy::casting) {
    const AreaProperties area = calc_area_properties(polygon, make_axes(normal));
    if (area.area < kLeastJoint) return;
    Bond bond;
    bond.piece_a = a, bond.piece_b = b;
    if (by == JoinedBy::casting || by == JoinedBy::bed || by == JoinedBy::rest) {
      bond.section = make_section(polygon, normal, weaker(a, b), steel_of(a, b, normal, area.area));
      const bool masonry = is_bearing_masonry(member_of(a)) && (b == kFoundation || is_bearing_masonry(member_of(b)));
      if (masonry && std::abs(normal.z) < 0.5) {
        bond.section.tension *= kAcrossBeds;
        bond.section.shear *= kAcrossBeds;
      }
    } else {
      bond.section = make_section(polygon, normal, weaker(a, b), {});
      weaken(bond, by);
    }
    set_stiffness(bond);
    soften(bond, by);
    structure_.bonds.push_back(bond);
  }

  void weaken(Bond& bond, JoinedBy by) const {
    const Joint& joint = by == JoinedBy::seat ? kSeat : by == JoinedBy::grout ? kGrout : kNails;
    Section& s = bond.section;
    s.tension = std::min(s.tension, joint.tension);
    s.shear = std::min(s.shear, joint.shear);
    s.shear_friction = joint.friction;
    if (is_timber(member_of(bond.piece_a)) || is_timber(member_of(bond.piece_b))) {
      s.compression = std::min(s.compression, kTimberAcross);
    }
  }

  static void scale(Bond& bond, double share) {
    bond.axial_stiffness *= share, bond.shear_stiffness *= share, bond.torsion_stiffness *= share;
    bond.bending_s_stiffness *= share, bond.bending_t_stiffness *= share;
  }

  // A seat turns about the horizontal axis across the span of what rests on it; under floor units about both,
  // since their bedding gives way to the sag of what carries them.
  void soften(Bond& bond, JoinedBy by) const {
    const bool b_is_upper = bond.section.normal.z > 0;
    const Member& upper = member_of(bond.piece_b == kFoundation || !b_is_upper ? bond.piece_a : bond.piece_b);
    const bool turns_about_s = std::abs(bond.section.axis_s[upper.span_axis]) < 0.5;
    const bool freely = by == JoinedBy::grout || upper.kind == MemberKind::slab;
    switch (by) {
      case JoinedBy::nothing:
      case JoinedBy::casting: return;
      case JoinedBy::bed:
        scale(bond, kBed);
        return;
      case JoinedBy::rest:
        scale(bond, kBed);
        bond.bending_s_stiffness *= kPinned, bond.bending_t_stiffness *= kPinned;
        return;
      case JoinedBy::nails:
        scale(bond, kSlip);
        return;
      case JoinedBy::seat:
      case JoinedBy::grout: {
        const double share = freely ? kSlip : kBedding;
        scale(bond, share);
        if (upper.joint != MemberJoint::seated) return;
        if (turns_about_s || freely) bond.bending_s_stiffness *= kPinned;
        if (!turns_about_s || freely) bond.bending_t_stiffness *= kPinned;
      }
    }
  }

  const Member& member_of(std::int32_t piece) const {
    return structure_.members[structure_.pieces[piece].member];
  }

  const StructuralMaterial& weaker(std::int32_t a, std::int32_t b) const {
    const StructuralMaterial& one = member_of(a).material;
    if (b == kFoundation) return one;
    const StructuralMaterial& other = member_of(b).material;
    return one.tension <= other.tension ? one : other;
  }

  // Between two members the bars of the longer one across the joint are anchored in the other, if that
  // has bars as well.
  SectionSteel steel_of(std::int32_t a, std::int32_t b, const Vec3& normal, double area) const {
    const Member& one = member_of(a);
    if (b == kFoundation) return bars_across(one.bars, area);
    const Member& other = member_of(b);
    if (!(one.bars.ratio > 0 && other.bars.ratio > 0)) return {};
    const bool ends = extent_along(one, normal) >= extent_along(other, normal);
    return bars_across(ends ? one.bars : other.bars, area);
  }

  // A spring of the two half lengths between the pieces' centres (Kawai's rigid bodies and springs).
  void set_stiffness(Bond& bond) const {
    const Section& s = bond.section;
    const StructuralMaterial& material = weaker(bond.piece_a, bond.piece_b);
    double share = member_of(bond.piece_a).stiffness;
    if (bond.piece_b != kFoundation) share = std::min(share, member_of(bond.piece_b).stiffness);
    const double e = material.youngs_modulus * share, g = e / (2 * (1 + material.poisson_ratio));
    double length = std::abs(dot(s.centroid - structure_.pieces[bond.piece_a].centre, s.normal));
    if (bond.piece_b != kFoundation) {
      length += std::abs(dot(structure_.pieces[bond.piece_b].centre - s.centroid, s.normal));
    }
    bond.axial_stiffness = e * s.area / length;
    bond.shear_stiffness = g * s.area * 5 / 6 / length;
    bond.torsion_stiffness = g * s.torsion_constant / length;
    bond.bending_s_stiffness = e * s.inertia_s / length;
    bond.bending_t_stiffness = e * s.inertia_t / length;
  }

  void join_members() {
    std::map<PlaneKey, std::vector<int>> planes;  // faces whose normals point along + of the axis
    const auto offset_of = [](const OuterFace& f) {
      return f.polygon[0][axis_of(f.plane.normal)];
    };
    const auto key = [&](const OuterFace& f) {
      return PlaneKey{axis_of(f.plane.normal), std::llround(offset_of(f) / (10 * kSamePlane))};
    };
    for (std::size_t i = 0; i < outer_.size(); ++i) {
      if (outer_[i].plane.normal[axis_of(outer_[i].plane.normal)] > 0) planes[key(outer_[i])].push_back(int(i));
    }
    for (const OuterFace& face : outer_) {
      if (face.plane.normal[axis_of(face.plane.normal)] > 0) continue;
      const PlaneKey at = key(face);
      for (std::int64_t step = -1; step <= 1; ++step) {
        const auto found = planes.find({at.axis, at.offset + step});
        if (found == planes.end()) continue;
        for (const int other : found->second) join_faces(outer_[other], face);
      }
    }
  }

  void join_faces(const OuterFace& a, const OuterFace& b) {
    if (structure_.pieces[a.piece].member == structure_.pieces[b.piece].member) return;
    if (std::abs(dot(a.plane.normal, b.polygon[0]) - a.plane.offset) > kSamePlane) return;
    for (int axis = 0; axis < 3; ++axis) {
      if (a.box.min[axis] > b.box.max[axis] + kSamePlane) return;
      if (b.box.min[axis] > a.box.max[axis] + kSamePlane) return;
    }
    const JoinedBy by = find_joint(member_of(a.piece), member_of(b.piece), a.plane.normal);
    if (by == JoinedBy::nothing) return;
    Polygon common = a.polygon;
    for (std::size_t i = 0; i < b.polygon.size(); ++i) {
      const Vec3 edge = b.polygon[(i + 1) % b.polygon.size()] - b.polygon[i];
      const Vec3 outwards = normalized(cross(edge, b.plane.normal));
      common = clip(common, {outwards, dot(outwards, b.polygon[i])});
    }
    if (common.empty()) return;
    join(a.piece, b.piece, a.plane.normal, common, by);
  }

  void join_foundation() {
    const std::vector<OuterFace> faces = outer_;
    for (const OuterFace& face : faces) {
      const bool below = face.plane.normal.z < -0.5 && std::abs(face.polygon[0].z) < kSamePlane;
      if (below) join(face.piece, kFoundation, face.plane.normal, face.polygon);
    }
  }

  Structure structure_;
  std::uint64_t seed_;
  std::map<CutKey, CutMember> cuts_;
  std::vector<OuterFace> outer_;
};

bool overlap(const Member& a, const Member& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const double between = std::abs(a.centre[axis] - b.centre[axis]);
    if (between > (a.size[axis] + b.size[axis]) / 2 - 1e-4) return false;
  }
  return true;
}

void check_apart(const std::vector<Member>& members) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    for (std::size_t k = i + 1; k < members.size(); ++k) {
      if (!overlap(members[i], members[k])) continue;
      throw InputError({"", 0, members[k].name, "two members are in the same place",
                        "members that share faces at most", members[i].name, ""});
    }
  }
}

}  // namespace

const char* member_name(MemberKind kind) {
  switch (kind) {
    case MemberKind::column: return "column";
    case MemberKind::beam: return "beam";
    case MemberKind::slab: return "slab";
    case MemberKind::wall: return "wall";
  }
  return "member";
}

Structure build_structure(const std::vector<Member>& members, std::uint64_t seed, bool foundation) {
  check_apart(members);
  return Builder(members, seed).build(foundation);
}

std::string describe_bond(const Structure& structure, std::size_t index) {
  const Bond& bond = structure.bonds[index];
  const std::string a = structure.members[structure.pieces[bond.piece_a].member].name;
  const std::string b = bond.piece_b == kFoundation
                            ? "the foundation"
                            : structure.members[structure.pieces[bond.piece_b].member].name;
  const Vec3& p = bond.section.centroid;
  char where[80];
  std::snprintf(where, sizeof where, " at (%.2f, %.2f, %.2f) m", p.x, p.y, p.z);
  return (a == b ? "within " + a : "between " + a + " and " + b) + where;
}

}  // namespace rubble
