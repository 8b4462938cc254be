#include "io/scenes/sim_scene.h"

#include <cmath>

#include "kernel/base/inertia.h"
#include "kernel/geometry/lattice_hull.h"

namespace rubble {
namespace {

// The quaternion of a rotation matrix, by its largest component (Shepperd 1978).
Quat quat_of(const Mat3& m) {
  const double trace = m.rows[0].x + m.rows[1].y + m.rows[2].z;
  const double squares[4] = {trace, m.rows[0].x * 2 - trace, m.rows[1].y * 2 - trace, m.rows[2].z * 2 - trace};
  int largest = 0;
  for (int i = 1; i < 4; ++i)
    if (squares[i] > squares[largest]) largest = i;
  const double twice = std::sqrt(1 + squares[largest]);  // of the component
  const double over = 0.5 / twice;
  const double yz = m.rows[2].y - m.rows[1].z, zx = m.rows[0].z - m.rows[2].x, xy = m.rows[1].x - m.rows[0].y;
  const double sum_yz = m.rows[2].y + m.rows[1].z, sum_zx = m.rows[0].z + m.rows[2].x, sum_xy = m.rows[1].x + m.rows[0].y;
  if (largest == 0) return normalized(Quat{0.5 * twice, yz * over, zx * over, xy * over});
  if (largest == 1) return normalized(Quat{yz * over, 0.5 * twice, sum_xy * over, sum_zx * over});
  if (largest == 2) return normalized(Quat{zx * over, sum_xy * over, 0.5 * twice, sum_yz * over});
  return normalized(Quat{xy * over, sum_zx * over, sum_yz * over, 0.5 * twice});
}

constexpr double kSquare = 1e-4;  // cosine between edges of a box at most
constexpr double kEqual = 1e-4;   // relative difference of opposite edges of a box at most

}  // namespace

Pose parent_from_child(const SimModel& model, const SimJoint& joint) {
  return model.links[std::size_t(joint.parent)].world_from_link.inverse() *
         model.links[std::size_t(joint.child)].world_from_link;
}

const SimJoint* find_parent_joint(const SimModel& model, int link) {
  for (const SimJoint& joint : model.joints)
    if (joint.child == link && !joint.loop) return &joint;
  return nullptr;
}

PrincipalInertia calc_principal_inertia(const Mat3& inertia) {
  Mat3 axes;
  const Vec3 moments = find_principal_axes(inertia, axes);
  return {moments, quat_of(axes)};
}

std::vector<std::array<int, 3>> calc_hull_triangles(const Hull& hull) {
  const LatticePoints rounded = round_to_lattice(hull.points);
  std::vector<std::array<int, 3>> triangles;
  for (const Polygon& face : calc_lattice_hull(rounded.grid)) {
    const auto corner = [&](std::size_t i) { return rounded.source[std::size_t(face[i])]; };
    for (std::size_t i = 1; i + 1 < face.size(); ++i) triangles.push_back({corner(0), corner(i), corner(i + 1)});
  }
  return triangles;
}

// A corner's three edges span the box; all eight corners must be where they put them.
std::optional<SimBox> find_box(const Hull& hull) {
  if (hull.points.size() != 8 || hull.faces.size() != 6) return std::nullopt;
  std::vector<int> neighbours;
  for (const std::vector<int>& face : hull.faces) {
    if (face.size() != 4) return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i)
      if (face[i] == 0) neighbours.push_back(face[(i + 1) % 4]);
  }
  if (neighbours.size() != 3) return std::nullopt;
  const Vec3 corner = hull.points[0];
  Vec3 edges[3];
  for (int i = 0; i < 3; ++i) edges[i] = hull.points[std::size_t(neighbours[std::size_t(i)])] - corner;
  const double size = norm(edges[0] + edges[1] + edges[2]);
  for (int i = 0; i < 3; ++i) {
    const Vec3 &a = edges[i], &b = edges[(i + 1) % 3];
    if (std::abs(dot(a, b)) > kSquare * norm(a) * norm(b)) return std::nullopt;
  }
  for (int bits = 0; bits < 8; ++bits) {
    Vec3 expected = corner;
    for (int i = 0; i < 3; ++i)
      if (bits >> i & 1) expected += edges[i];
    bool found = false;
    for (const Vec3& point : hull.points) found = found || distance(point, expected) < kEqual * size;
    if (!found) return std::nullopt;
  }
  if (dot(cross(edges[0], edges[1]), edges[2]) < 0) std::swap(edges[0], edges[1]);
  // Right angles in all digits: the second edge across the first, the third across both.
  const Vec3 x = normalized(edges[0]), z = normalized(cross(edges[0], edges[1])), y = cross(z, x);
  SimBox box;
  box.size = {norm(edges[0]), norm(edges[1]), norm(edges[2])};
  box.shape_from_box = {quat_of(Mat3{{x, y, z}}.transposed()), corner + (edges[0] + edges[1] + edges[2]) * 0.5};
  return box;
}

}  // namespace rubble
