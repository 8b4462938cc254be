// An SDF 1.9 world for Gazebo Sim: http://sdformat.org/spec?ver=1.9.
#include <algorithm>

#include "io/base/escaped_text.h"
#include "io/scenes/scene_text.h"
#include "io/scenes/scene_writers.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

// The ground is a box: Drake's tree of boxes does not hold a plane without end (segmentation fault of 1.44 and 1.51).
constexpr char kBegin[] = R"(<?xml version="1.0"?>
<sdf version="1.9">
  <world name="rubble">
    <gravity>0 0 -%</gravity>
    <light name="sun" type="directional">
      <pose>0 0 20 0 0 0</pose>
      <diffuse>0.9 0.9 0.9 1</diffuse>
      <direction>-0.5 0.3 -0.8</direction>
      <cast_shadows>true</cast_shadows>
    </light>
    <model name="ground">
      <static>true</static>
      <link name="link">
        <collision name="collision">
          <pose>0 0 -5 0 0 0</pose>
          <geometry><box><size>200 200 10</size></box></geometry>
        </collision>
        <visual name="visual">
          <geometry><plane><normal>0 0 1</normal><size>200 200</size></plane></geometry>
        </visual>
      </link>
    </model>
)";


std::string element(const char* name, const std::string& value) {
  return std::string("<") + name + ">" + value + "</" + name + ">";
}

// Roll, pitch and yaw: readers other than Gazebo's take any six or seven numbers as these.
std::string pose_text(const Pose& pose) {
  return element("pose", vector_text(pose.translation) + " " + rpy_text(pose.rotation));
}

class SdfBuilder {
 public:
  SdfBuilder(const ExportModel& model, const SceneMeshFiles& meshes) : model_(model), meshes_(meshes) {}

  std::string build() {
    std::string world = kBegin;
    world.replace(world.find('%'), 1, exact_text(model_.pile.gravity));
    for (std::size_t i = 0; i < model_.sim.surfaces.size(); ++i) world += surface_text(i);
    for (std::size_t i = 0; i < model_.sim.models.size(); ++i) world += model_text(int(i));
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model < 0)
        world += "    <model name=\"" + xml_text(camera.name) + "\">\n      <static>true</static>\n      " +
                 pose_text(camera.carrier_from_camera) + "\n      <link name=\"link\">\n" + camera_text(camera, {}) +
                 "      </link>\n    </model>\n";
    return world + "  </world>\n</sdf>\n";
  }

 private:
  std::string mesh_text(const std::string& file, double scale) const {
    return "          <geometry><mesh><uri>" + xml_text(file) + "</uri><scale>" + number_list({scale, scale, scale}) +
           "</scale></mesh></geometry>\n";
  }

  static std::string friction_text(double friction) {
    const std::string mu = exact_text(friction);
    return "          <surface><friction><ode>" + element("mu", mu) + element("mu2", mu) + "</ode></friction></surface>\n";
  }

  std::string surface_text(std::size_t index) const {
    const SimSurface& surface = model_.sim.surfaces[index];
    return "    <model name=\"" + xml_text(surface.name) + "_surface\">\n      <static>true</static>\n      " +
           pose_text(surface.world_from_mesh) + "\n      <link name=\"link\">\n        <collision name=\"collision\">\n" +
           mesh_text(meshes_.surfaces[index], surface.scale) + friction_text(surface.friction) +
           "        </collision>\n      </link>\n    </model>\n";
  }

  std::string model_text(int index) const {
    const SimModel& model = model_.sim.models[std::size_t(index)];
    const bool still = model.fixed && model.links.size() == 1;
    std::string text = "    <model name=\"" + xml_text(model.name) + "\">\n";
    if (still) text += "      <static>true</static>\n";
    text += "      " + pose_text(model.links[0].world_from_link) + "\n";
    for (std::size_t i = 0; i < model.links.size(); ++i) text += link_text(index, int(i), still);
    if (model.fixed && !still)
      text += "      <joint name=\"fixed_root\" type=\"fixed\"><parent>world</parent>" +
              element("child", xml_text(model.links[0].name)) + "</joint>\n";
    for (const SimJoint& joint : model.joints) text += joint_text(model, joint);
    for (const SimJoint& joint : model.joints) text += controller_text(joint);
    return text + "    </model>\n";
  }

  std::string link_text(int model_index, int index, bool still) const {
    const SimModel& model = model_.sim.models[std::size_t(model_index)];
    const SimLink& link = model.links[std::size_t(index)];
    const std::string xml_name = model.links.size() == 1 ? "link" : xml_text(link.name);
    std::string text = "      <link name=\"" + xml_name + "\">\n";
    if (index > 0) text += "        " + pose_text(model.links[0].world_from_link.inverse() * link.world_from_link) + "\n";
    if (!still) text += inertial_text(link);
    int number = 0;
    for (const SimPart& part : link.parts) text += part_text(part, number);
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model == model_index && camera.link == index) text += camera_text(camera, camera.carrier_from_camera);
    return text + "      </link>\n";
  }

  static std::string inertial_text(const SimLink& link) {
    const Mat3& i = link.inertia;
    return "        <inertial>" + pose_text({{}, link.centre_of_mass}) + element("mass", exact_text(link.mass)) + "<inertia>" +
           element("ixx", exact_text(i.rows[0].x)) + element("ixy", exact_text(i.rows[0].y)) +
           element("ixz", exact_text(i.rows[0].z)) + element("iyy", exact_text(i.rows[1].y)) +
           element("iyz", exact_text(i.rows[1].z)) + element("izz", exact_text(i.rows[2].z)) + "</inertia></inertial>\n";
  }

  std::string part_text(const SimPart& part, int& number) const {
    std::string text;
    const auto begin = [&](const char* kind) {
      const std::string suffix = number == 0 ? "" : "_" + std::to_string(number);
      return std::string("        <") + kind + " name=\"" + kind + suffix + "\">\n";
    };
    const auto add = [&](const char* kind, const Pose& pose, const std::string& content) {
      text += begin(kind);
      if (!(pose.translation == Vec3()) || !(pose.rotation == Quat())) text += "          " + pose_text(pose) + "\n";
      text += content + "        </" + kind + ">\n";
      ++number;
    };
    if (part.shape >= 0) {
      const SimShape& shape = model_.sim.shapes[std::size_t(part.shape)];
      for (std::size_t k = 0; k < shape.hulls.size(); ++k) {
        const auto box = find_box(shape.hulls[k]);
        if (!box) {
          add("collision", part.link_from_part,
              mesh_text(meshes_.hulls[std::size_t(part.shape)][k], part.scale) + friction_text(part.friction));
          continue;
        }
        Pose at = box->shape_from_box;
        at.translation *= part.scale;
        add("collision", part.link_from_part * at,
            "          <geometry><box>" + element("size", vector_text(box->size * part.scale)) + "</box></geometry>\n" +
                friction_text(part.friction));
      }
    }
    if (part.mesh >= 0) add("visual", part.link_from_part, mesh_text(meshes_.meshes[std::size_t(part.mesh)], part.scale));
    return text;
  }

  // A joint's position is 0 at the poses of the file.
  static std::string joint_text(const SimModel& model, const SimJoint& joint) {
    const char* kind = joint.kind == JointKind::weld     ? "fixed"
                       : joint.kind == JointKind::hinge  ? "revolute"
                       : joint.kind == JointKind::slider ? "prismatic"
                                                         : "ball";
    std::string text = "      <joint name=\"" + xml_text(joint.name) + "\" type=\"" + kind + "\">\n        " +
                       pose_text(joint.child_from_joint) + element("parent", xml_text(model.links[std::size_t(joint.parent)].name)) +
                       element("child", xml_text(model.links[std::size_t(joint.child)].name)) + "\n";
    if (joint.kind == JointKind::hinge || joint.kind == JointKind::slider) {
      text += "        <axis>" + element("xyz", vector_text(joint.axis)) + "<limit>" +
              element("lower", exact_text(std::max(joint.lower, -kFreeLimit) - joint.position)) +
              element("upper", exact_text(std::min(joint.upper, kFreeLimit) - joint.position)) +
              (joint.effort > 0 ? element("effort", exact_text(joint.effort)) : "") +
              (joint.speed > 0 ? element("velocity", exact_text(joint.speed)) : "") + "</limit><dynamics>" +
              element("damping", exact_text(joint.damping)) + element("friction", exact_text(joint.friction));
      if (joint.stiffness > 0)
        text += element("spring_reference", exact_text(joint.rest - joint.position)) +
                element("spring_stiffness", exact_text(joint.stiffness));
      text += "</dynamics></axis>\n";
    }
    return text + "      </joint>\n";
  }

  static std::string controller_text(const SimJoint& joint) {
    if (joint.drive == SimDrive::none) return "";
    const bool position = joint.drive == SimDrive::position;
    std::string text = position ? "      <plugin filename=\"gz-sim-joint-position-controller-system\" "
                                  "name=\"gz::sim::systems::JointPositionController\">"
                                : "      <plugin filename=\"gz-sim-joint-controller-system\" name=\"gz::sim::systems::JointController\">";
    text += element("joint_name", xml_text(joint.name));
    if (position)
      text += element("p_gain", exact_text(joint.drive_stiffness)) + element("i_gain", "0") +
              element("d_gain", exact_text(joint.drive_damping)) + element("cmd_max", exact_text(joint.effort)) +
              element("cmd_min", exact_text(-joint.effort));
    return text + "</plugin>\n";
  }

  // A camera of SDF looks along X, with Z up, as those of missions. Its principal point is measured from the corner of the
  // image (gz-rendering's projection), ours from the middle of the first pixel.
  static std::string camera_text(const SimCamera& camera, const Pose& pose) {
    const double fov = 2 * portable::atan2(0.5 * camera.width, camera.fx);
    return "        <sensor name=\"" + xml_text(camera.name) + "\" type=\"camera\">\n          " + pose_text(pose) + "<camera>" +
           element("horizontal_fov", exact_text(fov)) + "<image>" + element("width", std::to_string(camera.width)) +
           element("height", std::to_string(camera.height)) +
           "</image><clip><near>0.02</near><far>200</far></clip><lens><intrinsics>" + element("fx", exact_text(camera.fx)) +
           element("fy", exact_text(camera.fy)) + element("cx", exact_text(camera.cx + 0.5)) + element("cy", exact_text(camera.cy + 0.5)) +
           "<s>0</s></intrinsics></lens></camera>\n        </sensor>\n";
  }

  const ExportModel& model_;
  const SceneMeshFiles& meshes_;
};

}  // namespace

void write_sdf(const std::string& folder, const ExportModel& model) {
  FolderWriter files(folder, {"meshes"}, 1);
  const SceneMeshFiles meshes = write_mesh_files(model, files);
  files.write("pile.sdf", SdfBuilder(model, meshes).build());
  files.write("scene.json", scene_json(model));
  files.finish();
}

}  // namespace rubble
