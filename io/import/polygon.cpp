#include "io/import/polygon.h"

#include <cmath>
#include <numeric>

namespace rubble {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

constexpr std::size_t kMostClipped = 1024;  // ear clipping may take time with the cube of the corners

struct Flat {
  double x = 0, y = 0;
};

double turn(const Flat& a, const Flat& b, const Flat& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Newell's: twice the area, along the normal.
Vec3 area_of(const std::vector<Vec3>& corners) {
  Vec3 area;
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  return area;
}

// Along the largest component of the area, seen from the side from which the polygon turns to the left.
std::vector<Flat> flatten(const std::vector<Vec3>& corners, const Vec3& area) {
  const int drop = longest_axis(Vec3{std::fabs(area.x), std::fabs(area.y), std::fabs(area.z)});
  const int u = (drop + 1) % 3, v = (drop + 2) % 3;
  std::vector<Flat> flat;
  for (const Vec3& p : corners)
    flat.push_back(area[drop] > 0 ? Flat{p[u], p[v]} : Flat{p[v], p[u]});
  return flat;
}

bool is_convex(const std::vector<Flat>& flat) {
  for (std::size_t i = 0; i < flat.size(); ++i)
    if (turn(flat[i], flat[(i + 1) % flat.size()], flat[(i + 2) % flat.size()]) < 0) return false;
  return true;
}

Triangles fan(std::size_t count, std::size_t first = 0) {
  Triangles out;
  for (std::size_t i = 2; i < count; ++i)
    out.push_back({std::uint32_t(first), std::uint32_t((first + i - 1) % count), std::uint32_t((first + i) % count)});
  return out;
}

bool is_ear(const std::vector<Flat>& flat, const std::vector<std::uint32_t>& left, std::size_t at) {
  const std::size_t n = left.size();
  const std::uint32_t a = left[(at + n - 1) % n], b = left[at], c = left[(at + 1) % n];
  if (turn(flat[a], flat[b], flat[c]) <= 0) return false;
  for (const std::uint32_t i : left) {
    if (i == a || i == b || i == c) continue;
    const Flat& p = flat[i];
    if ((p.x == flat[a].x && p.y == flat[a].y) || (p.x == flat[c].x && p.y == flat[c].y)) continue;  // a bridge to a hole
    if (turn(flat[a], flat[b], p) >= 0 && turn(flat[b], flat[c], p) >= 0 && turn(flat[c], flat[a], p) >= 0) return false;
  }
  return true;
}

Triangles clip_ears(const std::vector<Flat>& flat) {
  std::vector<std::uint32_t> left(flat.size());
  std::iota(left.begin(), left.end(), 0u);
  Triangles out;
  while (left.size() > 3) {
    std::size_t at = 0;
    while (at < left.size() && !is_ear(flat, left, at)) ++at;
    if (at == left.size()) at = 0;  // it crosses itself
    const std::size_t n = left.size();
    out.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
    left.erase(left.begin() + std::ptrdiff_t(at));
  }
  out.push_back({left[0], left[1], left[2]});
  return out;
}

}  // namespace

Triangles triangulate(const std::vector<Vec3>& corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{0, 1, 2}};
  const Vec3 area = area_of(corners);
  if (!(dot(area, area) > 0) || !std::isfinite(dot(area, area)) || corners.size() > kMostClipped)
    return fan(corners.size());
  const std::vector<Flat> flat = flatten(corners, area);
  if (is_convex(flat)) return fan(corners.size());
  if (corners.size() == 4)  // the fan about the corner that points inwards
    for (std::size_t i = 0; i < 4; ++i)
      if (turn(flat[(i + 3) % 4], flat[i], flat[(i + 1) % 4]) < 0) return fan(4, i);
  return clip_ears(flat);
}

}  // namespace rubble
