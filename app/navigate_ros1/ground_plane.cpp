#include "app/navigate_ros1/ground_plane.h"

#include <cmath>

namespace rubble {
namespace {

// What counts is ever farther away, and ever nearer to the plane found so far; unit: m.
struct Pass {
  double reach, band;
};
constexpr Pass kPasses[]{{1.5, 0.12}, {2.2, 0.08}, {3, 0.06}, {3, 0.04}, {3, 0.03}};
constexpr int kFewestOfGround = 60;         // points
constexpr double kSteepest = 0.47;  // tan(25 degrees)

// Sums of least squares for a plane, of one sort of points.
struct PlaneSums {
  Mat3 normal = Mat3::diagonal({0, 0, 0});
  Vec3 right;
  int count = 0;

  void add(const Vec3& p) {
    const Vec3 row{p.x, p.y, 1};
    for (int i = 0; i < 3; ++i) normal.rows[i] += row * row[i];
    right += row * p.z;
    ++count;
  }
  // By Cramer's rule; false where the points lie on a line.
  bool solve(GroundPlane& plane) const {
    const Mat3 columns = normal.transposed();
    const Vec3 &a = columns.rows[0], &b = columns.rows[1], &c = columns.rows[2];
    const double volume = dot(a, cross(b, c)), scale = double(count);
    if (!(volume > 1e-3 * scale * scale * scale)) return false;
    plane = {dot(right, cross(b, c)) / volume, dot(a, cross(right, c)) / volume, dot(a, cross(b, right)) / volume};
    return true;
  }
};

}  // namespace

Pose GroundPlane::level_from_base() const {
  const Vec3 up = normalized(Vec3{-along_x, -along_y, 1});
  // The shortest turn from `up` to Z.
  const Quat turn = normalized(Quat{1 + up.z, up.y, -up.x, 0});
  return {turn, {0, 0, -height * up.z}};
}

GroundPlane find_ground(const std::vector<Vec3>& points, const GroundPlane& before) {
  GroundPlane plane = before;
  for (const Pass& pass : kPasses) {
    PlaneSums sums;
    for (const Vec3& p : points) {
      const double off = p.z - (plane.along_x * p.x + plane.along_y * p.y + plane.height);
      if (p.x * p.x + p.y * p.y < pass.reach * pass.reach && std::fabs(off) < pass.band) sums.add(p);
    }
    if (sums.count < kFewestOfGround || !sums.solve(plane)) return before;
  }
  return std::hypot(plane.along_x, plane.along_y) < kSteepest ? plane : before;
}

}  // namespace rubble
