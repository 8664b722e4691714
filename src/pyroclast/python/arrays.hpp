#pragma once

#include <string>

#include <pybind11/numpy.h>

#include "pyroclast/simulation/fields.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast::python {

namespace py = pybind11;

/// An array of the mechanics as it lies in memory, read-only.
/// \param what  displacement, velocity, force or internals
/// \param owner  that the array keeps alive
py::array view(const Simulation& simulation, const std::string& what, const py::object& owner);

/// (n, 2)
py::array vectors(const std::vector<Vec<2>>& list);

/// Arrays of the mesh in the order of the model, as copies.
py::array copied(const Simulation& simulation, const std::string& what);

/// Members of a set, ascending, each once: gridpoints, or rows of `contacts`. Throws Error naming what sets
/// there are.
py::array members(const Simulation& simulation, const std::string& set, bool of_contacts);

/// What fields there are.
std::vector<FieldInfo> field_infos(const Simulation& simulation);
/// Fields of one item now, by their names with units: (items,) or (items, components).
/// \param names  without units; none: all
py::dict fields(const Simulation& simulation, Item item, const std::vector<std::string>& names);
/// Where every contact point stands, its interface and its law.
py::dict contact_points(const Simulation& simulation);

/// All cells of a history, (rows, columns); NaN where there is none.
py::array_t<double> table(const History& history);
py::array_t<double> row(const std::vector<std::optional<double>>& cells);

}  // namespace pyroclast::python
