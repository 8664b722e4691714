#pragma once

#include <string>

#include <pybind11/numpy.h>

#include "pyroclast/simulation/loop/run.hpp"
#include "pyroclast/simulation/watching/fields.hpp"

namespace pyroclast::python {

namespace py = pybind11;

/// Returns an array of the mechanics as it lies in memory, read-only.
/// \param what   displacement, velocity, force or internals
/// \param owner  object that the array keeps alive
py::array view(const Simulation& simulation, const std::string& what, const py::object& owner);

/// Returns places as an array (n, dimension).
py::array vectors(const std::vector<Vec<3>>& list, int dimension);

/// Returns arrays of the mesh in the order of the model, as copies.
py::array copied(const Simulation& simulation, const std::string& what);

/// Returns the members of a set, ascending, each once: gridpoints, or rows of the table `contacts`. Throws
/// Error naming the sets of the model.
py::array members(const Simulation& simulation, const std::string& set, bool of_contacts);

/// Returns the present fields of one item, by their names with units: (items,) or (items, components).
/// \param names  names without units; none: all fields
py::dict fields(const Simulation& simulation, Item item, const std::vector<std::string>& names);
/// Returns the place of every contact point, its interface and its law.
py::dict contact_points(const Simulation& simulation);

/// Returns the ends of pairs that press now: places, blocks, faces, interfaces and fields that are numbers.
py::dict found_points(const Simulation& simulation);

/// Returns all cells of a history, (rows, columns); NaN where a cell is empty.
py::array_t<double> table(const History& history);
py::array_t<double> row(const std::vector<std::optional<double>>& cells);

}  // namespace pyroclast::python
