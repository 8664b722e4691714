#pragma once

#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast::python {

/// Specimen of Python, in the plane or in space.
struct PythonSpecimen {
  MadeSpecimen made;
};

}  // namespace pyroclast::python
