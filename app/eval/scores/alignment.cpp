#include "app/eval/scores/alignment.h"

#include <Eigen/Eigenvalues>

namespace rubble {
namespace {

Vec3 calc_mean(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3& p : points) sum += p;
  return sum * (1.0 / double(points.size()));
}

// The sums of squared distances from the mean along the principal axes, ascending.
Eigen::Vector3d calc_spreads(const std::vector<Vec3>& points, const Vec3& mean) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vec3& p : points) {
    const Eigen::Vector3d d(p.x - mean.x, p.y - mean.y, p.z - mean.z);
    spread += d * d.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvalues();
}

// Whether the points span at least a plane: the second largest spread against the largest.
bool span_plane(const std::vector<Vec3>& points) {
  const Eigen::Vector3d spreads = calc_spreads(points, calc_mean(points));
  return spreads[1] > 1e-12 * spreads[2];
}

bool span_line(const std::vector<Vec3>& points) { return calc_spreads(points, calc_mean(points))[2] > 0; }

// Horn's matrix, whose eigenvector of the largest eigenvalue is the rotation.
Eigen::Matrix4d make_matrix(const Eigen::Matrix3d& s) {
  Eigen::Matrix4d n;
  n << s(0, 0) + s(1, 1) + s(2, 2), s(1, 2) - s(2, 1), s(2, 0) - s(0, 2), s(0, 1) - s(1, 0),  //
      s(1, 2) - s(2, 1), s(0, 0) - s(1, 1) - s(2, 2), s(0, 1) + s(1, 0), s(2, 0) + s(0, 2),   //
      s(2, 0) - s(0, 2), s(0, 1) + s(1, 0), s(1, 1) - s(0, 0) - s(2, 2), s(1, 2) + s(2, 1),   //
      s(0, 1) - s(1, 0), s(2, 0) + s(0, 2), s(1, 2) + s(2, 1), s(2, 2) - s(0, 0) - s(1, 1);
  return n;
}

}  // namespace

std::optional<Similarity> align_points(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                       bool with_scale) {
  if (from.size() < 3 || to.size() < 3 || !span_plane(from) || !span_plane(to)) return std::nullopt;
  return align_for_distances(from, to, with_scale);
}

std::optional<Similarity> align_for_distances(const std::vector<Vec3>& from, const std::vector<Vec3>& to,
                                              bool with_scale) {
  if (from.size() != to.size() || from.size() < 3 || !span_line(from) || !span_line(to)) return std::nullopt;
  const Vec3 a = calc_mean(from), b = calc_mean(to);
  Eigen::Matrix3d s = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 x = from[i] - a, y = to[i] - b;
    s += Eigen::Vector3d(x.x, x.y, x.z) * Eigen::RowVector3d(y.x, y.y, y.z);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(make_matrix(s));
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  Similarity result;
  result.rotation = normalized(Quat{q[0], q[1], q[2], q[3]});
  if (with_scale) {
    double product = 0, square = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      product += dot(to[i] - b, result.rotation.rotate(from[i] - a));
      square += dot(from[i] - a, from[i] - a);
    }
    result.scale = product / square;
  }
  result.translation = b - result.scale * result.rotation.rotate(a);
  return result;
}

}  // namespace rubble
