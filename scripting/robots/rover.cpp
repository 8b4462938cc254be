#include "scripting/robots/rover.h"

#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr double kWheelBase = 0.262, kWheelWidth = 0.08;     // unit: m
constexpr double kRoverBodyMass = 14.6, kWheelMass = 0.6;         // unit: kg
constexpr double kEffort = 6, kServoDamping = 50;            // unit: N m, N m s/rad
constexpr int kRoverFacets = 32;

}  // namespace

RobotModel make_rover(const RoverOptions& options) {
  RobotModel model;
  model.name = "rover";
  RobotLink body;
  body.name = "base_link";
  body.parts = {make_box({0.42, 0.27, 0.12}, {0, 0, 0.125})};
  body.friction = 0.4;
  set_mass(kRoverBodyMass, body);
  body.looks = make_rover_body_looks();
  model.links.push_back(body);
  model.headlamp.link_from_lamp.translation = {0.24, 0, 0.13};
  const struct {
    const char* name;
    double x, y;
  } wheels[] = {{"front_left_wheel", 1, 1},
                {"front_right_wheel", 1, -1},
                {"rear_left_wheel", -1, 1},
                {"rear_right_wheel", -1, -1}};
  for (const auto& w : wheels) {
    RobotLink wheel;
    wheel.name = w.name;
    wheel.parts = {make_wheel(kRoverWheelRadius, kWheelWidth, kRoverFacets)};
    wheel.friction = options.friction;
    set_mass(kWheelMass, wheel);
    wheel.looks = make_rover_wheel_looks(kRoverWheelRadius, kWheelWidth, w.y);
    RobotJoint joint;
    joint.name = wheel.name + "_joint";
    joint.parent = 0;
    joint.child = int(model.links.size());
    joint.parent_from_child.translation = {w.x * 0.5 * kWheelBase, w.y * 0.5 * kRoverTrackDistance,
                                           kRoverWheelRadius};
    joint.axis = {0, 1, 0};
    joint.motor = {kEffort, options.speed / kRoverWheelRadius, 0, kServoDamping};
    (w.y > 0 ? model.sides.left : model.sides.right).push_back(int(model.joints.size()));
    model.links.push_back(wheel);
    model.joints.push_back(joint);
  }
  model.sides.radius = kRoverWheelRadius;
  model.sides.distance = kRoverTrackDistance;
  return model;
}

}  // namespace rubble
