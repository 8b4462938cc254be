// The makers of the parts of surroundings. Internal to kernel/surroundings. Each draws from the stream that it
// is given alone.
#pragma once

#include "kernel/base/random.h"
#include "kernel/model/surroundings.h"
#include "kernel/geometry/mesh_builder.h"

namespace rubble {

// A building: its front lies in the plane y = 0 and looks to -y, from x = 0 to width; z = 0 is the pavement.
struct NeighbourPlan {
  double width = 14, depth = 11;  // unit: m
  int storeys = 3;                // with the ground floor
  bool windows_left = false, windows_right = false;  // in the sides, which are fire walls otherwise
  double lit = 0;                 // share of the windows that are lit
  bool plain = false;             // without reveals, frames, balconies and so on: for what is far
};
SurroundingMesh make_building(const NeighbourPlan& plan, RandomStream& random);

// Root at the origin; about `height` m high.
SurroundingMesh make_tree(double height, RandomStream& random);
SurroundingMesh make_hedge(double length, double height, RandomStream& random);

// A car or van: X forward, on z = 0, its middle at the origin. number: of its kind and colour.
inline constexpr int kVehicles = 9;
SurroundingMesh make_vehicle(int number);
double vehicle_length(int number);  // unit: m

// A column at the origin whose arm reaches out to +y. The light is at lamp_place().
SurroundingMesh make_street_lamp(bool lit);
Vec3 lamp_place();

enum class FenceKind { mesh, boards, wall };
// From the origin along +X.
SurroundingMesh make_fence(FenceKind kind, double length, RandomStream& random);

}  // namespace rubble
