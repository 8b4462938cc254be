#include "kernel/geometry/decompose_voxels.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "kernel/geometry/hull.h"

namespace rubble::decomposing {
namespace {

// The primitive integer vectors of [-2, 2]^3: 98 directions, well spread.
const std::vector<Cell3>& directions() {
  static const std::vector<Cell3> all = [] {
    std::vector<Cell3> list;
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          const bool even = x % 2 == 0 && y % 2 == 0 && z % 2 == 0;
          if (!even) list.push_back({x, y, z});
        }
      }
    }
    return list;
  }();
  return all;
}

}  // namespace

double calc_hull_volume(const std::vector<Vec3>& points) {
  if (points.size() < 4) return 0;
  try {
    const Hull hull = calc_hull(points);
    double six = 0;
    for (const std::vector<int>& face : hull.faces) {
      const Vec3& a = hull.points[std::size_t(face[0])];
      for (std::size_t k = 2; k < face.size(); ++k) {
        six += dot(a - points[0], cross(hull.points[std::size_t(face[k - 1])] - points[0],
                                        hull.points[std::size_t(face[k])] - points[0]));
      }
    }
    return six / 6;
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

Voxels::Voxels(const TriangleMesh& mesh, int resolution) {
  const Aabb box = mesh.bounds();
  const Vec3 extent = box.max - box.min;
  edge_ = std::max({extent.x, extent.y, extent.z}) / resolution;
  for (int i = 0; i < 3; ++i) size_[std::size_t(i)] = int(extent[i] / edge_) + 3;
  const Vec3 span = Vec3(size_[0], size_[1], size_[2]) * edge_;
  origin_ = (box.min + box.max) * 0.5 - span * 0.5;
  state_.assign(std::size_t(size_[0]) * std::size_t(size_[1]) * std::size_t(size_[2]), kUnknown);
  for (const auto& t : mesh.triangles) {
    mark_triangle(Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]),
                  Vec3(mesh.positions[t[2]]));
  }
  flood_outside();
}

// Points over the triangle, closer than half a voxel.
void Voxels::mark_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double longest = std::max({distance(a, b), distance(b, c), distance(c, a)});
  const int steps = std::max(1, int(longest / (0.45 * edge_)) + 1);
  for (int u = 0; u <= steps; ++u) {
    for (int v = 0; u + v <= steps; ++v) {
      const Vec3 p = a + (b - a) * (double(u) / steps) + (c - a) * (double(v) / steps);
      const Vec3 q = (p - origin_) * (1 / edge_);
      const auto at = [&](int axis) {
        return std::clamp(int(std::floor(q[axis])), 0, size_[std::size_t(axis)] - 1);
      };
      state_[index(at(0), at(1), at(2))] = kSurface;
    }
  }
}

void Voxels::flood_outside() {
  std::vector<Cell3> open{{0, 0, 0}};
  state_[0] = kOutside;
  while (!open.empty()) {
    const Cell3 c = open.back();
    open.pop_back();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const int step : {-1, 1}) {
        Cell3 next = c;
        next[axis] += step;
        if (next[axis] < 0 || next[axis] >= size_[axis]) continue;
        std::uint8_t& state = state_[index(next[0], next[1], next[2])];
        if (state != kUnknown) continue;
        state = kOutside;
        open.push_back(next);
      }
    }
  }
}

bool Voxels::surely_inside(const Cell3& corner) const {
  bool wholly = false;
  for (int i = 0; i < 8; ++i) {
    const int x = corner[0] - (i & 1), y = corner[1] - (i >> 1 & 1), z = corner[2] - (i >> 2);
    if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) return false;
    const std::uint8_t state = state_[index(x, y, z)];
    if (state == kOutside) return false;
    wholly = wholly || state == kUnknown;
  }
  return wholly;
}

Voxels::Fill Voxels::measure(const Box& box) const {
  Fill fill;
  std::vector<Cell3> ends;  // the first and last filled voxel of each row
  for (int z = box.low[2]; z < box.high[2]; ++z) {
    for (int y = box.low[1]; y < box.high[1]; ++y) {
      int first = -1, last = -1;
      for (int x = box.low[0]; x < box.high[0]; ++x) {
        if (!filled(x, y, z)) continue;
        first = first < 0 ? x : first;
        last = x;
        fill.voxels += 1;
      }
      if (first < 0) continue;
      ends.push_back({first, y, z});
      if (last != first) ends.push_back({last, y, z});
    }
  }
  if (ends.empty()) return fill;
  std::vector<Vec3> points;
  for (const Cell3& d : directions()) {
    int best = -1000000;
    const Cell3* at = nullptr;
    for (const Cell3& c : ends) {
      const int height = d[0] * c[0] + d[1] * c[1] + d[2] * c[2];
      if (height > best) best = height, at = &c;
    }
    // Where the direction is level along an axis both ends of the voxel count.
    for (int i = 0; i < 8; ++i) {
      bool extreme = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool high = i >> axis & 1;
        extreme = extreme && (high ? d[axis] >= 0 : d[axis] <= 0);
      }
      if (extreme) points.push_back(Vec3((*at)[0] + (i & 1), (*at)[1] + (i >> 1 & 1), (*at)[2] + (i >> 2)));
    }
  }
  fill.hull = calc_hull_volume(points);
  return fill;
}

Box Voxels::tight(const Box& box) const {
  Box result{box.high, box.low};
  for (int z = box.low[2]; z < box.high[2]; ++z) {
    for (int y = box.low[1]; y < box.high[1]; ++y) {
      for (int x = box.low[0]; x < box.high[0]; ++x) {
        if (!filled(x, y, z)) continue;
        const Cell3 c{x, y, z};
        for (std::size_t i = 0; i < 3; ++i) {
          result.low[i] = std::min(result.low[i], c[i]);
          result.high[i] = std::max(result.high[i], c[i] + 1);
        }
      }
    }
  }
  return result;
}

}  // namespace rubble::decomposing
