#include "assets/generator/polytope.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kernel/base/error.h"
#include "kernel/base/portable_math.h"

namespace rubble::generator {
namespace {

constexpr double kMerge = 1e-4;    // corners closer than this are one; unit: m
constexpr double kLattice = 1e-5;  // of the points of hulls; unit: m

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

// Points on the lattice of the files, in whole units: orientations are then exact, and the faces of
// a hull fit together whatever the points. Differences up to 10 m keep determinants within 64 bits.
using Whole = Vec3T<std::int64_t>;

Whole to_lattice(const Vec3& p) {
  const auto whole = [](double x) {
    return static_cast<std::int64_t>(std::floor(x / kLattice + 0.5));
  };
  return {whole(p.x), whole(p.y), whole(p.z)};
}

// Whether no point lies above the plane; gathers those on it.
bool supports(const std::vector<Whole>& points, const Whole& normal, const Whole& on_plane,
              std::vector<int>& on) {
  on.clear();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int64_t height = dot(normal, points[i] - on_plane);
    if (height > 0) return false;
    if (height == 0) on.push_back(static_cast<int>(i));
  }
  return true;
}

// Whether i, j, k are the first of the points on a face that span it.
bool leads(const std::vector<Whole>& points, const std::vector<int>& on, int i, int j, int k) {
  if (on[0] != i || on[1] != j) return false;
  for (std::size_t m = 2; on[m] != k; ++m) {
    const Whole area = cross(points[j] - points[i], points[on[m]] - points[i]);
    if (!(area == Whole{})) return false;
  }
  return true;
}

// Sorts the points of a face about their middle and drops those that are no corner of it.
std::vector<int> order_polygon(const std::vector<Vec3>& points, std::vector<int> on,
                               const Vec3& normal) {
  Vec3 middle;
  for (const int i : on) middle += points[i] * (1.0 / static_cast<double>(on.size()));
  const Vec3 u = normalized(points[on[0]] - middle), v = cross(normal, u);
  const auto angle = [&](int i) {
    return portable::atan2(dot(points[i] - middle, v), dot(points[i] - middle, u));
  };
  std::sort(on.begin(), on.end(), [&](int a, int b) { return angle(a) < angle(b); });
  std::vector<int> kept;
  for (std::size_t i = 0; i < on.size(); ++i) {
    const Whole before = to_lattice(points[on[(i + on.size() - 1) % on.size()]]);
    const Whole after = to_lattice(points[on[(i + 1) % on.size()]]);
    const Whole turn = cross(to_lattice(points[on[i]]) - before, after - before);
    if (dot(Vec3(turn), normal) > 0.5) kept.push_back(on[i]);
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

std::vector<Polygon> hull_faces(const std::vector<Vec3>& points) {
  std::vector<Polygon> faces;
  std::vector<Whole> whole;
  for (const Vec3& p : points) whole.push_back(to_lattice(p));
  std::vector<int> on;
  const int count = static_cast<int>(points.size());
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        const Whole area = cross(whole[j] - whole[i], whole[k] - whole[i]);
        if (area == Whole{}) continue;
        for (const Whole& n : {area, -area}) {
          // Each face is met once by its first three points that are not in line.
          if (!supports(whole, n, whole[i], on) || !leads(whole, on, i, j, k)) continue;
          const Vec3 normal = normalized(Vec3(n));
          faces.push_back({order_polygon(points, on, normal), normal});
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
