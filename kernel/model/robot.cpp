#include "kernel/model/robot.h"

#include <cmath>

#include "kernel/base/portable_math.h"
#include "kernel/model/range_check.h"

namespace rubble {
namespace {

// Links have masses of their own; the density only carries them to the piece types.
constexpr double kNominalDensity = 1000;  // unit: kg/m3
constexpr double kUnitLength = 1e-6;      // tolerance of a unit vector

bool is_unit(const Vec3& v) { return std::abs(norm(v) - 1) <= kUnitLength; }

// Sylvester's criterion.
bool is_positive_definite(const Mat3& m) {
  const double a = m.rows[0].x, b = m.rows[0].x * m.rows[1].y - m.rows[0].y * m.rows[1].x;
  return a > 0 && b > 0 && dot(m.rows[0], cross(m.rows[1], m.rows[2])) > 0;
}

void check_link(const RobotLink& link, const std::string& at, RangeCheck& check) {
  check.expect(link.mass > 0 && std::isfinite(link.mass), at + ".mass", "more than 0 kg", link.mass);
  // trace(I) 1 - 2 I is the second moment of the mass: no mass makes one that is not positive.
  const Mat3& i = link.inertia;
  const double trace = i.rows[0].x + i.rows[1].y + i.rows[2].z;
  const Mat3 second = Mat3::diagonal({trace, trace, trace}) + i * -2.0;
  check.expect(is_positive_definite(i), at + ".inertia", "no body has these moments",
               "a positive definite matrix", "one that is not");
  check.expect(!is_positive_definite(i) || is_positive_definite(second), at + ".inertia",
               "no body has these moments", "each principal moment below the sum of the others",
               "one that is not");
  check.expect(link.friction >= 0 && link.friction <= 2, at + ".friction", "0 to 2", link.friction);
  check.expect(norm(link.belt_axis) == 0 || is_unit(link.belt_axis), at + ".belt_axis",
               "a unit vector, or zero", norm(link.belt_axis));
  check.expect(norm(link.eversion_axis) == 0 || is_unit(link.eversion_axis), at + ".eversion_axis",
               "a unit vector, or zero", norm(link.eversion_axis));
  check.expect(link.belt_speed_limit >= 0, at + ".belt_speed_limit", "0 m/s or more",
               link.belt_speed_limit);
}

void check_joint(const RobotJoint& joint, int number, const std::string& at, RangeCheck& check) {
  check.expect(joint.child == number + 1, at + ".child", "joints come in the order of their children",
               std::to_string(number + 1), std::to_string(joint.child));
  check.expect(joint.parent >= 0 && joint.parent <= number, at + ".parent",
               "a parent comes before its children", "0 to " + std::to_string(number),
               std::to_string(joint.parent));
  check.expect(joint.kind != JointKind::ball, at + ".kind", "not a joint of robots",
               "weld, hinge or slider", "ball");
  check.expect(is_unit(joint.axis), at + ".axis", "a unit vector", norm(joint.axis));
  check.expect(joint.lower <= joint.upper, at + ".lower", "at most the upper limit", joint.lower);
  check.expect(joint.start >= joint.lower && joint.start <= joint.upper, at + ".start",
               "within the joint's limits", joint.start);
  const RobotMotor& motor = joint.motor;
  const struct {
    const char* name;
    double value;
  } figures[] = {{".damping", joint.damping},
                 {".friction", joint.friction},
                 {".motor.effort", motor.effort},
                 {".motor.speed", motor.speed},
                 {".motor.stiffness", motor.stiffness},
                 {".motor.damping", motor.damping}};
  for (const auto& figure : figures) {
    check.expect(figure.value >= 0 && figure.value <= 1e9, at + figure.name, "0 to 1e9",
                 figure.value);
  }
}

// Takes the axis that a joint of its kind turns about or slides along to the given one.
Quat rotation_to(const Vec3& axis, JointKind kind) {
  const Vec3 from = kind == JointKind::slider ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  const double cosine = dot(from, axis);
  if (cosine < -1 + 1e-12) return kind == JointKind::slider ? Quat{0, 0, 0, 1} : Quat{0, 1, 0, 0};
  const Vec3 v = cross(from, axis);
  return normalized(Quat{1 + cosine, v.x, v.y, v.z});
}

Pose joint_motion(const RobotJoint& joint, double q) {
  if (joint.kind == JointKind::slider) return {{}, joint.axis * q};
  if (joint.kind != JointKind::hinge) return {};
  const auto [s, c] = portable::sincos(0.5 * q);
  return {{c, joint.axis.x * s, joint.axis.y * s, joint.axis.z * s}, {}};
}

}  // namespace

double RobotModel::mass() const {
  double sum = 0;
  for (const RobotLink& link : links) sum += link.mass;
  return sum;
}

void validate(const RobotModel& model, const std::string& key) {
  RangeCheck check(key);
  const std::size_t count = model.links.size();
  check.expect(count >= 1 && count <= std::size_t(kMaxLinks), ".links", "wrong number of links",
               "1 to " + std::to_string(kMaxLinks), std::to_string(count));
  check.expect(model.joints.size() + 1 == count, ".joints", "a tree has one joint fewer than links",
               std::to_string(count - 1), std::to_string(model.joints.size()));
  for (std::size_t i = 0; i < count; ++i) {
    check_link(model.links[i], ".links[" + std::to_string(i) + "]", check);
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    check_joint(model.joints[i], int(i), ".joints[" + std::to_string(i) + "]", check);
  }
  static_assert(kMostTubeLinks + 2 == kMaxLinks);
  if (model.tube) {
    check_tube(*model.tube, ".tube", check);
    check.expect(count == std::size_t(model.tube->links) + 2, ".links",
                 "a tube has a base, its links and a tip", std::to_string(model.tube->links + 2),
                 std::to_string(count));
  }
  check.finish();
}

std::vector<Pose> calc_base_from_links(const RobotModel& model, const std::vector<double>& q) {
  std::vector<Pose> poses(model.links.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const RobotJoint& joint = model.joints[i];
    const double at = q.empty() ? joint.start : q[i];
    poses[std::size_t(joint.child)] =
        poses[std::size_t(joint.parent)] * joint.parent_from_child * joint_motion(joint, at);
  }
  return poses;
}

std::vector<PieceType> make_link_types(const RobotModel& model) {
  std::vector<PieceType> types;
  for (const RobotLink& link : model.links) {
    PieceType type;
    type.name = model.name + "/" + link.name;
    type.parts = link.parts;
    type.density = kNominalDensity;
    type.friction = link.friction;
    type.volume = VolumeProperties{link.mass / kNominalDensity, link.centre_of_mass,
                                   link.inertia * (1 / kNominalDensity)};
    types.push_back(type);
  }
  return types;
}

AssemblyType make_assembly(const RobotModel& model, int first_type) {
  AssemblyType assembly;
  assembly.name = model.name;
  const std::vector<Pose> zero =
      calc_base_from_links(model, std::vector<double>(model.joints.size(), 0));
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    assembly.links.push_back({first_type + int(i), zero[i], 1});
  }
  for (const RobotJoint& from : model.joints) {
    JointType joint;
    joint.parent = from.parent;
    joint.child = from.child;
    joint.kind = from.kind;
    joint.assembly_from_joint =
        zero[std::size_t(from.child)] * Pose{rotation_to(from.axis, from.kind), {}};
    joint.damping = from.damping;
    joint.friction = from.friction;
    joint.lower = from.lower;
    joint.upper = from.upper;
    assembly.joints.push_back(joint);
  }
  return assembly;
}

}  // namespace rubble
