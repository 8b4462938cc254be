#include "tests/assets/probe.h"

#include <algorithm>
#include <cmath>

#include "kernel/base/random.h"

namespace rubble::test {
namespace {

constexpr int kSamplesInParts = 20000;

using Planes = std::vector<std::vector<HalfSpace>>;

Planes all_planes(const std::vector<Part>& parts) {
  Planes planes;
  for (const Part& part : parts) planes.push_back(planes_of(part));
  return planes;
}

}  // namespace

std::vector<HalfSpace> planes_of(const Part& part) {
  std::vector<HalfSpace> planes;
  for (const auto& t : part.hull.triangles) {
    const Vec3 &a = part.points[t[0]], &b = part.points[t[1]], &c = part.points[t[2]];
    const Vec3 n = normalized(cross(b - a, c - a));
    planes.push_back({n, dot(n, a)});
  }
  return planes;
}

double height_above(const std::vector<HalfSpace>& part, const Vec3& p) {
  double height = -1e9;
  for (const HalfSpace& plane : part) {
    height = std::max(height, dot(plane.normal, p) - plane.offset);
  }
  return height;
}

double distance_to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = cross(b - a, c - a);
  const Vec3 corners[3] = {a, b, c};
  bool over = true;
  double nearest = 1e18;
  for (int i = 0; i < 3; ++i) {
    const Vec3 &from = corners[i], edge = corners[(i + 1) % 3] - from;
    over = over && dot(cross(n, edge), p - from) >= 0;
    const double t = std::clamp(dot(p - from, edge) / dot(edge, edge), 0.0, 1.0);
    nearest = std::min(nearest, distance(p, from + edge * t));
  }
  return over ? std::fabs(dot(n, p - a)) / norm(n) : nearest;
}

double distance_to_mesh(const Vec3& p, const TriangleMesh& mesh) {
  double nearest = 1e18;
  for (const auto& t : mesh.triangles) {
    const Vec3 a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
    // A sphere about the triangle tells most of them apart at little cost.
    const double radius = std::max(distance(a, b), distance(a, c));
    if (distance(p, a) - radius < nearest) {
      nearest = std::min(nearest, distance_to_triangle(p, a, b, c));
    }
  }
  return nearest;
}

std::vector<Vec3> exposed_points(const std::vector<Part>& parts, double spacing) {
  const Planes planes = all_planes(parts);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (const auto& t : parts[i].hull.triangles) {
      const Vec3 &a = parts[i].points[t[0]], &b = parts[i].points[t[1]], &c = parts[i].points[t[2]];
      const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
      const int steps = std::max(1, static_cast<int>(longest / spacing));
      for (int u = 0; u <= steps; ++u) {
        for (int v = 0; u + v <= steps; ++v) {
          const Vec3 p = a + (b - a) * (double(u) / steps) + (c - a) * (double(v) / steps);
          bool free = true;
          for (std::size_t k = 0; k < parts.size(); ++k) {
            free = free && (k == i || height_above(planes[k], p) > 1e-5);
          }
          if (free) points.push_back(p);
        }
      }
    }
  }
  return points;
}

double calc_union_volume(const std::vector<Part>& parts) {
  const Planes planes = all_planes(parts);
  // Sampled part by part, counting each point by one over the number of parts that hold it.
  double volume = 0;
  RandomStream random(1, "union volume");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Aabb box = parts[i].hull.bounds();
    const Vec3 size = box.max - box.min;
    double sum = 0;
    for (int s = 0; s < kSamplesInParts; ++s) {
      const Vec3 p = box.min + Vec3{size.x * random.uniform(), size.y * random.uniform(),
                                    size.z * random.uniform()};
      if (height_above(planes[i], p) > 0) continue;
      int holders = 1;
      for (std::size_t k = 0; k < parts.size(); ++k) {
        holders += k != i && height_above(planes[k], p) <= 0;
      }
      sum += 1.0 / holders;
    }
    volume += size.x * size.y * size.z * sum / kSamplesInParts;
  }
  return volume;
}

}  // namespace rubble::test
