#include <cmath>

#include "kernel/surroundings/parts.h"

namespace rubble {

namespace {

constexpr double kLampHeight = 7.0, kArm = 1.3;  // unit: m

void add_boards(double length, MeshBuilder& out, RandomStream& random) {
  out.look("timber");
  for (double x = 0; x < length; x += 2) out.box({x, 0.02, -0.5}, {x + 0.09, 0.11, 1.75});
  for (const double z : {0.4, 1.45}) out.box({0, 0, z}, {length, 0.03, z + 0.09});
  for (double x = 0.02; x + 0.12 < length; x += 0.135) {
    const double top = 1.78 + random.uniform(-0.03, 0.03), foot = 0.04 + random.uniform(0, 0.03);
    out.box({x, -0.022, foot}, {x + 0.12, 0, top});
  }
}

// Panels of welded mesh between posts, as around sites.
void add_mesh_fence(double length, MeshBuilder& out) {
  out.look("steel_galvanised");
  for (double x = 0; x < length + 0.1; x += 2.5) out.tube({x, 0, -0.4}, {x, 0, 1.9}, 0.024, 0.024, 8);
  for (double x = 0.1; x < length; x += 0.1) out.box({x - 0.0025, -0.0025, 0.06}, {x + 0.0025, 0.0025, 1.83});
  for (const double z : {0.08, 0.28, 0.68, 1.08, 1.48, 1.8})
    out.box({0, -0.004, z - 0.004}, {length, 0.004, z + 0.004});
}

}  // namespace

Vec3 lamp_place() { return {0, kArm, kLampHeight - 0.12}; }

SurroundingMesh make_street_lamp(bool lit) {
  MeshBuilder out;
  out.look("steel_galvanised");
  out.tube({0, 0, -0.5}, {0, 0, 1.1}, 0.085, 0.085, 12);
  out.tube({0, 0, 1.1}, {0, 0, kLampHeight - 0.2}, 0.065, 0.042, 12);
  out.tube({0, 0, kLampHeight - 0.25}, {0, 0.45, kLampHeight}, 0.034, 0.03, 10);
  out.tube({0, 0.42, kLampHeight - 0.01}, {0, kArm - 0.25, kLampHeight + 0.02}, 0.03, 0.03, 10);
  out.box({-0.07, -0.09, 0.5}, {0.07, -0.06, 0.95});  // the door of its fuses
  out.look("rubber");
  out.box({-0.13, kArm - 0.3, kLampHeight - 0.05}, {0.13, kArm + 0.3, kLampHeight + 0.06});
  out.look(lit ? "window_lit" : "drywall");
  out.box({-0.1, kArm - 0.22, kLampHeight - 0.075}, {0.1, kArm + 0.24, kLampHeight - 0.05});
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take_smooth(50));
  mesh.light_spacing = 1;
  return mesh;
}

SurroundingMesh make_fence(FenceKind kind, double length, RandomStream& random) {
  MeshBuilder out;
  if (kind == FenceKind::boards) add_boards(length, out, random);
  if (kind == FenceKind::mesh) add_mesh_fence(length, out);
  if (kind == FenceKind::wall) {
    out.look("brickwork");
    out.box({0, -0.12, -0.5}, {length, 0.12, 1.9});
    out.look("concrete_cast");
    out.box({-0.02, -0.16, 1.9}, {length + 0.02, 0.16, 1.97});
  }
  SurroundingMesh mesh;
  mesh.levels.push_back(out.take());
  mesh.light_spacing = 1;
  return mesh;
}

}  // namespace rubble
