// A scene as URDF files, which hold one robot each: fixed.urdf, models/NAME.urdf for each model that moves, and
// robots/NAME.urdf. scene.json says where each begins.
#include <algorithm>

#include "io/base/escaped_text.h"
#include "io/mesh/stl_writer.h"
#include "io/robot/urdf_writer.h"
#include "io/scenes/scene_text.h"
#include "io/scenes/scene_writers.h"
#include "kernel/base/number_text.h"
#include "kernel/base/text.h"

namespace rubble {
namespace {

constexpr double kAnySpeed = 1e9;  // unit: rad/s, m/s
// Links between the three hinges of a ball joint: engines refuse links without mass between joints that move.
constexpr double kTinyMass = 1e-3, kTinyInertia = 1e-5;  // unit: kg, kg m2

std::string origin(const Pose& pose) {
  return "<origin xyz=\"" + vector_text(pose.translation) + "\" rpy=\"" + rpy_text(pose.rotation) + "\"/>";
}

std::string inertial_text(const SimLink& link) {
  const Mat3& i = link.inertia;
  return "    <inertial>" + origin({{}, link.centre_of_mass}) + "<mass value=\"" + exact_text(link.mass) + "\"/><inertia ixx=\"" +
         exact_text(i.rows[0].x) + "\" ixy=\"" + exact_text(i.rows[0].y) + "\" ixz=\"" + exact_text(i.rows[0].z) + "\" iyy=\"" +
         exact_text(i.rows[1].y) + "\" iyz=\"" + exact_text(i.rows[1].z) + "\" izz=\"" + exact_text(i.rows[2].z) + "\"/></inertial>\n";
}

std::string mesh_text(const std::string& file, double scale) {
  return "<mesh filename=\"" + xml_text(file) + "\" scale=\"" + number_list({scale, scale, scale}) + "\"/>";
}

class UrdfBuilder {
 public:
  // up: from the folder of the file to that of the scene.
  UrdfBuilder(const ExportModel& model, const SceneMeshFiles& meshes, std::string up)
      : model_(model), meshes_(meshes), up_(std::move(up)) {}

  std::string link_text(const std::string& xml_name, const SimLink& link, bool moves) const {
    std::string text = "  <link name=\"" + xml_name + "\">\n";
    double friction = 0.8;
    if (moves) text += inertial_text(link);
    for (const SimPart& part : link.parts) {
      text += part_text(part);
      if (part.shape >= 0) friction = part.friction;
    }
    return text + contact_text(friction) + "  </link>\n";
  }

  // Bullet multiplies the coefficients of two links, so each gets the root: the product is the geometric mean, as in the
  // kernel. Other readers ignore the element.
  static std::string contact_text(double friction) {
    return "    <contact><lateral_friction value=\"" + exact_text(std::sqrt(friction)) + "\"/></contact>\n";
  }

  std::string part_text(const SimPart& part) const {
    std::string text;
    const auto add = [&](const char* kind, const Pose& pose, const std::string& geometry) {
      text += std::string("    <") + kind + ">" + origin(pose) + "<geometry>" + geometry + "</geometry></" + kind + ">\n";
    };
    if (part.mesh >= 0) add("visual", part.link_from_part, mesh_text(up_ + meshes_.meshes[std::size_t(part.mesh)], part.scale));
    if (part.shape < 0) return text;
    const SimShape& shape = model_.sim.shapes[std::size_t(part.shape)];
    for (std::size_t k = 0; k < shape.hulls.size(); ++k) {
      const auto box = find_box(shape.hulls[k]);
      if (!box) {
        add("collision", part.link_from_part, mesh_text(up_ + meshes_.hulls[std::size_t(part.shape)][k], part.scale));
        continue;
      }
      Pose at = box->shape_from_box;
      at.translation *= part.scale;
      add("collision", part.link_from_part * at, "<box size=\"" + vector_text(box->size * part.scale) + "\"/>");
    }
    return text;
  }

  // In the frame of its joint, as URDF has it: what is in the frame of the link moves along.
  static SimLink in_joint_frame(const SimLink& link, const Pose& link_from_joint) {
    SimLink moved = link;
    const Pose joint_from_link = link_from_joint.inverse();
    const Mat3 turn = joint_from_link.rotation.matrix();
    moved.world_from_link = link.world_from_link * link_from_joint;
    moved.centre_of_mass = joint_from_link * link.centre_of_mass;
    moved.inertia = turn * link.inertia * turn.transposed();
    for (SimPart& part : moved.parts) part.link_from_part = joint_from_link * part.link_from_part;
    return moved;
  }

  std::string model_text(const SimModel& model) const {
    std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"" + xml_text(model.name) + "\">\n";
    std::vector<SimLink> links = model.links;
    for (std::size_t i = 1; i < links.size(); ++i)
      links[i] = in_joint_frame(links[i], find_parent_joint(model, int(i))->child_from_joint);
    for (const SimLink& link : links) text += link_text(xml_text(link.name), link, true);
    for (const SimJoint& joint : model.joints)
      if (!joint.loop) text += joint_text(model, links, joint);
    return text + "</robot>\n";
  }

 private:
  static std::string head(const std::string& xml_name, const char* kind, const std::string& parent, const std::string& child,
                          const Pose& pose) {
    return "  <joint name=\"" + xml_name + "\" type=\"" + kind + "\">\n    <parent link=\"" + parent + "\"/><child link=\"" + child +
           "\"/>" + origin(pose) + "\n";
  }

  // Where the frame of the joint is in that of the parent at the joint's zero.
  static Pose at_zero(const SimModel& model, const SimJoint& joint) {
    const SimJoint* const above = find_parent_joint(model, joint.parent);
    return (above ? above->child_from_joint.inverse() : Pose{}) * joint.parent_from_joint;
  }

  static std::string joint_text(const SimModel& model, const std::vector<SimLink>& links, const SimJoint& joint) {
    const std::string xml_name = xml_text(joint.name), parent = xml_text(links[std::size_t(joint.parent)].name),
                      child = xml_text(links[std::size_t(joint.child)].name);
    if (joint.kind == JointKind::ball) return ball_text(links, joint, xml_name, parent, child);
    const Pose pose = at_zero(model, joint);
    if (joint.kind == JointKind::weld) return head(xml_name, "fixed", parent, child, pose) + "  </joint>\n";
    const bool limited = joint.lower > -kFreeLimit || joint.upper < kFreeLimit, slides = joint.kind == JointKind::slider;
    std::string text = head(xml_name, slides ? "prismatic" : limited ? "revolute" : "continuous", parent, child, pose);
    text += "    <axis xyz=\"" + vector_text(joint.axis) + "\"/>";
    if (limited || slides)
      text += "<limit effort=\"0\" velocity=\"" + exact_text(kAnySpeed) + "\" lower=\"" +
              exact_text(std::max(joint.lower, -kFreeLimit)) + "\" upper=\"" + exact_text(std::min(joint.upper, kFreeLimit)) + "\"/>";
    return text + "<dynamics damping=\"" + exact_text(joint.damping) + "\" friction=\"" + exact_text(joint.friction) +
           "\"/>\n  </joint>\n";
  }

  // Three hinges, about X, Y and Z; all are at 0 where the child is now.
  static std::string ball_text(const std::vector<SimLink>& links, const SimJoint& joint, const std::string& xml_name,
                               const std::string& parent, const std::string& child) {
    const Pose now = links[std::size_t(joint.parent)].world_from_link.inverse() * links[std::size_t(joint.child)].world_from_link;
    const std::string between[4] = {parent, xml_name + "_x", xml_name + "_y", child};
    const Vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    std::string text;
    for (int i = 0; i < 3; ++i) {
      if (i > 0) {
        const std::string tiny = exact_text(kTinyInertia);
        text += "  <link name=\"" + between[i] + "\">\n    <inertial><mass value=\"" + exact_text(kTinyMass) + "\"/><inertia ixx=\"" + tiny +
                "\" ixy=\"0\" ixz=\"0\" iyy=\"" + tiny + "\" iyz=\"0\" izz=\"" + tiny + "\"/></inertial>\n  </link>\n";
      }
      text += head(xml_name + "_" + std::to_string(i + 1), "continuous", between[i], between[i + 1], i == 0 ? now : Pose{}) +
              "    <axis xyz=\"" + vector_text(axes[i]) + "\"/><dynamics damping=\"" + exact_text(joint.damping) + "\" friction=\"" +
              exact_text(joint.friction) + "\"/>\n  </joint>\n";
    }
    return text;
  }

  const ExportModel& model_;
  const SceneMeshFiles& meshes_;
  std::string up_;
};

bool stands(const SimModel& model) { return model.fixed && model.links.size() == 1; }

// All that never moves, each a link on the link `world`.
std::string standing_text(const ExportModel& model, const SceneMeshFiles& meshes) {
  const UrdfBuilder builder(model, meshes, "");
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"fixed\">\n  <link name=\"world\"/>\n";
  const auto hang = [&](const std::string& xml_name, const Pose& pose) {
    text += "  <joint name=\"" + xml_name + "_joint\" type=\"fixed\">\n    <parent link=\"world\"/><child link=\"" + xml_name + "\"/>" +
            origin(pose) + "\n  </joint>\n";
  };
  for (const SimModel& m : model.sim.models) {
    if (!stands(m)) continue;
    text += builder.link_text(xml_text(m.name), m.links[0], false);
    hang(xml_text(m.name), m.links[0].world_from_link);
  }
  for (std::size_t i = 0; i < model.sim.surfaces.size(); ++i) {
    const SimSurface& surface = model.sim.surfaces[i];
    const std::string xml_name = xml_text(surface.name) + "_surface";
    // Bullet's word for contacts of the triangles, not of their hull; others ignore it.
    text += "  <link name=\"" + xml_name + "\" concave=\"yes\">\n    <collision concave=\"yes\"><geometry>" +
            mesh_text(meshes.surfaces[i], surface.scale) + "</geometry></collision>\n" +
            UrdfBuilder::contact_text(surface.friction) + "  </link>\n";
    hang(xml_name, surface.world_from_mesh);
  }
  return text + "</robot>\n";
}

// As robots of a run are written, with meshes beside the file.
void write_robot(const ExportModel& model, const SimModel& robot, const std::string& name, FolderWriter& files) {
  const std::string meshes = name + "_meshes";
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const RobotLink& link = robot.robot->links[i];
    std::size_t part = 0;
    for (const SimPart& p : robot.links[i].parts) {
      if (p.mesh >= 0)
        files.write("robots/" + link_mesh_file(meshes, link.name), stl_bytes(*model.sim.meshes[std::size_t(p.mesh)].mesh));
      if (p.shape < 0) continue;
      for (const Hull& hull : model.sim.shapes[std::size_t(p.shape)].hulls)
        files.write("robots/" + part_mesh_file(meshes, link.name, part++), hull_obj(hull));
    }
  }
  files.write("robots/" + name + ".urdf", robot_to_urdf(*robot.robot, robot.name, meshes, "", robot.links[0].world_from_link));
}

}  // namespace

void write_urdf(const std::string& folder, const ExportModel& model) {
  std::vector<std::string> folders{"meshes", "models", "robots"}, file_of;
  FileNames models, robots;
  for (const SimModel& m : model.sim.models) {
    if (m.robot) {
      const std::string name = robots.add(m.name);
      folders.push_back("robots/" + name + "_meshes");
      file_of.push_back("robots/" + name + ".urdf");
    } else {
      file_of.push_back(stands(m) ? "fixed.urdf" : "models/" + models.add(m.name) + ".urdf");
    }
  }
  FolderWriter files(folder, folders, 1);
  const SceneMeshFiles meshes = write_mesh_files(model, files);
  const UrdfBuilder builder(model, meshes, "../");
  files.write("fixed.urdf", standing_text(model, meshes));
  for (std::size_t i = 0; i < file_of.size(); ++i) {
    const SimModel& m = model.sim.models[i];
    if (m.robot) {
      write_robot(model, m, file_of[i].substr(7, file_of[i].size() - 12), files);
    } else if (!stands(m)) {
      files.write(file_of[i], builder.model_text(m));
    }
  }
  files.write("scene.json", scene_json(model, &file_of));
  files.finish();
}

}  // namespace rubble
