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
#include "pyroclast/simulation/fields.hpp"

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

/// Returns a view of plain data of doubles, with a shape behind the index of the item.
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
      {"internals",
       [](const auto& s, const py::object& owner) { return seen(s.internals, {kLanes}, owner); }}};
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
      {"slot", [](const Simulation& s) {
         return filled<int>(mechanics_of(s).body().layout.gridpoint_slot, 0,
                            [](int slot, py::ssize_t) { return slot; });
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
  return make(mechanics_of(simulation).body().arrays, owner);
}

py::array copied(const Simulation& simulation, const std::string& what) {
  return of(copies(), what)(simulation);
}

py::dict fields(const Simulation& simulation, Item item, const std::vector<std::string>& names) {
  auto chosen = fields_of(simulation);
  std::erase_if(chosen, [&](const Field& field) {
    return field.item != item || (!names.empty() && std::ranges::find(names, field.name) == names.end());
  });
  const auto values = values_of<double>(chosen, simulation);
  py::dict all;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const py::ssize_t components = components_of(chosen[i].kind);
    const auto items = static_cast<py::ssize_t>(values[i].size()) / components;
    std::vector<py::ssize_t> shape{items};
    if (components > 1) shape.push_back(components);
    all[py::str(name_with_unit(chosen[i]))] = py::array_t<double>(shape, values[i].data());
  }
  return all;
}

py::dict contact_points(const Simulation& simulation) {
  const Mechanics<2>& mechanics = mechanics_of(simulation);
  const Model<2>& model = simulation.model();
  py::list interface, law;
  for (int i = 0; i < model.contact_count(); ++i) {
    interface.append(model.interface_names[static_cast<std::size_t>(model.contacts[i].interface)]);
    law.append(mechanics.body().law_of(i).name);
  }
  py::dict all;
  all["interface"] = interface;
  all["law"] = law;
  const auto add = [&](const char* name, auto number) {
    all[name] =
        filled<double>(model.contacts, 0, [&](const auto& contact, py::ssize_t) { return number(contact); });
  };
  add("x_m", [&](const auto& c) { return model.position[c.a][0]; });
  add("y_m", [&](const auto& c) { return model.position[c.a][1]; });
  add("face", [](const auto& c) { return static_cast<double>(c.face); });
  add("area_m2", [](const auto& c) { return c.area; });
  add("normal_x", [](const auto& c) { return c.normal[0]; });
  add("normal_y", [](const auto& c) { return c.normal[1]; });
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
