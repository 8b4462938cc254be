// Between numpy and the program's own types. Internal to python/.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/set.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kernel/base/error.h"
#include "kernel/base/math.h"
#include "kernel/base/number_text.h"
#include "scripting/values/value.h"

namespace rubble::python {

namespace nb = nanobind;

using Size = std::ptrdiff_t;
using Shape = std::vector<Size>;

// What an argument gives as an array of double: an array as it is, everything else as numpy converts it.
class DoubleArray {
 public:
  DoubleArray() = default;
  // Throws nb::python_error where numpy finds no numbers.
  explicit DoubleArray(nb::handle given) {
    const nb::module_ numpy = nb::module_::import_("numpy");
    const nb::object masks = numpy.attr("ma");
    if (nb::isinstance(given, masks.attr("MaskedArray")) && nb::cast<bool>(masks.attr("is_masked")(given)))
      lost_ = "values that are masked";
    if (nb::try_cast(given, values_, false)) return;
    nb::object numbers = nb::borrow(given);
    if (nb::cast<bool>(numpy.attr("iscomplexobj")(given))) lost_ = "complex ones", numbers = numpy.attr("real")(given);
    values_ = nb::cast<Values>(numpy.attr("require")(numbers, "float64", "CA"), false);
  }
  // What would be lost of what is given, as the mask of an array; "": nothing.
  const char* lost() const { return lost_; }
  Size ndim() const { return Size(values_.ndim()); }
  Size shape(Size axis) const { return Size(values_.shape(std::size_t(axis))); }
  Size size() const { return Size(values_.size()); }
  const double* data() const { return values_.data(); }

 private:
  using Values = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
  Values values_;
  const char* lost_ = "";
};

// Throws InputError, keyed by the argument's name, for what is no array of finite numbers.
inline void expect_finite(const DoubleArray& values, const char* name) {
  if (*values.lost()) throw InputError({"", 0, name, "not all are numbers", "real numbers without a mask", values.lost(), ""});
  for (Size i = 0; i < values.size(); ++i)
    if (!std::isfinite(values.data()[i]))
      throw InputError({"", 0, name, "not a finite number", "finite numbers",
                        "nan or inf at element " + std::to_string(i), ""});
}

inline std::string shape_of(const DoubleArray& values) {
  std::string text = "(";
  for (Size i = 0; i < values.ndim(); ++i) text += (i ? ", " : "") + std::to_string(values.shape(i));
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

constexpr double kFarthest = 1e9;  // that rays are cast from and to; beyond what float squares can hold, Embree aborts; unit: m

// Above 0 and at most `most`, which nan never is. Throws InputError.
inline void expect_positive(double value, const char* name, double most = std::numeric_limits<double>::infinity()) {
  if (value > 0 && value <= most) return;
  std::string expected = "more than 0";
  if (std::isfinite(most)) expected += ", at most " + exact_text(most);
  throw InputError({"", 0, name, "out of range", expected, exact_text(value), ""});
}

// Of seven finite numbers.
inline Pose read_pose(const double* v, const char* name) {
  for (int i = 0; i < 3; ++i)
    if (!(std::abs(v[i]) <= kFarthest))
      throw InputError({"", 0, name, "out of range", "x y z from -1e9 to 1e9 m", exact_text(v[i]), ""});
  const Quat q{v[3], v[4], v[5], v[6]};
  const double squares = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(squares > 1e-12 && std::isfinite(squares)))
    throw InputError({"", 0, name, "no rotation", "a quaternion that is not zero", squares > 1 ? "too large numbers" : "zeros", ""});
  return {normalized(q), {v[0], v[1], v[2]}};
}

// A pose as x, y, z, then the quaternion w, x, y, z of any length but zero.
inline Pose to_pose(const DoubleArray& values, const char* name) {
  if (values.ndim() != 1 || values.shape(0) != 7)
    throw InputError({"", 0, name, "wrong shape", "(7,): x y z qw qx qy qz", shape_of(values), ""});
  expect_finite(values, name);
  return read_pose(values.data(), name);
}

// Rows of such poses. A single one is taken, too.
inline std::vector<Pose> to_poses(const DoubleArray& values, const char* name) {
  const bool row = values.ndim() == 1 && values.shape(0) == 7;
  if (!row && (values.ndim() != 2 || values.shape(1) != 7))
    throw InputError({"", 0, name, "wrong shape", "(7,) or (n, 7): x y z qw qx qy qz", shape_of(values), ""});
  expect_finite(values, name);
  std::vector<Pose> poses;
  for (Size i = 0; i < values.size(); i += 7) poses.push_back(read_pose(values.data() + i, name));
  return poses;
}

// A whole number from 0 to `most`. Throws InputError for anything else, where nanobind would list signatures.
inline std::uint64_t to_whole(const nb::object& value, const char* name, std::uint64_t most) {
  const nb::object whole = nb::steal<nb::object>(PyNumber_Index(value.ptr()));
  const std::uint64_t found = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
  if (whole && !PyErr_Occurred() && found <= most) return found;
  PyErr_Clear();
  throw InputError({"", 0, name, "out of range", "a whole number from 0 to " + std::to_string(most), nb::repr(value).c_str(), ""});
}

inline std::uint64_t to_seed(const nb::object& value) {
  return to_whole(value, "seed", std::numeric_limits<std::uint64_t>::max());
}

// Of a mission, as rubble run --seed takes it: missions keep it as an integer of Lua.
inline std::uint64_t to_mission_seed(const nb::object& value) {
  return to_whole(value, "seed", std::uint64_t(std::numeric_limits<std::int64_t>::max()));
}

// As rubble run --threads; 0: one per processor.
inline int to_threads(const nb::object& value) { return int(to_whole(value, "threads", 256)); }

// Text, bytes or an os.PathLike. Throws InputError for anything else.
inline std::string to_path(const nb::object& value, const char* name) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(value.ptr(), &bytes)) {
    const nb::object kept = nb::steal<nb::object>(bytes);
    return {PyBytes_AsString(bytes), std::size_t(PyBytes_Size(bytes))};
  }
  PyErr_Clear();
  throw InputError({"", 0, name, "is no path", "text, bytes or an os.PathLike, without a zero character",
                    nb::repr(value).c_str(), ""});
}

// What a list has, each made by `make`. One text is no list: it would be taken for its letters; and of a dict, its keys
// would be taken alone.
template <typename Make>
std::vector<std::string> to_list(const nb::object& values, const char* name, const char* expected, const Make& make) {
  const bool one = PyUnicode_Check(values.ptr()) || PyBytes_Check(values.ptr());
  const bool named = PyDict_Check(values.ptr());
  const nb::object items = one || named ? nb::object() : nb::steal<nb::object>(PySequence_List(values.ptr()));
  if (!items) {
    PyErr_Clear();
    const std::string found = nb::repr(values).c_str();
    throw InputError({"", 0, name, "is no list", expected, found,
                      one ? "put it in a list: [" + found + "]" : named ? "write each key with its value as one text of the list" : ""});
  }
  std::vector<std::string> made;
  for (const nb::handle item : nb::borrow<nb::list>(items)) made.push_back(make(nb::borrow<nb::object>(item)));
  return made;
}

inline std::vector<std::string> to_overrides(const nb::object& values, const char* name) {
  return to_list(values, name, "a list of texts, \"key=value\"", [name](const nb::object& item) -> std::string {
    std::string text;
    if (nb::try_cast(item, text, false)) return text;
    throw InputError({"", 0, name, "is no text", "a list of texts, \"key=value\"", nb::repr(item).c_str(), ""});
  });
}

inline std::vector<std::string> to_folders(const nb::object& values, const char* name) {
  return to_list(values, name, "a list of folders", [name](const nb::object& item) { return to_path(item, name); });
}

// An array of numpy in C order that owns its values. Every array of the module is made here; a test looks for arrays that
// are made elsewhere.
template <typename T>
using Array = nb::ndarray<nb::numpy, T, nb::c_contig>;

// The memory of a vector, which the array owns: nothing is copied. T: of the elements that the array shows.
template <typename T, typename Kept>
Array<T> take_as(std::vector<Kept>&& values, const Shape& shape) {
  auto* const kept = new std::vector<Kept>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<Kept>*>(p); });
  const std::vector<std::size_t> sizes(shape.begin(), shape.end());
  return Array<T>(kept->data(), sizes.size(), sizes.data(), owner);
}

template <typename T>
Array<T> take_vector(std::vector<T>&& values, const Shape& shape) {
  return take_as<T>(std::move(values), shape);
}

// An array to be filled; at first zeros.
template <typename T>
Array<T> make_array(const Shape& shape) {
  Size count = 1;
  for (const Size n : shape) count *= n;
  return take_vector(std::vector<T>(std::size_t(count)), shape);
}

inline void put_pose(const Pose& pose, double* to) {
  const auto& [q, t] = pose;
  for (const double value : {t.x, t.y, t.z, q.w, q.x, q.y, q.z}) *to++ = value;
}

inline Array<double> from_pose(const Pose& pose) {
  Array<double> out = make_array<double>({7});
  put_pose(pose, out.data());
  return out;
}

inline Array<double> from_vector(const Vec3& v) { return take_vector<double>({v[0], v[1], v[2]}, {3}); }

}  // namespace rubble::python

// A DoubleArray as an argument. What numpy cannot convert is no match, which Python reports as a TypeError.
namespace nanobind::detail {
template <>
struct type_caster<rubble::python::DoubleArray> {
  NB_TYPE_CASTER(rubble::python::DoubleArray, const_name("numpy.typing.ArrayLike"))
  bool from_python(handle given, std::uint8_t, cleanup_list*) noexcept {
    try {
      value = rubble::python::DoubleArray(given);
      return true;
    } catch (...) {
      PyErr_Clear();
      return false;
    }
  }
};
}  // namespace nanobind::detail
