#include "app/robots/urdf_robot.h"

#include <algorithm>
#include <cmath>

#include "app/assets/decompose_cache.h"
#include "app/assets/surface_choice.h"
#include "kernel/base/error.h"
#include "kernel/base/hash.h"
#include "kernel/base/portable_math.h"
#include "kernel/robot/looks.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr double kFriction = 0.7;       // of what the mission says nothing of
constexpr double kFullEffortAt = 0.07;  // error of position control; unit: rad
constexpr double kFullEffortSlide = 0.007;  // of a slider; unit: m
constexpr double kDampingTime = 0.05;   // of position control: damping by stiffness; unit: s
constexpr int kFacets = 32, kSpherePoints = 96;
constexpr float kPaintReflectance = 0.04f, kPaintRoughness = 0.6f;  // of what has a colour in the file; our choice
constexpr double kLeftwards = 0.999;    // cosine between a wheel's axis and +Y

// Golden-angle spiral.
ConvexPart make_ball(double radius) {
  ConvexPart part;
  const double golden = portable::kPi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kSpherePoints; ++i) {
    const double z = 1 - 2 * (i + 0.5) / kSpherePoints, level = std::sqrt(1 - z * z);
    const auto [s, c] = portable::sincos(golden * i);
    part.points.push_back(Vec3{level * c, level * s, z} * radius);
  }
  return part;
}

// Along Z.
ConvexPart make_cylinder(double radius, double length) {
  ConvexPart part = make_wheel(radius, length, kFacets);
  for (Vec3& p : part.points) p = {p.x, -p.z, p.y};
  return part;
}

// warnings: gets once what of the file is left out.
TriangleMesh load_scaled(const UrdfGeometry& g, MeshImporter& importer, std::vector<std::string>& warnings) {
  MeshUnits units;
  units.heed_stated_axis = false;
  TriangleMesh mesh = importer.load_mesh(g.file, units);
  for (const std::string& note : importer.notes().shape) {
    const std::string warning = g.file + ": " + note;
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
  }
  for (Vec3f& p : mesh.positions)
    p = {float(p.x * g.scale.x), float(p.y * g.scale.y), float(p.z * g.scale.z)};
  mesh.normals.clear();  // an uneven scale turns them
  return mesh;
}

class Builder {
 public:
  Builder(const UrdfFile& file, const RobotItem& robot, const std::string& key, MeshImporter& importer)
      : file_(file), robot_(robot), key_(key), importer_(importer) {}

  MissionRobot build() {
    join_fixed_links();
    made_.model.name = file_.name;
    made_.warnings = file_.warnings;
    for (std::size_t i = 0; i < file_.links.size(); ++i) add_shape(file_.links[i], places_[i]);
    set_masses();
    add_mimics();
    add_sides();
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    return std::move(made_);
  }

 private:
  // Where a link of the file is: on which body, and where.
  struct Place {
    int body = 0;
    Pose body_from_link;
  };

  void add(int line, const std::string& what, const std::string& message, const std::string& expected,
           const std::string& found) {
    mistakes_.push_back({file_.path, line, what, message, expected, found, ""});
  }

  void start_body(const UrdfLink& link) {
    RobotLink body;
    body.name = link.name;
    body.friction = robot_.friction.value_or(kFriction);
    made_.model.links.push_back(body);
    body_lines_.push_back(link.line);
  }

  void join_fixed_links() {
    start_body(file_.links[0]);
    places_.push_back({});
    for (const UrdfJoint& joint : file_.joints) {
      const Place parent = places_[std::size_t(joint.parent)];
      const Pose body_from_child = parent.body_from_link * joint.parent_from_child;
      const UrdfLink& child = file_.links[std::size_t(joint.child)];
      if (joint.kind == JointKind::weld) {
        places_.push_back({parent.body, body_from_child});
        made_.frames.push_back({child.name, parent.body, body_from_child});
        continue;
      }
      places_.push_back({int(made_.model.links.size()), {}});
      start_body(child);
      add_joint(joint, parent.body, body_from_child);
    }
  }

  void add_joint(const UrdfJoint& from, int parent, const Pose& parent_from_child) {
    RobotJoint joint;
    joint.name = from.name;
    joint.parent = parent;
    joint.child = int(made_.model.links.size()) - 1;
    joint.kind = from.kind;
    joint.parent_from_child = parent_from_child;
    joint.axis = from.axis;
    joint.lower = from.lower, joint.upper = from.upper;
    joint.damping = from.damping, joint.friction = from.friction;
    const bool slides = from.kind == JointKind::slider;
    joint.motor.effort = from.effort;
    joint.motor.speed = from.speed;
    joint.motor.stiffness = from.effort / (slides ? kFullEffortSlide : kFullEffortAt);
    const bool turns_round = !(from.upper - from.lower < kNever);
    joint.motor.damping = turns_round && from.speed > 0 ? 10 * from.effort / from.speed
                                                        : kDampingTime * joint.motor.stiffness;
    made_.model.joints.push_back(joint);
  }

  std::vector<ConvexPart> parts_of(const UrdfGeometry& g, const UrdfLink& link) {
    switch (g.kind) {
      case UrdfGeometry::Kind::box:
        return {make_box(g.size)};
      case UrdfGeometry::Kind::cylinder:
        return {make_cylinder(g.radius, g.length)};
      case UrdfGeometry::Kind::sphere:
        return {make_ball(g.radius)};
      case UrdfGeometry::Kind::mesh:
        break;
    }
    try {
      return decompose_cached(load_scaled(g, importer_, made_.warnings), DiskCache(DiskCache::usual_folder()));
    } catch (const InputError& error) {
      add(link.line, link.name, "its mesh has no use as a solid: " + error.diagnostics().front().text(),
          "a mesh with a volume", g.file);
      return {};
    }
  }

  void add_shape(const UrdfLink& link, const Place& place) {
    RobotLink& body = made_.model.links[std::size_t(place.body)];
    for (const UrdfGeometry& g : link.collisions) {
      const Pose body_from_part = place.body_from_link * g.link_from_geometry;
      for (ConvexPart part : parts_of(g, link)) {
        for (Vec3& p : part.points) p = body_from_part * p;
        body.parts.push_back(std::move(part));
      }
    }
    for (const UrdfGeometry& g : link.visuals) add_looks(g, place, link, body);
  }

  void add_looks(const UrdfGeometry& g, const Place& place, const UrdfLink& link, RobotLink& body) {
    TriangleMesh mesh;
    if (g.kind == UrdfGeometry::Kind::mesh) {
      mesh = load_scaled(g, importer_, made_.warnings);
      if (!g.colour && has_paint(mesh))
        for (const std::string& note : importer_.notes().looks) made_.warnings.push_back(g.file + ": " + note);
    } else {
      RobotLink solid;
      solid.parts = parts_of(g, link);
      mesh = make_link_mesh(solid, "");
    }
    if (g.colour) paint(*g.colour, mesh);
    const Pose body_from_mesh = place.body_from_link * g.link_from_geometry;
    TriangleMesh& looks = body.looks;
    const std::string plain = choose_link_surface(made_.model, std::size_t(place.body));
    choose_surfaces(mesh, [&plain](const std::string&, const SurfacePaint* paint) { return paint ? std::string() : plain; });
    const std::vector<std::uint8_t> surfaces = add_surfaces(mesh, plain, looks);
    const auto first = std::uint32_t(looks.positions.size());
    for (const Vec3f& p : mesh.positions) looks.positions.push_back(Vec3f(body_from_mesh * Vec3(p)));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& v = mesh.triangles[t];
      looks.triangles.push_back({first + v[0], first + v[1], first + v[2]});
      looks.surfaces.push_back(mesh.surfaces.empty() ? std::uint8_t(0) : surfaces[mesh.surfaces[t]]);
      if (mesh.paint_corners.empty() && looks.paint_corners.empty()) continue;
      looks.paint_corners.resize(looks.triangles.size());
      if (!mesh.paint_corners.empty()) looks.paint_corners.back() = mesh.paint_corners[t];
    }
  }

  // All of it, over the colours of its file, as RViz does.
  static void paint(const Vec3f& colour, TriangleMesh& mesh) {
    SurfacePaint paint;
    paint.colour = colour, paint.reflectance = kPaintReflectance, paint.roughness = kPaintRoughness;
    Sha256 hash;
    for (const float x : {colour.x, colour.y, colour.z}) hash.add(&x, sizeof x);
    paint.sha256 = hash.hex();
    mesh.surface_names = {"material"};
    mesh.surfaces.assign(mesh.triangles.size(), 0);
    mesh.paints = {std::make_shared<const SurfacePaint>(std::move(paint))};
    mesh.paint_corners.assign(mesh.triangles.size(), {});
  }

  // By surface of the mesh: which it is of the link's looks. The first of those is what has no colours of its own.
  static std::vector<std::uint8_t> add_surfaces(const TriangleMesh& mesh, const std::string& plain,
                                                TriangleMesh& looks) {
    if (looks.surface_names.empty()) looks.surface_names = {plain};
    std::vector<std::uint8_t> out(std::max<std::size_t>(1, mesh.surface_names.size()), 0);
    for (std::size_t s = 0; s < mesh.paints.size() && looks.surface_names.size() < 256; ++s) {
      if (!mesh.paints[s]) continue;
      out[s] = std::uint8_t(looks.surface_names.size());
      looks.paints.resize(looks.surface_names.size());
      looks.surface_names.push_back(mesh.surface_names[s]);
      looks.paints.push_back(mesh.paints[s]);
    }
    return out;
  }

  // Of all links of a body, about their common centre (Steiner).
  void set_masses() {
    for (std::size_t b = 0; b < made_.model.links.size(); ++b) {
      RobotLink& body = made_.model.links[b];
      body.mass = 0;
      Vec3 moment;
      const auto each = [&](const auto& use) {
        for (std::size_t i = 0; i < file_.links.size(); ++i)
          if (places_[i].body == int(b) && file_.links[i].has_inertial)
            use(file_.links[i], places_[i].body_from_link * file_.links[i].link_from_inertial);
      };
      each([&](const UrdfLink& link, const Pose& at) {
        body.mass += link.mass;
        moment += at.translation * link.mass;
      });
      if (!(body.mass > 0) || !std::isfinite(body.mass)) {
        add(body_lines_[b], body.name, "has no mass, and is a body of its own",
            "an <inertial> with a mass above 0, on it or on a link that is fixed to it",
            std::to_string(body.mass) + " kg");
        continue;
      }
      body.centre_of_mass = moment * (1 / body.mass);
      Mat3 sum = Mat3::diagonal({0, 0, 0});
      each([&](const UrdfLink& link, const Pose& at) {
        const Mat3 r = at.rotation.matrix();
        const Vec3 d = at.translation - body.centre_of_mass;
        const Mat3 square{{d * d.x, d * d.y, d * d.z}};
        sum = sum + r * link.inertia * r.transposed() +
              Mat3::diagonal({dot(d, d), dot(d, d), dot(d, d)}) * link.mass + square * -link.mass;
      });
      body.inertia = sum;
      check_inertia(body, body_lines_[b]);
    }
  }

  void check_inertia(const RobotLink& body, int line) {
    RobotModel alone;
    alone.links = {body};
    try {
      validate(alone, body.name);
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics())
        add(line, body.name, d.message, d.expected, d.found);
    }
  }

  int find_joint(const std::string& name) const {
    const std::vector<RobotJoint>& joints = made_.model.joints;
    const auto at = std::find_if(joints.begin(), joints.end(),
                                 [&](const RobotJoint& joint) { return joint.name == name; });
    return at == joints.end() ? -1 : int(at - joints.begin());
  }

  void add_mimics() {
    for (const UrdfJoint& joint : file_.joints) {
      if (!joint.mimic || joint.kind == JointKind::weld) continue;
      const int of = find_joint(joint.mimic->joint), own = find_joint(joint.name);
      if (of < 0 || of == own)
        add(joint.line, joint.name, "mimics a joint that does not move", "another joint that moves",
            "\"" + joint.mimic->joint + "\"");
      else if (joint.effort <= 0)
        add(joint.line, joint.name, "a mimic joint is driven by a servo", "a limit with an effort above 0",
            "0");
      else
        made_.mimics.push_back({own, of, joint.mimic->multiplier, joint.mimic->offset});
    }
  }

  std::vector<int> wheels_of(const std::vector<std::string>& names, const char* member) {
    std::vector<int> wheels;
    for (const std::string& name : names) {
      const int joint = find_joint(name);
      const auto refuse = [&](const std::string& message, const std::string& expected) {
        mistakes_.push_back({"", 0, key_ + "." + member, message, expected, "\"" + name + "\"", ""});
      };
      if (joint < 0) {
        refuse("the robot has no such joint that moves", "a joint of " + file_.path);
        continue;
      }
      const RobotJoint& wheel = made_.model.joints[std::size_t(joint)];
      const Vec3 axis = zero_[std::size_t(wheel.child)].rotation.rotate(wheel.axis);
      if (wheel.kind != JointKind::hinge || axis.y < kLeftwards)
        refuse("the axis of a wheel must point left", "+Y of the first link");
      if (wheel.motor.effort <= 0) refuse("this joint has no motor", "a limit with an effort above 0");
      wheels.push_back(joint);
    }
    return wheels;
  }

  void add_sides() {
    if (robot_.left_wheels.empty()) return;
    zero_ = calc_base_from_links(made_.model, std::vector<double>(made_.model.joints.size(), 0));
    SideDrive& sides = made_.model.sides;
    sides.left = wheels_of(robot_.left_wheels, "left_wheels");
    sides.right = wheels_of(robot_.right_wheels, "right_wheels");
    if (!sides.any()) return;
    const auto middle = [&](const std::vector<int>& side) {
      double sum = 0;
      for (int i : side)
        sum += zero_[std::size_t(made_.model.joints[std::size_t(i)].child)].translation.y;
      return sum / double(side.size());
    };
    sides.radius = robot_.wheel_radius;
    sides.distance = middle(sides.left) - middle(sides.right);
    if (sides.distance > 0) return;
    mistakes_.push_back({"", 0, key_ + ".left_wheels", "the left wheels are not left of the right ones",
                         "a larger y", "", ""});
  }

  const UrdfFile& file_;
  const RobotItem& robot_;
  std::string key_;
  MeshImporter& importer_;
  MissionRobot made_;
  std::vector<Place> places_;     // by link of the file
  std::vector<int> body_lines_;   // by body
  std::vector<Pose> zero_;        // of the bodies in the base, at the joints' zeros
  std::vector<Diagnostic> mistakes_;
};

}  // namespace

MissionRobot make_urdf_robot(const RobotItem& robot, const std::string& path, const std::string& key,
                             MeshImporter& importer) {
  const UrdfFile file = read_urdf(path);
  return Builder(file, robot, key, importer).build();
}

}  // namespace rubble
