// What the bundled vine robot looks like: a tube of coated cloth, a box with a reel that feeds it, and a
// mount with camera and lamp that the tip pushes along.
#pragma once

#include "kernel/base/mesh.h"

namespace rubble {

// In the frames of the links (vine.cpp); unit: m
TriangleMesh make_vine_base_looks(double radius);
TriangleMesh make_vine_tube_looks(double radius, double length);
TriangleMesh make_vine_tip_looks(double radius, double length);

}  // namespace rubble
