// The vine robot: an inflated tube that grows from its tip. Figures and their sources: docs/reference/robots.md. SI.
#pragma once

#include "kernel/model/robot.h"

namespace rubble {

// Origin: the middle of the mouth of the base, X forwards. The base is a box behind it that is staked to the ground.
// Link i + 1 is the i-th link of the tube; joint i bends it about Y (i even) or Z (i odd). The last link is the tip, on
// the joint `growth`.
struct VineOptions {
  EvertingTube tube;      // with the largest number of links
  double tip_mass = 0.12; // of the mount with camera and lamp; unit: kg; range: 0.001 to 10
  double friction = 0.4;  // range: 0 to 2
  double speed = 0.3;     // of growth at most; unit: m/s; range: 0.001 to 1
};
RobotModel make_vine(const VineOptions& options = {});
// Number of links for a length; unit: m
int count_vine_links(double length, double link_length);

// A tube of coated cloth, a box with a reel that feeds it, and a mount with camera and lamp that the tip
// pushes along.
TriangleMesh make_vine_base_looks(double radius);
TriangleMesh make_vine_tube_looks(double radius, double length);
TriangleMesh make_vine_tip_looks(double radius, double length);

}  // namespace rubble
