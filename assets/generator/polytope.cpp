#include "assets/generator/polytope.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr double kMerge = 1e-4;  // corners closer than this are one; unit: m

bool meet(const Face& a, const Face& b, const Face& c, Vec3& point) {
  const Vec3 bc = cross(b.normal, c.normal);
  const double det = dot(a.normal, bc);
  if (std::fabs(det) < 1e-5) return false;
  point = (bc * a.offset + cross(c.normal, a.normal) * b.offset +
           cross(a.normal, b.normal) * c.offset) *
          (1 / det);
  return true;
}

bool contains(const Cell& cell, const Vec3& p) {
  return std::all_of(cell.begin(), cell.end(),
                     [&](const Face& f) { return f.round || dot(f.normal, p) <= f.offset + 1e-9; });
}

void add_if_new(std::vector<Vec3>& points, const Vec3& p) {
  const bool known = std::any_of(points.begin(), points.end(),
                                 [&](const Vec3& q) { return distance(p, q) < kMerge; });
  if (!known) points.push_back(p);
}

// Whether no point lies above the plane; gathers those on it.
bool supports(const std::vector<Vec3>& points, const Vec3& normal, double offset, double tolerance,
              std::vector<int>& on) {
  on.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double height = dot(normal, points[i]) - offset;
    if (height > tolerance) return false;
    if (height > -tolerance) on.push_back(static_cast<int>(i));
  }
  return true;
}

// Sorts the points of a face about their middle and drops those that are no corner of it.
std::vector<int> order_polygon(const std::vector<Vec3>& points, std::vector<int> on,
                               const Vec3& normal, double tolerance) {
  Vec3 middle;
  for (const int i : on) middle += points[i] * (1.0 / static_cast<double>(on.size()));
  const Vec3 u = normalized(points[on[0]] - middle), v = cross(normal, u);
  const auto angle = [&](int i) {
    return portable::atan2(dot(points[i] - middle, v), dot(points[i] - middle, u));
  };
  std::sort(on.begin(), on.end(), [&](int a, int b) { return angle(a) < angle(b); });
  std::vector<int> kept;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const Vec3& before = points[on[(i + on.size() - 1) % on.size()]];
    const Vec3& after = points[on[(i + 1) % on.size()]];
    const Vec3 out = normalized(cross(after - before, normal));
    if (dot(out, points[on[i]] - before) > tolerance) kept.push_back(on[i]);
  }
  return kept;
}

}  // namespace

std::vector<Vec3> corners_of(const Cell& cell) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    for (std::size_t j = i + 1; j < cell.size(); ++j) {
      for (std::size_t k = j + 1; k < cell.size(); ++k) {
        Vec3 p;
        if (cell[i].round || cell[j].round || cell[k].round) continue;
        if (meet(cell[i], cell[j], cell[k], p) && contains(cell, p)) add_if_new(corners, p);
      }
    }
  }
  if (corners.size() < 4) throw RunError("a cell of a generated solid is empty or not bounded");
  return corners;
}

std::vector<Polygon> hull_faces(const std::vector<Vec3>& points, double tolerance) {
  std::vector<Polygon> faces;
  std::vector<int> on;
  const int count = static_cast<int>(points.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        Vec3 normal = cross(points[j] - points[i], points[k] - points[i]);
        if (norm(normal) < 1e-9) continue;
        normal = normalized(normal);
        for (const Vec3& n : {normal, -normal}) {
          if (!supports(points, n, dot(n, points[i]), tolerance, on)) continue;
          // Each face is met once by its first three points.
          if (on.size() < 3 || on[0] != i || on[1] != j || on[2] != k) continue;
          Polygon polygon{order_polygon(points, on, n, 0.1 * tolerance), n};
          if (polygon.corners.size() >= 3) faces.push_back(polygon);
        }
      }
    }
  }
  return faces;
}

double hull_volume(const std::vector<Vec3>& points) {
  double six = 0;
  for (const Polygon& face : hull_faces(points)) {
    const Vec3& a = points[face.corners[0]];
    for (std::size_t i = 2; i < face.corners.size(); ++i) {
      six += dot(a, cross(points[face.corners[i - 1]], points[face.corners[i]]));
    }
  }
  return six / 6;
}

}  // namespace rubble::generator
