#include "io/robot/urdf_reader.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "io/base/srgb.h"
#include "io/robot/urdf_lines.h"
#include "kernel/base/error.h"
#include "kernel/base/system/isolated_worker.h"
#include "kernel/base/read_file.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

// What liburdfdom complains of, instead of on the standard error.
class Complaints : public console_bridge::OutputHandler {
 public:
  Complaints() { console_bridge::useOutputHandler(this); }
  ~Complaints() override { console_bridge::restorePreviousOutputHandler(); }
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_.empty()) first_ = text;
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

Vec3 vec(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose pose(const urdf::Pose& p) {
  double x = 0, y = 0, z = 0, w = 1;
  p.rotation.getQuaternion(x, y, z, w);
  return {normalized(Quat{w, x, y, z}), vec(p.position)};
}

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

class Reader {
 public:
  Reader(const std::string& path, const std::string& text) : lines_(text) {
    file_.path = path;
    urdf::ModelInterfaceSharedPtr model;
    std::string why;
    {
      const Complaints complaints;
      model = urdf::parseURDF(text);
      why = complaints.first();
    }
    check_tree();
    if (!model || !why.empty()) add(0, "", "cannot be read as URDF: " + why, "a robot as ROS describes it", "");
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    file_.name = model->getName();
    warn_of_what_is_left_out();
    take(*model, *model->getRoot(), {});
    if (file_.links.size() != model->links_.size())
      add(0, "", "some links hang on nothing that leads to the root", "one tree of links",
          std::to_string(model->links_.size() - file_.links.size()) + " apart");
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
  }

  UrdfFile take_file() { return std::move(file_); }

 private:
  void add(int line, const std::string& key, const std::string& message, const std::string& expected,
           const std::string& found) {
    mistakes_.push_back({file_.path, line, key, message, expected, found, ""});
  }

  void check_tree() {
    for (const char* element : {"link", "joint"})
      for (const std::string& name : lines_.doubled(element))
        add(lines_.line_of(element, name), name, std::string("two ") + element + "s have this name",
            "a name of its own", "");
  }

  void warn_of_what_is_left_out() {
    for (const char* element : {"transmission", "gazebo", "safety_controller", "calibration", "sensor"})
      for (int line : lines_.lines_of(element))
        file_.warnings.push_back(file_.path + ":" + std::to_string(line) + ": <" + element +
                                 "> is left out");
  }

  // The link, and what hangs on it, depth first.
  void take(const urdf::ModelInterface& model, const urdf::Link& link, const urdf::JointSharedPtr& by) {
    const auto known = numbers_.find(link.name);
    if (known != numbers_.end()) {
      add(by ? lines_.line_of("joint", by->name) : 0, by ? by->name : link.name,
          "closes a loop: link `" + link.name + "` hangs on another joint already",
          "a tree: each link is the child of one joint", "");
      return;
    }
    const int number = int(file_.links.size());
    numbers_[link.name] = number;
    if (by) file_.joints.push_back(make_joint(*by, number));
    file_.links.push_back(make_link(link));
    for (const auto& [name, joint] : model.joints_) {
      if (joint->parent_link_name != link.name) continue;
      const auto child = model.links_.find(joint->child_link_name);
      if (child != model.links_.end()) take(model, *child->second, joint);
    }
  }

  UrdfJoint make_joint(const urdf::Joint& from, int child) {
    UrdfJoint joint;
    joint.name = from.name;
    joint.line = lines_.line_of("joint", from.name);
    joint.parent = numbers_.at(from.parent_link_name);
    joint.child = child;
    joint.parent_from_child = pose(from.parent_to_joint_origin_transform);
    switch (from.type) {
      case urdf::Joint::FIXED:
        return joint;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        joint.kind = JointKind::hinge;
        break;
      case urdf::Joint::PRISMATIC:
        joint.kind = JointKind::slider;
        break;
      default:
        add(joint.line, from.name, "this type of joint is not supported",
            "fixed, revolute, continuous or prismatic", "planar or floating");
        return joint;
    }
    take_axis(from, joint);
    take_limits(from, joint);
    if (from.dynamics) joint.damping = from.dynamics->damping, joint.friction = from.dynamics->friction;
    if (from.mimic)
      joint.mimic = UrdfJoint::Mimic{from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
    return joint;
  }

  void take_axis(const urdf::Joint& from, UrdfJoint& joint) {
    const Vec3 axis = vec(from.axis);
    if (!finite(axis) || norm(axis) < 1e-9)
      add(joint.line, from.name, "its axis has no direction", "a vector that is not zero", "");
    else
      joint.axis = axis * (1 / norm(axis));
  }

  void take_limits(const urdf::Joint& from, UrdfJoint& joint) {
    if (!from.limits) return;
    joint.effort = std::max(0.0, from.limits->effort);
    joint.speed = std::max(0.0, from.limits->velocity);
    if (from.type == urdf::Joint::CONTINUOUS) return;
    joint.lower = from.limits->lower, joint.upper = from.limits->upper;
    if (joint.lower <= 0 && joint.upper >= 0) return;
    add(joint.line, from.name, "its zero lies outside of its limits, which is not supported",
        "lower <= 0 <= upper", std::to_string(joint.lower) + " to " + std::to_string(joint.upper));
  }

  UrdfLink make_link(const urdf::Link& from) {
    UrdfLink link;
    link.name = from.name;
    link.line = lines_.line_of("link", from.name);
    if (from.inertial) {
      const urdf::Inertial& i = *from.inertial;
      link.has_inertial = true;
      link.mass = i.mass;
      link.link_from_inertial = pose(i.origin);
      link.inertia.rows[0] = {i.ixx, i.ixy, i.ixz};
      link.inertia.rows[1] = {i.ixy, i.iyy, i.iyz};
      link.inertia.rows[2] = {i.ixz, i.iyz, i.izz};
    }
    for (const auto& c : from.collision_array)
      if (c && c->geometry) take_geometry(*c->geometry, c->origin, link, link.collisions);
    for (const auto& v : from.visual_array) {
      const std::size_t before = link.visuals.size();
      if (v && v->geometry) take_geometry(*v->geometry, v->origin, link, link.visuals);
      if (link.visuals.size() > before) link.visuals.back().colour = colour_of(*v);
    }
    return link;
  }

  // Colours of URDF files are those of a screen: sRGB.
  static std::optional<Vec3f> colour_of(const urdf::Visual& visual) {
    const auto& m = visual.material;
    if (!m || !m->texture_filename.empty()) return std::nullopt;
    const auto decode = [](float code) {
      return float(linear_from_srgb(double(code > 0 ? std::min(code, 1.0f) : 0.0f)));
    };
    return Vec3f(decode(m->color.r), decode(m->color.g), decode(m->color.b));
  }

  void take_geometry(const urdf::Geometry& from, const urdf::Pose& origin, const UrdfLink& link,
                     std::vector<UrdfGeometry>& list) {
    UrdfGeometry g;
    g.link_from_geometry = pose(origin);
    bool fine = true;
    if (from.type == urdf::Geometry::BOX) {
      g.kind = UrdfGeometry::Kind::box;
      g.size = vec(static_cast<const urdf::Box&>(from).dim);
      fine = finite(g.size) && g.size.x > 0 && g.size.y > 0 && g.size.z > 0;
    } else if (from.type == urdf::Geometry::CYLINDER) {
      g.kind = UrdfGeometry::Kind::cylinder;
      g.radius = static_cast<const urdf::Cylinder&>(from).radius;
      g.length = static_cast<const urdf::Cylinder&>(from).length;
      fine = g.radius > 0 && g.length > 0;
    } else if (from.type == urdf::Geometry::SPHERE) {
      g.kind = UrdfGeometry::Kind::sphere;
      g.radius = static_cast<const urdf::Sphere&>(from).radius;
      fine = g.radius > 0;
    } else {
      g.kind = UrdfGeometry::Kind::mesh;
      const auto& mesh = static_cast<const urdf::Mesh&>(from);
      g.scale = vec(mesh.scale);
      fine = finite(g.scale) && g.scale.x > 0 && g.scale.y > 0 && g.scale.z > 0;
      g.file = find_mesh(mesh.filename);
      if (g.file.empty()) {
        add(link.line, link.name, "its mesh is missing", "a file beside the URDF file, or below one of its folders",
            "\"" + mesh.filename + "\"");
        return;
      }
    }
    if (!fine) add(link.line, link.name, "its geometry has no size", "sizes and scales above 0", "");
    list.push_back(g);
  }

  // "package://NAME/PATH" and "file:PATH" too: PATH is looked for in the folder of the URDF file and in those
  // that it lies in; absolute paths are those of another machine. Empty: not found.
  std::string find_mesh(const std::string& name) const {
    std::string path = name;
    if (path.rfind("package://", 0) == 0) {
      path.erase(0, 10);
    } else if (path.rfind("file:", 0) == 0) {
      path.erase(0, path.find_first_not_of('/', 5));
    }
    const std::string below = path.substr(std::min(path.size(), path.find('/') + 1));
    std::error_code failed;
    fs::path folder = fs::absolute(fs::path(file_.path)).parent_path();
    for (;; folder = folder.parent_path()) {
      for (const std::string& tried : {path, below})
        if (!tried.empty() && fs::is_regular_file(folder / tried, failed))
          return (folder / tried).lexically_normal().string();
      if (folder == folder.parent_path()) return "";
    }
  }

  UrdfLines lines_;
  UrdfFile file_;
  std::map<std::string, int> numbers_;
  std::vector<Diagnostic> mistakes_;
};

}  // namespace

UrdfFile read_urdf(const std::string& path) {
  const std::string text = read_file(path);
  run_isolated(path, "URDF", [&] {
    const Complaints complaints;
    urdf::parseURDF(text);
    return std::string();
  });
  return Reader(path, text).take_file();
}

}  // namespace rubble
