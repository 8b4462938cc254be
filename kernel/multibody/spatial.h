// Spatial vectors: motions, momenta and forces of six numbers about one reference point
// (Featherstone, Rigid Body Dynamics Algorithms, 2008). A motion is the angular velocity and the
// velocity of the material point at the reference; a momentum or a force is the moment about the
// reference and the linear part.
//
// Written with the vector extension of GCC and Clang, two numbers at a time: every lane is computed
// by the plain IEEE operations in the order written, on any machine.
#pragma once

#include "kernel/base/math.h"

namespace rubble {

typedef double Double2 __attribute__((vector_size(16)));

struct Spatial {
  Double2 pairs[3]{};  // angular x y, angular z and linear x, linear y z

  Spatial() = default;
  Spatial(const Vec3& angular, const Vec3& linear)
      : pairs{{angular.x, angular.y}, {angular.z, linear.x}, {linear.y, linear.z}} {}
  Vec3 angular() const { return {pairs[0][0], pairs[0][1], pairs[1][0]}; }
  Vec3 linear() const { return {pairs[1][1], pairs[2][0], pairs[2][1]}; }
  double operator[](int i) const { return pairs[i / 2][i % 2]; }

  Spatial& operator+=(const Spatial& s) {
    for (int i = 0; i < 3; ++i) pairs[i] += s.pairs[i];
    return *this;
  }
  Spatial& operator-=(const Spatial& s) {
    for (int i = 0; i < 3; ++i) pairs[i] -= s.pairs[i];
    return *this;
  }
  Spatial& add_scaled(const Spatial& s, double x) {
    const Double2 by{x, x};
    for (int i = 0; i < 3; ++i) pairs[i] += s.pairs[i] * by;
    return *this;
  }
  Spatial operator*(double x) const {
    const Double2 by{x, x};
    Spatial result;
    for (int i = 0; i < 3; ++i) result.pairs[i] = pairs[i] * by;
    return result;
  }
};
inline Spatial operator+(Spatial a, const Spatial& b) { return a += b; }
inline Spatial operator-(Spatial a, const Spatial& b) { return a -= b; }
inline double dot(const Spatial& a, const Spatial& b) {
  const Double2 s =
      a.pairs[0] * b.pairs[0] + a.pairs[1] * b.pairs[1] + a.pairs[2] * b.pairs[2];
  return s[0] + s[1];
}

// The spatial force of a force at a point.
inline Spatial force_at(const Vec3& point, const Vec3& force) {
  return {cross(point, force), force};
}

// Six columns.
struct SpatialMatrix {
  Spatial columns[6];  // from the left

  Spatial operator*(const Spatial& x) const {
    Spatial result = columns[0] * x[0];
    for (int i = 1; i < 6; ++i) result.add_scaled(columns[i], x[i]);
    return result;
  }
  // The transposed matrix times x.
  Spatial transposed_times(const Spatial& x) const {
    return {{dot(columns[0], x), dot(columns[1], x), dot(columns[2], x)},
            {dot(columns[3], x), dot(columns[4], x), dot(columns[5], x)}};
  }
  SpatialMatrix& operator+=(const SpatialMatrix& m) {
    for (int i = 0; i < 6; ++i) columns[i] += m.columns[i];
    return *this;
  }
  // Adds a b^T times x.
  void add_product(const Spatial& a, const Spatial& b, double x) {
    for (int i = 0; i < 6; ++i) columns[i].add_scaled(a, b[i] * x);
  }
};

// The inverse of a symmetric positive definite matrix (Cholesky, in a fixed order of operations).
SpatialMatrix invert(const SpatialMatrix& matrix);

}  // namespace rubble
