// MuJoCo's XML (https://mujoco.readthedocs.io/en/stable/XMLreference.html), for MuJoCo 3.2 and later.
#include <algorithm>
#include <map>

#include "io/base/escaped_text.h"
#include "io/base/little_endian.h"
#include "io/scenes/scene_text.h"
#include "io/scenes/scene_writers.h"
#include "io/scenes/surface_heights.h"
#include "kernel/base/number_text.h"
#include "kernel/base/portable_math.h"

namespace rubble {
namespace {

constexpr double kHeightSpacing = 0.1;  // of the corners of a height field; unit: m
constexpr double kPixel = 5e-6;         // edge of a pixel of a camera, which no picture depends on; unit: m
constexpr double kFieldBase = 1;        // of a height field below its lowest corner; unit: m

// The order of MuJoCo's integrator, solver and cone of friction: contacts of a pile creep least with these. Softness is
// the default one (solref 0.02 1).
constexpr char kHead[] = R"(<mujoco model="rubble">
  <compiler angle="radian" autolimits="true" meshdir="meshes" texturedir="meshes" inertiafromgeom="false"/>
  <option timestep="0.002" gravity="0 0 -%" integrator="implicitfast" cone="elliptic" impratio="10">
    <flag multiccd="enable"/>
  </option>
  <size memory="512M"/>
  <default>
    <default class="visual">
      <geom type="mesh" group="2" contype="0" conaffinity="0" mass="0"/>
    </default>
    <default class="collision">
      <geom type="mesh" group="3" condim="4" mass="0" rgba="0.6 0.6 0.6 1"/>
    </default>
  </default>
)";

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

std::string place(const Pose& pose) {
  return attribute("pos", vector_text(pose.translation)) + attribute("quat", quaternion_text(pose.rotation));
}


class MjcfBuilder {
 public:
  MjcfBuilder(const ExportModel& model, FolderWriter& files) : model_(model), files_(files), looks_(list_looks(model)) {}

  std::string build() {
    std::string head = kHead;
    head.replace(head.find('%'), 1, exact_text(model_.pile.gravity));
    const std::string world = world_text();
    return head + "  <asset>\n" + materials() + assets_ + "  </asset>\n  <worldbody>\n" + world + "  </worldbody>\n" +
           section("contact", excludes_) + section("equality", equalities_) + section("actuator", actuators_) +
           "</mujoco>\n";
  }

 private:
  static std::string section(const char* name, const std::string& content) {
    return content.empty() ? "" : std::string("  <") + name + ">\n" + content + "  </" + name + ">\n";
  }

  std::string materials() {
    write_pictures(looks_, files_);
    std::string text;
    for (const SceneLook& look : looks_) {
      const std::string name = attribute("name", xml_text(look.name));
      if (!look.picture.empty()) text += "    <texture type=\"2d\"" + name + attribute("file", xml_text(look.picture)) + "/>\n";
      text += "    <material" + name + attribute("rgba", srgb_text(look.colour)) + " specular=\"0.1\" shininess=\"0.1\"";
      if (!look.picture.empty()) text += attribute("texture", xml_text(look.name));
      text += "/>\n";
    }
    return text;
  }

  std::string world_text() {
    std::string text =
        "    <light pos=\"0 0 20\" dir=\"-0.5 0.3 -0.8\" directional=\"true\"/>\n"
        "    <geom name=\"ground\" type=\"plane\" size=\"100 100 1\" friction=\"0 0.005 0.0001\" condim=\"4\" rgba=\"0.4 0.38 0.35 1\"/>\n";
    text += surfaces_text();
    for (std::size_t i = 0; i < model_.sim.models.size(); ++i) text += model_text(int(i));
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model < 0) text += camera_text(camera, "    ");
    return text;
  }

  std::string surfaces_text() {
    const SurfaceHeights heights = calc_surface_heights(model_.sim.surfaces, kHeightSpacing);
    if (heights.columns == 0) return "";
    std::string bytes;
    put(bytes, std::int32_t(heights.rows));
    put(bytes, std::int32_t(heights.columns));
    for (const float share : heights.shares) put(bytes, share);
    files_.write("meshes/surface.hfield", bytes);
    const double x = 0.5 * (heights.columns - 1) * heights.spacing, y = 0.5 * (heights.rows - 1) * heights.spacing;
    assets_ += "    <hfield name=\"surface\" file=\"surface.hfield\"" +
               attribute("size", number_list({x, y, heights.range, kFieldBase})) + "/>\n";
    double friction = 0;
    for (const SimSurface& surface : model_.sim.surfaces) friction = std::max(friction, surface.friction);
    return "    <geom name=\"surface\" class=\"collision\" type=\"hfield\" hfield=\"surface\"" +
           attribute("pos", vector_text({heights.low.x + x, heights.low.y + y, heights.low.z})) + friction_text(friction) + "/>\n";
  }

  static std::string friction_text(double friction) { return attribute("friction", number_list({friction, 0.005, 0.0001})); }

  std::string prefix(const SimModel& model) const { return model.robot || model.links.size() > 1 ? model.name + "/" : ""; }
  std::string body_name(const SimModel& model, int link) const {
    return xml_text(prefix(model) + model.links[std::size_t(link)].name);
  }
  std::string joint_name(const SimModel& model, const SimJoint& joint) const { return xml_text(prefix(model) + joint.name); }

  std::string model_text(int index) {
    const SimModel& model = model_.sim.models[std::size_t(index)];
    const std::string text = body_text(index, 0, "    ");
    for (const SimJoint& joint : model.joints) {
      excludes_ += "    <exclude body1=\"" + body_name(model, joint.parent) + "\" body2=\"" + body_name(model, joint.child) + "\"/>\n";
      if (joint.loop) add_loop(model, joint);
      if (joint.mimics >= 0)
        add_mimic(model, joint);
      else if (joint.drive != SimDrive::none)
        add_actuator(model, joint);
    }
    return text;
  }

  // MuJoCo counts both positions from their references.
  void add_mimic(const SimModel& model, const SimJoint& joint) {
    const SimJoint& led = model.joints[std::size_t(joint.mimics)];
    equalities_ += "    <joint joint1=\"" + joint_name(model, joint) + "\" joint2=\"" + joint_name(model, led) + "\" polycoef=\"" +
                   number_list({joint.offset + joint.multiplier * led.position - joint.position, joint.multiplier, 0, 0, 0}) + "\"/>\n";
  }

  std::string body_text(int index, int link_index, const std::string& indent) {
    const SimModel& model = model_.sim.models[std::size_t(index)];
    const SimLink& link = model.links[std::size_t(link_index)];
    const SimJoint* const joint = find_parent_joint(model, link_index);
    const Pose pose = joint ? parent_from_child(model, *joint) : link.world_from_link;
    std::string text = indent + "<body name=\"" + body_name(model, link_index) + "\"" + place(pose) + ">\n";
    const std::string inner = indent + "  ";
    if (joint) text += joint_text(model, *joint, inner);
    if (!joint && !model.fixed) text += inner + "<freejoint name=\"" + xml_text(model.name) + "/free\"/>\n";
    if (!(model.fixed && model.links.size() == 1)) {
      const Mat3& i = link.inertia;
      text += inner + "<inertial pos=\"" + vector_text(link.centre_of_mass) + "\"" + attribute("mass", exact_text(link.mass)) +
              attribute("fullinertia", number_list({i.rows[0].x, i.rows[1].y, i.rows[2].z, i.rows[0].y, i.rows[0].z, i.rows[1].z})) +
              "/>\n";
    }
    for (const SimPart& part : link.parts) text += part_text(part, inner);
    for (const SimCamera& camera : model_.sim.cameras)
      if (camera.model == index && camera.link == link_index) text += camera_text(camera, inner);
    for (const SimJoint& next : model.joints)
      if (next.parent == link_index && !next.loop) text += body_text(index, next.child, inner);
    return text + indent + "</body>\n";
  }

  std::string joint_text(const SimModel& model, const SimJoint& joint, const std::string& indent) {
    if (joint.kind == JointKind::weld) return "";
    const Pose& at = joint.child_from_joint;
    const char* kind = joint.kind == JointKind::hinge ? "hinge" : joint.kind == JointKind::slider ? "slide" : "ball";
    std::string text = indent + "<joint name=\"" + joint_name(model, joint) + "\" type=\"" + kind + "\"" +
                       attribute("pos", vector_text(at.translation));
    const bool ball = joint.kind == JointKind::ball;
    if (!ball) {
      text += attribute("axis", vector_text(at.rotation.rotate(joint.axis))) + attribute("ref", exact_text(joint.position));
      if (joint.stiffness > 0)
        text += attribute("stiffness", exact_text(joint.stiffness)) + attribute("springref", exact_text(joint.rest));
    }
        if (ball ? joint.upper < kFreeLimit : joint.lower > -kFreeLimit || joint.upper < kFreeLimit)
      text += attribute("range", number_list({ball ? 0 : std::max(joint.lower, -kFreeLimit), std::min(joint.upper, kFreeLimit)}));
    if (joint.damping > 0) text += attribute("damping", exact_text(joint.damping));
    if (joint.friction > 0) text += attribute("frictionloss", exact_text(joint.friction));
    return text + "/>\n";
  }

  // Of a hinge by two points of its axis.
  void add_loop(const SimModel& model, const SimJoint& joint) {
    const std::string bodies =
        " body1=\"" + body_name(model, joint.parent) + "\" body2=\"" + body_name(model, joint.child) + "\"";
    const Pose& at = joint.parent_from_joint;
    if (joint.kind == JointKind::weld)
      equalities_ += "    <weld" + bodies + "/>\n";
    else if (joint.kind == JointKind::ball)
      equalities_ += "    <connect" + bodies + attribute("anchor", vector_text(at.translation)) + "/>\n";
    else if (joint.kind == JointKind::hinge)
      for (const double side : {-0.1, 0.1})
        equalities_ += "    <connect" + bodies + attribute("anchor", vector_text(at * (joint.axis * side))) + "/>\n";
  }

  // gain * control + bias; bias by position and speed: MuJoCo's <position> and <velocity> for all versions.
  void add_actuator(const SimModel& model, const SimJoint& joint) {
    const std::string xml_name = joint_name(model, joint);
    std::string text = "    <general name=\"" + xml_name + "\" joint=\"" + xml_name + "\"";
    const double kp = joint.drive_stiffness, kd = joint.drive_damping;
    if (joint.drive == SimDrive::position)
      text += " biastype=\"affine\"" + attribute("gainprm", exact_text(kp)) + attribute("biasprm", number_list({0, -kp, -kd}));
    if (joint.drive == SimDrive::velocity)
      text += " biastype=\"affine\"" + attribute("gainprm", exact_text(kd)) + attribute("biasprm", number_list({0, 0, -kd}));
    if (joint.effort > 0) text += attribute("forcerange", number_list({-joint.effort, joint.effort}));
    if (joint.drive == SimDrive::velocity && joint.speed > 0)
      text += attribute("ctrlrange", number_list({-joint.speed, joint.speed}));
    if (joint.drive == SimDrive::position && joint.lower > -kNever && joint.upper < kNever)
      text += attribute("ctrlrange", number_list({joint.lower, joint.upper}));
    actuators_ += text + "/>\n";
  }

  std::string part_text(const SimPart& part, const std::string& indent) {
    std::string text;
    if (part.mesh >= 0) text += visual_text(part, indent);
    if (part.shape >= 0) {
      const SimShape& shape = model_.sim.shapes[std::size_t(part.shape)];
      for (std::size_t k = 0; k < shape.hulls.size(); ++k) text += hull_text(part, k, indent);
    }
    return text;
  }

  std::string hull_text(const SimPart& part, std::size_t k, const std::string& indent) {
    const SimShape& shape = model_.sim.shapes[std::size_t(part.shape)];
    const std::string geom = indent + "<geom class=\"collision\"" + friction_text(part.friction);
    if (const auto box = find_box(shape.hulls[k])) {
      Pose at = box->shape_from_box;
      at.translation *= part.scale;
      return geom + " type=\"box\"" + attribute("size", vector_text(box->size * (0.5 * part.scale))) +
             place(part.link_from_part * at) + "/>\n";
    }
    const auto next = int(hulls_.size());
    const auto [found, is_new] = hulls_.try_emplace({part.shape, int(k), part.scale}, next);
    const std::string xml_name = "hull_" + std::to_string(found->second);
    if (is_new)
      assets_ += "    <mesh name=\"" + xml_name + "\" inertia=\"convex\"" + attribute("file", xml_text(hull_file_of(part.shape, k))) +
                 attribute("scale", number_list({part.scale, part.scale, part.scale})) + "/>\n";
    return geom + attribute("mesh", xml_name) + place(part.link_from_part) + "/>\n";
  }

  // Files, since Rapier's reader leaves out meshes whose vertices are in the XML.
  const std::string& hull_file_of(int shape_index, std::size_t k) {
    const auto [found, is_new] = hull_files_.try_emplace({shape_index, int(k)});
    if (!is_new) return found->second;
    const SimShape& shape = model_.sim.shapes[std::size_t(shape_index)];
    found->second = names_.add(shape.name + "_part_" + std::to_string(k)) + ".obj";
    files_.write("meshes/" + found->second, hull_obj(shape.hulls[k]));
    return found->second;
  }

  std::string visual_text(const SimPart& part, const std::string& indent) {
    const TriangleMesh& mesh = *model_.sim.meshes[std::size_t(part.mesh)].mesh;
    std::string text;
    for (std::size_t s = 0; s < count_surfaces(mesh); ++s) {
      const std::string& file = file_of(part.mesh, s);
      if (file.empty()) continue;
      const auto next = int(visuals_.size());
      const auto [found, is_new] = visuals_.try_emplace({part.mesh, int(s), part.scale}, next);
      const std::string xml_name = "visual_" + std::to_string(found->second);
      if (is_new)
        assets_ += "    <mesh name=\"" + xml_name + "\" inertia=\"shell\"" + attribute("file", xml_text(file)) +
                   attribute("scale", number_list({part.scale, part.scale, part.scale})) + "/>\n";
      text += indent + "<geom class=\"visual\"" + attribute("mesh", xml_name) + attribute("material", xml_text(surface_name(mesh, s))) +
              place(part.link_from_part) + "/>\n";
    }
    return text;
  }

  // Of one surface of a mesh, since a mesh of MuJoCo has one material; "" where it has no triangle.
  const std::string& file_of(int mesh_index, std::size_t surface) {
    const auto [found, is_new] = surface_files_.try_emplace({mesh_index, int(surface)});
    if (!is_new) return found->second;
    const SimMesh& mesh = model_.sim.meshes[std::size_t(mesh_index)];
    const TriangleMesh taken = take_surface(*mesh.mesh, surface);
    const std::string text = surface_obj(mesh.name, taken);
    if (text.empty()) return found->second;
    found->second = names_.add(mesh.name + "_" + surface_name(*mesh.mesh, surface)) + ".obj";
    files_.write("meshes/" + found->second, text);
    return found->second;
  }

  // By its angle of view where the pixels are square and the axis meets the middle. MuJoCo counts the principal point to the
  // left and up.
  static std::string lens_text(const SimCamera& camera) {
    const double left = 0.5 * (camera.width - 1) - camera.cx, up = 0.5 * (camera.height - 1) - camera.cy;
    if (camera.fx == camera.fy && left == 0 && up == 0)
      return attribute("fovy", exact_text(2 * portable::atan2(0.5 * camera.height, camera.fy) * 180 / portable::kPi));
    const double width = camera.width, height = camera.height;
    return attribute("resolution", number_list({width, height})) +
           attribute("sensorsize", number_list({width * kPixel, height * kPixel})) +
           attribute("focalpixel", number_list({camera.fx, camera.fy})) + attribute("principalpixel", number_list({left, up}));
  }

  std::string camera_text(const SimCamera& camera, const std::string& indent) const {
    const Pose pose{camera.carrier_from_camera.rotation * kBodyFromLens, camera.carrier_from_camera.translation};
    return indent + "<camera name=\"" + xml_text(camera.name) + "\"" + place(pose) + lens_text(camera) + "/>\n";
  }

  struct Key {
    int index, part;
    double scale;
    bool operator<(const Key& o) const {
      return index != o.index ? index < o.index : part != o.part ? part < o.part : scale < o.scale;
    }
  };

  const ExportModel& model_;
  FolderWriter& files_;
  std::vector<SceneLook> looks_;
  FileNames names_;
  std::map<Key, int> hulls_, visuals_;
  std::map<std::pair<int, int>, std::string> surface_files_, hull_files_;
  std::string assets_, excludes_, equalities_, actuators_;
};

}  // namespace

void write_mjcf(const std::string& folder, const ExportModel& model) {
  FolderWriter files(folder, {"meshes"}, 1);
  files.write("pile.xml", MjcfBuilder(model, files).build());
  files.write("scene.json", scene_json(model));
  files.finish();
}

}  // namespace rubble
