#include "kernel/geometry/hull.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <stdexcept>
#include <utility>

namespace rubble {
namespace {

// With 2^19 steps every product below stays under 2^60.
constexpr double kGridSteps = 524288.0;
constexpr double kNarrowSteps = 8;  // faces that are narrower than so many are of rounding alone
// Faces are merged when their normals differ by less than about 1 degree, and only while every
// corner stays this near to the plane of the largest among them. The angle alone would make one
// bent polygon of several sides of a fine drum. Packs write corners to 0.01 mm.
constexpr double kCoplanarCosine = 0.99985;
constexpr double kPlanarShare = 1e-5;  // of the hull's longest extent
constexpr double kPlanarLeast = 3e-5;  // unit: m

struct GridPoint {
  std::int64_t x, y, z;
  bool operator<(const GridPoint& b) const {
    return x != b.x ? x < b.x : (y != b.y ? y < b.y : z < b.z);
  }
  bool operator==(const GridPoint& b) const { return x == b.x && y == b.y && z == b.z; }
};
GridPoint operator-(const GridPoint& a, const GridPoint& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GridPoint cross(const GridPoint& a, const GridPoint& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
std::int64_t dot(const GridPoint& a, const GridPoint& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
bool is_zero(const GridPoint& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

using Polygon = std::vector<int>;

class Wrapper {
 public:
  explicit Wrapper(std::vector<GridPoint> points) : points_(std::move(points)) {}

  std::vector<Polygon> wrap() {
    add_face(make_first_face());
    while (!open_.empty()) {
      const auto [a, b] = *open_.begin();
      add_face(make_face_over_edge(a, b));
    }
    return std::move(faces_);
  }

 private:
  GridPoint normal(int a, int b, int c) const {
    return cross(points_[b] - points_[a], points_[c] - points_[a]);
  }

  // A face that contains the edge a -> b: no point lies outside of its plane.
  Polygon make_face_over_edge(int a, int b) const {
    GridPoint n{0, 0, 0};
    for (int p = 0; p < int(points_.size()); ++p) {
      if (is_zero(n) || dot(n, points_[p] - points_[a]) > 0) {
        const GridPoint candidate = normal(a, b, p);
        if (!is_zero(candidate)) n = candidate;
      }
    }
    return make_polygon(coplanar(a, n), n);
  }

  // The vertical plane through the lowest point in (x, y) and its neighbour on the outline.
  Polygon make_first_face() const {
    const int start = int(std::min_element(points_.begin(), points_.end()) - points_.begin());
    GridPoint n{0, 0, 0};
    for (const GridPoint& p : points_) {
      const GridPoint d = p - points_[start];
      if (is_zero(n) ? (d.x != 0 || d.y != 0) : dot(n, d) > 0) n = {d.y, -d.x, 0};
    }
    if (is_zero(n)) throw std::invalid_argument("the points do not span a volume");
    const std::vector<int> side = coplanar(start, n);
    const auto by_position = [this](int a, int b) { return points_[a] < points_[b]; };
    const int a = *std::min_element(side.begin(), side.end(), by_position);
    const int b = *std::max_element(side.begin(), side.end(), by_position);
    for (int c : side) {
      if (!is_zero(normal(a, b, c))) return make_polygon(side, n);
    }
    return make_face_over_edge(a, b);
  }

  std::vector<int> coplanar(int a, const GridPoint& n) const {
    std::vector<int> result;
    for (int p = 0; p < int(points_.size()); ++p) {
      if (dot(n, points_[p] - points_[a]) == 0) result.push_back(p);
    }
    if (result.size() == points_.size()) {
      throw std::invalid_argument("the points do not span a volume");
    }
    return result;
  }

  // Outline of coplanar points, counter-clockwise about n, by wrapping in the plane.
  Polygon make_polygon(const std::vector<int>& members, const GridPoint& n) const {
    const auto turn = [&](int u, int v, int w) {
      const GridPoint c = cross(points_[v] - points_[u], points_[w] - points_[u]);
      const std::int64_t ax = std::abs(n.x), ay = std::abs(n.y), az = std::abs(n.z);
      if (ax >= ay && ax >= az) return n.x > 0 ? c.x : -c.x;
      if (ay >= az) return n.y > 0 ? c.y : -c.y;
      return n.z > 0 ? c.z : -c.z;
    };
    const auto farther = [&](int u, int v, int w) {
      const GridPoint dv = points_[v] - points_[u], dw = points_[w] - points_[u];
      return dot(dw, dw) > dot(dv, dv);
    };
    const int first = *std::min_element(members.begin(), members.end(), [this](int a, int b) {
      return points_[a] < points_[b];
    });
    Polygon polygon;
    for (int at = first;;) {
      polygon.push_back(at);
      int next = -1;
      for (int p : members) {
        if (p == at) continue;
        const std::int64_t t = next < 0 ? -1 : turn(at, next, p);
        if (t < 0 || (t == 0 && farther(at, next, p))) next = p;
      }
      at = next;
      if (at == first) return polygon;
      if (polygon.size() > members.size()) throw std::logic_error("hull: outline does not close");
    }
  }

  void add_face(Polygon face) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      const int a = face[i], b = face[(i + 1) % face.size()];
      if (!used_.insert({a, b}).second) throw std::logic_error("hull: an edge is used twice");
      open_.erase({a, b});
      if (used_.count({b, a}) == 0) open_.insert({b, a});
    }
    faces_.push_back(std::move(face));
  }

  std::vector<GridPoint> points_;
  std::vector<Polygon> faces_;
  std::set<std::pair<int, int>> used_, open_;
};

// Newell's normal: twice the area vector of a polygon.
Vec3 area_vector(const std::vector<Vec3>& points, const Polygon& face) {
  Vec3 sum;
  for (std::size_t i = 1; i + 1 < face.size(); ++i) {
    sum += cross(points[face[i]] - points[face[0]], points[face[i + 1]] - points[face[0]]);
  }
  return sum;
}

// The outline of a connected set of faces.
Polygon outline(const std::vector<Polygon>& faces, const std::vector<int>& group) {
  std::set<std::pair<int, int>> edges;
  for (int f : group) {
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      edges.insert({faces[f][i], faces[f][(i + 1) % faces[f].size()]});
    }
  }
  std::map<int, int> next;
  for (const auto& [a, b] : edges) {
    if (edges.count({b, a}) == 0) next[a] = b;
  }
  Polygon polygon;
  for (int at = next.begin()->first;;) {
    polygon.push_back(at);
    at = next.at(at);
    if (at == polygon.front()) break;
    if (polygon.size() > next.size()) return {};  // not a simple outline
  }
  return polygon.size() == next.size() ? polygon : Polygon{};
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
  std::map<std::pair<int, int>, int> face_of_edge;
  std::vector<Vec3> areas;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    areas.push_back(area_vector(points, faces[f]));
    for (std::size_t i = 0; i < faces[f].size(); ++i) {
      face_of_edge[{faces[f][i], faces[f][(i + 1) % faces[f].size()]}] = int(f);
    }
  }
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
        const int other = face_of_edge.at({face[(i + 1) % face.size()], face[i]});
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
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const Vec3 extent = box.max - box.min;
  const double longest = std::max(extent.x, std::max(extent.y, extent.z));
  if (points.size() < 4 || !(longest > 0)) {
    throw std::invalid_argument("the points do not span a volume");
  }
  std::map<GridPoint, int> unique;  // the first of equal points stays
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 g = (points[i] - box.min) * (kGridSteps / longest);
    unique.insert({{std::int64_t(g.x + 0.5), std::int64_t(g.y + 0.5), std::int64_t(g.z + 0.5)},
                   int(i)});
  }
  std::vector<GridPoint> grid;
  std::vector<int> source;
  for (const auto& [point, index] : unique) grid.push_back(point), source.push_back(index);

  std::vector<Vec3> candidates;
  for (int index : source) candidates.push_back(points[index]);
  const std::vector<Polygon> faces =
      merge_coplanar(candidates, Wrapper(std::move(grid)).wrap(),
                     std::max(kPlanarShare * longest, kPlanarLeast));

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
    const bool narrow = norm(area) <= 2 * kNarrowSteps / kGridSteps * size * longest;
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
