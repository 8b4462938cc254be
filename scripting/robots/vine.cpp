#include "scripting/robots/vine.h"

#include <cmath>
#include <string>

#include "kernel/robot/parts.h"

namespace rubble {
namespace {

constexpr int kTubeFacets = 12;
// A link is narrower at its ends, so that its neighbours' corners do not stand out in a bend; unit: 1.
constexpr double kTubeEndRadius = 0.85, kTubeNarrowing = 0.2;
constexpr double kMostFold = 1.5707963267948966;  // of a hinge; unit: rad
constexpr double kBaseMass = 15;                  // reel, regulator and fan; it does not move; unit: kg
// Gain of the speed of growth: all of the tip's force at an error of a few mm/s; unit: N s/m.
constexpr double kGrowthGain = 2e4;

RobotLink make_base(double radius, double friction) {
  RobotLink base;
  base.name = "base_link";
  base.parts = {make_box({6 * radius, 4.4 * radius, 4 * radius}, {-3 * radius, 0, radius})};
  base.friction = friction;
  set_mass(kBaseMass, base);
  base.looks = make_vine_base_looks(radius);
  return base;
}

RobotLink make_section(int number, const EvertingTube& tube, double friction) {
  RobotLink link;
  link.name = "tube_" + std::to_string(number);
  // The first begins within the base's collar: what lies right before the base cannot wedge it up.
  const double from = number == 1 ? 0.5 * tube.link_length : 0;
  link.parts = {make_tube(tube.radius, kTubeEndRadius * tube.radius, from, tube.link_length,
                          kTubeNarrowing * tube.link_length, kTubeFacets)};
  link.friction = friction;
  set_mass(tube.mass_per_length() * tube.link_length, link);
  link.looks = make_vine_tube_looks(tube.radius, tube.link_length);
  return link;
}

// The tip's frame is at the end of what has been laid; it reaches a link back, so that no gap opens.
RobotLink make_tip(const VineOptions& options) {
  const double r = options.tube.radius, l = options.tube.link_length;
  RobotLink tip;
  tip.name = "tip";
  tip.parts = {make_rings({{-0.9 * l, kTubeEndRadius * r},
                           {-0.7 * l, r},
                           {0, r},
                           {0.5 * r, 0.866 * r},
                           {0.8 * r, 0.6 * r},
                           {0.95 * r, 0.3 * r},
                           {r, 0.02 * r}},
                          kTubeFacets)};
  tip.friction = options.friction;
  tip.eversion_axis = {1, 0, 0};
  set_mass(options.tip_mass, tip);
  tip.looks = make_vine_tip_looks(r, l);
  return tip;
}

}  // namespace

int count_vine_links(double length, double link_length) {
  return int(std::floor(length / link_length + 1e-9));
}

RobotModel make_vine(const VineOptions& options) {
  const EvertingTube& tube = options.tube;
  RobotModel model;
  model.name = "vine";
  model.tube = tube;
  model.links = {make_base(tube.radius, options.friction)};
  for (int i = 1; i <= tube.links; ++i) {
    model.links.push_back(make_section(i, tube, options.friction));
    RobotJoint joint;
    joint.name = "bend_" + std::to_string(i);
    joint.parent = i - 1;
    joint.child = i;
    joint.parent_from_child.translation = {i == 1 ? 0 : tube.link_length, 0, 0};
    joint.axis = i % 2 == 1 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    joint.lower = -kMostFold;
    joint.upper = kMostFold;
    model.joints.push_back(joint);
  }
  model.links.push_back(make_tip(options));
  RobotJoint growth;
  growth.name = "growth";
  growth.kind = JointKind::slider;
  growth.parent = tube.links;
  growth.child = tube.links + 1;
  growth.parent_from_child.translation = {tube.link_length, 0, 0};
  growth.axis = {1, 0, 0};
  growth.lower = 0;
  growth.upper = tube.length();
  growth.motor = {tube.pressure * tube.area(), options.speed, 0, kGrowthGain};
  model.joints.push_back(growth);
  model.headlamp.link = tube.links + 1;
  model.headlamp.link_from_lamp.translation = {1.05 * tube.radius, 0, 0};
  return model;
}

}  // namespace rubble
