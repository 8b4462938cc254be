#include "scripting/packs/asset_links.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kWidestBall = 3.1;  // what a ball's limit may be at most; unit: rad

// The shortest turn of one unit vector into another.
Quat turn_between(const Vec3& from, const Vec3& to) {
  const double cosine = dot(from, to);
  if (cosine < -1 + 1e-9) return {0, 0, 1, 0};  // about Y: `from` is X or Z
  const Vec3 axis = cross(from, to);
  return normalized(Quat{1 + cosine, axis.x, axis.y, axis.z});
}

}  // namespace

AssetLink make_asset_link(const LinkTable& table) {
  constexpr double kRadians = portable::kPi / 180;
  const Vec3 rpy = table.rpy_deg * kRadians;
  AssetLink link;
  link.asset = table.asset;
  link.whole_from_link = {portable::quat_from_rpy(rpy.x, rpy.y, rpy.z), table.position};
  link.scale = table.scale;
  JointType& j = link.joint;
  j.kind = table.joint;
  const bool slides = j.kind == JointKind::slider;
  const Vec3 moves = slides ? Vec3{1, 0, 0} : Vec3{0, 0, 1};  // in the joint's frame
  j.assembly_from_joint = {turn_between(moves, normalized(table.joint_axis)),
                           table.joint_position};
  j.stiffness = table.stiffness;
  j.damping = table.damping;
  j.friction = table.friction;
  j.yield = table.yield.value_or(kNever);
  j.break_force = table.break_force.value_or(kNever);
  j.break_torque = table.break_torque.value_or(kNever);
  j.collide = table.collide;
  if (const auto& range = slides ? table.travel : table.limit_deg) {
    const double unit = slides ? 1 : kRadians;
    const bool one = (*range)[0] == (*range)[1];  // a single number
    j.lower = (one ? -std::abs((*range)[0]) : (*range)[0]) * unit;
    j.upper = (one ? std::abs((*range)[1]) : (*range)[1]) * unit;
  }
  if (j.kind == JointKind::ball) {
    j.lower = -kNever;
    if (j.upper < kNever) j.upper = std::min(j.upper, kWidestBall);
  }
  return link;
}

}  // namespace rubble
