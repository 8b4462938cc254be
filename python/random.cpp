// Random numbers of environments: the program's own streams, with the same bits on every machine and with every numpy.
#include "kernel/base/random.h"

#include <nanobind/nanobind.h>

#include "kernel/base/portable_math.h"
#include "python/arrays.h"
#include "python/parts.h"

namespace rubble::python {
namespace {

template <typename Draw>
Array<double> draw_many(std::size_t count, const Draw& draw) {
  std::vector<double> values(count);
  for (double& value : values) value = draw();
  return take_vector(std::move(values), {Size(count)});
}

}  // namespace

void add_random(nb::module_& module) {
  nb::class_<RandomStream>(module, "_Random")
      .def("__init__", [](RandomStream* made, const nb::object& seed, const std::string& name) {
        new (made) RandomStream(to_seed(seed), name);
      })
      .def("uniform", [](RandomStream& r, std::size_t count) { return draw_many(count, [&] { return r.uniform(); }); })
      .def("normal", [](RandomStream& r, std::size_t count) { return draw_many(count, [&] { return r.normal(); }); });
  module.def("_exp", &portable::exp);
  module.def("_log", &portable::log);
}

}  // namespace rubble::python
