#include "pyroclast/python/errors.hpp"

#include <pybind11/stl.h>

#include "pyroclast/deck/diagnostic.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/python/bindings.hpp"

namespace pyroclast::python {

namespace {

void raise(const char* type, const py::object& argument) {
  const py::object error = py::module_::import("pyroclast.errors").attr(type);
  PyErr_SetObject(error.ptr(), error(argument).ptr());
}

}  // namespace

py::list diagnostics(const std::vector<Diagnostic>& list) {
  const py::object type = py::module_::import("pyroclast.errors").attr("Diagnostic");
  py::list all;
  for (const Diagnostic& d : list)
    all.append(type(d.file, d.is_changed ? 0 : d.line, d.is_changed ? 0 : d.column, d.key, d.value, d.message,
                    d.hint, to_string(d)));
  return all;
}

void bind_errors(py::module_&) {
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const DeckError& error) {
      raise("DeckError", diagnostics(error.diagnostics()));
    } catch (const CodeNotAllowed& error) {
      raise("CodeNotAllowed", py::str(error.what()));
    } catch (const Error& error) {
      raise("Error", py::str(error.what()));
    }
  });
}

std::shared_ptr<py::object> shared(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            const py::gil_scoped_acquire gil;
            delete held;
          }};
}

}  // namespace pyroclast::python
