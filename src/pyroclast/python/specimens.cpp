#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/python/arrays.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/decks.hpp"
#include "pyroclast/setup/cells_in_metres.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/pieces.hpp"

namespace pyroclast::python {

namespace {

using solid::SolidSpecimen;
using specimen::Specimen;
using Reals = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<int, py::array::c_style | py::array::forcecast>;

/// \param corners  corners of all cells in turn
/// \param first    first corner of each cell, and the end behind the last
/// \param size     size that each cell was to have, m; empty where cells are alike
/// \param stone    number of the stone of each cell, -1: none; empty where none are known
/// \param join     distance within which vertices are joined, m; 0: none
Specimen from_cells(const Reals& vertices, const Integers& corners, const Integers& first,
                    std::vector<std::string> phases, const Integers& phase, std::vector<double> size,
                    const Integers& stone, double join) {
  specimen::Cells cells;
  const auto at = vertices.unchecked<2>();
  for (py::ssize_t v = 0; v < at.shape(0); ++v) cells.tessellation.vertices.push_back({{at(v, 0), at(v, 1)}});
  for (py::ssize_t c = 0; c + 1 < first.size(); ++c)
    cells.tessellation.cells.emplace_back(corners.data() + first.data()[c],
                                          corners.data() + first.data()[c + 1]);
  cells.phases = std::move(phases);
  cells.phase.assign(phase.data(), phase.data() + phase.size());
  cells.size = std::move(size);
  cells.grain.assign(stone.data(), stone.data() + stone.size());
  const py::gil_scoped_release no_gil;
  return specimen::specimen_from(specimen::joined(specimen::checked(std::move(cells)), join));
}

Specimen read(const std::string& file, double join) {
  specimen::Cells cells = cells_in_metres(file, join);
  specimen::Region region;
  try {
    region = specimen::outline_of(cells.tessellation);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file, error.what()));
  }
  return specimen::specimen_from(std::move(cells), std::move(region));
}

/// Makes a rectangle of blocks, all of one phase.
Specimen rectangle(double width, double height, int count, double shortest_edge, int relaxation,
                   double radius_spread, std::uint64_t seed) {
  AskedSpecimen p;
  p.region = specimen::Region::rectangle(width, height);
  p.seed = seed;
  p.aggregates.phase = p.matrix;
  p.blocks = {.count = count,
              .radius_spread = radius_spread,
              .relaxation = relaxation,
              .shortest_edge = shortest_edge,
              .tessellation = {}};
  const py::gil_scoped_release no_gil;
  return std::get<Specimen>(make_checked_specimen(p));
}

MadeSpecimen of_deck(const DeckText& text, const std::optional<std::uint64_t>& seed) {
  const Deck deck = parse(text);
  Setup setup = read_setup(deck, text.folder, kinds_with(text.stages), law_sources(text));
  if (seed) setup.specimen.seed = *seed;
  const py::gil_scoped_release no_gil;
  return make_checked_specimen(setup.specimen);
}

py::list arrays_of(const std::vector<std::vector<int>>& lists) {
  py::list arrays;
  for (const auto& list : lists)
    arrays.append(py::array_t<int>(static_cast<py::ssize_t>(list.size()), list.data()));
  return arrays;
}

py::array_t<int> array_of(const std::vector<int>& list) {
  return py::array_t<int>(static_cast<py::ssize_t>(list.size()), list.data());
}

/// Returns the balls, (balls, 4): x, y, z, diameter, m.
py::array_t<double> balls(const SolidSpecimen& s) {
  py::array_t<double> array({static_cast<py::ssize_t>(s.balls.size()), py::ssize_t{4}});
  auto to = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    for (py::ssize_t axis = 0; axis < 3; ++axis) to(i, axis) = s.balls[i].centre[axis];
    to(i, 3) = s.balls[i].diameter;
  }
  return array;
}

void bind_solid_specimens(py::module_& m) {
  py::class_<SolidSpecimen, std::shared_ptr<SolidSpecimen>>(m, "SolidSpecimen",
                                                            "Polyhedral blocks, each with its material.")
      .def_static(
          "read",
          [](const std::string& file, double join) {
            solid::Polyhedra polyhedra = solid::read_polyhedra(file, join);
            const solid::Prism body = polyhedra.body;
            return solid::specimen_from(std::move(polyhedra), body);
          },
          py::arg("file"), py::arg("join"))
      .def("text", &solid::polyhedra_text, "As a file holds it.")
      .def_property_readonly("vertices",
                             [](const SolidSpecimen& s) { return vectors(s.complex.vertices, 3); })
      .def_property_readonly("faces",
                             [](const SolidSpecimen& s) {
                               std::vector<std::vector<int>> corners;
                               for (const auto& face : s.complex.faces) corners.push_back(face.corners);
                               return arrays_of(corners);
                             })
      .def_property_readonly("neighbours",
                             [](const SolidSpecimen& s) {
                               std::vector<int> cells;
                               for (const auto& face : s.complex.faces)
                                 cells.insert(cells.end(), {face.inner, face.outer});
                               return array_of(cells).reshape({-1, 2});
                             })
      .def_property_readonly("cells", [](const SolidSpecimen& s) { return arrays_of(s.complex.cells); })
      .def_property_readonly("phase", [](const SolidSpecimen& s) { return array_of(s.phase); })
      .def_readonly("block_size", &SolidSpecimen::size)
      .def_property_readonly("stone", [](const SolidSpecimen& s) { return array_of(s.grain); })
      .def_property_readonly("phases", [](const SolidSpecimen& s) { return s.phases; })
      .def_property_readonly("shares", [](const SolidSpecimen& s) { return s.fraction; })
      .def_property_readonly("volume", [](const SolidSpecimen& s) { return s.body.volume(); })
      .def_property_readonly("size",
                             [](const SolidSpecimen& s) {
                               const Vec<3> size = s.body.high() - s.body.low();
                               return std::tuple(size[0], size[1], size[2]);
                             })
      .def_property_readonly("balls", &balls)
      .def_property_readonly("sides", [](const SolidSpecimen& s) { return s.body.sides(); });
}

std::vector<std::string> side_names(const Specimen& s) {
  std::vector<std::string> names;
  for (const specimen::Side& side : s.region.sides()) names.push_back(side.name);
  return names;
}

}  // namespace

void bind_specimens(py::module_& m) {
  using py::arg;
  bind_solid_specimens(m);
  py::class_<Specimen, std::shared_ptr<Specimen>>(m, "Specimen", "Blocks, each with its material.")
      .def_static("from_cells", &from_cells, arg("vertices"), arg("corners"), arg("first"), arg("phases"),
                  arg("phase"), arg("block_size"), arg("stone"), arg("join"))
      .def_static("rectangle", &rectangle, arg("width"), arg("height"), arg("count"), arg("shortest_edge"),
                  arg("relaxation"), arg("radius_spread"), arg("seed"))
      .def_static("of_deck", &of_deck, arg("deck"), arg("seed"))
      .def_static("read", &read, arg("file"), arg("join"))
      .def(
          "text",
          [](const Specimen& s) {
            return specimen::cells_text({s.tessellation, s.phases, s.phase, s.size, s.grain});
          },
          "As a file holds it.")
      .def_readonly("block_size", &Specimen::size)
      .def_property_readonly("stone", [](const Specimen& s) { return array_of(s.grain); })
      .def_property_readonly("vertices",
                             [](const Specimen& s) {
                               std::vector<Vec<3>> places;
                               for (const auto& v : s.tessellation.vertices) places.push_back(resized<3>(v));
                               return vectors(places, 2);
                             })
      .def_property_readonly("cells", [](const Specimen& s) { return arrays_of(s.tessellation.cells); })
      .def_property_readonly("phase", [](const Specimen& s) { return array_of(s.phase); })
      .def_property_readonly("phases", [](const Specimen& s) { return s.phases; })
      .def_property_readonly("shares", [](const Specimen& s) { return s.fraction; })
      .def_property_readonly("area", [](const Specimen& s) { return s.region.area(); })
      .def_property_readonly(
          "size",
          [](const Specimen& s) { return std::pair(s.region.box().width(), s.region.box().height()); })
      .def_property_readonly("sides", &side_names);
}

}  // namespace pyroclast::python
