#include "io/robot/urdf_writer.h"

#include "io/base/number_text.h"
#include "io/base/xml_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kFree = 1e8;  // limits beyond this are none; unit: rad, m

std::string triple(const Vec3& v) { return exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z); }

std::string origin(const Pose& pose) {
  return "<origin xyz=\"" + triple(pose.translation) + "\" rpy=\"" + triple(portable::rpy_from_quat(pose.rotation)) +
         "\"/>";
}

std::string geometry(const char* kind, const std::string& file) {
  return std::string("    <") + kind + "><geometry><mesh filename=\"" + xml_text(file) +
         "\"/></geometry></" + kind + ">\n";
}

std::string link_text(const RobotLink& link, const std::string& folder, const std::string& prefix) {
  const Mat3& i = link.inertia;
  std::string text = "  <link name=\"" + xml_text(prefix + link.name) + "\">\n    <inertial>" +
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

std::string connection(const std::string& parent, const std::string& child, const Pose& parent_from_child) {
  return "    <parent link=\"" + xml_text(parent) + "\"/><child link=\"" + xml_text(child) + "\"/>" +
         origin(parent_from_child) + "\n";
}

std::string joint_text(const RobotModel& model, const RobotJoint& joint, const std::string& prefix) {
  const bool limited = joint.lower > -kFree && joint.upper < kFree;
  const char* kind = joint.kind == JointKind::weld     ? "fixed"
                     : joint.kind == JointKind::slider ? "prismatic"
                     : limited                         ? "revolute"
                                                       : "continuous";
  std::string text = "  <joint name=\"" + xml_text(joint.name) + "\" type=\"" + kind + "\">\n" +
                     connection(prefix + model.links[std::size_t(joint.parent)].name,
                                prefix + model.links[std::size_t(joint.child)].name, joint.parent_from_child);
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
  return folder + "/" + link + ".stl";
}

std::string part_mesh_file(const std::string& folder, const std::string& link, std::size_t part) {
  return folder + "/" + link + "_part_" + std::to_string(part) + ".stl";
}

std::string robot_to_urdf(const RobotModel& model, const std::string& name, const std::string& folder,
                          const std::string& prefix, const std::vector<UrdfFrame>& frames) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + xml_text(name) + "\">\n";
  for (const RobotLink& link : model.links) text += link_text(link, folder, prefix);
  for (const RobotJoint& joint : model.joints) text += joint_text(model, joint, prefix);
  for (const UrdfFrame& frame : frames) {
    text += "  <link name=\"" + xml_text(prefix + frame.name) + "\"/>\n  <joint name=\"" +
            xml_text(frame.name + "_frame") + "\" type=\"fixed\">\n" +
            connection(prefix + model.links[std::size_t(frame.link)].name, prefix + frame.name, frame.link_from_frame) +
            "  </joint>\n";
  }
  return text + "</robot>\n";
}

}  // namespace rubble
