#include "io/robot/urdf_writer.h"

#include <cmath>

#include "io/base/number_text.h"
#include "io/base/xml_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr double kFree = 1e8;  // limits beyond this are none; unit: rad, m

std::string triple(const Vec3& v) { return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z); }

// R = Rz(yaw) Ry(pitch) Rx(roll)
Vec3 rpy_of(const Quat& rotation) {
  const Mat3 r = rotation.matrix();
  const double level = std::sqrt(r.rows[0].x * r.rows[0].x + r.rows[1].x * r.rows[1].x);
  const double pitch = portable::atan2(-r.rows[2].x, level);
  if (level < 1e-9) return {portable::atan2(-r.rows[1].z, r.rows[1].y), pitch, 0};
  return {portable::atan2(r.rows[2].y, r.rows[2].z), pitch, portable::atan2(r.rows[1].x, r.rows[0].x)};
}

std::string origin(const Pose& pose) {
  return "<origin xyz=\"" + triple(pose.translation) + "\" rpy=\"" + triple(rpy_of(pose.rotation)) +
         "\"/>";
}

std::string geometry(const char* kind, const std::string& file) {
  return std::string("    <") + kind + "><geometry><mesh filename=\"" + xml_text(file) +
         "\"/></geometry></" + kind + ">\n";
}

std::string link_text(const RobotLink& link, const std::string& folder) {
  const Mat3& i = link.inertia;
  std::string text = "  <link name=\"" + xml_text(link.name) + "\">\n    <inertial>" +
                     origin({{}, link.centre_of_mass}) + "<mass value=\"" + exact_text(link.mass) +
                     "\"/><inertia ixx=\"" + exact_text(i.rows[0].x) + "\" ixy=\"" + exact_text(i.rows[0].y) +
                     "\" ixz=\"" + exact_text(i.rows[0].z) + "\" iyy=\"" + exact_text(i.rows[1].y) + "\" iyz=\"" +
                     exact_text(i.rows[1].z) + "\" izz=\"" + exact_text(i.rows[2].z) + "\"/></inertial>\n";
  if (!link.parts.empty() || !link.looks.triangles.empty())
    text += geometry("visual", link_mesh_file(folder, link.name));
  for (std::size_t k = 0; k < link.parts.size(); ++k)
    text += geometry("collision", part_mesh_file(folder, link.name, k));
  return text + "  </link>\n";
}

std::string joint_text(const RobotModel& model, const RobotJoint& joint) {
  const bool limited = joint.lower > -kFree && joint.upper < kFree;
  const char* kind = joint.kind == JointKind::weld     ? "fixed"
                     : joint.kind == JointKind::slider ? "prismatic"
                     : limited                         ? "revolute"
                                                       : "continuous";
  std::string text = "  <joint name=\"" + xml_text(joint.name) + "\" type=\"" + kind + "\">\n    <parent link=\"" +
                     xml_text(model.links[std::size_t(joint.parent)].name) + "\"/><child link=\"" +
                     xml_text(model.links[std::size_t(joint.child)].name) + "\"/>" +
                     origin(joint.parent_from_child) + "\n";
  if (joint.kind == JointKind::weld) return text + "  </joint>\n";
  text += "    <axis xyz=\"" + triple(joint.axis) + "\"/><limit effort=\"" + exact_text(joint.motor.effort) +
          "\" velocity=\"" + exact_text(joint.motor.speed) + "\"";
  if (limited) text += " lower=\"" + exact_text(joint.lower) + "\" upper=\"" + exact_text(joint.upper) + "\"";
  text += "/><dynamics damping=\"" + exact_text(joint.damping) + "\" friction=\"" + exact_text(joint.friction) +
          "\"/>\n";
  return text + "  </joint>\n";
}

}  // namespace

std::string link_mesh_file(const std::string& folder, const std::string& link) {
  return folder + "/" + file_name_of(link) + ".stl";
}

std::string part_mesh_file(const std::string& folder, const std::string& link, std::size_t part) {
  return folder + "/" + file_name_of(link) + "_part_" + std::to_string(part) + ".stl";
}

std::string robot_to_urdf(const RobotModel& model, const std::string& name, const std::string& folder) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + xml_text(name) + "\">\n";
  for (const RobotLink& link : model.links) text += link_text(link, folder);
  for (const RobotJoint& joint : model.joints) text += joint_text(model, joint);
  return text + "</robot>\n";
}

}  // namespace rubble
