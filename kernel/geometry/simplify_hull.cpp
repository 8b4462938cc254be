#include "kernel/geometry/simplify_hull.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/geometry/hull.h"

namespace rubble {
namespace {

using Points = std::vector<Vec3>;

constexpr double kShortage = 0.002;        // of the volume, from which on it is restored
constexpr int kHalvings = 12;              // of the distance by which corners move
constexpr std::size_t kFinePoints = 2000;  // the volume of the hull of more points is that of a finer simple hull
constexpr std::size_t kFineCorners = 600;  // of which

const Points& directions() {
  static const Points all = [] {
    Points axes{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, list = axes;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (std::abs(x) + std::abs(y) + std::abs(z) > 1) list.push_back(Vec3(x, y, z));
    return list;
  }();
  return all;
}

void keep(Points& kept, const Vec3& point) {
  if (std::find(kept.begin(), kept.end(), point) == kept.end()) kept.push_back(point);
}

Vec3 farthest(const Points& points, const Vec3& direction) {
  return *std::max_element(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    return dot(direction, a) < dot(direction, b);
  });
}

// The extremes along the axes and, while those span no volume, in between.
Points first_corners(const Points& points) {
  Points kept;
  for (std::size_t i = 0; i < directions().size(); ++i) {
    if (i >= 6 && calc_hull_volume(kept) > 0) break;
    keep(kept, farthest(points, directions()[i]));
  }
  if (calc_hull_volume(kept) > 0) return kept;
  throw std::invalid_argument("the points do not span a volume");
}

// How far points stand out of a hull.
struct Standing {
  std::vector<double> heights;     // of each face: of the farthest point of those that stand out of it most
  std::vector<std::size_t> which;  // that point
  double highest = 0;
};

Standing measure(const Points& points, const std::vector<HullPlane>& planes) {
  Standing result;
  result.heights.assign(planes.size(), 0), result.which.assign(planes.size(), 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double height = -1e300;
    std::size_t face = 0;
    for (std::size_t f = 0; f < planes.size(); ++f) {
      const double h = dot(planes[f].normal, points[i]) - planes[f].offset;
      if (h > height) height = h, face = f;
    }
    if (height > result.heights[face]) result.heights[face] = height, result.which[face] = i;
    result.highest = std::max(result.highest, height);
  }
  return result;
}

double calc_full_volume(const Points& points) {
  if (points.size() <= kFinePoints) return calc_hull_volume(points);
  return calc_hull_volume(simplify_hull(points, kFineCorners, 0).points);
}

}  // namespace

SimpleHull simplify_hull(const Points& points, std::size_t most, double tolerance) {
  if (points.size() < 4) throw std::invalid_argument("the points do not span a volume");
  Points kept = first_corners(points);
  for (;;) {
    const Hull hull = calc_hull(kept);
    const Standing standing = measure(points, calc_planes(hull));
    if (standing.highest <= tolerance || kept.size() >= most) return {hull.points, standing.highest};
    // Several a round, where they stand out nearly as far as the farthest.
    std::vector<std::size_t> faces;
    for (std::size_t f = 0; f < standing.heights.size(); ++f)
      if (standing.heights[f] > std::max(tolerance, 0.6 * standing.highest)) faces.push_back(f);
    std::stable_sort(faces.begin(), faces.end(), [&](std::size_t a, std::size_t b) {
      return standing.heights[a] > standing.heights[b];
    });
    const std::size_t before = kept.size();
    for (std::size_t i = 0; i < std::min(faces.size(), std::max<std::size_t>(1, before / 4)); ++i)
      if (kept.size() < most) keep(kept, points[standing.which[faces[i]]]);
    if (kept.size() == before) return {hull.points, standing.highest};  // finer than the hull's grid
  }
}

Points restore_volume(const SimpleHull& simple, const Points& points) {
  const double wanted = calc_full_volume(points);
  if (calc_hull_volume(simple.points) >= (1 - kShortage) * wanted) return simple.points;
  const Hull hull = calc_hull(simple.points);
  const std::vector<HullPlane> planes = calc_planes(hull);
  const Standing standing = measure(points, planes);
  Points moves(hull.points.size()), normals(hull.points.size());
  std::vector<double> lengths(hull.points.size(), 0);
  for (std::size_t f = 0; f < hull.faces.size(); ++f)
    for (const int corner : hull.faces[f]) {
      normals[std::size_t(corner)] += planes[f].normal;
      lengths[std::size_t(corner)] = std::max(lengths[std::size_t(corner)], standing.heights[f]);
    }
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i] = normalized(normals[i]) * lengths[i];
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const auto moved = [&](double share) {
    Points result = hull.points;
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = min(max(result[i] + moves[i] * share, box.min), box.max);
    return result;
  };
  double low = 0, high = 2;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (calc_hull_volume(moved(middle)) < wanted ? low : high) = middle;
  }
  return calc_hull(moved(low)).points;
}

}  // namespace rubble
