// Between numpy and the program's own types. Internal to python/.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"

namespace rubble::python {

namespace py = pybind11;

using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

// Throws InputError, keyed by the argument's name, for another shape and for what is not finite.
inline void expect_finite(const DoubleArray& values, const char* name) {
  for (py::ssize_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values.data()[i]))
      throw InputError({"", 0, name, "not a finite number", "finite numbers",
                        "nan or inf at element " + std::to_string(i), ""});
}

inline std::string shape_of(const DoubleArray& values) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < values.ndim(); ++i) text += (i ? ", " : "") + std::to_string(values.shape(i));
  return text + ")";
}

// Rows of three. A single row is taken, too.
inline std::vector<Vec3> to_points(const DoubleArray& values, const char* name) {
  const bool row = values.ndim() == 1 && values.shape(0) == 3;
  if (!row && (values.ndim() != 2 || values.shape(1) != 3))
    throw InputError({"", 0, name, "wrong shape", "(n, 3)", shape_of(values), ""});
  expect_finite(values, name);
  std::vector<Vec3> points(std::size_t(values.size() / 3));
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = {values.data()[3 * i], values.data()[3 * i + 1], values.data()[3 * i + 2]};
  return points;
}

// A pose as x, y, z, then the quaternion w, x, y, z of any length but zero.
inline Pose to_pose(const DoubleArray& values, const char* name) {
  if (values.ndim() != 1 || values.shape(0) != 7)
    throw InputError({"", 0, name, "wrong shape", "(7,): x y z qw qx qy qz", shape_of(values), ""});
  expect_finite(values, name);
  const double* v = values.data();
  const Quat q{v[3], v[4], v[5], v[6]};
  if (!(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z > 1e-12))
    throw InputError({"", 0, name, "no rotation", "a quaternion that is not zero", "zeros", ""});
  return {normalized(q), {v[0], v[1], v[2]}};
}

// A whole number of 64 bits without a sign. Throws InputError for anything else, where pybind11 would list signatures.
inline std::uint64_t to_seed(const py::object& value) {
  const py::object whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
  const std::uint64_t seed = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
  if (whole && !PyErr_Occurred()) return seed;
  PyErr_Clear();
  throw InputError({"", 0, "seed", "out of range", "a whole number from 0 to 18446744073709551615",
                    py::repr(value).cast<std::string>(), ""});
}

inline std::vector<py::ssize_t> c_strides(const std::vector<py::ssize_t>& shape, std::size_t item) {
  std::vector<py::ssize_t> strides(shape.size());
  py::ssize_t stride = py::ssize_t(item);
  for (std::size_t i = shape.size(); i-- > 0;) {
    strides[i] = stride;
    stride *= shape[i];
  }
  return strides;
}

// An array to be filled. Every array of the module is made here or by take_vector(), with its strides: pybind11 before
// 2.12 reads the size of an item of numpy 2 as 0, and makes arrays all of whose elements are one. A test looks for
// arrays that are made elsewhere.
template <typename T>
py::array_t<T> make_array(const std::vector<py::ssize_t>& shape) {
  return py::array_t<T>(shape, c_strides(shape, sizeof(T)));
}

// An array that owns the vector it was made from: nothing is copied.
template <typename T>
py::array_t<T> take_vector(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(shape, c_strides(shape, sizeof(T)), kept->data(), owner);
}

inline void put_pose(const Pose& pose, double* to) {
  const auto& [q, t] = pose;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z}) *to++ = value;
}

inline py::array_t<double> from_pose(const Pose& pose) {
  py::array_t<double> out = make_array<double>({7});
  put_pose(pose, out.mutable_data());
  return out;
}

inline py::array_t<double> from_vector(const Vec3& v) {
  py::array_t<double> out = make_array<double>({3});
  for (int i = 0; i < 3; ++i) out.mutable_data()[i] = v[i];
  return out;
}

}  // namespace rubble::python
