// Thin things that a sampled field would not resolve, as meshes and collision parts.
#pragma once

#include <vector>

#include "assets/generator/surface_mesh.h"

namespace rubble::generator {

// Reinforcing bars: round rods along a bent line.
struct Bar {
  std::vector<Vec3> line;  // at least two points; a bend at each inner one; unit: m
  double radius = 0.006;   // unit: m
  double hidden = 0;       // length at the start that is buried in concrete; unit: m
  bool collides = true;    // false: drawn only
  Surface surface = Surface::rebar;
};

// A closed tube with `sides` sides whose bends are rounded and whose ends are flat. Level 0 has
// rolled-in unevenness; coarser levels have fewer rings.
SurfaceMesh mesh_bar(const Bar& bar, int sides, double ring_spacing);

// One square prism per straight stretch outside the concrete, with the section area of the rod: its
// faces lie 0.11 radii inside the rod and its edges 0.25 radii outside.
std::vector<std::vector<Vec3>> bar_parts(const Bar& bar);

// Thin sheets: rolled steel, panes, torn paper.
// A grid of points with a thickness, half of it on either side.

// A grid of points with a thickness, half of it on either side.
struct Sheet {
  int columns = 2, rows = 2;  // of points; at least 2 each
  std::vector<Vec3> points;   // row by row; unit: m
  double thickness = 0.003;   // unit: m
  Surface front = Surface::steel_galvanised;  // where rows x columns turn counter-clockwise
  Surface back = Surface::steel_galvanised;   // the rim belongs to it

  const Vec3& at(int row, int column) const { return points[std::size_t(row * columns + column)]; }
  Vec3& at(int row, int column) { return points[std::size_t(row * columns + column)]; }
};

// Bilinear between four corners in order around the rim: a and b end the first row.
Sheet quad_sheet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int columns, int rows,
                 double thickness, Surface surface);

// A closed shell.
SurfaceMesh mesh_sheet(const Sheet& sheet);

// A convex part over the cells between two rows and two columns, at least `thickness` thick; the
// points between the corners count, so a gently curved stretch is covered whole.
std::vector<Vec3> sheet_part(const Sheet& sheet, int row0, int row1, int column0, int column1,
                             double thickness);

}  // namespace rubble::generator
