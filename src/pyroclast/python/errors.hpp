#pragma once

#include <vector>

#include <pybind11/pybind11.h>

#include "pyroclast/deck/diagnostic.hpp"

namespace pyroclast::python {

/// Returns diagnostics as objects of pyroclast/errors.py.
pybind11::list diagnostics(const std::vector<Diagnostic>& list);

}  // namespace pyroclast::python
