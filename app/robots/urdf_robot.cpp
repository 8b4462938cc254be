#include "app/robots/urdf_robot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "app/robots/urdf_parts.h"
#include "io/robot/xacro_tool.h"
#include "kernel/base/error.h"
#include "kernel/geometry/shape.h"

namespace rubble {
namespace {

constexpr double kFriction = 0.7;       // of what the mission says nothing of
constexpr double kFullEffortAt = 0.07;  // error of position control; unit: rad
constexpr double kFullEffortSlide = 0.007;  // of a slider; unit: m
constexpr double kDampingTime = 0.05;   // of position control: damping by stiffness; unit: s
constexpr double kMostGain = 1e9;       // of stiffness and damping
constexpr double kLeftwards = 0.999;    // cosine between a wheel's axis and +Y
constexpr double kUpwards = 0.9;        // between that of steering and Z, less its caster angle
constexpr double kGravity = 9.81;       // unit: m/s2

class Builder {
 public:
  Builder(const UrdfFile& file, const RobotItem& robot, const std::string& key, MeshImporter& importer)
      : file_(file), robot_(robot), key_(key), importer_(importer) {}

  MissionRobot build() {
    made_.model.name = file_.name;
    made_.model.fixed_base = file_.fixed;
    made_.warnings = file_.warnings;
    join_fixed_links();
    if (made_.model.links.size() > std::size_t(kMaxLinks))
      add(file_.links[0].line, file_.name, "too many bodies that move", std::to_string(kMaxLinks) + " at most",
          std::to_string(made_.model.links.size()));
    for (std::size_t i = 0; i < file_.links.size(); ++i) add_shape(file_.links[i], places_[i]);
    add_belts();
    set_urdf_masses(file_, places_, body_lines_, made_.model, made_.warnings, mistakes_);
    add_mimics();
    add_motors();
    add_sides();
    warn_of_ghosts();
    check_bodies();
    if (!mistakes_.empty()) throw InputError(std::move(mistakes_));
    return std::move(made_);
  }

 private:
  void add(int line, const std::string& what, const std::string& message, const std::string& expected,
           const std::string& found) {
    mistakes_.push_back({file_.path, line, what, message, expected, found, ""});
  }

  void refuse_key(const std::string& member, const std::string& message, const std::string& expected,
                  const std::string& found) {
    mistakes_.push_back({"", 0, key_ + "." + member, message, expected, found, ""});
  }

  void warn(int line, const std::string& text) {
    made_.warnings.push_back(file_.path + ":" + std::to_string(line) + ": " + text);
  }

  void start_body(const std::string& name, int line) {
    RobotLink body;
    body.name = name;
    body.friction = robot_.friction.value_or(kFriction);
    made_.model.links.push_back(body);
    body_lines_.push_back(line);
  }

  // A robot on a link `world` begins with what is fixed to that: the frame `world` is the mission's.
  void start_base() {
    const UrdfLink& root = file_.links[0];
    places_.push_back({});
    if (!file_.fixed) return start_body(root.name, root.line);
    for (const UrdfJoint& joint : file_.joints) {
      if (joint.parent != 0 || joint.kind != JointKind::weld) continue;
      base_ = joint.child;
      places_[0].body_from_link = joint.parent_from_child.inverse();
      made_.placed_from_base = joint.parent_from_child;
      return start_body(file_.links[std::size_t(base_)].name, file_.links[std::size_t(base_)].line);
    }
    start_body(file_.name + "_base", root.line);
  }

  void join_fixed_links() {
    start_base();
    for (const UrdfJoint& joint : file_.joints) {
      const UrdfPlace parent = places_[std::size_t(joint.parent)];
      const Pose body_from_child = parent.body_from_link * joint.parent_from_child;
      const UrdfLink& child = file_.links[std::size_t(joint.child)];
      if (joint.child == base_) {
        places_.push_back({0, {}});
      } else if (joint.kind == JointKind::weld && !is_track(child.name)) {
        places_.push_back({parent.body, body_from_child});
        made_.model.frames.push_back({child.name, parent.body, body_from_child});
      } else {
        places_.push_back({int(made_.model.links.size()), {}});
        start_body(child.name, child.line);
        add_joint(joint, parent.body, body_from_child);
      }
    }
  }

  // It moves with its link, but its surface runs: a body of its own.
  bool is_track(const std::string& link) const {
    for (const auto* side : {&robot_.left_tracks, &robot_.right_tracks})
      if (std::find(side->begin(), side->end(), link) != side->end()) return true;
    return false;
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
    joint.motor.effort = from.effort;
    joint.motor.speed = from.speed;
    made_.model.joints.push_back(joint);
    joint_lines_.push_back(from.line);
  }

  void add_shape(const UrdfLink& link, const UrdfPlace& place) {
    const auto body = std::size_t(place.body);
    for (const UrdfGeometry& g : link.collisions) {
      const Pose body_from_part = place.body_from_link * g.link_from_geometry;
      for (ConvexPart part : parts_of(g, link)) {
        for (Vec3& p : part.points) p = body_from_part * p;
        made_.model.links[body].parts.push_back(std::move(part));
      }
    }
    for (const UrdfGeometry& g : link.visuals) {
      try {
        add_urdf_looks(g, place.body_from_link, made_.model, body, importer_, made_.warnings);
      } catch (const InputError& error) {
        add(g.line, link.name, "its visual cannot be drawn: " + error.diagnostics().front().text(), "a mesh that can be read",
            g.file);
      }
    }
  }

  std::vector<ConvexPart> parts_of(const UrdfGeometry& g, const UrdfLink& link) {
    try {
      return make_urdf_parts(g, importer_, made_.warnings);
    } catch (const InputError& error) {
      add(g.line, link.name, "its mesh has no use as a solid: " + error.diagnostics().front().text(),
          "a mesh with a volume", g.file);
      return {};
    }
  }

  int find_joint(const std::string& name) const {
    const std::vector<RobotJoint>& joints = made_.model.joints;
    const auto at = std::find_if(joints.begin(), joints.end(),
                                 [&](const RobotJoint& joint) { return joint.name == name; });
    return at == joints.end() ? -1 : int(at - joints.begin());
  }

  const UrdfJoint* find_in_file(const std::string& name) const {
    for (const UrdfJoint& joint : file_.joints)
      if (joint.name == name) return &joint;
    return nullptr;
  }

  // What follows a joint that follows another follows that one.
  void add_mimics() {
    for (const UrdfJoint& joint : file_.joints) {
      if (!joint.mimic || joint.kind == JointKind::weld) continue;
      MimicJoint mimic{find_joint(joint.name), 0, 1, 0};
      const UrdfJoint* led = &joint;
      for (std::size_t i = 0; led && led->mimic && i <= file_.joints.size(); ++i) {
        mimic.offset += mimic.multiplier * led->mimic->offset;
        mimic.multiplier *= led->mimic->multiplier;
        led = find_in_file(led->mimic->joint);
      }
      mimic.of = led && !led->mimic ? find_joint(led->name) : -1;
      if (mimic.of < 0)
        warn(joint.line, "the joint `" + joint.name + "` moves by itself: `" + joint.mimic->joint +
                             "`, which it mimics, is no joint that moves");
      else
        made_.model.mimics.push_back(mimic);
    }
  }

  // By `efforts` or `speeds` of the mission: values of joints.
  void apply(const std::vector<std::pair<std::string, double>>& values, const char* member, double RobotMotor::*figure) {
    for (const auto& [name, value] : values) {
      const int joint = find_joint(name);
      if (joint < 0)
        refuse_key(member, "the robot has no such joint that moves", "a joint of " + file_.path, "\"" + name + "\"");
      else
        made_.model.joints[std::size_t(joint)].motor.*figure = value;
    }
  }

  // What the file gives no effort: a driven wheel could spin on the spot, a mimic is as strong as what it follows.
  void add_efforts() {
    std::vector<RobotJoint>& joints = made_.model.joints;
    for (const auto* side : {&robot_.left_wheels, &robot_.right_wheels})
      for (const std::string& name : *side) {
        const int wheel = find_joint(name);
        if (wheel < 0 || joints[std::size_t(wheel)].motor.effort > 0) continue;
        const double effort = made_.model.mass() * kGravity * robot_.wheel_radius;
        joints[std::size_t(wheel)].motor.effort = effort;
        char text[32];
        std::snprintf(text, sizeof text, "%.3g N m", effort);
        warn(joint_lines_[std::size_t(wheel)], "the wheel `" + name + "` has no effort in the file: its motor gets " + text +
                                                   ", the robot's weight times wheel_radius; `efforts` gives it another");
      }
    for (const MimicJoint& mimic : made_.model.mimics) {
      RobotMotor &own = joints[std::size_t(mimic.joint)].motor, &led = joints[std::size_t(mimic.of)].motor;
      if (own.effort <= 0) own.effort = led.effort;
    }
  }

  void add_motors() {
    apply(robot_.efforts, "efforts", &RobotMotor::effort);
    apply(robot_.speeds, "speeds", &RobotMotor::speed);
    add_efforts();
    std::string passive;
    int line = 0;
    for (std::size_t i = 0; i < made_.model.joints.size(); ++i) {
      RobotJoint& joint = made_.model.joints[i];
      RobotMotor& motor = joint.motor;
      if (motor.effort <= 0) {
        if (passive.empty()) line = joint_lines_[i];
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

  std::vector<int> wheels_of(const std::vector<std::string>& names, const char* member) {
    std::vector<int> wheels;
    for (const std::string& name : names) {
      const int joint = find_joint(name);
      if (joint < 0) {
        refuse_key(member, "the robot has no such joint that moves", "a joint of " + file_.path, "\"" + name + "\"");
        continue;
      }
      const RobotJoint& wheel = made_.model.joints[std::size_t(joint)];
      const Vec3 axis = zero_[std::size_t(wheel.child)].rotation.rotate(wheel.axis);
      if (wheel.kind != JointKind::hinge || axis.y < kLeftwards)
        refuse_key(member, "the axis of a wheel must point left", "+Y of the first link", "\"" + name + "\"");
      wheels.push_back(joint);
    }
    return wheels;
  }

  // Of one side: indices of the links. Their surface runs about the base's Y axis.
  std::vector<int> tracks_of(const std::vector<std::string>& names, const char* member, int side) {
    std::vector<int> tracks;
    std::vector<RobotLink>& links = made_.model.links;
    for (const std::string& name : names) {
      const auto at = std::find_if(links.begin(), links.end(), [&](const RobotLink& link) { return link.name == name; });
      if (at == links.end()) {
        refuse_key(member, "the robot has no such link", "a link of " + file_.path, "\"" + name + "\"");
        continue;
      }
      tracks.push_back(int(at - links.begin()));
      if (at->parts.empty())
        add(body_lines_[std::size_t(tracks.back())], name, "a track has no <collision>, so it moves nothing", "a shape", "none");
      at->belt_axis = zero_[std::size_t(tracks.back())].rotation.conjugate().rotate({0, 1, 0});
      at->belt_speed_limit = robot_.track_speed;
      at->belt_side = side;
    }
    return tracks;
  }

  // Of tracks, in the middle of their shapes.
  Vec3 middle_of(const std::vector<int>& tracks) const {
    Vec3 sum;
    for (const int track : tracks) {
      Aabb reach;
      for (const ConvexPart& part : made_.model.links[std::size_t(track)].parts)
        for (const Vec3& p : part.points) reach.include(zero_[std::size_t(track)] * p);
      sum += (reach.min + reach.max) * 0.5;
    }
    return sum * (1 / double(tracks.size()));
  }

  void add_belts() {
    if (robot_.left_tracks.empty()) return;
    zero_ = calc_base_from_links(made_.model, std::vector<double>(made_.model.joints.size(), 0));
    SideDrive& sides = made_.model.sides;
    sides.left = tracks_of(robot_.left_tracks, "left_tracks", 1);
    sides.right = tracks_of(robot_.right_tracks, "right_tracks", -1);
    if (!sides.any() || !mistakes_.empty()) return;
    sides.belts = true;
    refuse_odom_link("left_tracks");
    const Vec3 left = middle_of(sides.left), right = middle_of(sides.right);
    sides.distance = left.y - right.y, sides.axle = 0.5 * (left.x + right.x);
    if (sides.distance <= 0) refuse_key("left_tracks", "the left tracks are not left of the right ones", "a larger y", "");
  }

  // key: that gives the robot odometry.
  void refuse_odom_link(const std::string& key) {
    for (const UrdfLink& link : file_.links)
      if (link.name == "odom") add(link.line, link.name, "is the frame of the odometry", "another name, or no `" + key + "`", "");
  }

  // Of a wheel's middle, in the base.
  Vec3 place_of(int wheel) const { return zero_[std::size_t(made_.model.joints[std::size_t(wheel)].child)].translation; }
  Vec3 mean_place(const std::vector<int>& wheels) const {
    Vec3 sum;
    for (const int wheel : wheels) sum += place_of(wheel);
    return sum * (1 / double(wheels.size()));
  }

  void add_sides() {
    if (robot_.left_wheels.empty()) return;
    zero_ = calc_base_from_links(made_.model, std::vector<double>(made_.model.joints.size(), 0));
    SideDrive& sides = made_.model.sides;
    sides.left = wheels_of(robot_.left_wheels, "left_wheels");
    sides.right = wheels_of(robot_.right_wheels, "right_wheels");
    if (!sides.any()) return;
    refuse_odom_link("left_wheels");
    sides.radius = robot_.wheel_radius;
    sides.distance = mean_place(sides.left).y - mean_place(sides.right).y;
    if (sides.distance <= 0) refuse_key("left_wheels", "the left wheels are not left of the right ones", "a larger y", "");
    refuse_rollers();
    if (mistakes_.empty()) add_steering();
  }

  // Of mecanum and omni wheels: these also roll sideways, and turn the robot by another law.
  void refuse_rollers() {
    const std::vector<RobotJoint>& joints = made_.model.joints;
    for (const auto* side : {&made_.model.sides.left, &made_.model.sides.right})
      for (const int wheel : *side)
        for (const RobotJoint& roller : joints)
          if (roller.parent == joints[std::size_t(wheel)].child && roller.kind != JointKind::weld)
            return refuse_key(side == &made_.model.sides.left ? "left_wheels" : "right_wheels",
                              "the wheel has rollers: mecanum and omni wheels do not drive as these do; a function as `control` "
                              "gives each wheel its speed",
                              "wheels without joints of their own",
                              "\"" + joints[std::size_t(wheel)].name + "\" with \"" + roller.name + "\"");
  }

  // The joints between the base and that one, nearest first.
  std::vector<int> chain_to(int joint) const {
    std::vector<int> chain;
    const std::vector<RobotJoint>& joints = made_.model.joints;
    for (int link = joints[std::size_t(joint)].parent; link > 0; link = joints[std::size_t(link) - 1].parent) chain.push_back(link - 1);
    return chain;
  }

  // Those that are driven, and others that turn freely as they do, as high above the ground.
  std::vector<int> find_wheels() const {
    const SideDrive& sides = made_.model.sides;
    std::vector<int> wheels = sides.left;
    wheels.insert(wheels.end(), sides.right.begin(), sides.right.end());
    const double height = mean_place(wheels).z;
    for (int i = 0; i < int(made_.model.joints.size()); ++i) {
      const RobotJoint& joint = made_.model.joints[std::size_t(i)];
      const Vec3 axis = zero_[std::size_t(joint.child)].rotation.rotate(joint.axis);
      if (joint.kind == JointKind::hinge && std::abs(axis.y) > kLeftwards && !(joint.upper - joint.lower < kNever) &&
          std::abs(place_of(i).z - height) < 0.5 * sides.radius && std::find(wheels.begin(), wheels.end(), i) == wheels.end())
        wheels.push_back(i);
    }
    return wheels;
  }

  // Turns about the vertical axis within limits, by a motor. What turns round and round is a castor's.
  double steering_sign(int joint) const {
    const RobotJoint& j = made_.model.joints[std::size_t(joint)];
    const double up = zero_[std::size_t(j.child)].rotation.rotate(j.axis).z;
    return j.kind == JointKind::hinge && std::abs(up) > kUpwards && j.upper - j.lower < kNever && j.motor.effort > 0 ? std::copysign(1.0, up)
                                                                                                                    : 0;
  }

  // A robot with steered wheels is a car. If `steering` does not say so, it would be dragged sideways over them.
  void add_steering() {
    SideDrive& sides = made_.model.sides;
    std::vector<int> steering, fixed_driven, fixed_others;
    for (const std::string& name : robot_.steering) {
      steering.push_back(find_joint(name));
      if (steering.back() < 0 || steering_sign(steering.back()) == 0)
        return refuse_key("steering", "not a joint that steers: a hinge about the vertical axis, with limits and an effort",
                          "such a joint of " + file_.path, "\"" + name + "\"");
    }
    const std::size_t driven = sides.left.size() + sides.right.size();
    const std::vector<int> wheels = find_wheels();
    for (std::size_t k = 0; k < wheels.size(); ++k) {
      const std::vector<int> chain = chain_to(wheels[k]);
      const auto steers = std::find_if(chain.begin(), chain.end(), [&](int joint) { return steering_sign(joint) != 0; });
      if (steers == chain.end()) {
        (k < driven ? fixed_driven : fixed_others).push_back(wheels[k]);
        continue;
      }
      const std::string& name = made_.model.joints[std::size_t(*steers)].name;
      if (std::find(steering.begin(), steering.end(), *steers) == steering.end())
        return refuse_key("steering", "the joint steers the wheel `" + made_.model.joints[std::size_t(wheels[k])].name + "`",
                          "\"" + name + "\" in `steering`", robot_.steering.empty() ? "no `steering`" : "others");
      const Vec3 place = place_of(wheels[k]);
      sides.steered.push_back({*steers, steering_sign(*steers), place.x, place.y, k < driven ? wheels[k] : -1});
    }
    const std::vector<int>& axle = !fixed_driven.empty() ? fixed_driven : !fixed_others.empty() && !steering.empty() ? fixed_others : wheels;
    sides.axle = mean_place(axle).x;
    for (const int joint : steering) {
      const auto wheel = std::find_if(sides.steered.begin(), sides.steered.end(), [&](const SteeredWheel& w) { return w.joint == joint; });
      const bool ahead = wheel != sides.steered.end() && std::abs(wheel->x - sides.axle) > 0.1 * sides.radius;
      if (ahead) continue;
      return refuse_key("steering", wheel == sides.steered.end() ? "the joint carries no wheel" : "its wheel is on the axle that does not turn",
                        "a joint that steers a wheel before or behind the others", "\"" + made_.model.joints[std::size_t(joint)].name + "\"");
    }
  }

  // What the world would refuse, with the line of the file.
  void check_bodies() {
    if (!mistakes_.empty()) return;
    const std::vector<PieceType> types = make_link_types(made_.model);
    for (std::size_t b = 0; b < types.size(); ++b) {
      try {
        compile_shape(types[b], types[b].name);
      } catch (const InputError& error) {
        for (const Diagnostic& d : error.diagnostics())
          add(body_lines_[b], made_.model.links[b].name, d.key + ": " + d.message, d.expected, d.found);
      }
    }
    for (std::size_t j = 0; j < made_.model.joints.size(); ++j)
      for (const double figure : {made_.model.joints[j].damping, made_.model.joints[j].friction})
        if (figure > kMostGain)
          add(joint_lines_[j], made_.model.joints[j].name, "too much damping or friction", "1e9 at most", std::to_string(figure));
  }

  // What has no collision shape falls through everything, if nothing holds it.
  void warn_of_ghosts() {
    const std::vector<RobotLink>& links = made_.model.links;
    if (!file_.fixed && std::all_of(links.begin(), links.end(), [](const RobotLink& link) { return link.parts.empty(); }))
      warn(file_.links[0].line, "the robot has no <collision>: it touches nothing and falls through the ground");
  }

  const UrdfFile& file_;
  const RobotItem& robot_;
  std::string key_;
  MeshImporter& importer_;
  MissionRobot made_;
  int base_ = -1;                  // the link of the file that is the first body, if not its root
  std::vector<UrdfPlace> places_;  // by link of the file
  std::vector<int> body_lines_, joint_lines_;  // by body, by joint of the model
  std::vector<Pose> zero_;         // of the bodies in the base, at the joints' zeros
  std::vector<Diagnostic> mistakes_;
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
