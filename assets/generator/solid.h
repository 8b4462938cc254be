// A solid as a signed field: convex cells united, convex hollows cut out, every face roughened by
// noise that only ever removes material, every edge worn and chipped. Because nothing is added,
// the convex cells themselves contain the surface and serve as collision parts.
#pragma once

#include <cstdint>
#include <vector>

#include "kernel/base/math.h"

namespace rubble::generator {

// What a face looks like; the names are the renderer's. Order: surface_name() in solid.cpp.
enum class Surface : std::uint8_t {
  concrete_cast,
  concrete_fracture,
  brick,
  brick_fracture,
  cinder_block,
  rebar,
  steel_galvanised,
  timber,
  plaster
};
inline constexpr int kSurfaceCount = 9;
const char* surface_name(Surface surface);

// The half-space dot(normal, x) <= offset or, when round, the inside of an endless cylinder about
// the axis `normal` through the origin with the radius `offset`.
struct Face {
  Vec3 normal;    // unit length
  double offset;  // unit: m
  Surface surface = Surface::concrete_cast;
  bool round = false;
  bool rough = false;  // dented as a break is, whatever its surface
};

using Cell = std::vector<Face>;  // the intersection of its faces

// How worn the solid is. Lengths in metres.
struct Wear {
  double fracture_depth = 0.008;  // the deepest dent of a fracture face below its plane
  double fracture_size = 0.10;    // wavelength of its largest waves
  double grain_size = 0.024;      // spacing of the aggregate
  double cast_depth = 0.0015;     // the same for all other faces: waves and pits
  double edge_round = 0.014;      // width of the rounding of every edge; the edge recedes by 1/4
  double edge_chip = 0.024;        // extra width where an edge is chipped
  double chip_size = 0.06;        // spacing of the chips
};

struct Solid {
  std::vector<Cell> cells;
  std::vector<Cell> hollows;
  Wear wear;
  std::uint32_t seed = 0;
};

Cell box_cell(const Vec3& min, const Vec3& max, Surface surface);

struct FieldSample {
  double value;     // negative inside; near the surface about the distance; unit: m
  Surface surface;  // of the face that is nearest
};

// Exact within `band` of the surface, farther out only the sign holds; at least twice the distance
// over which the value is interpolated. unit: m
FieldSample sample(const Solid& solid, const Vec3& p, double band);

// A box around the solid. Throws RunError when its cells are not bounded.
Aabb bounds(const Solid& solid);

}  // namespace rubble::generator
