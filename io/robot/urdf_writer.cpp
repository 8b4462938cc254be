#include "io/robot/urdf_writer.h"

#include <algorithm>
#include <cmath>

#include "io/base/escaped_text.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr double kFree = 1e8;  // limits beyond this are none; unit: rad, m
constexpr double kAnySpeed = 1e9;  // of a motor without a limit: 0 would hold it still; unit: rad/s, m/s

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

std::string joint_head(const std::string& name, const char* kind, const std::string& parent, const std::string& child,
                       const Pose& parent_from_child) {
  return "  <joint name=\"" + xml_text(name) + "\" type=\"" + kind + "\">\n    <parent link=\"" + xml_text(parent) +
         "\"/><child link=\"" + xml_text(child) + "\"/>" + origin(parent_from_child) + "\n";
}

// Of a continuous joint without a motor nothing: it may be left out there, and an effort of 0 says something else.
std::string limit_text(const RobotJoint& joint, bool limited) {
  const RobotMotor& motor = joint.motor;
  const bool ranged = limited || joint.kind == JointKind::slider;
  if (motor.effort <= 0 && !ranged) return "";
  const double speed = motor.effort > 0 && motor.speed <= 0 ? kAnySpeed : motor.speed;
  std::string text = "<limit effort=\"" + exact_text(motor.effort) + "\" velocity=\"" + exact_text(speed) + "\"";
  if (ranged)
    text += " lower=\"" + exact_text(std::max(joint.lower, -kFree)) + "\" upper=\"" +
            exact_text(std::min(joint.upper, kFree)) + "\"";
  return text + "/>";
}

std::string mimic_text(const RobotModel& model, int joint) {
  for (const MimicJoint& mimic : model.mimics)
    if (mimic.joint == joint)
      return "    <mimic joint=\"" + xml_text(model.joints[std::size_t(mimic.of)].name) + "\" multiplier=\"" +
             exact_text(mimic.multiplier) + "\" offset=\"" + exact_text(mimic.offset) + "\"/>\n";
  return "";
}

std::string joint_text(const RobotModel& model, const RobotJoint& joint, const std::string& prefix) {
  const bool limited = joint.lower > -kFree || joint.upper < kFree;
  const char* kind = joint.kind == JointKind::weld     ? "fixed"
                     : joint.kind == JointKind::slider ? "prismatic"
                     : limited                         ? "revolute"
                                                       : "continuous";
  std::string text = joint_head(joint.name, kind, prefix + model.links[std::size_t(joint.parent)].name,
                                prefix + model.links[std::size_t(joint.child)].name, joint.parent_from_child);
  if (joint.kind == JointKind::weld) return text + "  </joint>\n";
  text += "    <axis xyz=\"" + triple(joint.axis) + "\"/>" + limit_text(joint, limited) + "<dynamics damping=\"" +
          exact_text(joint.damping) + "\" friction=\"" + exact_text(joint.friction) + "\"/>\n";
  return text + mimic_text(model, int(&joint - model.joints.data())) + "  </joint>\n";
}

// A name that no joint of the model has.
std::string free_joint_name(const RobotModel& model, std::string name) {
  const auto taken = [&](const RobotJoint& joint) { return joint.name == name; };
  while (std::any_of(model.joints.begin(), model.joints.end(), taken)) name += "_";
  return name;
}

// A link without a body.
std::string empty_link(const std::string& name) { return "  <link name=\"" + xml_text(name) + "\"/>\n"; }

std::string frame_text(const RobotModel& model, const RobotFrame& frame, const std::string& prefix) {
  return empty_link(prefix + frame.name) +
         joint_head(free_joint_name(model, frame.name + "_frame"), "fixed",
                    prefix + model.links[std::size_t(frame.link)].name, prefix + frame.name, frame.link_from_frame) +
         "  </joint>\n";
}

}  // namespace

std::string link_mesh_file(const std::string& folder, const std::string& link) {
  return folder + "/" + file_name_of(link) + ".stl";
}

std::string part_mesh_file(const std::string& folder, const std::string& link, std::size_t part) {
  return folder + "/" + file_name_of(link) + "_part_" + std::to_string(part) + ".obj";
}

std::string robot_to_urdf(const RobotModel& model, const std::string& name, const std::string& folder,
                          const std::string& prefix, const Pose& world_from_base) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + xml_text(name) + "\">\n";
  for (const RobotLink& link : model.links) text += link_text(link, folder, prefix);
  for (const RobotJoint& joint : model.joints) text += joint_text(model, joint, prefix);
  for (const RobotFrame& frame : model.frames) text += frame_text(model, frame, prefix);
  if (model.fixed_base)
    text += empty_link("world") + joint_head(free_joint_name(model, "world_joint"), "fixed", "world",
                                             prefix + model.links[0].name, world_from_base) +
            "  </joint>\n";
  return text + "</robot>\n";
}

}  // namespace rubble
