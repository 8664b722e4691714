#include "pyroclast/python/specimens.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include <pybind11/stl.h>

#include "pyroclast/python/arrays.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/decks.hpp"
#include "pyroclast/setup/cells_in_metres.hpp"
#include "pyroclast/specimen/cells_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"

namespace pyroclast::python {

namespace {

MadeSpecimen made_of(specimen::FileOfCells read) {
  return std::visit([](auto& cells) -> MadeSpecimen { return specimen::specimen_from(std::move(cells)); },
                    read);
}

/// Reads a file of cells, in the plane or in space.
MadeSpecimen read(const std::string& file, double join) {
  return made_of(cells_in_metres(file, join));
}

/// Makes a specimen of cells as a file holds them, in m.
MadeSpecimen from_text(const std::string& text, double join) {
  const py::gil_scoped_release no_gil;
  return made_of(specimen::cells_from(text, "", {}, join));
}

/// Makes a rectangle of blocks, all of one phase.
MadeSpecimen rectangle(double width, double height, int count, double shortest_edge, int relaxation,
                       double radius_spread, std::uint64_t seed) {
  specimen::SpecimenParameters p;
  p.outline = specimen::Region::rectangle(width, height);
  p.seed = seed;
  p.aggregates.phase = p.matrix;
  p.blocks = {.count = count,
              .radius_spread = radius_spread,
              .relaxation = relaxation,
              .shortest_edge = shortest_edge,
              .cells = {}};
  const py::gil_scoped_release no_gil;
  return make_checked_specimen(p);
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

/// Returns the stones, (stones, dimension + 1): centre and diameter, m.
template <int Dim>
py::array_t<double> stones(const specimen::Specimen<Dim>& s) {
  py::array_t<double> array({static_cast<py::ssize_t>(s.stones.size()), py::ssize_t{Dim + 1}});
  auto to = array.mutable_unchecked<2>();
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    for (py::ssize_t axis = 0; axis < Dim; ++axis) to(i, axis) = s.stones[i].centre[axis];
    to(i, Dim) = s.stones[i].diameter;
  }
  return array;
}

template <int Dim>
py::array vertices(const specimen::Specimen<Dim>& s) {
  std::vector<Vec<3>> places;
  for (const auto& v : s.cells.vertices) places.push_back(resized<3>(v));
  return vectors(places, Dim);
}

/// Lets a function of a specimen in either dimension be one of Python's.
template <class F>
auto of_either(F f) {
  return [f](const PythonSpecimen& s) { return std::visit(f, s.made); };
}

/// Lets a function that makes a specimen be one of Python's.
template <class... Args>
auto making(MadeSpecimen (*make)(Args...)) {
  return [make](Args... args) { return PythonSpecimen{make(std::forward<Args>(args)...)}; };
}

}  // namespace

void bind_specimens(py::module_& m) {
  using py::arg;
  py::class_<PythonSpecimen>(m, "Specimen", "Blocks, each with its material.")
      .def_static("from_text", making(from_text), arg("text"), arg("join"))
      .def_static("rectangle", making(rectangle), arg("width"), arg("height"), arg("count"),
                  arg("shortest_edge"), arg("relaxation"), arg("radius_spread"), arg("seed"))
      .def_static("of_deck", making(of_deck), arg("deck"), arg("seed"))
      .def_static("read", making(read), arg("file"), arg("join"))
      .def("text", of_either([](const auto& s) { return specimen::cells_text(s); }), "As a file holds it.")
      .def_property_readonly("dimension",
                             of_either([]<int Dim>(const specimen::Specimen<Dim>&) { return Dim; }))
      .def_property_readonly("vertices", of_either([](const auto& s) { return vertices(s); }))
      .def_property_readonly("facets", of_either([](const auto& s) {
                               std::vector<std::vector<int>> corners;
                               for (const auto& facet : specimen::facets(s.cells))
                                 corners.emplace_back(facet.corners.begin(), facet.corners.end());
                               return arrays_of(corners);
                             }))
      .def_property_readonly("neighbours", of_either([](const auto& s) {
                               std::vector<int> cells;
                               for (const auto& facet : specimen::facets(s.cells))
                                 cells.insert(cells.end(), {facet.inner, facet.outer});
                               return array_of(cells).reshape({-1, 2});
                             }))
      .def_property_readonly("cells", of_either([](const auto& s) { return arrays_of(s.cells.cells); }))
      .def_property_readonly("phase", of_either([](const auto& s) { return array_of(s.phase); }))
      .def_property_readonly("block_size", of_either([](const auto& s) { return s.size; }))
      .def_property_readonly("stone", of_either([](const auto& s) { return array_of(s.stone); }))
      .def_property_readonly("stones", of_either([](const auto& s) { return stones(s); }))
      .def_property_readonly("phases", of_either([](const auto& s) { return s.phases; }))
      .def_property_readonly("shares", of_either([](const auto& s) { return s.fraction; }))
      .def_property_readonly("extent", of_either([](const auto& s) { return s.outline.extent(); }))
      .def_property_readonly("size", of_either([](const auto& s) {
                               return py::tuple(py::cast((s.outline.high() - s.outline.low()).c));
                             }))
      .def_property_readonly("sides",
                             of_either([](const auto& s) { return specimen::names_of(s.outline.sides()); }));
}

}  // namespace pyroclast::python
