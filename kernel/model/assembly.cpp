#include "kernel/model/assembly.h"

#include <cmath>

#include "kernel/model/pile.h"
#include "kernel/model/range_check.h"

namespace rubble {
namespace {

void check_joint(const JointType& j, const std::string& at, RangeCheck& check) {
  check.expect(j.stiffness >= 0 && j.stiffness <= 1e9, at + ".stiffness", "0 to 1e9", j.stiffness);
  check.expect(j.damping >= 0 && j.damping <= 1e9, at + ".damping", "0 to 1e9", j.damping);
  check.expect(j.friction >= 0 && j.friction <= 1e9, at + ".friction", "0 to 1e9", j.friction);
  check.expect(j.yield > 0, at + ".yield", "more than 0", j.yield);
  check.expect(j.break_force > 0, at + ".break_force", "more than 0", j.break_force);
  check.expect(j.break_torque > 0, at + ".break_torque", "more than 0", j.break_torque);
  check.expect(j.lower <= 0, at + ".lower", "0 or less", j.lower);
  check.expect(j.upper >= 0, at + ".upper", "0 or more", j.upper);
  if (j.kind == JointKind::ball) {
    check.expect(j.upper == kNever || (j.upper > 0 && j.upper <= 3.1), at + ".upper",
                 "more than 0, up to 3.1 rad", j.upper);
  }
}

// A loop is held by the contact solver, which knows no springs and stops of loops.
void check_loop(const JointType& j, const std::string& at, RangeCheck& check) {
  const auto none = [&](bool fine, const char* member, double found) {
    check.expect(fine, at + member, "a joint that closes a loop has no spring, friction or stops",
                 "not given", std::to_string(found));
  };
  none(j.stiffness == 0, ".stiffness", j.stiffness);
  none(j.damping == 0, ".damping", j.damping);
  none(j.friction == 0, ".friction", j.friction);
  none(j.lower == -kNever, ".lower", j.lower);
  none(j.upper == kNever, ".upper", j.upper);
}

}  // namespace

void validate(const AssemblyType& assembly, int types, const std::string& key) {
  RangeCheck check(key);
  const int count = int(assembly.links.size());
  check.expect(count >= 2 && count <= kMaxLinks, ".links", "wrong number of links",
               "2 to " + std::to_string(kMaxLinks), std::to_string(count));
  for (int i = 0; i < count; ++i) {
    const AssemblyLink& link = assembly.links[std::size_t(i)];
    const std::string at = ".links[" + std::to_string(i) + "]";
    check.expect(link.type >= 0 && link.type < types, at + ".type", "no such type",
                 "0 to " + std::to_string(types - 1), std::to_string(link.type));
    check.expect(link.scale >= 0.01 && link.scale <= 100, at + ".scale", "0.01 to 100", link.scale);
  }
  std::vector<int> parents(std::size_t(count), 0);
  for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
    const JointType& joint = assembly.joints[i];
    const std::string at = ".joints[" + std::to_string(i) + "]";
    const std::string found =
        "parent " + std::to_string(joint.parent) + ", child " + std::to_string(joint.child);
    const auto exists = [count](int link) { return link >= 0 && link < count; };
    const bool loops = exists(joint.child) && parents[std::size_t(joint.child)] > 0;
    if (loops) {
      check.expect(exists(joint.parent) && joint.parent != joint.child, at,
                   "a joint that closes a loop must join two links", "two different links", found);
      check_loop(joint, at, check);
    } else {
      const bool fits = exists(joint.parent) && joint.parent < joint.child && exists(joint.child);
      check.expect(fits, at, "a joint must hang a link on one that is listed before it",
                   "parent < child < " + std::to_string(count), found);
      if (fits) ++parents[std::size_t(joint.child)];
    }
    check_joint(joint, at, check);
  }
  for (int i = 1; i < count; ++i) {
    check.expect(parents[std::size_t(i)] == 1, ".links[" + std::to_string(i) + "]",
                 "every link but the first must be the child of one joint", "1 joint",
                 std::to_string(parents[std::size_t(i)]));
  }
  check.finish();
}

PieceType make_rigid_type(const AssemblyType& assembly, const std::vector<PieceType>& types) {
  PieceType whole;
  whole.name = assembly.name;
  for (const AssemblyLink& link : assembly.links) {
    for (const ConvexPart& part : types[std::size_t(link.type)].parts) {
      whole.parts.emplace_back();
      for (const Vec3& p : part.points) {
        whole.parts.back().points.push_back(link.assembly_from_link * (p * link.scale));
      }
    }
  }
  return whole;
}

}  // namespace rubble
