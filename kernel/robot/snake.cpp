#include <string>

#include "kernel/robot/bundled.h"
#include "kernel/robot/bundled_looks.h"
#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr int kSnakeFacets = 12;
// A module is narrower at its ends, so that only neighbours, which pass each other, meet in a bend; unit: 1.
constexpr double kEndRadius = 0.75, kNarrowing = 0.2;
// The servo's gains; unit: N m/rad, N m s/rad. Stiff: 7 N m are reached at 4 degrees.
constexpr double kStiffness = 100, kDamping = 2;
constexpr double kMostBend = 1.5707963267948966;  // unit: rad

}  // namespace

RobotModel make_snake(const SnakeOptions& options) {
  RobotModel model;
  model.name = "snake";
  const double radius = 0.5 * options.diameter, length = options.length;
  model.headlamp.link_from_lamp.translation = {0.55 * length, 0, 0};
  for (int i = 0; i < options.modules; ++i) {
    RobotLink link;
    link.name = i == 0 ? "head" : "module_" + std::to_string(i);
    const double front = i == 0 ? 0.5 * length : 0;
    link.parts = {make_tube(radius, kEndRadius * radius, front - length, front, kNarrowing * length,
                            kSnakeFacets)};
    link.friction = options.friction;
    set_mass(options.module_mass, link);
    link.looks = make_snake_module_looks({radius, length, front}, i % 2 == 1, i == 0, i + 1 == options.modules);
    model.links.push_back(link);
    if (i == 0) continue;
    RobotJoint joint;
    joint.name = "joint_" + std::to_string(i);
    joint.parent = i - 1;
    joint.child = i;
    joint.parent_from_child.translation = {i == 1 ? -0.5 * length : -length, 0, 0};
    joint.axis = i % 2 == 1 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    joint.lower = -kMostBend;
    joint.upper = kMostBend;
    joint.motor = {options.effort, options.speed, kStiffness, kDamping};
    model.joints.push_back(joint);
  }
  return model;
}

}  // namespace rubble
