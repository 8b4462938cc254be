#include "io/robot/urdf_reader.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "io/base/srgb.h"
#include "io/base/xml_document.h"
#include "io/robot/urdf_elements.h"
#include "io/robot/xacro_tool.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/base/read_file.h"
#include "kernel/base/system/file_sandbox.h"

namespace rubble {
namespace {

constexpr double kLeastAxis = 1e-9;  // length of an axis that has a direction
constexpr double kMostMass = 1e9;    // of a link; unit: kg

// Reads the children of <robot>, one by one.
class PartReader {
 public:
  PartReader(UrdfElements& elements, const XmlElement& robot) : elements_(elements) {
    collect_colours(robot);
  }

  UrdfLink read_link(const XmlElement& from) {
    UrdfLink link;
    link.line = from.line;
    elements_.set_owner("");
    link.name = elements_.name_of(from, "name");
    elements_.set_owner(link.name);
    elements_.expect(from, {"name", "type"}, {"inertial", "visual", "collision"});
    if (const XmlElement* inertial = from.child("inertial")) read_inertial(*inertial, link);
    for (const XmlElement& child : from.children) {
      if (child.name == "collision") {
        elements_.expect(child, {"name"}, {"origin", "geometry"});
        read_shape(child, link.collisions);
      }
      if (child.name == "visual") read_visual(child, link.visuals);
    }
    return link;
  }

  UrdfNamedJoint read_joint(const XmlElement& from) {
    UrdfNamedJoint named;
    UrdfJoint& joint = named.joint;
    joint.line = from.line;
    elements_.set_owner("");
    joint.name = elements_.name_of(from, "name");
    elements_.set_owner(joint.name);
    elements_.expect(from, {"name", "type"}, {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"});
    named.parent = read_end(from, "parent");
    named.child = read_end(from, "child");
    joint.parent_from_child = elements_.origin(from);
    const std::string* type = from.find("type");
    const std::string kind = type ? *type : "";
    named.floating = kind == "floating";
    if (kind == "fixed" || named.floating) return named;
    if (kind == "revolute" || kind == "continuous")
      joint.kind = JointKind::hinge;
    else if (kind == "prismatic")
      joint.kind = JointKind::slider;
    else
      return elements_.mistake(from.line, "this type of joint is not supported",
                               "fixed, revolute, continuous or prismatic", "\"" + kind + "\""),
             named;
    read_axis(from, joint);
    read_limit(from, kind == "continuous", joint);
    read_dynamics(from, joint);
    return named;
  }

 private:
  // Materials that are defined anywhere, by name: a visual may name one that comes later.
  void collect_colours(const XmlElement& robot) {
    for (const XmlElement& child : robot.children)
      if (child.name == "material") add_colour(child);
    for (const XmlElement& link : robot.children)
      for (const XmlElement& visual : link.children)
        for (const XmlElement& material : visual.children)
          if (link.name == "link" && visual.name == "visual" && material.name == "material") add_colour(material);
  }

  // The first one counts.
  void add_colour(const XmlElement& material) {
    elements_.expect(material, {"name"}, {"color"});
    const std::string* name = material.find("name");
    if (name && !name->empty() && material.child("color")) colours_.emplace(*name, material.child("color"));
    if (name && !name->empty() && material.child("texture")) textured_.insert({*name, true});
  }

  // Colours of URDF files are those of a screen: sRGB. A fault in a colour costs the colour alone.
  std::optional<Vec3f> read_colour(const XmlElement& color) {
    elements_.expect(color, {"rgba"}, {});
    const std::string* text = color.find("rgba");
    const std::vector<double> n = text ? UrdfElements::numbers_in(*text) : std::vector<double>();
    if (n.size() != 4 || !std::all_of(n.begin(), n.end(), [](double x) { return std::isfinite(x); })) {
      elements_.warn(color.line, "<color> is left out: `rgba` is to be four numbers from 0 to 1, and is " +
                                     (text ? "\"" + *text + "\"" : std::string("missing")));
      return std::nullopt;
    }
    if (std::any_of(n.begin(), n.end(), [](double x) { return x < 0 || x > 1; }))
      elements_.warn(color.line, "`rgba` is to be four numbers from 0 to 1, and is \"" + *text + "\": cut to this range");
    if (n[3] < 1)
      elements_.warn(color.line, "the transparency of <color> is left out: it is drawn as a solid");
    const auto decode = [](double code) { return float(linear_from_srgb(std::clamp(code, 0.0, 1.0))); };
    return Vec3f(decode(n[0]), decode(n[1]), decode(n[2]));
  }

  std::optional<Vec3f> colour_of(const XmlElement& visual) {
    const XmlElement* material = visual.child("material");
    if (!material) return std::nullopt;
    const XmlElement* color = material->child("color");
    const std::string* name = material->find("name");
    if (!color && name && colours_.count(*name) > 0) color = colours_.at(*name);
    if (color) return read_colour(*color);
    const bool textured = material->child("texture") || (name && textured_.count(*name) > 0);
    if (!textured)
      elements_.warn(material->line, "the material " + (name ? "`" + *name + "`" : std::string("without a name")) +
                                         " is defined nowhere in the file: drawn without a colour");
    return std::nullopt;
  }

  void read_inertial(const XmlElement& from, UrdfLink& link) {
    elements_.expect(from, {}, {"origin", "mass", "inertia"});
    link.link_from_inertial = elements_.origin(from);
    if (const XmlElement* mass = from.child("mass")) {
      elements_.expect(*mass, {"value"}, {});
      link.mass = elements_.number(*mass, "value", 0, true);
      if (link.mass < 0)
        elements_.mistake(mass->line, "a mass below 0", "0 kg or more", plain_text(link.mass) + " kg");
      if (link.mass > kMostMass)
        elements_.mistake(mass->line, "a mass that no robot has", "at most 1e9 kg", plain_text(link.mass) + " kg");
    }
    double i[6] = {};
    if (const XmlElement* inertia = from.child("inertia")) {
      elements_.expect(*inertia, {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, {});
      const char* const names[6] = {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"};
      for (int k = 0; k < 6; ++k) i[k] = elements_.number(*inertia, names[k], 0);
    }
    link.inertia.rows[0] = {i[0], i[1], i[2]};
    link.inertia.rows[1] = {i[1], i[3], i[4]};
    link.inertia.rows[2] = {i[2], i[4], i[5]};
    link.has_inertial = link.mass != 0 || std::any_of(i, i + 6, [](double x) { return x != 0; });
    if (link.has_inertial && link.mass == 0)
      elements_.warn(from.line, "`" + link.name + "` has moments of inertia without a mass");
  }

  void read_visual(const XmlElement& from, std::vector<UrdfGeometry>& list) {
    elements_.expect(from, {"name"}, {"origin", "geometry", "material"});
    const std::size_t before = list.size();
    read_shape(from, list);
    if (list.size() > before) list.back().colour = colour_of(from);
  }

  void read_shape(const XmlElement& from, std::vector<UrdfGeometry>& list) {
    UrdfGeometry g;
    g.link_from_geometry = elements_.origin(from);
    const XmlElement* geometry = from.child("geometry");
    g.line = geometry ? geometry->line : from.line;
    if (!geometry || geometry->children.empty())
      return elements_.mistake(g.line, "<" + from.name + "> has no shape",
                               "a <geometry> with one of <box>, <cylinder>, <capsule>, <sphere>, <mesh>",
                               geometry ? "an empty <geometry>" : "no <geometry>");
    const XmlElement& shape = geometry->children.front();
    if (geometry->children.size() > 1)
      elements_.warn(geometry->children[1].line, "a <geometry> is one shape: what follows the first is left out");
    g.line = shape.line;
    double least = 0;  // of its sizes; unit: m
    if (shape.name == "box") {
      elements_.expect(shape, {"size"}, {});
      g.size = elements_.vector(shape, "size", {1, 1, 1}, true);
      least = std::min({g.size.x, g.size.y, g.size.z});
    } else if (shape.name == "cylinder" || shape.name == "capsule") {
      elements_.expect(shape, {"radius", "length"}, {});
      g.kind = shape.name == "capsule" ? UrdfGeometry::Kind::capsule : UrdfGeometry::Kind::cylinder;
      g.radius = elements_.number(shape, "radius", 1, true);
      g.length = elements_.number(shape, "length", 1, true);
      least = std::min(g.radius, g.length);
    } else if (shape.name == "sphere") {
      elements_.expect(shape, {"radius"}, {});
      g.kind = UrdfGeometry::Kind::sphere;
      g.radius = elements_.number(shape, "radius", 1, true);
      least = g.radius;
    } else if (shape.name == "mesh") {
      if (!read_mesh(shape, g)) return;
      least = 1;
    } else {
      return elements_.mistake(shape.line, "<" + shape.name + "> is not a shape that can be read",
                               "<box>, <cylinder>, <capsule>, <sphere> or <mesh>", "<" + shape.name + ">");
    }
    if (std::max(g.radius, g.length) > kUrdfFarthest)
      elements_.mistake(shape.line, "its geometry is too large", "sizes of at most 10000 m", plain_text(std::max(g.radius, g.length)));
    if (least < 0) elements_.mistake(shape.line, "its geometry has a size below 0", "sizes above 0 m", plain_text(least));
    if (least == 0)
      elements_.warn(shape.line, "<" + shape.name + "> of " + from.name + " has a size of 0 and is left out");
    else
      list.push_back(g);
  }

  bool read_mesh(const XmlElement& shape, UrdfGeometry& g) {
    elements_.expect(shape, {"filename", "scale"}, {});
    g.kind = UrdfGeometry::Kind::mesh;
    g.scale = elements_.scale(shape);
    if (g.scale.x == 0 || g.scale.y == 0 || g.scale.z == 0)
      elements_.mistake(shape.line, "the scale of its mesh is 0", "three numbers that are not 0", "0");
    const std::string name = elements_.name_of(shape, "filename");
    if (name.empty()) return false;
    g.file = find_urdf_mesh(name, elements_.path());
    if (const auto refused = g.file.empty() ? std::nullopt : find_refusal(g.file)) {
      elements_.mistake(shape.line, "its mesh \"" + name + "\" lies outside the sandbox", refused->expected, refused->found,
                        refused->hint);
      return false;
    }
    if (!g.file.empty()) return true;
    elements_.mistake(shape.line, "its mesh is missing", "a file beside the URDF file, or below one of its folders",
                      "\"" + name + "\"",
                      name.find("://") != std::string::npos ? "put the package beside the URDF file, or name its "
                                                              "workspace in ROS_PACKAGE_PATH or AMENT_PREFIX_PATH"
                                                            : "");
    return false;
  }

  std::string read_end(const XmlElement& joint, const char* end) {
    const XmlElement* element = joint.child(end);
    if (!element) {
      elements_.mistake(joint.line, std::string("it has no <") + end + ">", "<parent link=...> and <child link=...>",
                        "none");
      return "";
    }
    elements_.expect(*element, {"link"}, {});
    return elements_.name_of(*element, "link");
  }

  void read_axis(const XmlElement& from, UrdfJoint& joint) {
    const XmlElement* axis = from.child("axis");
    if (!axis) return;  // X
    elements_.expect(*axis, {"xyz"}, {});
    const Vec3 v = elements_.vector(*axis, "xyz", {1, 0, 0});
    if (norm(v) < kLeastAxis)
      elements_.mistake(axis->line, "its axis has no direction", "a vector that is not zero", "0 0 0");
    else
      joint.axis = v * (1 / norm(v));
  }

  // What is optional in a continuous joint's limit is forgiven in others with a warning, but for the range.
  void read_limit(const XmlElement& from, bool endless, UrdfJoint& joint) {
    const XmlElement* limit = from.child("limit");
    if (!limit) {
      if (!endless)
        elements_.mistake(from.line, "it has no <limit>", "<limit lower= upper= effort= velocity=>, or type=\"continuous\"",
                          "none");
      return;
    }
    elements_.expect(*limit, {"lower", "upper", "effort", "velocity"}, {});
    joint.effort = read_most(*limit, "effort");
    joint.speed = read_most(*limit, "velocity");
    if (endless) return;
    joint.lower = elements_.number(*limit, "lower", 0, false, true);
    joint.upper = elements_.number(*limit, "upper", 0, false, true);
    if (joint.lower > joint.upper || joint.lower == kNever || joint.upper == -kNever)
      elements_.mistake(limit->line, "its range is empty", "lower <= upper",
                        plain_text(joint.lower) + " to " + plain_text(joint.upper));
    else if (joint.lower > kUrdfFarthest || joint.upper < -kUrdfFarthest)
      elements_.mistake(limit->line, "its range is out of reach", "some of -10000 to 10000",
                        plain_text(joint.lower) + " to " + plain_text(joint.upper));
  }

  // 0: there is no such limit, or it is below 0, which some programs write for "none".
  double read_most(const XmlElement& limit, const char* attribute) {
    const double most = elements_.number(limit, attribute, 0, false, true);
    if (most >= 0) return std::min(most, kMostFigure);
    elements_.warn(limit.line, std::string("`") + attribute + "` of <limit> is below 0: taken as not given");
    return 0;
  }

  void read_dynamics(const XmlElement& from, UrdfJoint& joint) {
    if (const XmlElement* dynamics = from.child("dynamics")) {
      elements_.expect(*dynamics, {"damping", "friction"}, {});
      joint.damping = elements_.number(*dynamics, "damping", 0);
      joint.friction = elements_.number(*dynamics, "friction", 0);
      if (joint.damping < 0 || joint.friction < 0)
        elements_.mistake(dynamics->line, "damping or friction below 0", "0 or more", "less");
    }
    if (const XmlElement* mimic = from.child("mimic")) {
      elements_.expect(*mimic, {"joint", "multiplier", "offset"}, {});
      joint.mimic = UrdfJoint::Mimic{elements_.name_of(*mimic, "joint"), elements_.number(*mimic, "multiplier", 1),
                                     elements_.number(*mimic, "offset", 0)};
    }
  }

  static constexpr double kMostFigure = 1e9;  // of efforts and speeds: as good as endless; unit: N m, rad/s

  UrdfElements& elements_;
  std::map<std::string, const XmlElement*> colours_;
  std::map<std::string, bool> textured_;
};

UrdfFile read_document(const XmlDocument& document, const std::string& path) {
  UrdfElements elements(path);
  const XmlElement& root = document.root;
  if (root.name != "robot") {
    elements.mistake(root.line, "is no URDF", "a <robot>", "<" + root.name + ">",
                     root.name == "sdf" || root.name == "mujoco" ? "convert it to URDF" : "");
    elements.throw_mistakes();
  }
  elements.expect(root, {"name", "version"}, {"link", "joint", "material"});
  UrdfFile file;
  file.path = path;
  file.name = root.find("name") ? *root.find("name") : "";
  if (file.name.empty()) file.name = "robot", elements.warn(root.line, "<robot> has no name: called `robot`");
  PartReader parts(elements, root);
  std::vector<UrdfLink> links;
  std::vector<UrdfNamedJoint> joints;
  for (const XmlElement& child : root.children) {
    if (child.name == "link") links.push_back(parts.read_link(child));
    if (child.name == "joint") joints.push_back(parts.read_joint(child));
  }
  elements.throw_mistakes();
  order_urdf_tree(elements, std::move(links), std::move(joints), file);
  file.warnings = document.warnings;
  for (std::string& warning : elements.take_warnings()) file.warnings.push_back(std::move(warning));
  return file;
}

}  // namespace

UrdfFile read_urdf(const std::string& path, const std::vector<std::pair<std::string, std::string>>& arguments) {
  const XmlDocument document = parse_xml(read_file(path), path);
  const XmlElement* xacro = find_xacro(document.root);
  if (!xacro) return read_document(document, path);
  if (!is_xacro_file(path))
    throw InputError({path, xacro->line, "", "<" + xacro->name + "> of xacro is not expanded", "a URDF file", "a xacro file",
                      "with a name that ends in .xacro, the xacro tool is called for it"});
  const std::string text = expand_xacro(path, *xacro, arguments);
  UrdfFile file = read_document(parse_xml(text, path + " (expanded)"), path + " (expanded)");
  file.expanded = text;
  return file;
}

}  // namespace rubble
