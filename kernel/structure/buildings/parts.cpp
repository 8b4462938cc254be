#include "kernel/structure/buildings/parts.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

constexpr double kSliver = 0.02;      // thinner members are left out; unit: m
constexpr double kTouch = 1e-4;       // boxes that overlap less only touch; unit: m
constexpr double kLaidApart = 0.01;   // of boards from walls; unit: m

bool is_sliver(const Aabb& box) {
  for (int axis = 0; axis < 3; ++axis) {
    if (box.max[axis] - box.min[axis] < kSliver) return true;
  }
  return false;
}

struct Axes {
  int order[3];
};

// Walls split along their length, then by height; all else along its longest edge first. A pocket in a wall
// is cut out of its layer.
Axes split_order(const Member& member, bool pocket) {
  int order[3] = {0, 1, 2};
  const Vec3& size = member.size;
  std::sort(order, order + 3, [&](int a, int b) {
    const auto key = [&](int axis) {
      if (member.kind == MemberKind::wall && axis == 2) return pocket ? 1e9 : std::min(size.x, size.y) + 1e-6;
      return size[axis];
    };
    return key(a) != key(b) ? key(a) > key(b) : a < b;
  });
  return {{order[0], order[1], order[2]}};
}

// By the shallow side first: what a wall shaves off the edge of a floor leaves the floor in one.
Axes shallow_order(const Aabb& from, const Aabb& taken) {
  int order[3] = {0, 1, 2};
  const auto depth = [&](int axis) { return std::min(from.max[axis], taken.max[axis]) - std::max(from.min[axis], taken.min[axis]); };
  std::sort(order, order + 3, [&](int a, int b) { return depth(a) != depth(b) ? depth(a) < depth(b) : a < b; });
  return {{order[0], order[1], order[2]}};
}

struct Placed {
  Aabb box;
  double above = 0;  // as of its part
};

// walls: as they were drawn. Boards end before them, also where joists have cut them.
std::vector<Aabb> subtract_all(const BuildingPart& part, const std::vector<Placed>& placed,
                               const std::vector<Aabb>& walls) {
  std::vector<Aabb> left = {box_of(part.member)};
  const auto take = [&](const Aabb& box, const auto& order_of) {
    std::vector<Aabb> next;
    for (const Aabb& from : left) {
      for (const Aabb& rest : subtract(from, box, order_of(from).order)) next.push_back(rest);
    }
    left = next;
  };
  const auto split = [&](bool pocket) { return [&part, pocket](const Aabb&) { return split_order(part.member, pocket); }; };
  for (const Aabb& hole : part.holes) take(hole, split(false));
  const bool laid = part.member.joint == MemberJoint::laid;
  for (const Placed& other : placed) {
    Aabb box = other.box;
    if (!laid) box.max.z += other.above;
    take(box, split(other.above > 0));
  }
  for (const Aabb& wall : laid ? walls : std::vector<Aabb>{}) {
    const Aabb apart{wall.min - Vec3{kLaidApart, kLaidApart, 0}, wall.max + Vec3{kLaidApart, kLaidApart, 0}};
    take(apart, [&](const Aabb& from) { return shallow_order(from, apart); });
  }
  return left;
}

void cut_into_pieces(Member& member, const BuildingSpec& b) {
  member.cut.roughness = b.roughness;
  for (int axis = 0; axis < 3; ++axis) {
    member.cut.counts[axis] = std::clamp(int(std::lround(member.size[axis] / b.piece)), 1, 40);
  }
  if (member.kind == MemberKind::column) {
    member.cut.counts[0] = member.cut.counts[1] = 1;
    member.cut.slope = kColumnSlope;
  }
}

}  // namespace

bool overlap(const Aabb& a, const Aabb& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]) < kTouch) return false;
  }
  return true;
}

Aabb box_of(const Member& member) { return {member.centre - member.size * 0.5, member.centre + member.size * 0.5}; }

void set_box(Member& member, const Aabb& box) {
  member.centre = (box.min + box.max) * 0.5;
  member.size = box.max - box.min;
}

const StructuralMaterial& material_of(Infill infill) {
  return find_structural_material(infill == Infill::block ? "block_masonry" : "brick_masonry", "building.infill");
}

Reinforcement make_bars(double ratio, double stirrups, double cover) {
  Reinforcement r;
  r.ratio = ratio;
  r.side_ratio = ratio * 0.4;  // the rest stands at half height
  r.cover = cover;
  r.stirrups = stirrups;
  return r;
}

std::string place_name(const std::string& what, int storey, int i, int j) {
  return what + " (" + std::to_string(i) + ", " + std::to_string(j) + ") of storey " + std::to_string(storey);
}

std::vector<Aabb> subtract(const Aabb& from, const Aabb& taken, const int (&axes)[3]) {
  if (!overlap(from, taken)) return {from};
  std::vector<Aabb> left;
  Aabb rest = from;
  for (const int axis : axes) {
    if (taken.min[axis] - rest.min[axis] > kTouch) {
      Aabb low = rest;
      low.max[axis] = rest.min[axis] = taken.min[axis];
      left.push_back(low);
    }
    if (rest.max[axis] - taken.max[axis] > kTouch) {
      Aabb high = rest;
      high.min[axis] = rest.max[axis] = taken.max[axis];
      left.push_back(high);
    }
  }
  return left;
}

std::vector<Member> resolve_parts(std::vector<BuildingPart> parts, const BuildingSpec& building,
                                  RandomStream& random) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const BuildingPart& a, const BuildingPart& b) { return a.rank < b.rank; });
  std::vector<Member> members;
  std::vector<Placed> placed;
  std::vector<Aabb> walls;
  for (const BuildingPart& part : parts) {
    if (part.member.kind == MemberKind::wall) walls.push_back(box_of(part.member));
  }
  for (const BuildingPart& part : parts) {
    for (const Aabb& box : subtract_all(part, placed, walls)) {
      if (is_sliver(box)) continue;
      Member member = part.member;
      set_box(member, box);
      member.variant = int(random.below(kVariants));
      if (!part.whole) cut_into_pieces(member, building);
      members.push_back(member);
      placed.push_back({box, part.above});
    }
  }
  return members;
}

namespace {

// Boards with the ceiling and the filling between the joists: 0.8 kN/m2, EN 1991-1-1, annex A. unit: kg/m2
constexpr double kFloorWeight = 80;
constexpr double kLintelBars = 0.012;      // share of the section; unit: 1

}  // namespace

BuildingPart make_lintel(const std::string& name, int storey, const Aabb& box) {
  BuildingPart part;
  part.member.name = name;
  part.member.kind = MemberKind::beam;
  part.member.material = find_structural_material("concrete", "building.material");
  part.member.bars = make_bars(kLintelBars, kDowels, 0.04);
  part.member.joint = MemberJoint::bedded;
  part.member.place.storey = storey;
  part.rank = kLintelRank;
  set_box(part.member, box);
  return part;
}

void add_timber_floor(const BuildingSpec& b, const Aabb& room, double bearing, const std::string& name,
                      int storey, const std::string& plan_part, std::vector<BuildingPart>& parts) {
  const Vec3 size = room.max - room.min;
  const int along = size.x <= size.y ? 0 : 1, across = 1 - along;
  const int count = std::max(2, int(std::ceil(size[across] / b.joist_spacing)));
  const double top = room.max.z - kBoards;
  BuildingPart joist;
  joist.member.kind = MemberKind::beam;
  joist.member.material = find_structural_material("timber", "building.material");
  joist.member.joint = MemberJoint::seated;
  joist.member.span_axis = along;
  joist.member.place.storey = storey;
  joist.member.place.part = plan_part;
  joist.rank = kJoistRank;
  joist.above = kBoards;
  for (int m = 0; m < count; ++m) {
    const double middle = room.min[across] + (m + 0.5) * size[across] / count;
    Aabb box;
    box.min[along] = room.min[along] - bearing, box.max[along] = room.max[along] + bearing;
    box.min[across] = middle - b.joist_width / 2, box.max[across] = middle + b.joist_width / 2;
    box.min.z = top - b.joist_depth, box.max.z = top;
    joist.member.name = "joist " + std::to_string(m) + " of " + name;
    set_box(joist.member, box);
    parts.push_back(joist);
  }
  BuildingPart boards;
  boards.member.name = "boards of " + name;
  boards.member.kind = MemberKind::slab;
  boards.member.material = joist.member.material;
  boards.member.material.density = kFloorWeight / kBoards;
  boards.member.joint = MemberJoint::laid;
  boards.member.place = joist.member.place;
  boards.rank = kDeckRank;
  set_box(boards.member, {{room.min.x, room.min.y, top}, room.max});
  parts.push_back(boards);
}

}  // namespace rubble
