#include "kernel/structure/buildings/floors.h"

#include <algorithm>
#include <cmath>

namespace rubble {
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
