#include "assets/generator/fit.h"

#include <algorithm>
#include <cmath>

#include "assets/generator/polytope.h"

namespace rubble::generator {
namespace {

constexpr double kInside = 0.012;  // a corner deeper than this is within the solid; unit: m
constexpr double kMaxShrink = 0.02;

bool in_cell(const Cell& cell, const Vec3& p) {
  return std::all_of(cell.begin(), cell.end(),
                     [&](const Face& f) { return dot(f.normal, p) < f.offset + 1e-3; });
}

double support(const std::vector<Vec3>& points, const Vec3& normal) {
  double top = -1e9;
  for (const Vec3& p : points) top = std::fmax(top, dot(normal, p));
  return top;
}

// The points that the part of a cell must contain: the surface inside it, and its own corners
// where they are buried in the rest of the solid.
std::vector<Vec3> points_to_keep(const Solid& solid, const Cell& cell, const SurfaceMesh& surface) {
  std::vector<Vec3> points;
  for (const Vec3& p : surface.positions) {
    if (in_cell(cell, p)) points.push_back(p);
  }
  for (const Vec3& corner : corners_of(cell)) {
    if (sample(solid, corner, 0.05).value < -kInside) points.push_back(corner);
  }
  return points;
}

struct Gap {
  Vec3 corner;
  double size = 0;
  Vec3 outward;
};

// Distances from corners to the nearest of some points; each corner is looked up once.
class GapFinder {
 public:
  explicit GapFinder(const std::vector<Vec3>& points) : points_(points) {}

  Gap largest(const std::vector<Vec3>& corners) {
    Gap result;
    for (const Vec3& corner : corners) {
      const Gap& gap = find(corner);
      if (gap.size > result.size) result = gap;
    }
    return result;
  }

 private:
  const Gap& find(const Vec3& corner) {
    for (const Gap& gap : known_) {
      if (gap.corner == corner) return gap;
    }
    Vec3 nearest;
    double best = 1e18;
    for (const Vec3& p : points_) {
      const Vec3 d = p - corner;
      if (dot(d, d) < best) best = dot(d, d), nearest = p;
    }
    known_.push_back({corner, std::sqrt(best), normalized(corner - nearest)});
    return known_.back();
  }

  const std::vector<Vec3>& points_;
  std::vector<Gap> known_;
};

std::vector<Vec3> fit_cell(Cell cell, const std::vector<Vec3>& points) {
  for (Face& face : cell) {
    const double top = support(points, face.normal);
    if (top < face.offset && top > face.offset - kMaxShrink) face.offset = top;
  }
  std::vector<Vec3> corners = corners_of(cell);
  GapFinder finder(points);
  for (int tries = 0; tries < 3 * kMaxCorners; ++tries) {
    const Gap gap = finder.largest(corners);
    if (gap.size < kCornerGap) break;
    cell.push_back({gap.outward, support(points, gap.outward)});
    std::vector<Vec3> cut = corners_of(cell);
    if (static_cast<int>(cut.size()) > kMaxCorners) break;
    corners = std::move(cut);
  }
  return corners;
}

}  // namespace

std::vector<std::vector<Vec3>> cell_parts(const Solid& solid) {
  std::vector<std::vector<Vec3>> parts;
  for (const Cell& cell : solid.cells) parts.push_back(corners_of(cell));
  return parts;
}

std::vector<std::vector<Vec3>> fit_parts(const Solid& solid, const SurfaceMesh& surface) {
  std::vector<std::vector<Vec3>> parts;
  for (const Cell& cell : solid.cells) {
    parts.push_back(fit_cell(cell, points_to_keep(solid, cell, surface)));
  }
  return parts;
}

}  // namespace rubble::generator
