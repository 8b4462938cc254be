#include "kernel/geometry/hull.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "kernel/geometry/lattice_hull.h"

namespace rubble {
namespace {

constexpr double kNarrowSteps = 8;  // faces that are narrower than so many are of rounding alone
// Faces are merged when their normals differ by less than about 1 degree, and only while every
// corner stays this near to the plane of the largest among them. The angle alone would make one
// bent polygon of several sides of a fine drum. Packs write corners to 0.01 mm.
constexpr double kCoplanarCosine = 0.99985;
constexpr double kPlanarShare = 1e-5;  // of the hull's longest extent
constexpr double kPlanarLeast = 3e-5;  // unit: m

// Newell's normal: twice the area vector of a polygon.
Vec3 area_vector(const std::vector<Vec3>& points, const Polygon& face) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += cross(points[face[i]] - points[face[0]], points[face[i + 1]] - points[face[0]]);
  }
  return sum;
}

// The outline of a connected set of faces, from its lowest corner on. Empty: it is not simple.
Polygon outline(const std::vector<Polygon>& faces, const std::vector<int>& group) {
  if (group.size() == 1) return faces[group[0]];
  using Edge = std::pair<int, int>;
  std::vector<Edge> edges, rim;
  for (int f : group)
    for (std::size_t i = 0; i < faces[f].size(); ++i) edges.emplace_back(faces[f][i], faces[f][(i + 1) % faces[f].size()]);
  std::sort(edges.begin(), edges.end());
  for (const auto& [a, b] : edges)
    if (!std::binary_search(edges.begin(), edges.end(), Edge(b, a))) rim.emplace_back(a, b);
  const auto is_same = [](const Edge& a, const Edge& b) { return a.first == b.first; };
  if (std::adjacent_find(rim.begin(), rim.end(), is_same) != rim.end()) return {};
  Polygon polygon;
  for (int at = rim.front().first;;) {
    polygon.push_back(at);
    at = std::lower_bound(rim.begin(), rim.end(), Edge(at, 0))->second;
    if (at == polygon.front()) break;
    if (polygon.size() > rim.size()) return {};
  }
  return polygon.size() == rim.size() ? polygon : Polygon{};
}

bool is_within(double tolerance, const std::vector<Vec3>& points, const Polygon& face,
               const Vec3& n, const Vec3& from) {
  return std::all_of(face.begin(), face.end(), [&](int p) {
    return std::abs(dot(n, points[p] - from)) <= tolerance;
  });
}

// `tolerance`: how far a corner of a merged face may be from its plane; unit: m.
std::vector<Polygon> merge_coplanar(const std::vector<Vec3>& points,
                                    const std::vector<Polygon>& faces, double tolerance) {
  const FaceOfEdge face_of_edge(faces);
  std::vector<Vec3> areas;
  for (const Polygon& face : faces) areas.push_back(area_vector(points, face));
  std::vector<int> order(faces.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return dot(areas[a], areas[a]) > dot(areas[b], areas[b]); });
  std::vector<char> taken(faces.size(), 0);
  std::vector<Polygon> merged;
  for (int seed : order) {
    if (taken[seed]) continue;
    taken[seed] = 1;
    const Vec3 n = normalized(areas[seed]);
    std::vector<int> group{seed};
    for (std::size_t g = 0; g < group.size(); ++g) {
      const Polygon& face = faces[group[g]];
      for (std::size_t i = 0; i < face.size(); ++i) {
        const int other = face_of_edge.find(FaceOfEdge::key(face[(i + 1) % face.size()], face[i]));
        if (taken[other] || dot(normalized(areas[other]), n) < kCoplanarCosine) continue;
        if (!is_within(tolerance, points, faces[other], n, points[faces[seed][0]])) continue;
        taken[other] = 1;
        group.push_back(other);
      }
    }
    Polygon polygon = outline(faces, group);
    if (!polygon.empty()) {
      merged.push_back(std::move(polygon));
    } else {
      for (int f : group) merged.push_back(faces[f]);
    }
  }
  return merged;
}

}  // namespace

Hull calc_hull(const std::vector<Vec3>& points) {
  const LatticePoints rounded = round_to_lattice(points);
  std::vector<Vec3> candidates;
  for (int index : rounded.source) candidates.push_back(points[index]);
  const std::vector<Polygon> faces =
      merge_coplanar(candidates, calc_lattice_hull(rounded.grid),
                     std::max(kPlanarShare * rounded.longest, kPlanarLeast));

  Hull hull;
  std::vector<int> corner(candidates.size(), -1);
  for (const Polygon& face : faces) {
    hull.faces.emplace_back();
    for (int p : face) {
      if (corner[p] < 0) {
        corner[p] = int(hull.points.size());
        hull.points.push_back(candidates[p]);
      }
      hull.faces.back().push_back(corner[p]);
    }
  }
  return hull;
}

std::vector<HullPlane> calc_planes(const Hull& hull) {
  std::vector<HullPlane> planes;
  Aabb box;
  for (const Vec3& p : hull.points) box.include(p);
  const Vec3 extent = box.max - box.min;
  const double size = std::max({extent.x, extent.y, extent.z});
  for (const std::vector<int>& face : hull.faces) {
    const Vec3 area = area_vector(hull.points, face), normal = normalized(area);
    double longest = 0;
    for (std::size_t i = 0; i < face.size(); ++i)
      longest = std::max(longest, distance(hull.points[std::size_t(face[i])],
                                           hull.points[std::size_t(face[(i + 1) % face.size()])]));
    const bool narrow = norm(area) <= 2 * kNarrowSteps / kLatticeSteps * size * longest;
    planes.push_back(narrow ? HullPlane{{}, 1e300} : HullPlane{normal, dot(normal, hull.points[std::size_t(face[0])])});
  }
  return planes;
}

double calc_volume(const Hull& hull) {
  double six = 0;
  for (const std::vector<int>& face : hull.faces) {
    const Vec3 a = hull.points[std::size_t(face[0])] - hull.points[0];
    for (std::size_t k = 2; k < face.size(); ++k)
      six += dot(a, cross(hull.points[std::size_t(face[k - 1])] - hull.points[0],
                          hull.points[std::size_t(face[k])] - hull.points[0]));
  }
  return six / 6;
}

double calc_hull_volume(const std::vector<Vec3>& points) {
  if (points.size() < 4) return 0;
  try {
    return calc_volume(calc_hull(points));
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

}  // namespace rubble
