// What the bundled robots look like, in the frames of their links. Nothing collides with it. unit: m
#pragma once

#include "kernel/base/mesh.h"

namespace rubble {

// Sizes of the parts that collide, which the looks keep to.
struct TrackSize {
  double length = 0;                                    // between the axles; unit: m
  double width = 0, radius_front = 0, radius_rear = 0;  // unit: m
};

// A belt with lugs on wheels, with a plate at the side that looks out (y: 1 or -1). The middle of the belt is
// {0, y, radius}.
TriangleMesh make_track_looks(const TrackSize& size, double y, double side);
// Its hub in the origin, its tip at direction * length along X.
TriangleMesh make_flipper_looks(const TrackSize& size, double direction, double side);
TriangleMesh make_crawler_body_looks();

// side: 1 where the wheel's outside looks along Y, else -1.
TriangleMesh make_rover_wheel_looks(double radius, double width, double side);
TriangleMesh make_rover_body_looks();

// A module from x = to - length to x = to, which bends about `front_axis_z ? Z : Y` in front and about the
// other behind. The head has no joint in front, the tail none behind.
struct SnakeModuleSize {
  double radius = 0, length = 0, to = 0;  // unit: m
};
TriangleMesh make_snake_module_looks(const SnakeModuleSize& size, bool front_axis_z, bool head, bool tail);

// A tube of coated cloth, a box with a reel that feeds it, and a mount with camera and lamp that the tip
// pushes along.
TriangleMesh make_vine_base_looks(double radius);
TriangleMesh make_vine_tube_looks(double radius, double length);
TriangleMesh make_vine_tip_looks(double radius, double length);

// Edges flatter than this are round; unit: degree
inline constexpr double kLooksCrease = 38;

}  // namespace rubble
