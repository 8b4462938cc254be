#include "assets/generator/thin_shapes.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr double kPrismHalf = 0.886;  // half the side of a square with the circle's area

Vec3 any_across(const Vec3& direction) {
  const Vec3 axis = std::fabs(direction.z) < 0.8 ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  return normalized(cross(axis, direction));
}

// The radius of a polygon with the area of the unit circle, so that every level has one volume.
double equal_area(int sides) {
  const double turn = 2 * portable::kPi / sides;
  return std::sqrt(turn / portable::sin(turn));
}

// Points along the line, with each bend cut short over twice the bar's radius.
std::vector<Vec3> ring_centres(const Bar& bar, double spacing) {
  std::vector<Vec3> points{bar.line.front()};
  for (std::size_t i = 1; i < bar.line.size(); ++i) {
    const bool last = i + 1 == bar.line.size();
    const Vec3 from = points.back(), direction = normalized(bar.line[i] - from);
    const double cut = last ? 0 : 1.5 * bar.radius;
    const double length = distance(from, bar.line[i]) - cut;
    const int steps = std::max(1, static_cast<int>(length / spacing + 0.5));
    for (int s = 1; s <= steps; ++s) points.push_back(from + direction * (length * s / steps));
    if (!last) {
      const Vec3 next = normalized(bar.line[i + 1] - bar.line[i]);
      points.push_back(bar.line[i] + (next - direction) * (0.35 * cut));
      points.push_back(bar.line[i] + next * cut);
    }
  }
  return points;
}

}  // namespace

SurfaceMesh mesh_bar(const Bar& bar, int sides, double ring_spacing) {
  SurfaceMesh mesh;
  const std::vector<Vec3> centres = ring_centres(bar, ring_spacing);
  const int rings = static_cast<int>(centres.size());
  const double radius = bar.radius * equal_area(sides);
  Vec3 across = any_across(normalized(centres[1] - centres[0]));
  for (int r = 0; r < rings; ++r) {
    const Vec3 along =
        normalized(centres[std::min(r + 1, rings - 1)] - centres[std::max(r - 1, 0)]);
    across = normalized(across - along * dot(across, along));  // carried along without twist
    const Vec3 up = cross(along, across);
    for (int s = 0; s < sides; ++s) {
      const portable::SinCos turn = portable::sincos(2 * portable::kPi * s / sides);
      mesh.positions.push_back(centres[r] + (across * turn.cos + up * turn.sin) * radius);
    }
  }
  for (int r = 0; r + 1 < rings; ++r) {
    for (int s = 0; s < sides; ++s) {
      const int a = r * sides + s, b = r * sides + (s + 1) % sides;
      mesh.triangles.push_back({a, b, b + sides});
      mesh.triangles.push_back({a, b + sides, a + sides});
    }
  }
  const int last = (rings - 1) * sides;
  for (int s = 1; s + 1 < sides; ++s) {
    mesh.triangles.push_back({0, s + 1, s});
    mesh.triangles.push_back({last, last + s, last + s + 1});
  }
  mesh.surfaces.assign(mesh.triangles.size(), bar.surface);
  return mesh;
}

std::vector<std::vector<Vec3>> bar_parts(const Bar& bar) {
  std::vector<std::vector<Vec3>> parts;
  double buried = bar.hidden;
  for (std::size_t i = 0; i + 1 < bar.line.size(); ++i) {
    const Vec3 along = normalized(bar.line[i + 1] - bar.line[i]);
    const double length = distance(bar.line[i], bar.line[i + 1]);
    const double skip = std::fmin(buried, length);
    buried -= skip;
    if (length - skip < 4 * bar.radius) continue;
    const Vec3 u = any_across(along) * (kPrismHalf * bar.radius), v = cross(along, u);
    std::vector<Vec3> part;
    for (const Vec3& end : {bar.line[i] + along * skip, bar.line[i + 1]}) {
      for (const Vec3& side : {u + v, v - u, -u - v, u - v}) part.push_back(end + side);
    }
    parts.push_back(part);
  }
  return parts;
}

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
