// Closed solids that the looks of robots are put together from. Their faces look outwards; each lies in the
// frame `at`, with the builder's present look. Lengths in m.
#pragma once

#include <array>
#include <vector>

#include "kernel/geometry/mesh_builder.h"
#include "kernel/robot/parts.h"

namespace rubble {

// Edges flatter than this are round; unit: degree
inline constexpr double kLooksCrease = 38;

// The frame whose X axis looks along `axis` (unit length).
Pose facing(const Vec3& centre, const Vec3& axis);

// Solids of revolution about X.
// rings: from back to front, as the outside goes; an end with a radius is closed by a disc.
void add_lathe(const std::vector<Ring>& rings, int facets, const Pose& at, MeshBuilder& out);
// A ring with a hole. outline: round its cut, clockwise with X to the right and the radius upwards.
void add_collar(const std::vector<Ring>& outline, int facets, const Pose& at, MeshBuilder& out);
// A hexagonal head that stands on x = 0 and reaches a little below it.
void add_bolt(double radius, const Pose& at, MeshBuilder& out);
// Bolts on a circle about X.
void add_bolt_circle(double circle, int count, double radius, const Pose& at, MeshBuilder& out);

void add_chamfered_box(const Vec3& size, const Vec3& centre, double chamfer, const Pose& at, MeshBuilder& out);
// Four corners and the four above them; counter-clockwise seen from above.
void add_block(const std::array<Vec3, 8>& corners, const Pose& at, MeshBuilder& out);

// Outlines in the plane of X and Z (y = 0), counter-clockwise with X to the right and Z upwards.
using Outline = std::vector<Vec3>;
// The hull of a circle about the origin and one about {length, 0, 0}: what a belt runs along.
// arc: steps of 180 degrees.
Outline make_belt_outline(double radius_a, double radius_b, double length, int arc);
// What an outline with no corner that goes in bounds, from y = from to y = to, with chamfered edges.
void add_slab(const Outline& outline, double from, double to, double chamfer, const Pose& at, MeshBuilder& out);
// What is between two outlines of as many corners.
void add_band(const Outline& outer, const Outline& inner, double from, double to, const Pose& at, MeshBuilder& out);
// A place on the outline at `share` of its length, with the direction outwards.
struct OutlineSpot {
  Vec3 position, normal;
};
OutlineSpot find_outline_spot(const Outline& outline, double share);

// A round bar along a bent line; corners within it are rounded by `bend`.
void add_pipe(const std::vector<Vec3>& line, double radius, double bend, int sides, const Pose& at, MeshBuilder& out);

// What several robots carry.
// A reflector with a light-emitting diode; its back at x = 0, its glass at x = 0.6 radius.
void add_lamp(double radius, const Pose& at, MeshBuilder& out);
// A camera's lens; its mount at x = 0, its front at x = 0.6 radius.
void add_lens(double radius, const Pose& at, MeshBuilder& out);
// A spinning laser scanner on its foot, which is at z = 0.
void add_scanner(double radius, double height, const Pose& at, MeshBuilder& out);
// A flexible aerial on its foot, along Z.
void add_aerial(double height, const Pose& at, MeshBuilder& out);
// A red mushroom button on its box, along Z.
void add_stop_button(const Pose& at, MeshBuilder& out);

}  // namespace rubble
