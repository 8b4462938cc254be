// The Python module rubble._core; rubble/__init__.py is what users import.

#include "app/support/build_info.h"
#include "kernel/base/error.h"
#include "python/parts.h"


namespace rubble::python {
namespace {

PyObject* input_error = nullptr;  // rubble.InputError, for as long as the interpreter runs
PyObject* run_error = nullptr;    // rubble.RunError

PyObject* add_error(nb::module_& module, const char* name, PyObject* base) {
  const nb::object made = nb::steal<nb::object>(PyErr_NewException((std::string("rubble._core.") + name).c_str(), base, nullptr));
  module.attr(name) = made;
  return made.inc_ref().ptr();
}

// With the first mistake's file, line and key, and a list of all.
void raise(const InputError& error) {
  nb::list all;
  for (const Diagnostic& d : error.diagnostics()) {
    nb::dict one;
    one["file"] = d.file, one["line"] = d.line, one["key"] = d.key, one["message"] = d.message;
    one["expected"] = d.expected, one["found"] = d.found, one["hint"] = d.hint;
    all.append(one);
  }
  const nb::object made = nb::borrow<nb::object>(input_error)(error.what());
  for (const char* name : {"file", "line", "key"}) made.attr(name) = all[0][name];
  made.attr("diagnostics") = all;
  PyErr_SetObject(input_error, made.ptr());
}

}  // namespace

void add_errors(nb::module_& module) {
  input_error = add_error(module, "InputError", PyExc_ValueError);
  const nb::object mistaken = nb::borrow<nb::object>(input_error);
  mistaken.attr("file") = "";
  mistaken.attr("key") = "";
  mistaken.attr("line") = 0;
  mistaken.attr("diagnostics") = nb::make_tuple();
  run_error = add_error(module, "RunError", PyExc_RuntimeError);
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
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

NB_MODULE(_core, module) {
  nanobind::set_leak_warnings(false);  // what a program holds until it ends is no fault
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
  rubble::python::add_episodes(module);
}
