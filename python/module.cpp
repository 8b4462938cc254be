// The Python module rubble._core; rubble/__init__.py is what users import.
#include <pybind11/stl.h>

#include "app/support/build_info.h"
#include "kernel/base/error.h"
#include "python/parts.h"

namespace py = pybind11;

namespace rubble::python {
namespace {

PyObject* input_error = nullptr;  // rubble.InputError, for as long as the interpreter runs
PyObject* run_error = nullptr;    // rubble.RunError

// With the first mistake's file, line and key, and a list of all.
void raise(const InputError& error) {
  py::list all;
  for (const Diagnostic& d : error.diagnostics()) {
    py::dict one;
    one["file"] = d.file, one["line"] = d.line, one["key"] = d.key, one["message"] = d.message;
    one["expected"] = d.expected, one["found"] = d.found, one["hint"] = d.hint;
    all.append(one);
  }
  const py::object made = py::reinterpret_borrow<py::object>(input_error)(error.what());
  for (const char* name : {"file", "line", "key"}) made.attr(name) = all[0][name];
  made.attr("diagnostics") = all;
  PyErr_SetObject(input_error, made.ptr());
}

}  // namespace

void add_errors(py::module_& module) {
  input_error = py::exception<InputError>(module, "InputError", PyExc_ValueError).release().ptr();
  const py::object mistaken = py::reinterpret_borrow<py::object>(input_error);
  mistaken.attr("file") = "";
  mistaken.attr("key") = "";
  mistaken.attr("line") = 0;
  mistaken.attr("diagnostics") = py::tuple();
  run_error = py::exception<RunError>(module, "RunError", PyExc_RuntimeError).release().ptr();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      raise(error);
    } catch (const RunError& error) {
      PyErr_SetString(run_error, error.what());
    }
  });
}

}  // namespace rubble::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "Rubble's kernel, sensors and robots; see rubble/__init__.py.";
  module.attr("__version__") = rubble::build_info().version;
  rubble::python::add_errors(module);
  rubble::python::add_pile(module);
  rubble::python::add_sensors(module);
  rubble::python::add_geometry(module);
  rubble::python::add_random(module);
  rubble::python::add_explorer(module);
  rubble::python::add_sessions(module);
  rubble::python::add_recordings(module);
}
