#include "bench/true_hull.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

namespace rubble {
namespace {

// Points nearer to a plane than this, relative to the size of the hull, lie in it.
constexpr double kFlat = 1e-9;
// Unit directions whose cross product is shorter than this are parallel.
constexpr double kParallelSine = 1e-9;

using Members = std::vector<int>;  // corners in one supporting plane, ascending

struct Plane {
  bool supporting = false;  // all points on one side
  Members members;
};

Plane find_plane(const std::vector<Vec3>& points, int i, int j, int k, double size) {
  Plane plane;
  const Vec3 normal = cross(points[j] - points[i], points[k] - points[i]);
  const double length = norm(normal);
  if (length <= kFlat * size * size) return plane;
  bool above = false, below = false;
  for (int p = 0; p < int(points.size()); ++p) {
    const double height = dot(normal, points[p] - points[i]) / length;
    above = above || height > kFlat * size;
    below = below || height < -kFlat * size;
    if (above && below) return plane;
    if (height <= kFlat * size && height >= -kFlat * size) plane.members.push_back(p);
  }
  plane.supporting = above || below;
  return plane;
}

void add_direction(std::vector<Vec3>& directions, const Vec3& direction) {
  const Vec3 unit = normalized(direction);
  for (const Vec3& d : directions) {
    if (norm(cross(d, unit)) < kParallelSine) return;
  }
  directions.push_back(unit);
}

// The members that span the face, counter-clockwise about its normal.
std::vector<int> make_loop(const std::vector<Vec3>& points, const Members& members,
                           const Vec3& normal) {
  const Vec3 least = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(normal, least)), v = cross(normal, u);
  const auto x = [&](int i) { return dot(u, points[i]); };
  const auto y = [&](int i) { return dot(v, points[i]); };
  std::vector<int> order = members, loop;
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    return std::make_pair(x(i), y(i)) < std::make_pair(x(j), y(j));
  });
  // Andrew's monotone chain: the lower side from left to right, then the upper one back.
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = loop.size();
    for (int i : order) {
      while (loop.size() >= begin + 2) {
        const int a = loop[loop.size() - 2], b = loop.back();
        if ((x(b) - x(a)) * (y(i) - y(a)) > (y(b) - y(a)) * (x(i) - x(a))) break;
        loop.pop_back();
      }
      loop.push_back(i);
    }
    loop.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return loop;
}

Vec3 outward_normal(const std::vector<Vec3>& points, int i, int j, int k, const Vec3& middle) {
  const Vec3 normal = normalized(cross(points[j] - points[i], points[k] - points[i]));
  return dot(normal, middle - points[i]) > 0 ? -normal : normal;
}

double longest_extent(const std::vector<Vec3>& points) {
  Aabb box;
  for (const Vec3& p : points) box.include(p);
  const Vec3 extent = box.max - box.min;
  return std::max({extent.x, extent.y, extent.z});
}

}  // namespace

TrueHull make_true_hull(const std::vector<Vec3>& points) {
  const int count = int(points.size());
  const double size = count > 0 ? longest_extent(points) : 0;
  std::set<Members> faces;
  TrueHull hull;
  Vec3 middle;
  for (const Vec3& p : points) middle += p * (1.0 / count);
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      for (int k = j + 1; k < count; ++k) {
        const Plane plane = find_plane(points, i, j, k, size);
        if (!plane.supporting || !faces.insert(plane.members).second) continue;
        const Vec3 normal = outward_normal(points, i, j, k, middle);
        add_direction(hull.face_normals, normal);
        hull.faces.push_back({normal, make_loop(points, plane.members, normal)});
      }
    }
  }
  if (faces.size() < 4) throw std::invalid_argument("the points do not span a volume");
  std::map<std::pair<int, int>, int> faces_of_pair;
  std::set<int> corners;
  for (const Members& face : faces) {
    corners.insert(face.begin(), face.end());
    for (std::size_t a = 0; a < face.size(); ++a) {
      for (std::size_t b = a + 1; b < face.size(); ++b) ++faces_of_pair[{face[a], face[b]}];
    }
  }
  for (const auto& [pair, shared] : faces_of_pair) {
    if (shared >= 2) add_direction(hull.edge_directions, points[pair.second] - points[pair.first]);
  }
  std::map<int, int> number;  // of each corner, by its place among the points
  for (int corner : corners) {
    number[corner] = int(hull.corners.size());
    hull.corners.push_back(points[corner]);
  }
  for (TrueHull::Face& face : hull.faces)
    for (int& corner : face.loop) corner = number[corner];
  return hull;
}

PlacedHull place_hull(const TrueHull& hull, double scale, const Pose& world_from_body) {
  PlacedHull placed;
  for (const Vec3& corner : hull.corners) {
    const Vec3 p = world_from_body * (corner * scale);
    placed.hull.corners.push_back(p);
    placed.box.include(p);
    placed.middle += p;
  }
  placed.middle *= 1.0 / double(hull.corners.size());
  for (const TrueHull::Face& face : hull.faces) {
    placed.hull.faces.push_back({world_from_body.rotation.rotate(face.normal), face.loop});
  }
  for (const Vec3& n : hull.face_normals) {
    placed.hull.face_normals.push_back(world_from_body.rotation.rotate(n));
  }
  for (const Vec3& d : hull.edge_directions) {
    placed.hull.edge_directions.push_back(world_from_body.rotation.rotate(d));
  }
  return placed;
}

}  // namespace rubble
