// Robots described in URDF, read by liburdfdom.
//
// Links and joints as the file has them, with the lines where they stand: app/robots/urdf_robot.h makes a
// robot of them. Read in a child process first: a hostile file ends that one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/assembly.h"

namespace rubble {

struct UrdfGeometry {
  enum class Kind { box, cylinder, sphere, mesh };
  Kind kind = Kind::box;
  Vec3 size;                  // full edge lengths of a box; unit: m
  double radius = 0, length = 0;  // of a cylinder along Z, of a sphere; unit: m
  std::string file;           // of a mesh: a path that exists
  Vec3 scale{1, 1, 1};        // of a mesh; > 0
  Pose link_from_geometry;    // unit: m
  std::optional<Vec3f> colour;  // linear-light albedo, of a visual whose material names one
};

struct UrdfLink {
  std::string name;
  int line = 0;  // in the file
  bool has_inertial = false;
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
  double lower = -kNever, upper = kNever;  // unit: rad, m; lower <= 0 <= upper
  double effort = 0, speed = 0;            // 0: it has no motor; unit: N m or N, rad/s or m/s
  double damping = 0, friction = 0;
  std::optional<Mimic> mimic;
};

struct UrdfFile {
  std::string name, path;
  std::vector<UrdfLink> links;    // the root first, parents before children
  std::vector<UrdfJoint> joints;  // joints[i].child == i + 1
  std::vector<std::string> warnings;  // what was left out, each with file and line
};

// Throws InputError with every mistake, each with file and line: what is no URDF, closed loops, joints that
// are not supported, meshes that are missing.
UrdfFile read_urdf(const std::string& path);

}  // namespace rubble
