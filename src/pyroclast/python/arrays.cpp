#include "pyroclast/python/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/sort_unique.hpp"

namespace pyroclast::python {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const Mechanics<2>& mechanics_of(const Simulation& simulation) {
  if (!simulation.moves()) throw Error("nothing moves in this run, so there is no such array");
  return simulation.mechanics();
}

template <class Map>
const auto& of(const Map& all, const std::string& what) {
  const auto found = all.find(what);
  if (found == all.end()) throw Error(fmt::format("there is no \"{}\"", what));
  return found->second;
}

template <class T>
py::array frozen(py::array_t<T> array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// Plain data of doubles, with a shape behind the index of the item.
template <class Array>
py::array seen(const Array& array, std::vector<py::ssize_t> shape, const py::object& owner) {
  shape.insert(shape.begin(), static_cast<py::ssize_t>(array.size()));
  return frozen(py::array_t<double>(shape, reinterpret_cast<const double*>(array.data()), owner));
}

using ViewOf = py::array (*)(const StateArrays<2, FlatArray>&, const py::object&);

const std::map<std::string, ViewOf>& views() {
  static const std::map<std::string, ViewOf> all{
      {"displacement",
       [](const auto& s, const py::object& owner) { return seen(s.displacement, {2}, owner); }},
      {"velocity",
       [](const auto& s, const py::object& owner) {
         return seen(s.velocity, {2, kLanes}, owner);
       }},
      {"force",
       [](const auto& s, const py::object& owner) {
         return seen(s.force, {2, kLanes}, owner);
       }},
      {"history", [](const auto& s, const py::object& owner) { return seen(s.history, {kLanes}, owner); }}};
  return all;
}

template <class T, class List, class Number>
py::array filled(const List& list, py::ssize_t columns, Number number) {
  const auto rows = static_cast<py::ssize_t>(list.size());
  py::array_t<T> array(columns > 0 ? std::vector<py::ssize_t>{rows, columns}
                                   : std::vector<py::ssize_t>{rows});
  T* to = array.mutable_data();
  for (const auto& item : list)
    for (py::ssize_t i = 0; i < std::max<py::ssize_t>(columns, 1); ++i) *to++ = number(item, i);
  return array;
}

py::array numbers(const std::vector<double>& list) {
  return filled<double>(list, 0, [](double v, py::ssize_t) { return v; });
}

py::array tensors(const std::vector<SymmetricTensor<2>>& list) {
  return filled<double>(
      list, 3, [](const SymmetricTensor<2>& t, py::ssize_t i) { return t[static_cast<std::size_t>(i)]; });
}

using CopyOf = py::array (*)(const Simulation&);

const std::map<std::string, CopyOf>& copies() {
  static const std::map<std::string, CopyOf> all{
      {"position", [](const Simulation& s) { return vectors(s.model().position); }},
      {"zones",
       [](const Simulation& s) {
         return filled<int>(s.model().zones, 3, [](const auto& zone, py::ssize_t i) {
           return zone[static_cast<std::size_t>(i)];
         });
       }},
      {"zone_block",
       [](const Simulation& s) {
         return filled<int>(zone_blocks(s.model()), 0, [](int block, py::ssize_t) { return block; });
       }},
      {"block_material",
       [](const Simulation& s) {
         return filled<int>(s.model().block_material, 0, [](int material, py::ssize_t) { return material; });
       }},
      {"temperature", [](const Simulation& s) { return numbers(s.field().gridpoints()); }},
      {"zone_temperature", [](const Simulation& s) { return numbers(s.field().zones()); }},
      {"slot",
       [](const Simulation& s) {
         return filled<int>(mechanics_of(s).layout().gridpoint_slot, 0,
                            [](int slot, py::ssize_t) { return slot; });
       }},
      {"displacement", [](const Simulation& s) { return vectors(mechanics_of(s).displacements()); }},
      {"velocity", [](const Simulation& s) { return vectors(mechanics_of(s).velocities()); }},
      {"force", [](const Simulation& s) { return vectors(mechanics_of(s).forces()); }},
      {"stress", [](const Simulation& s) { return tensors(mechanics_of(s).stresses()); }},
      {"creep_strain", [](const Simulation& s) {
         const Mechanics<2>& mechanics = mechanics_of(s);
         std::vector<SymmetricTensor<2>> strains;
         for (int z = 0; z < s.model().zone_count(); ++z) strains.push_back(mechanics.creep_strain(z));
         return tensors(strains);
       }}};
  return all;
}

}  // namespace

py::array vectors(const std::vector<Vec<2>>& list) {
  return filled<double>(list, 2, [](const Vec<2>& v, py::ssize_t i) { return v[static_cast<int>(i)]; });
}

py::array members(const Simulation& simulation, const std::string& set, bool of_contacts) {
  const auto& sets = of_contacts ? simulation.model().contact_sets : simulation.model().sets;
  auto all = of(sets, set);
  sort_unique(all);
  return filled<int>(all, 0, [](int member, py::ssize_t) { return member; });
}

py::array view(const Simulation& simulation, const std::string& what, const py::object& owner) {
  const ViewOf make = of(views(), what);
  return make(mechanics_of(simulation).storage(), owner);
}

py::array copied(const Simulation& simulation, const std::string& what) {
  return of(copies(), what)(simulation);
}

py::dict contacts(const Simulation& simulation) {
  const Mechanics<2>& mechanics = mechanics_of(simulation);
  const Model<2>& model = simulation.model();
  const auto states = mechanics.contacts();
  py::list interface, law;
  for (std::size_t i = 0; i < states.size(); ++i) {
    interface.append(model.interface_names[static_cast<std::size_t>(model.contacts[i].interface)]);
    law.append(states[i].law->name);
  }
  py::dict all;
  all["interface"] = interface;
  all["law"] = law;
  const auto add = [&](const std::string& name, auto number) {
    py::array_t<double> column(static_cast<py::ssize_t>(states.size()));
    double* to = column.mutable_data();
    for (std::size_t i = 0; i < states.size(); ++i) to[i] = number(i);
    all[py::str(name)] = column;
  };
  add("x_m", [&](std::size_t i) { return model.position[model.contacts[i].a][0]; });
  add("y_m", [&](std::size_t i) { return model.position[model.contacts[i].a][1]; });
  add("face", [&](std::size_t i) { return static_cast<double>(model.contacts[i].face); });
  add("area_m2", [&](std::size_t i) { return model.contacts[i].area; });
  add("normal_x", [&](std::size_t i) { return model.contacts[i].normal[0]; });
  add("normal_y", [&](std::size_t i) { return model.contacts[i].normal[1]; });
  add("opening_m", [&](std::size_t i) { return states[i].opening; });
  add("slip_m", [&](std::size_t i) { return states[i].tangential_jump[0]; });
  add("normal_traction_Pa", [&](std::size_t i) { return states[i].normal_traction; });
  add("shear_traction_Pa", [&](std::size_t i) { return states[i].shear_traction[0]; });
  add("stored_J_m2", [&](std::size_t i) { return states[i].stored; });
  for (const LawTable* table : mechanics.laws()) {
    for (const HistoryInfo& info : table->history(2))
      if (const std::string name = column_with_unit(info.name, info.unit).name; !all.contains(py::str(name)))
        add(name, [&](std::size_t i) { return states[i].remembered(std::string_view(info.name)); });
    for (const LossInfo& info : table->losses)
      if (const std::string name = column_with_unit(fmt::format("lost_{}", info.name), info.unit).name;
          !all.contains(py::str(name)))
        add(name, [&](std::size_t i) { return states[i].lost(info.name); });
  }
  return all;
}

py::array_t<double> table(const History& history) {
  const auto columns = history.columns().size();
  py::array_t<double> cells({history.row_count(), columns});
  double* to = cells.mutable_data();
  for (std::size_t row = 0; row < history.row_count(); ++row)
    for (const auto& cell : history.row(row)) *to++ = cell.value_or(kNone);
  return cells;
}

py::array_t<double> row(const std::vector<std::optional<double>>& cells) {
  py::array_t<double> all(static_cast<py::ssize_t>(cells.size()));
  double* to = all.mutable_data();
  for (const auto& cell : cells) *to++ = cell.value_or(kNone);
  return all;
}

}  // namespace pyroclast::python
