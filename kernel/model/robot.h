// Robots as data: links with masses, convex collision parts and looks; joints with limits, friction
// and motors; surfaces that move (the belts of tracks). Read by World::Robots::add(); made by
// kernel/robot for the bundled ones and from URDF files by io/robot.
//
// Frames are those of URDF: the frame of a link is that of its parent joint at the joint's zero. The frame of
// the first link is that of the robot (`base_link`: X forward, Z up). SI.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kernel/base/mesh.h"
#include "kernel/model/assembly.h"
#include "kernel/model/everting_tube.h"
#include "kernel/model/pile.h"

namespace rubble {

struct RobotLink {
  std::string name;  // unique among the links: base_link, as URDF has it
  double mass = 0;       // unit: kg; > 0
  Vec3 centre_of_mass;   // in the link's frame; unit: m
  Mat3 inertia;          // about the centre of mass, along the link's axes; unit: kg m2; positive
                         // definite, no principal moment above the sum of the other two
  std::vector<ConvexPart> parts;  // collision parts in the link's frame; none: no contacts
  double friction = 0.7;          // Coulomb, against concrete, as PieceType::friction; range: 0 to 2
  // A belt runs around the link about this axis (link's frame, unit length; zero: no belt). A surface with the
  // outward normal n moves along axis x n. With Y to the left, a positive speed drives forwards. At the ends of
  // the axis, where this direction does not exist, the surface stands still.
  Vec3 belt_axis;
  double belt_speed_limit = 0;  // unit: m/s; >= 0
  int belt_side = 0;            // of a belt that a twist drives: 1: left, -1: right; 0: none does
  // The tip of a growing robot grows along this axis (link's frame, unit length; zero: no tip). Its wall turns
  // outwards, so the surface at its sides stands still while the tip advances.
  Vec3 eversion_axis;
  // Visual mesh in the link's frame; if empty, the collision parts are drawn.
  TriangleMesh looks;
};

// What drives a hinge or a slider. Its torque is
//   stiffness (position - q) + damping (speed - u) + torque
// in every mode of MotorMode, with the gains that the mode does not use set to 0; never beyond
// +-effort. It is found with the contacts of a substep, so that no gain makes it unstable.
struct RobotMotor {
  double effort = 0;     // unit: N m, slider N; 0: no motor
  double speed = 0;      // to which it drives the joint at most; unit: rad/s, slider m/s; 0: no limit
  double stiffness = 0;  // of position control; unit: N m/rad, slider N/m
  double damping = 0;    // of position and of velocity control; unit: N m s/rad, slider N s/m
};

struct RobotJoint {
  std::string name;  // unique among the joints
  int parent = 0, child = 1;  // indices into the links
  JointKind kind = JointKind::hinge;  // weld, hinge or slider
  Pose parent_from_child;  // at the joint's zero; unit: m
  Vec3 axis{0, 0, 1};      // of rotation or sliding, in the child's frame; unit length
  double lower = -kNever, upper = kNever;  // unit: rad, slider m; lower <= upper
  double damping = 0;      // unit: N m s/rad, slider N s/m
  double friction = 0;     // dry; unit: N m, slider N
  RobotMotor motor;  // effort 0: the joint is passive
  double start = 0;        // initial position, within the limits; unit: rad, slider m
};

// A frame on a link, such as that of a camera: a link of a URDF file that is fixed to another link.
struct RobotFrame {
  std::string name;
  int link = 0;
  Pose link_from_frame;  // unit: m
};

// A servo keeps `joint` at multiplier * q + offset, where q is the position of `of`. `of` is not a mimic joint.
struct MimicJoint {
  int joint = 0, of = 0;
  double multiplier = 1, offset = 0;
};

// A wheel that a joint turns about the vertical axis, as those in front of a car.
struct SteeredWheel {
  int joint = 0;        // that steers
  double sign = 1;      // of its axis; 1: upwards
  double x = 0, y = 0;  // of the wheel in the base; unit: m
  int driven = -1;      // the joint of the wheel, if that is driven, too
};

// Differential drive: belts, or wheels that skid or turn in place; with steered wheels a car (Ackermann).
struct SideDrive {
  std::vector<int> left, right;  // indices of the wheels' joints, or of the links with belts
  bool belts = false;
  double radius = 0;    // of the wheels; unit: m
  double distance = 0;  // between the sides; unit: m
  double axle = 0;      // where they are along X: the robot turns about a point beside it; of a car, of its unsteered wheels; unit: m
  std::vector<SteeredWheel> steered{};

  bool any() const { return !left.empty() && !right.empty(); }
};

// A spot light on a link, along X of its own frame. It has no collision parts.
struct RobotLamp {
  int link = 0;
  Pose link_from_lamp;        // unit: m
  double intensity_cd = 100;  // range: 0 to 100000
  double cone_deg = 70;       // full angle; range: 1 to 170
};

// Joints are in the order of their children, parents first: joints[i].child == i + 1. 1 to 256 links. A robot with
// a tube has these links: the base, which is staked to the ground; the links of the tube on hinges about Y and Z in
// turn; and the tip, on a slider with the motor of growth.
struct RobotModel {
  std::string name;                // prefix of topics and files
  std::vector<RobotLink> links;    // the first is the base
  std::vector<RobotJoint> joints;  // one fewer than the links
  bool fixed_base = false;         // the first link is bolted to the ground
  std::vector<RobotFrame> frames;  // additional frames; their names differ from those of links
  std::vector<MimicJoint> mimics;
  SideDrive sides;  // for twists and odometry; without it a robot has neither
  std::vector<RobotLamp> lamps;      // that shine; empty by default
  RobotLamp headlamp;                // place of the lamp in the visual mesh, else the origin of the base
  std::optional<EvertingTube> tube;  // of a growing robot

  double mass() const;  // unit: kg
  std::size_t lead() const { return tube ? links.size() - 1 : 0; }  // the link that defines the robot's path
};

enum class MotorMode : std::int32_t { off, torque, velocity, position };

struct MotorCommand {
  MotorMode mode = MotorMode::off;  // quantity of `target`
  double target = 0;                // unit: N m, rad/s or rad; of a slider N, m/s or m
};

// Command of a controller. It holds until the next command.
struct RobotCommand {
  std::vector<MotorCommand> joints;  // by joint; ignored for joints without a motor
  std::vector<double> belts;         // speed of the belt by link; unit: m/s; ignored without a belt
  // Curvature of the part of a tube that grows from now on, to the left and upwards; unit: 1/m
  double curve_left = 0, curve_up = 0;
};

// State of a robot after a step.
struct RobotState {
  struct Link {
    Pose world_from_link;  // of the link's frame; unit: m
    Vec3 linear, angular;         // of the link's frame's origin, in the world; unit: m/s, rad/s
    Vec3 contact_force, contact_moment;  // of all contacts, mean of the step, the moment about the
                                         // centre of mass; in the world; unit: N, N m
    double belt_speed = 0;        // unit: m/s
  };
  struct Joint {
    double position = 0, speed = 0;  // unit: rad, rad/s; slider m, m/s
    double torque = 0;               // of the motor, mean of the step; unit: N m, slider N
    double work = 0;                 // of the motor since the robot was put down; unit: J
    Vec3 load_force, load_moment;    // from the joint on the child, the moment about the joint; mean of
                                     // the step; in the world; unit: N, N m
  };
  std::vector<Link> links;    // in the order of RobotModel::links
  std::vector<Joint> joints;  // in the order of RobotModel::joints
  // Grown length of a tube and force of its tip; 0 without a tube. Links that have not grown are folded up in
  // the tip; the joint of growth is at `length`. unit: m, N
  double length = 0, tip_force = 0;
  bool lost = false;          // it left the world; all other members are those of that moment
};

// A link against a piece, the ground or another link of the same robot.
struct RobotContact {
  int link = 0;           // index into RobotModel::links
  int piece = -1;         // -1: the ground
  Vec3 point, normal;     // centre of pressure; the normal points towards the link; in the world; unit: m
  double separation = 0;  // of the deepest point; negative: overlap; unit: m
  double force = 0;       // normal, mean of the step; unit: N
};

// Throws InputError naming the member, with `key` as the path of the robot.
void validate(const RobotModel& model, const std::string& key);

// By link: base_from_link at the joints' positions (by joint; empty: their starts). unit: m, rad
std::vector<Pose> calc_base_from_links(const RobotModel& model, const std::vector<double>& q = {});

// The links as piece types, and as an assembly of them; types are numbered from `first_type`.
std::vector<PieceType> make_link_types(const RobotModel& model);
AssemblyType make_assembly(const RobotModel& model, int first_type);

}  // namespace rubble
