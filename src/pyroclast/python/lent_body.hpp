#pragma once

#include <pybind11/pybind11.h>

#include "pyroclast/simulation/simulation.hpp"

namespace pyroclast::python {

/// Body and press, lent to a stage that is written in Python for the time of one call.
struct LentBody {
  Simulation* simulation = nullptr;  ///< null when the call is over

  Simulation& get() const;
};

}  // namespace pyroclast::python
