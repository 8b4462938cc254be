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
  steel_rusty,
  timber,
  timber_fracture,
  drywall,
  drywall_core,
  car_paint,
  glass,
  fabric,
  rubber,
  plaster
};
inline constexpr int kSurfaceCount = 17;
const char* surface_name(Surface surface);

// The half-space dot(normal, x) <= offset or, when round, the inside of an endless cylinder about
// the axis `normal` through `centre` with the radius `offset`.
struct Face {
  Vec3 normal;    // unit length
  double offset;  // unit: m
  Surface surface = Surface::concrete_cast;
  bool round = false;
  bool rough = false;  // dented as a break is, whatever its surface
  Vec3 centre{};       // of a round face only; unit: m
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
  // Fibres: how much longer than wide the dents of a break are, along `along`. 1: none; timber: 20.
  // The depth of a break is then the length of its splinters.
  double fibre = 1;
  Vec3 along{1, 0, 0};  // unit length
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

// Those cells and hollows of a solid that shape its surface near a place.
struct SolidView {
  const Solid* solid = nullptr;
  std::vector<const Cell*> cells, hollows;
  double deepest = 0;  // what wear removes there at most; unit: m
};
SolidView whole_view(const Solid& solid);
// Samples within `radius` of `centre` are then the same as those of the whole, as far as they are
// within `band` of the surface; farther out the sign is.
SolidView view_near(const Solid& solid, const Vec3& centre, double radius, double band);

// Without any wear: at most the distance to the surface, so a sphere about p with this radius does not
// meet it. Negative inside. unit: m
double plain_value(const SolidView& solid, const Vec3& p);

// Exact within `band` of the surface, farther out only the sign holds; at least twice the distance
// over which the value is interpolated. unit: m
FieldSample sample(const SolidView& solid, const Vec3& p, double band);

// On which side of the surface a place is, as far as that can be told without noise.
enum class FieldSide : std::uint8_t { inside, outside, near };
FieldSide side_of(const SolidView& solid, const Vec3& p);
// The surface that sample() gives, for places on it.
Surface surface_at(const SolidView& solid, const Vec3& p, double band);

// A box around the solid. Throws RunError when its cells are not bounded.
Aabb bounds(const Solid& solid);

}  // namespace rubble::generator
