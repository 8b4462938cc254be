// Arithmetic of poses with the same bits on every machine: numpy's cos, arctan2 and products of matrices change in
// the last bits from build to build.
#include <algorithm>
#include <cmath>

#include "kernel/base/portable_math.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

Vec3 to_vector(const DoubleArray& values, const char* name) {
  if (values.ndim() != 1 || values.shape(0) != 3)
    throw InputError({"", 0, name, "wrong shape", "(3,)", shape_of(values), ""});
  return to_points(values, name).front();
}

Array<double> pose(const DoubleArray& position, const DoubleArray& rpy) {
  const Vec3 at = to_vector(position, "position"), angles = to_vector(rpy, "rpy");
  return from_pose({portable::quat_from_rpy(angles.x, angles.y, angles.z), at});
}

// Upright, its X axis towards the target.
Array<double> look_at(const DoubleArray& position, const DoubleArray& target) {
  const Vec3 at = to_vector(position, "position"), d = to_vector(target, "target") - at;
  if (!(norm(d) > 0))
    throw InputError({"", 0, "target", "nothing to look at", "a point away from the position", "the position itself", ""});
  const double pitch = -portable::atan2(d.z, std::sqrt(d.x * d.x + d.y * d.y));
  return from_pose({portable::quat_from_rpy(0, pitch, portable::atan2(d.y, d.x)), at});
}

Array<double> compose(const DoubleArray& world_from_a, const DoubleArray& a_from_b) {
  return from_pose(to_pose(world_from_a, "world_from_a") * to_pose(a_from_b, "a_from_b"));
}

// Vectors of the body as those of the world; back: the other way. One row stays one row.
Array<double> rotate(const DoubleArray& pose, const DoubleArray& vectors, bool back) {
  const Quat rotation = to_pose(pose, "pose").rotation;
  const Quat by = back ? rotation.conjugate() : rotation;
  std::vector<double> out;
  for (const Vec3& v : to_points(vectors, "vectors")) {
    const Vec3 turned = by.rotate(v);
    out.insert(out.end(), {turned.x, turned.y, turned.z});
  }
  const auto rows = Size(out.size() / 3);
  return vectors.ndim() == 1 ? take_vector(std::move(out), {3}) : take_vector(std::move(out), {rows, 3});
}

// Rows of cosine and sine; unit: rad.
Array<double> directions(const DoubleArray& angles) {
  expect_finite(angles, "angles");
  std::vector<double> out;
  for (Size i = 0; i < angles.size(); ++i) {
    const portable::SinCos turned = portable::sincos(angles.data()[i]);
    out.insert(out.end(), {turned.cos, turned.sin});
  }
  const auto rows = Size(out.size() / 2);
  return take_vector(std::move(out), {rows, 2});
}

// Of each row of two or three.
Array<double> lengths(const DoubleArray& rows) {
  if (rows.ndim() != 2) throw InputError({"", 0, "rows", "wrong shape", "(n, k)", shape_of(rows), ""});
  std::vector<double> out;
  const double* value = rows.data();
  for (Size i = 0; i < rows.shape(0); ++i) {
    double sum = 0;
    for (Size k = 0; k < rows.shape(1); ++k, ++value) sum += *value * *value;
    out.push_back(std::sqrt(sum));
  }
  const auto count = Size(out.size());
  return take_vector(std::move(out), {count});
}

}  // namespace

void add_geometry(nb::module_& module) {
  module.def("_pose", &pose, nb::arg("position"), nb::arg("rpy"));
  module.def("_look_at", &look_at, nb::arg("position"), nb::arg("target"));
  module.def("_compose", &compose, nb::arg("world_from_a"), nb::arg("a_from_b"));
  module.def("_rotate", &rotate, nb::arg("pose"), nb::arg("vectors"), nb::arg("back") = false);
  module.def("_directions", &directions, nb::arg("angles"));
  module.def("_lengths", &lengths, nb::arg("rows"));
  module.def("_atan2", &portable::atan2, nb::arg("y"), nb::arg("x"));
}

}  // namespace rubble::python
