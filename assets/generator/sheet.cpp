#include "assets/generator/sheet.h"

#include <algorithm>

namespace rubble::generator {
namespace {

Vec3 normal_at(const Sheet& s, int row, int column) {
  const int r0 = std::max(row - 1, 0), r1 = std::min(row + 1, s.rows - 1);
  const int c0 = std::max(column - 1, 0), c1 = std::min(column + 1, s.columns - 1);
  return normalized(cross(s.at(row, c1) - s.at(row, c0), s.at(r1, column) - s.at(r0, column)));
}

void add_quad(SurfaceMesh& mesh, int a, int b, int c, int d, Surface surface) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
  mesh.surfaces.insert(mesh.surfaces.end(), 2, surface);
}

}  // namespace

Sheet quad_sheet(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, int columns, int rows,
                 double thickness, Surface surface) {
  Sheet sheet{columns, rows, {}, thickness, surface, surface};
  for (int r = 0; r < rows; ++r) {
    const double v = double(r) / (rows - 1);
    const Vec3 left = a + (d - a) * v, right = b + (c - b) * v;
    for (int k = 0; k < columns; ++k) {
      sheet.points.push_back(left + (right - left) * (double(k) / (columns - 1)));
    }
  }
  return sheet;
}

SurfaceMesh mesh_sheet(const Sheet& s) {
  SurfaceMesh mesh;
  for (const double side : {0.5, -0.5}) {
    for (int r = 0; r < s.rows; ++r) {
      for (int c = 0; c < s.columns; ++c) {
        mesh.positions.push_back(s.at(r, c) + normal_at(s, r, c) * (side * s.thickness));
      }
    }
  }
  const int below = s.rows * s.columns;
  const auto node = [&](int r, int c) { return r * s.columns + c; };
  for (int r = 0; r + 1 < s.rows; ++r) {
    for (int c = 0; c + 1 < s.columns; ++c) {
      const int a = node(r, c), b = node(r, c + 1), d = node(r + 1, c), e = node(r + 1, c + 1);
      add_quad(mesh, a, b, e, d, s.front);
      add_quad(mesh, below + a, below + d, below + e, below + b, s.back);
    }
  }
  const auto rim = [&](int a, int b) { add_quad(mesh, b, a, below + a, below + b, s.back); };
  for (int c = 0; c + 1 < s.columns; ++c) {
    rim(node(0, c), node(0, c + 1));
    rim(node(s.rows - 1, c + 1), node(s.rows - 1, c));
  }
  for (int r = 0; r + 1 < s.rows; ++r) {
    rim(node(r, s.columns - 1), node(r + 1, s.columns - 1));
    rim(node(r + 1, 0), node(r, 0));
  }
  return mesh;
}

std::vector<Vec3> sheet_part(const Sheet& s, int row0, int row1, int column0, int column1,
                             double thickness) {
  // About the mean plane of the stretch, thick enough for its bend.
  const Vec3 &a = s.at(row0, column0), &b = s.at(row0, column1), &c = s.at(row1, column1),
             &d = s.at(row1, column0);
  const Vec3 normal = normalized(cross(c - a, d - b)), middle = (a + b + c + d) * 0.25;
  double low = 0, high = 0;
  for (int r = row0; r <= row1; ++r) {
    for (int k = column0; k <= column1; ++k) {
      const double height = dot(normal, s.at(r, k) - middle);
      low = std::min(low, height), high = std::max(high, height);
    }
  }
  const double extra = std::max(0.5 * s.thickness, 0.5 * (thickness - (high - low)));
  std::vector<Vec3> part;
  for (const Vec3& corner : {a, b, c, d}) {
    const Vec3 flat = corner - normal * dot(normal, corner - middle);
    part.push_back(flat + normal * (low - extra));
    part.push_back(flat + normal * (high + extra));
  }
  return part;
}

}  // namespace rubble::generator
