#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/decks.hpp"
#include "pyroclast/session/law_point.hpp"

namespace pyroclast::python {

namespace {

/// Takes a contact point along a path of (opening, slip, temperature), each leg in so many steps. Returns
/// values by column.
py::dict along_path(const std::string& law, const std::string& folder,
                    const std::vector<std::string>& sources, const std::vector<std::string>& values,
                    const py::array_t<double, py::array::c_style | py::array::forcecast>& path, int steps) {
  if (path.ndim() != 2 || path.shape(1) != 3) throw Error("a path is an array of (points, 3)");
  if (steps < 1) throw Error("each leg of a path has at least one step");
  LawPoint point(stated_material(find_law(law, folder, law_sources(sources), true), values));
  const auto columns = point.columns();
  std::vector<std::vector<double>> rows;
  const auto points = path.unchecked<2>();
  for (py::ssize_t i = 0; i < points.shape(0); ++i)
    point.go({points(i, 0), points(i, 1), points(i, 2)}, steps, [&] { rows.push_back(point.values()); });
  py::dict all;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    py::array_t<double> column(static_cast<py::ssize_t>(rows.size()));
    double* to = column.mutable_data();
    for (const auto& row : rows) *to++ = row[c];
    all[py::str(columns[c].name)] = column;
  }
  return all;
}

py::list properties(const std::string& law, const std::string& folder,
                    const std::vector<std::string>& sources) {
  py::list all;
  for (const PropertyInfo& info : find_law(law, folder, law_sources(sources), true).properties)
    all.append(py::make_tuple(info.key, info.unit.si, info.meaning));
  return all;
}

}  // namespace

void bind_laws(py::module_& m) {
  using py::arg;
  m.def(
      "law_name",
      [](const std::string& law, const std::string& folder, const std::vector<std::string>& sources) {
        return find_law(law, folder, law_sources(sources), true).name;
      },
      arg("law"), arg("folder"), arg("sources"), "Finds, loads or compiles a law; returns its name.");
  m.def("law_properties", &properties, arg("law"), arg("folder"), arg("sources"),
        "Key, unit and meaning of each property of a law.");
  m.def("law_along_path", &along_path, arg("law"), arg("folder"), arg("sources"), arg("values"), arg("path"),
        arg("steps"), "Takes a contact point along a path; returns its columns.");
}

}  // namespace pyroclast::python
