// Articulated debris: slabs on bent rebar, a door on its frame, a chain of facade panels. An
// assembly is a tree of links, each of which is an ordinary piece of an ordinary type, held
// together by joints that spring back, bend for good and break.
//
// Figures are those of scale 1. At scale s, with the material unchanged, lengths grow by s, forces
// by s^2, torques and torsional stiffness by s^3, a slider's stiffness by s; damping grows so that
// the share of critical damping stays the same.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kernel/base/math.h"

namespace rubble {

struct PieceType;

enum class JointKind : std::uint8_t {
  weld,    // permits no motion until it breaks
  hinge,   // turns about Z of the joint's frame
  slider,  // the child moves along X of the joint's frame
  ball,    // turns in every direction
};

inline constexpr int kJointKinds = 4;
// As scripts write them: by kind.
inline constexpr const char* kJointNames[kJointKinds] = {"weld", "hinge", "slider", "ball"};

inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct AssemblyLink {
  int type = 0;             // index into the pile's types
  Pose assembly_from_link;  // of the type's frame, as designed; unit: m
  double scale = 1;         // of this piece within the assembly; range: 0.01 to 100
};

// Everything is measured from the designed pose, where angle and travel are 0. A hinge and a slider
// move by an angle or a travel x; a ball is turned by an angle x about some axis.
//
// The spring's torque is stiffness * x for a hinge (a slider: force) and 2 stiffness sin(x / 2) for
// a ball. The latter is equal for small angles and needs no inverse sine. If the torque would exceed
// `yield`, the rest position of the spring follows the joint: the bend remains.
struct JointType {
  int parent = 0, child = 1;  // indices into the links
  JointKind kind = JointKind::ball;  // the permitted motion
  Pose assembly_from_joint;                // unit: m
  double stiffness = 0;                    // unit: N m/rad, slider N/m; range: 0 to 1e9
  double damping = 0;                      // unit: N m s/rad, slider N s/m; range: 0 to 1e9
  double friction = 0;                     // dry: the joint holds up to this torque, and resists motion
                                           // with it; unit: N m, slider N; range: 0 to 1e9
  double yield = kNever;                   // unit: N m, slider N; > 0
  double break_force = kNever;             // largest force of the joint, mean of a step; unit: N; > 0
  double break_torque = kNever;            // largest torque about the joint, mean of a step; unit: N m; > 0
  double lower = -kNever, upper = kNever;  // limits of x; unit: rad, slider m; lower <= 0 <= upper. A ball
                                           // has only `upper`, from 0 to 3.1 rad
  bool collide = false;  // whether the two links collide with each other
};

// The first link is the root. Every other link is the child of a joint, and its parent is listed before
// it. The first joint of each child forms the tree. Further joints of a child close loops: they hold it
// to another link, and have no spring, friction or stops. 2 to 256 links.
struct AssemblyType {
  std::string name;                 // unique among the assemblies of a pile
  std::vector<AssemblyLink> links;  // the root first
  std::vector<JointType> joints;    // at least one fewer than the links
};

inline constexpr int kMaxLinks = 256;

// Throws InputError naming the member, with `key` as the path of the assembly.
void validate(const AssemblyType& assembly, int types, const std::string& key);

// The convex parts of all links as one rigid piece in the frame of the assembly, to find room for it.
PieceType make_rigid_type(const AssemblyType& assembly, const std::vector<PieceType>& types);

}  // namespace rubble
