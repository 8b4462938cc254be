#include "bench/equilibrium/contact_patch.h"

#include <algorithm>
#include <cmath>

namespace rubble {
namespace {

// Corners of a patch that are nearer to each other, or to the line between their neighbours, add
// nothing to what forces can do there. unit: m
constexpr double kMerge = 1e-4;
constexpr double kLevel = 1e-7;  // a plane whose normal has less along a line is parallel to it

using Polygon = std::vector<Vec3>;

Polygon clip(const Polygon& polygon, const RegionPlane& plane) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
    const double hp = dot(plane.normal, p) - plane.offset;
    const double hq = dot(plane.normal, q) - plane.offset;
    if (hp <= 0) kept.push_back(p);
    if ((hp < 0 && hq > 0) || (hp > 0 && hq < 0)) kept.push_back(p + (q - p) * (hp / (hp - hq)));
  }
  return kept;
}

void add_clipped(const ConvexRegion& faces, const Vec3& moved, const ConvexRegion& by,
                 const Vec3& by_moved, std::vector<Vec3>& points) {
  for (Polygon polygon : faces.faces) {
    for (Vec3& p : polygon) p += moved;
    for (const RegionPlane& plane : by.planes) {
      if (polygon.empty()) break;
      polygon = clip(polygon, {plane.normal, plane.offset + dot(plane.normal, by_moved)});
    }
    points.insert(points.end(), polygon.begin(), polygon.end());
  }
}

// How far the line from p along `direction` goes before it leaves the region.
double find_exit(const ConvexRegion& region, const Vec3& p, const Vec3& direction) {
  double exit = 1e300;
  for (const RegionPlane& plane : region.planes) {
    const double along = dot(plane.normal, direction);
    if (along > kLevel) exit = std::min(exit, (plane.offset - dot(plane.normal, p)) / along);
  }
  return exit;
}

struct Flat {
  double x, y;
};

double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

double distance_to_line(const Flat& p, const Flat& a, const Flat& b) {
  const double length = std::hypot(b.x - a.x, b.y - a.y);
  return length > 0 ? std::abs(turn(a, b, p)) / length : std::hypot(p.x - a.x, p.y - a.y);
}

// Andrew's monotone chain.
std::vector<Flat> make_hull(std::vector<Flat> points) {
  std::sort(points.begin(), points.end(), [](const Flat& p, const Flat& q) {
    return std::make_pair(p.x, p.y) < std::make_pair(q.x, q.y);
  });
  std::vector<Flat> hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t begin = hull.size();
    for (const Flat& p : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull.empty() ? std::vector<Flat>{points.front()} : hull;
}

// Drops what adds less than kMerge to the region.
std::vector<Flat> simplify(std::vector<Flat> hull) {
  for (std::size_t i = 0; i < hull.size() && hull.size() > 1;) {
    const Flat& before = hull[(i + hull.size() - 1) % hull.size()];
    const Flat& after = hull[(i + 1) % hull.size()];
    const bool twin = std::hypot(hull[i].x - before.x, hull[i].y - before.y) < kMerge;
    if (twin || (hull.size() > 2 && distance_to_line(hull[i], before, after) < kMerge)) {
      hull.erase(hull.begin() + std::ptrdiff_t(i));
    } else {
      ++i;
    }
  }
  return hull;
}

}  // namespace

ConvexRegion make_region(const PlacedHull& hull) {
  ConvexRegion region;
  for (const TrueHull::Face& face : hull.hull.faces) {
    const Vec3& corner = hull.hull.corners[std::size_t(face.loop.front())];
    region.planes.push_back({face.normal, dot(face.normal, corner)});
    region.faces.emplace_back();
    for (int i : face.loop) region.faces.back().push_back(hull.hull.corners[std::size_t(i)]);
  }
  return region;
}

ConvexRegion make_column(const Vec3 (&triangle)[3], const Vec3& normal, double depth) {
  ConvexRegion column;
  const double top = dot(normal, triangle[0]);
  column.planes.push_back({normal, top});
  column.planes.push_back({-normal, depth - top});
  for (int i = 0; i < 3; ++i) {
    const Vec3 side = normalized(cross(triangle[(i + 1) % 3] - triangle[i], normal));
    column.planes.push_back({side, dot(side, triangle[i])});
  }
  column.faces.push_back({triangle[0], triangle[1], triangle[2]});
  return column;
}

std::vector<Vec3> find_patch(const ConvexRegion& a, const ConvexRegion& b, const Vec3& normal,
                             double tolerance) {
  const Vec3 moved = normal * tolerance, still;
  std::vector<Vec3> points;
  add_clipped(b, still, a, moved, points);
  add_clipped(a, moved, b, still, points);
  if (points.empty()) return {};
  const Vec3 least = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(normal, least)), v = cross(normal, u), origin = points.front();
  std::vector<Flat> shadow;
  for (const Vec3& p : points) shadow.push_back({dot(u, p - origin), dot(v, p - origin)});
  std::vector<Vec3> patch;
  for (const Flat& f : simplify(make_hull(shadow))) {
    const Vec3 p = origin + u * f.x + v * f.y;
    const double top_of_a = find_exit(a, p, normal), bottom_of_b = -find_exit(b, p, -normal);
    patch.push_back(p + normal * (0.5 * (top_of_a + bottom_of_b)));
  }
  return patch;
}

}  // namespace rubble
