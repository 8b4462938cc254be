// A settled pile as physics engines see it: models of rigid links with masses, convex parts, friction and joints, the
// robots beside them, and cameras. Built once; mjcf_writer.cpp, sdf_writer.cpp, urdf_scene_writer.cpp and
// usd_writer.cpp write it. Lengths in metres, masses in kg, angles in rad; world frame right-handed, Z up.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh/pile_model.h"
#include "kernel/geometry/hull.h"
#include "kernel/model/robot.h"

namespace rubble {

// The convex parts that the kernel collides, of one type of piece or of one link of a robot. Frame: that of the type or
// the link; at scale 1.
struct SimShape {
  std::string name;  // unique among the shapes
  std::vector<Hull> hulls;
};

// A mesh or a shape, or both, on a link.
struct SimPart {
  int mesh = -1;        // index into SimScene::meshes; -1: it is not seen
  int shape = -1;       // index into SimScene::shapes; -1: it has no contacts
  double scale = 1;     // of mesh and shape; > 0
  Pose link_from_part;  // unit: m
  double friction = 0.8;  // Coulomb, against concrete; of a pair the kernel takes the geometric mean; range: 0 to 2
};

struct SimLink {
  std::string name;     // unique in its model; of pieces unique in the scene
  std::string label;    // class: the name of the asset, "robot", "grit", "road"
  std::int32_t number = -1;  // in the stream `instance`; -1: it has none
  Pose world_from_link;
  // Without meaning for a link that never moves.
  double mass = 0;      // unit: kg
  Vec3 centre_of_mass;  // in the link's frame; unit: m
  Mat3 inertia;         // about the centre of mass, along the link's axes; unit: kg m2
  std::vector<SimPart> parts;
};

enum class SimDrive { none, torque, velocity, position };

// A joint turns or slides by `position` from the pose in which the frames of parent and child are equal.
struct SimJoint {
  std::string name;  // unique in its model
  int parent = 0, child = 1;  // indices into the links of the model
  JointKind kind = JointKind::hinge;
  Pose parent_from_joint, child_from_joint;  // unit: m
  Vec3 axis{0, 0, 1};     // of a hinge or slider, in the joint's frame; unit length
  double position = 0;    // as exported; of a ball without meaning; unit: rad, slider m
  double lower = -kNever, upper = kNever;  // of a ball only `upper`; unit: rad, slider m
  double stiffness = 0;   // of a passive spring; unit: N m/rad, slider N/m
  double rest = 0;        // of that spring; unit: rad, slider m
  double damping = 0;     // unit: N m s/rad, slider N s/m
  double friction = 0;    // dry; unit: N m, slider N
  bool loop = false;      // closes a loop; without spring, friction and limits
  SimDrive drive = SimDrive::none;
  double effort = 0;      // of the motor; unit: N m, slider N
  double speed = 0;       // limit of the motor; 0: none; unit: rad/s, slider m/s
  double drive_stiffness = 0, drive_damping = 0;  // gains of the motor; see RobotMotor
  int mimics = -1;        // index of the joint that it follows: multiplier * q + offset; -1: none
  double multiplier = 1, offset = 0;
};

// Links that joints hold together; the first is the root. Every other link is the child of one joint that closes no
// loop, and comes after its parent.
struct SimModel {
  std::string name;    // unique in the scene
  bool fixed = false;  // the root never moves
  std::shared_ptr<const RobotModel> robot;  // null: it is none; its links and joints are in the same order
  std::vector<SimLink> links;
  std::vector<SimJoint> joints;
};

// A surface of triangles with contacts from its front side, such as terrain; it never moves.
struct SimSurface {
  std::string name;
  std::shared_ptr<const TriangleMesh> mesh;
  Pose world_from_mesh;
  double scale = 1;
  double friction = 0.8;  // as of a SimPart
};

struct SimCamera {
  std::string name;
  int model = -1, link = 0;  // what carries it; model -1: the world
  Pose carrier_from_camera;  // camera: X forward, Y left, Z up (REP 103); unit: m
  int width = 640, height = 480;           // unit: pixel
  double fx = 320, fy = 320, cx = 0, cy = 0;  // pixel (0, 0) has its centre at (0, 0); unit: pixel
};

struct SimMesh {
  std::string name;  // unique among the meshes
  const TriangleMesh* mesh = nullptr;
};

struct SimScene {
  std::vector<std::shared_ptr<const TriangleMesh>> kept;  // meshes that are nobody else's
  std::vector<SimMesh> meshes;
  std::vector<SimShape> shapes;
  std::vector<SimModel> models;  // pieces in the order of the pile, then fines and surroundings, then robots
  std::vector<SimSurface> surfaces;
  std::vector<SimCamera> cameras;
};

// A pile for every format: of meshes and of simulators.
struct ExportModel {
  PileModel pile;
  SimScene sim;
};

// The child's frame in that of its parent, as exported.
Pose parent_from_child(const SimModel& model, const SimJoint& joint);
// The joint that holds a link to its parent; null: it is the root.
const SimJoint* find_parent_joint(const SimModel& model, int link);

// Principal moments and axes of an inertia: link_from_principal rotates diag(moments) to it.
struct PrincipalInertia {
  Vec3 moments;  // unit: kg m2
  Quat link_from_principal;
};
PrincipalInertia calc_principal_inertia(const Mat3& inertia);

// A hull that is a box, within 0.01 % of its size: engines know more points of contact between boxes.
struct SimBox {
  Vec3 size;           // full edge lengths; unit: m
  Pose shape_from_box;
};
std::optional<SimBox> find_box(const Hull& hull);

// Triangles of the hull of its points, a closed and convex surface. Fans of its own faces are not: a face that was merged of
// several is flat within a tolerance, and two that meet in more than an edge would make a fin.
std::vector<std::array<int, 3>> calc_hull_triangles(const Hull& hull);

}  // namespace rubble
