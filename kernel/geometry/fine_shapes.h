// The shapes of loose fines: a small set, drawn once and for all, that sizes and turns make manifold.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kernel/base/math.h"
#include "kernel/model/fines.h"
#include "kernel/model/pile_state.h"

namespace rubble {

// A closed convex polyhedron with corners within the cube from -1 to 1, its origin inside.
struct FineShape {
  std::vector<Vec3f> points;                            // corners
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

enum class FineForm {
  chip,    // four corners: the smallest grit
  pebble,  // six corners
  stone,   // up to twelve corners
  flake,   // a prism of three to seven corners, flat along z: plaster
  shard    // a prism of three or four corners, flat along z: glass
};
inline constexpr int kShapesOfForm = 16;
static_assert(kFineShapes == 5 * kShapesOfForm, "numbers of shapes are kept in files");

// number: 0 to kShapesOfForm - 1.
constexpr int fine_shape_number(FineForm form, int number) { return int(form) * kShapesOfForm + number; }

// number: 0 to kFineShapes - 1.
const FineShape& fine_shape(int number);

// The largest face of a shape whose axes are scaled by `half`: what it lies on.
struct FineBase {
  std::size_t triangle = 0;  // index into the shape's
  Vec3 normal;               // unit length, out of the shape
  double distance = 0;       // from its origin; unit: as `half`
};
FineBase find_base(const FineShape& shape, const Vec3f& half);

// Fines as meshes: all of one kind that lie on one piece, or on the ground, within one cell.

// Edge of a cell in the frame of the host; unit: m. A heap is drawn or left out as a whole, and has one
// number.
inline constexpr double kFineCell = 1.0;

// Makes what Fines::heaps() returns.
void heap_fines(Fines& fines);

// Of the frame that a heap's or a fine piece's host has.
Pose world_from_host(const PileState& pile, int host);

}  // namespace rubble
