#pragma once

#include <memory>

#include <pybind11/pybind11.h>

#include "pyroclast/session/session.hpp"
#include "pyroclast/stages/registry.hpp"

/// The module _core: the parts of the library that Python needs. The package's own files make them pleasant
/// to use; here they are only reached.
namespace pyroclast::python {

namespace py = pybind11;

/// Lets errors of the library appear as those of pyroclast/errors.py.
void bind_errors(py::module_& module);
void bind_decks(py::module_& module);
void bind_laws(py::module_& module);
void bind_sessions(py::module_& module);
void bind_specimens(py::module_& module);
void bind_stages(py::module_& module);
void bind_tables(py::module_& module);

/// Returns a Python object that threads without the interpreter's lock may hold and let go.
std::shared_ptr<py::object> shared(py::object object);

/// Returns the kinds of stages of the library, and one for each of these classes.
StageRegistry kinds_with(const py::list& classes);

}  // namespace pyroclast::python
