#include "app/robots/urdf_robot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/robots/urdf_draft.h"
#include "app/robots/urdf_parts.h"
#include "io/robot/xacro_tool.h"
#include "kernel/base/error.h"
#include "kernel/base/number_text.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

constexpr double kFriction = 0.7;       // of what the mission says nothing of
constexpr double kFullEffortAt = 0.07;  // error of position control; unit: rad
constexpr double kFullEffortSlide = 0.007;  // of a slider; unit: m
constexpr double kDampingTime = 0.05;   // of position control: damping by stiffness; unit: s
constexpr double kMostGain = 1e9;       // of stiffness and damping
constexpr double kGravity = 9.81;       // unit: m/s2

class Builder : private UrdfDraft {
 public:
  Builder(const UrdfFile& from, const RobotItem& mission, const std::string& at, MeshImporter& importer)
      : UrdfDraft{from, mission, at}, importer_(importer) {}

  MissionRobot build() {
    made.model.name = file.name;
    made.model.fixed_base = file.fixed;
    made.warnings = file.warnings;
    join_fixed_links();
    if (made.model.links.size() > std::size_t(kMaxLinks))
      add_mistake(file.links[0].line, file.name, "too many bodies that move", std::to_string(kMaxLinks) + " at most",
          std::to_string(made.model.links.size()));
    for (std::size_t i = 0; i < file.links.size(); ++i) add_shape(file.links[i], places_[i]);
    add_tracks(*this);
    set_urdf_masses(file, places_, body_lines, made.model, made.warnings, mistakes);
    add_mimics();
    add_motors();
    add_wheels(*this);
    warn_of_ghosts();
    check_bodies();
    if (!mistakes.empty()) throw InputError(std::move(mistakes));
    return std::move(made);
  }

 private:
  void warn(int line, const std::string& text) {
    made.warnings.push_back(file.path + ":" + std::to_string(line) + ": " + text);
  }

  void start_body(const std::string& name, int line) {
    RobotLink body;
    body.name = name;
    body.friction = robot.friction.value_or(kFriction);
    made.model.links.push_back(body);
    body_lines.push_back(line);
  }

  // A robot on a link `world` begins with what is fixed to that: the frame `world` is the mission's.
  void start_base() {
    const UrdfLink& root = file.links[0];
    places_.push_back({});
    if (!file.fixed) return start_body(root.name, root.line);
    for (const UrdfJoint& joint : file.joints) {
      if (joint.parent != 0 || joint.kind != JointKind::weld) continue;
      base_ = joint.child;
      places_[0].body_from_link = joint.parent_from_child.inverse();
      made.placed_from_base = joint.parent_from_child;
      return start_body(file.links[std::size_t(base_)].name, file.links[std::size_t(base_)].line);
    }
    start_body(file.name + "_base", root.line);
  }

  void join_fixed_links() {
    start_base();
    for (const UrdfJoint& joint : file.joints) {
      const UrdfPlace parent = places_[std::size_t(joint.parent)];
      const Pose body_from_child = parent.body_from_link * joint.parent_from_child;
      const UrdfLink& child = file.links[std::size_t(joint.child)];
      if (joint.child == base_) {
        places_.push_back({0, {}});
      } else if (joint.kind == JointKind::weld && !is_track(child.name)) {
        places_.push_back({parent.body, body_from_child});
        made.model.frames.push_back({child.name, parent.body, body_from_child});
      } else {
        places_.push_back({int(made.model.links.size()), {}});
        start_body(child.name, child.line);
        add_joint(joint, parent.body, body_from_child);
      }
    }
  }

  // It moves with its link, but its surface runs: a body of its own.
  bool is_track(const std::string& link) const {
    for (const auto* side : {&robot.left_tracks, &robot.right_tracks})
      if (std::find(side->begin(), side->end(), link) != side->end()) return true;
    return false;
  }

  void add_joint(const UrdfJoint& from, int parent, const Pose& parent_from_child) {
    RobotJoint joint;
    joint.name = from.name;
    joint.parent = parent;
    joint.child = int(made.model.links.size()) - 1;
    joint.kind = from.kind;
    joint.parent_from_child = parent_from_child;
    joint.axis = from.axis;
    joint.lower = from.lower, joint.upper = from.upper;
    joint.damping = from.damping, joint.friction = from.friction;
    joint.motor.effort = from.effort;
    joint.motor.speed = from.speed;
    made.model.joints.push_back(joint);
    joint_lines.push_back(from.line);
  }

  void add_shape(const UrdfLink& link, const UrdfPlace& place) {
    const auto body = std::size_t(place.body);
    for (const UrdfGeometry& g : link.collisions) {
      const Pose body_from_part = place.body_from_link * g.link_from_geometry;
      for (ConvexPart part : parts_of(g, link)) {
        for (Vec3& p : part.points) p = body_from_part * p;
        made.model.links[body].parts.push_back(std::move(part));
      }
    }
    for (const UrdfGeometry& g : link.visuals) {
      try {
        add_urdf_looks(g, place.body_from_link, made.model, body, importer_, made.warnings);
      } catch (const InputError& error) {
        add_mistake(g.line, link.name, "its visual cannot be drawn: " + error.diagnostics().front().text(), "a mesh that can be read",
            g.file);
      }
    }
  }

  std::vector<ConvexPart> parts_of(const UrdfGeometry& g, const UrdfLink& link) {
    try {
      return make_urdf_parts(g, importer_, made.warnings);
    } catch (const InputError& error) {
      add_mistake(g.line, link.name, "its mesh has no use as a solid: " + error.diagnostics().front().text(),
          "a mesh with a volume", g.file);
      return {};
    }
  }

  const UrdfJoint* find_in_file(const std::string& name) const {
    for (const UrdfJoint& joint : file.joints)
      if (joint.name == name) return &joint;
    return nullptr;
  }

  // What follows a joint that follows another follows that one.
  void add_mimics() {
    for (const UrdfJoint& joint : file.joints) {
      if (!joint.mimic || joint.kind == JointKind::weld) continue;
      MimicJoint mimic{find_joint(joint.name), 0, 1, 0};
      const UrdfJoint* led = &joint;
      for (std::size_t i = 0; led && led->mimic && i <= file.joints.size(); ++i) {
        mimic.offset += mimic.multiplier * led->mimic->offset;
        mimic.multiplier *= led->mimic->multiplier;
        led = find_in_file(led->mimic->joint);
      }
      mimic.of = led && !led->mimic ? find_joint(led->name) : -1;
      if (mimic.of < 0)
        warn(joint.line, "the joint `" + joint.name + "` moves by itself: `" + joint.mimic->joint +
                             "`, which it mimics, is no joint that moves");
      else
        made.model.mimics.push_back(mimic);
    }
  }

  // By `efforts` or `speeds` of the mission: values of joints.
  void apply(const std::vector<std::pair<std::string, double>>& values, const char* member, double RobotMotor::*figure) {
    for (const auto& [name, value] : values) {
      const int joint = find_joint(name);
      if (joint < 0)
        refuse_key(member, "the robot has no such joint that moves", "a joint of " + file.path, "\"" + name + "\"");
      else
        made.model.joints[std::size_t(joint)].motor.*figure = value;
    }
  }

  // What the file gives no effort: a driven wheel could spin on the spot, a mimic is as strong as what it follows.
  void add_efforts() {
    std::vector<RobotJoint>& joints = made.model.joints;
    for (const auto* side : {&robot.left_wheels, &robot.right_wheels})
      for (const std::string& name : *side) {
        const int wheel = find_joint(name);
        if (wheel < 0 || joints[std::size_t(wheel)].motor.effort > 0) continue;
        const double effort = made.model.mass() * kGravity * robot.wheel_radius;
        joints[std::size_t(wheel)].motor.effort = effort;
        char text[32];
        std::snprintf(text, sizeof text, "%.3g N m", effort);
        warn(joint_lines[std::size_t(wheel)], "the wheel `" + name + "` has no effort in the file: its motor gets " + text +
                                                   ", the robot's weight times wheel_radius; `efforts` gives it another");
      }
    for (const MimicJoint& mimic : made.model.mimics) {
      RobotMotor &own = joints[std::size_t(mimic.joint)].motor, &led = joints[std::size_t(mimic.of)].motor;
      if (own.effort <= 0) own.effort = led.effort;
    }
  }

  void add_motors() {
    apply(robot.efforts, "efforts", &RobotMotor::effort);
    apply(robot.speeds, "speeds", &RobotMotor::speed);
    add_efforts();
    std::string passive;
    int line = 0;
    for (std::size_t i = 0; i < made.model.joints.size(); ++i) {
      RobotJoint& joint = made.model.joints[i];
      RobotMotor& motor = joint.motor;
      if (motor.effort <= 0) {
        if (passive.empty()) line = joint_lines[i];
        passive += (passive.empty() ? "`" : ", `") + joint.name + "`";
        continue;
      }
      const bool slides = joint.kind == JointKind::slider, turns_round = !(joint.upper - joint.lower < kNever);
      motor.stiffness = std::min(kMostGain, motor.effort / (slides ? kFullEffortSlide : kFullEffortAt));
      motor.damping = std::min(kMostGain, turns_round && motor.speed > 0 ? 10 * motor.effort / motor.speed
                                                                         : kDampingTime * motor.stiffness);
    }
    if (!passive.empty())
      warn(line, "joints without an effort in their <limit> have no motor: " + passive +
                     "; `efforts = { NAME = ... }` gives them one");
  }

  // What the world would refuse, with the line of the file.
  void check_bodies() {
    if (!mistakes.empty()) return;
    const std::vector<PieceType> types = make_link_types(made.model);
    for (std::size_t b = 0; b < types.size(); ++b) {
      try {
        compile_shape(types[b], types[b].name);
      } catch (const InputError& error) {
        for (const Diagnostic& d : error.diagnostics())
          add_mistake(body_lines[b], made.model.links[b].name, d.key + ": " + d.message, d.expected, d.found);
      }
    }
    for (std::size_t j = 0; j < made.model.joints.size(); ++j)
      for (const double figure : {made.model.joints[j].damping, made.model.joints[j].friction})
        if (figure > kMostGain)
          add_mistake(joint_lines[j], made.model.joints[j].name, "too much damping or friction", "1e9 at most", plain_text(figure));
  }

  // What has no collision shape falls through everything, if nothing holds it.
  void warn_of_ghosts() {
    const std::vector<RobotLink>& links = made.model.links;
    if (!file.fixed && std::all_of(links.begin(), links.end(), [](const RobotLink& link) { return link.parts.empty(); }))
      warn(file.links[0].line, "the robot has no <collision>: it touches nothing and falls through the ground");
  }

  MeshImporter& importer_;
  int base_ = -1;                  // the link of the file that is the first body, if not its root
  std::vector<UrdfPlace> places_;  // by link of the file
};

}  // namespace

MissionRobot make_urdf_robot(const RobotItem& robot, const std::string& path, const std::string& key,
                             MeshImporter& importer) {
  if (!robot.urdf_arguments.empty() && !is_xacro_file(path))
    throw InputError({"", 0, key + ".urdf_arguments", "the file takes no arguments", "a .xacro file", path, ""});
  const UrdfFile file = read_urdf(path, robot.urdf_arguments);
  return Builder(file, robot, key, importer).build();
}

}  // namespace rubble
