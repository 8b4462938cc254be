// Vectors, quaternions and rigid transforms with a fixed order of operations.
//
// Eigen chooses instructions, and with them the order of additions, by the target of the compiler.
// The kernel promises the same bits on every machine. So all arithmetic of results uses these types,
// which write out every operation. They are header-only, trivially copyable and free of alignment
// rules. Quaternions are (w, x, y, z) with unit length, unless a function states otherwise.
#pragma once

#include <array>
#include <cmath>

namespace rubble {

template <typename T>
struct Vec3T {
  T x{}, y{}, z{};  // components, in the unit of the vector's quantity

  constexpr Vec3T() = default;
  constexpr Vec3T(T x_, T y_, T z_) : x(x_), y(y_), z(z_) {}
  template <typename U>
  constexpr explicit Vec3T(const Vec3T<U>& v) : x(T(v.x)), y(T(v.y)), z(T(v.z)) {}

  constexpr T operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
  constexpr T& operator[](int i) { return i == 0 ? x : (i == 1 ? y : z); }
  constexpr Vec3T operator-() const { return {-x, -y, -z}; }
  constexpr Vec3T& operator+=(const Vec3T& v) { return x += v.x, y += v.y, z += v.z, *this; }
  constexpr Vec3T& operator-=(const Vec3T& v) { return x -= v.x, y -= v.y, z -= v.z, *this; }
  constexpr Vec3T& operator*=(T s) { return x *= s, y *= s, z *= s, *this; }
};

template <typename T>
constexpr Vec3T<T> operator+(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
constexpr Vec3T<T> operator-(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <typename T>
constexpr Vec3T<T> operator*(const Vec3T<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename T>
constexpr Vec3T<T> operator*(T s, const Vec3T<T>& a) {
  return {a.x * s, a.y * s, a.z * s};
}
template <typename T>
constexpr bool operator==(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}
template <typename T>
constexpr T dot(const Vec3T<T>& a, const Vec3T<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <typename T>
constexpr Vec3T<T> cross(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <typename T>
T norm(const Vec3T<T>& a) {
  return std::sqrt(dot(a, a));  // sqrt is correctly rounded everywhere (IEEE 754)
}
template <typename T>
T distance(const Vec3T<T>& a, const Vec3T<T>& b) {
  return norm(a - b);
}
// `a` scaled to length 1; the zero vector stays zero.
template <typename T>
Vec3T<T> normalized(const Vec3T<T>& a) {
  const T n = norm(a);
  return n > T(0) ? a * (T(1) / n) : Vec3T<T>{};
}
template <typename T>
constexpr Vec3T<T> min(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <typename T>
constexpr Vec3T<T> max(const Vec3T<T>& a, const Vec3T<T>& b) {
  return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
// 0, 1 or 2: the axis of the largest component, the first of equal ones.
template <typename T>
constexpr int longest_axis(const Vec3T<T>& size) {
  if (size.x >= size.y && size.x >= size.z) return 0;
  return size.y >= size.z ? 1 : 2;
}

// Row-major 3x3 matrix.
template <typename T>
struct Mat3T {
  Vec3T<T> rows[3];  // from the top

  static constexpr Mat3T identity() { return diagonal({T(1), T(1), T(1)}); }
  static constexpr Mat3T diagonal(const Vec3T<T>& d) {
    return {{{d.x, T(0), T(0)}, {T(0), d.y, T(0)}, {T(0), T(0), d.z}}};
  }
  constexpr Vec3T<T> operator*(const Vec3T<T>& v) const {
    return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
  }
  constexpr Vec3T<T> column(int i) const { return {rows[0][i], rows[1][i], rows[2][i]}; }
  constexpr Mat3T transposed() const { return {{column(0), column(1), column(2)}}; }
  constexpr Mat3T operator*(const Mat3T& m) const {
    const Mat3T t = m.transposed();
    return {{t * rows[0], t * rows[1], t * rows[2]}};
  }
  constexpr Mat3T operator+(const Mat3T& m) const {
    return {{rows[0] + m.rows[0], rows[1] + m.rows[1], rows[2] + m.rows[2]}};
  }
  constexpr Mat3T operator*(T s) const { return {{rows[0] * s, rows[1] * s, rows[2] * s}}; }
};

template <typename T>
struct QuatT {
  T w{1}, x{}, y{}, z{};  // the identity by default

  constexpr QuatT() = default;
  constexpr QuatT(T w_, T x_, T y_, T z_) : w(w_), x(x_), y(y_), z(z_) {}
  template <typename U>
  constexpr explicit QuatT(const QuatT<U>& q) : w(T(q.w)), x(T(q.x)), y(T(q.y)), z(T(q.z)) {}

  constexpr QuatT conjugate() const { return {w, -x, -y, -z}; }
  constexpr QuatT operator*(const QuatT& b) const {
    return {w * b.w - x * b.x - y * b.y - z * b.z, w * b.x + x * b.w + y * b.z - z * b.y,
            w * b.y - x * b.z + y * b.w + z * b.x, w * b.z + x * b.y - y * b.x + z * b.w};
  }
  constexpr Vec3T<T> rotate(const Vec3T<T>& v) const {
    const Vec3T<T> u{x, y, z};
    const Vec3T<T> t = T(2) * cross(u, v);
    return v + w * t + cross(u, t);
  }
  constexpr Mat3T<T> matrix() const {
    return {{{T(1) - T(2) * (y * y + z * z), T(2) * (x * y - w * z), T(2) * (x * z + w * y)},
             {T(2) * (x * y + w * z), T(1) - T(2) * (x * x + z * z), T(2) * (y * z - w * x)},
             {T(2) * (x * z - w * y), T(2) * (y * z + w * x), T(1) - T(2) * (x * x + y * y)}}};
  }
};

template <typename T>
constexpr bool operator==(const QuatT<T>& a, const QuatT<T>& b) {
  return a.w == b.w && a.x == b.x && a.y == b.y && a.z == b.z;
}
template <typename T>
QuatT<T> normalized(const QuatT<T>& q) {
  const T s = T(1) / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  return {q.w * s, q.x * s, q.y * s, q.z * s};
}

using Vec3 = Vec3T<double>;
using Vec3f = Vec3T<float>;
using Mat3 = Mat3T<double>;
using Mat3f = Mat3T<float>;
using Quat = QuatT<double>;
using Quatf = QuatT<float>;

inline Mat3f to_float(const Mat3& m) {
  return {{Vec3f(m.rows[0]), Vec3f(m.rows[1]), Vec3f(m.rows[2])}};
}

// A rigid transform. Its name has both frames: `world_from_body` maps body coordinates to the world.
struct Pose {
  Quat rotation;     // unit length
  Vec3 translation;  // unit: m

  constexpr Vec3 operator*(const Vec3& p) const { return rotation.rotate(p) + translation; }
  constexpr Pose operator*(const Pose& b) const {
    return {rotation * b.rotation, rotation.rotate(b.translation) + translation};
  }
  constexpr Pose inverse() const {
    const Quat r = rotation.conjugate();
    return {r, r.rotate(-translation)};
  }
};

constexpr bool operator==(const Pose& a, const Pose& b) {
  return a.translation == b.translation && a.rotation == b.rotation;
}

// The camera frames of REP 103: body X forward, Y left, Z up; optical Z forward, X right, Y down.
inline constexpr Pose camera_from_optical{{0.5, -0.5, 0.5, -0.5}, {0, 0, 0}};

// Axis-aligned box; empty while min > max.
struct Aabb {
  Vec3 min{1e300, 1e300, 1e300};     // lowest corner; unit: m
  Vec3 max{-1e300, -1e300, -1e300};  // highest corner; unit: m

  constexpr void include(const Vec3& p) { min = rubble::min(min, p), max = rubble::max(max, p); }
  constexpr bool empty() const { return min.x > max.x; }
};

}  // namespace rubble
