#include <algorithm>
#include <cmath>

#include "kernel/structure/building.h"
#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

// A footing is at least this high, so that a settlement of millimetres does not need a piece as thin. unit: m
constexpr double kLeastFooting = 0.1;
// What would be left of a member above its footing and is lower than this becomes part of the footing. unit: m
constexpr double kLeastRest = 0.1;
// A footing is so much stronger than what stands on it that only their joint fails. unit: 1
constexpr double kFootingStrength = 1e4;

// The largest depth by which the footing under a member sinks; unit: m.
double depth_under(const BuildingSpec& b, const Member& member) {
  double depth = 0;
  for (const SinkingFooting& f : b.cause.sinking) {
    if (is_ground_column(member, f.i, f.j, f.part)) depth = std::max(depth, f.depth);
  }
  return depth;
}

void set_heights(Member& member, double bottom, double top) {
  const double share = (top - bottom) / member.size.z;
  member.cut.counts[2] = std::max(1, int(std::lround(member.cut.counts[2] * share)));
  member.centre.z = (bottom + top) / 2;
  member.size.z = top - bottom;
}

Member make_footing(Member member, double top) {
  member.name = "footing of " + member.name;
  member.place.footing = true;
  set_heights(member, member.centre.z - member.size.z / 2, top);
  member.cut.counts[2] = 1;
  StructuralMaterial& m = member.material;
  m.compression *= kFootingStrength, m.tension *= kFootingStrength, m.shear *= kFootingStrength;
  member.bars.steel.yield *= kFootingStrength;
  return member;
}

}  // namespace

void add_footings(const BuildingSpec& b, std::vector<Member>& members) {
  std::vector<Member> result;
  for (Member& member : members) {
    const double bottom = member.centre.z - member.size.z / 2, top = bottom + member.size.z;
    const double depth = depth_under(b, member);
    const double cut = std::max(depth, kLeastFooting);
    if (!(depth > 0) || bottom >= cut - kLeastRest / 2) {
      result.push_back(member);
    } else if (top < cut + kLeastRest) {
      result.push_back(make_footing(member, top));
    } else {
      const Member footing = make_footing(member, cut);
      set_heights(member, cut, top);
      result.push_back(member);
      result.push_back(footing);
    }
  }
  members = std::move(result);
}

}  // namespace rubble
