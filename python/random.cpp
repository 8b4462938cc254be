// Random numbers of environments: the program's own streams, with the same bits on every machine and with every numpy.
#include "kernel/base/random.h"

#include <pybind11/pybind11.h>

#include "kernel/base/portable_math.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

template <typename Draw>
py::array_t<double> draw_many(std::size_t count, const Draw& draw) {
  std::vector<double> values(count);
  for (double& value : values) value = draw();
  return take_vector(std::move(values), {py::ssize_t(count)});
}

}  // namespace

void add_random(py::module_& module) {
  py::class_<RandomStream>(module, "_Random")
      .def(py::init([](const py::object& seed, const std::string& name) { return RandomStream(to_seed(seed), name); }))
      .def("uniform", [](RandomStream& r, std::size_t count) { return draw_many(count, [&] { return r.uniform(); }); })
      .def("normal", [](RandomStream& r, std::size_t count) { return draw_many(count, [&] { return r.normal(); }); });
  module.def("_exp", &portable::exp);
  module.def("_log", &portable::log);
}

}  // namespace rubble::python
