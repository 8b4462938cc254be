#include "kernel/base/mesh.h"

#include "kernel/base/mesh_edges.h"

namespace rubble {

PaintCorner between(const PaintCorner& a, const PaintCorner& b, float share) {
  return {a.u + (b.u - a.u) * share, a.v + (b.v - a.v) * share, a.colour + (b.colour - a.colour) * share};
}

Aabb TriangleMesh::bounds() const {
  Aabb box;
  for (const Vec3f& p : positions) box.include(Vec3(p));
  return box;
}

// Sums over the tetrahedra (origin, a, b, c): the integral of x_i x_j over one of them is
// det / 120 * (sum_k p_k,i p_k,j + (sum_k p_k,i)(sum_k p_k,j)) with k over its three corners.
VolumeProperties calc_volume_properties(const TriangleMesh& mesh) {
  double volume = 0;
  Vec3 first;
  Mat3 second{};
  for (const auto& t : mesh.triangles) {
    const Vec3 p[3] = {Vec3(mesh.positions[t[0]]), Vec3(mesh.positions[t[1]]),
                       Vec3(mesh.positions[t[2]])};
    const double det = dot(p[0], cross(p[1], p[2]));
    const Vec3 sum = p[0] + p[1] + p[2];
    volume += det / 6.0;
    first += sum * (det / 24.0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        second.rows[i][j] += det / 120.0 *
                             (p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j] +
                              sum[i] * sum[j]);
  }
  VolumeProperties result;
  result.volume = volume;
  if (volume == 0.0) return result;
  const Vec3 c = first * (1.0 / volume);
  result.centre_of_mass = c;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) second.rows[i][j] -= volume * c[i] * c[j];
  const double trace = second.rows[0].x + second.rows[1].y + second.rows[2].z;
  result.inertia = Mat3::diagonal({trace, trace, trace}) + second * -1.0;
  return result;
}

bool is_closed(const TriangleMesh& mesh) { return !mesh.triangles.empty() && find_open_edges(mesh).count == 0; }

}  // namespace rubble
