#include "kernel/structure/building.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/structure/buildings/parts.h"

namespace rubble {
namespace {

constexpr double kIntoMember = 0.001;  // far less than contact lets pieces overlap, far more than rounding; unit: m

using Triangle = std::array<Vec3, 3>;

// Also where they only touch: triangles may be level.
bool meet(const Aabb& a, const Aabb& b) {
  for (const int axis : {0, 1, 2})
    if (a.min[axis] > b.max[axis] || b.min[axis] > a.max[axis]) return false;
  return true;
}

Aabb bounds_of(const Triangle& triangle) {
  Aabb box;
  for (const Vec3& p : triangle) box.include(p);
  return box;
}

// The part of a convex polygon where sign * (p[axis] - bound) <= 0.
std::vector<Vec3> clip(const std::vector<Vec3>& polygon, int axis, double bound, double sign) {
  std::vector<Vec3> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
    if (da <= 0) left.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) left.push_back(a + (b - a) * (da / (da - db)));
  }
  return left;
}

std::vector<Vec3> clip(const Triangle& triangle, const Aabb& box) {
  std::vector<Vec3> inside(triangle.begin(), triangle.end());
  for (const int axis : {0, 1, 2}) inside = clip(clip(inside, axis, box.min[axis], -1), axis, box.max[axis], 1);
  return inside;
}

// The triangle's height above (x, y), and +1 where it faces up, -1 where it faces down.
struct Crossing {
  double z;
  int facing;
};

std::optional<Crossing> cross_vertical(const Triangle& t, double x, double y) {
  const auto side = [&](const Vec3& a, const Vec3& b) { return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x); };
  const double u = side(t[1], t[2]), v = side(t[2], t[0]), w = side(t[0], t[1]), sum = u + v + w;
  const bool up = u >= 0 && v >= 0 && w > 0, down = u <= 0 && v <= 0 && w < 0;
  if (!up && !down) return {};
  return Crossing{(u * t[0].z + v * t[1].z + w * t[2].z) / sum, up ? 1 : -1};
}

[[noreturn]] void fail(const Vec3& where, const Member& member) {
  char found[160];
  std::snprintf(found, sizeof found, "terrain %.3f m high at (%.2f, %.2f), in or over a %s", where.z, where.x, where.y,
                member_name(member.kind));
  throw InputError({"", 0, "pile.building", "the terrain reaches into the building",
                    "terrain at or below z = 0 under a building, which stands on the ground z = 0", found,
                    "make the terrain flat there, or move it by `pile.terrain.position`"});
}

}  // namespace

void check_site(const Structure& building, const TriangleMesh& terrain, const Vec3& position) {
  std::vector<Aabb> boxes;
  Aabb all;
  for (const Member& m : building.members) {
    boxes.push_back(box_of(m));
    all.include(boxes.back().min), all.include(boxes.back().max);
  }
  std::vector<int> cover(boxes.size(), 0);        // by member: surfaces above its centre, those that face down taken off
  std::vector<Vec3> covered_at(boxes.size());
  double deepest = kIntoMember;                   // above the member's underside
  Vec3 where;
  const Member* member = nullptr;
  for (const auto& t : terrain.triangles) {
    const Triangle triangle = {Vec3(terrain.positions[t[0]]) + position, Vec3(terrain.positions[t[1]]) + position,
                               Vec3(terrain.positions[t[2]]) + position};
    const Aabb bounds = bounds_of(triangle);
    Aabb above = all;
    above.max.z = std::max(above.max.z, bounds.max.z);
    if (!meet(bounds, above)) continue;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Vec3 centre = building.members[i].centre;
      const std::optional<Crossing> crossing = cross_vertical(triangle, centre.x, centre.y);
      if (crossing && crossing->z > centre.z) cover[i] += crossing->facing, covered_at[i] = {centre.x, centre.y, crossing->z};
      if (!meet(bounds, boxes[i])) continue;
      for (const Vec3& p : clip(triangle, boxes[i]))
        if (p.z - boxes[i].min.z > deepest) deepest = p.z - boxes[i].min.z, where = p, member = &building.members[i];
    }
  }
  if (member) fail(where, *member);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (cover[i] > 0) fail(covered_at[i], building.members[i]);
}

}  // namespace rubble
