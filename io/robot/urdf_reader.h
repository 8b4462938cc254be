// Robots described in URDF, read by the grammar of its specification.
//
// Links and joints as the file has them, with the lines where they stand: app/robots/urdf_robot.h makes a
// robot of them. What the specification leaves optional has its default; what this reader does not know is named
// in `warnings`, or refused.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/assembly.h"

namespace rubble {

struct UrdfGeometry {
  enum class Kind { box, cylinder, capsule, sphere, mesh };
  Kind kind = Kind::box;
  int line = 0;               // of its <geometry>
  Vec3 size;                  // full edge lengths of a box; unit: m
  double radius = 0, length = 0;  // of a cylinder along Z, of a capsule (length without its ends), of a sphere; unit: m
  std::string file;           // of a mesh: a path that exists
  Vec3 scale{1, 1, 1};        // of a mesh; not 0; negative: mirrored
  Pose link_from_geometry;    // unit: m
  std::optional<Vec3f> colour;  // linear-light albedo, of a visual whose material names one
};

struct UrdfLink {
  std::string name;
  int line = 0;  // in the file
  bool has_inertial = false;  // false: the file gives it no mass, by no <inertial> or one of zeros
  double mass = 0;           // unit: kg; >= 0
  Pose link_from_inertial;   // the centre of mass, and the axes of `inertia`; unit: m
  Mat3 inertia;              // about the centre of mass; unit: kg m2
  std::vector<UrdfGeometry> collisions, visuals;
};

struct UrdfJoint {
  // It stands at multiplier * q + offset of another joint.
  struct Mimic {
    std::string joint;
    double multiplier = 1, offset = 0;
  };
  std::string name;
  int line = 0;
  JointKind kind = JointKind::weld;
  int parent = 0, child = 0;  // indices into the links
  Pose parent_from_child;     // unit: m
  Vec3 axis{1, 0, 0};         // unit length
  double lower = -kNever, upper = kNever;  // unit: rad, m; lower <= upper
  double effort = 0, speed = 0;            // 0: the file gives none; unit: N m or N, rad/s or m/s
  double damping = 0, friction = 0;
  std::optional<Mimic> mimic;
};

inline constexpr double kUrdfFarthest = 1e4;  // of a place, a size or a slider's stop: what is larger has wrong units; unit: m

struct UrdfFile {
  std::string name, path;
  bool fixed = false;             // the root is called `world`: it stands still, as in Gazebo and ROS
  std::vector<UrdfLink> links;    // the root first, parents before children, siblings by the names of their joints
  std::vector<UrdfJoint> joints;  // joints[i].child == i + 1
  std::vector<std::string> warnings;  // what was left out or doubtful, each with file and line
  std::string expanded;               // of a .xacro file, the text that the tool made of it
};

// arguments: of a .xacro file, by name (io/robot/xacro_tool.h). Throws InputError with every mistake, each with
// file and line: what is no URDF, elements of xacro that were not expanded, closed loops, joints that are not
// supported, meshes that are missing.
UrdfFile read_urdf(const std::string& path,
                   const std::vector<std::pair<std::string, std::string>>& arguments = {});

}  // namespace rubble
