#include "pyroclast/python/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/simulation/watching/fields.hpp"
#include "pyroclast/simulation/watching/found_fields.hpp"

namespace pyroclast::python {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

const Motion& motion_of(const Simulation& simulation) {
  if (!simulation.moves()) throw Error("nothing moves in this run, so there is no such array");
  return simulation.motion();
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
      {"position",
       [](const Simulation& s) {
         std::vector<Vec<3>> places;
         for (int g = 0; g < s.model().gridpoint_count(); ++g) places.push_back(s.model().place(g));
         return vectors(places, s.model().dimension());
       }},
      {"zones",
       [](const Simulation& s) {
         std::vector<std::span<const int>> zones;
         for (int z = 0; z < s.model().zone_count(); ++z) zones.push_back(s.model().gridpoints_of_zone(z));
         return filled<int>(zones, s.model().dimension() + 1, [](const auto& zone, py::ssize_t i) {
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
         return filled<int>(motion_of(s).gridpoint_slots(), 0, [](int slot, py::ssize_t) { return slot; });
       }}};
  return all;
}

}  // namespace

py::array vectors(const std::vector<Vec<3>>& list, int dimension) {
  return filled<double>(list, dimension,
                        [](const Vec<3>& v, py::ssize_t i) { return v[static_cast<int>(i)]; });
}

py::array members(const Simulation& simulation, const std::string& set, bool of_contacts) {
  const auto& sets = of_contacts ? simulation.model().contact_sets : simulation.model().sets;
  auto all = of(sets, set);
  sort_unique(all);
  return filled<int>(all, 0, [](int member, py::ssize_t) { return member; });
}

py::array view(const Simulation& simulation, const std::string& what, const py::object& owner) {
  const ArrayInMemory array = motion_of(simulation).array_of(what);
  return frozen(py::array_t<double>(array.shape, array.numbers, owner));
}

py::array copied(const Simulation& simulation, const std::string& what) {
  return of(copies(), what)(simulation);
}

py::dict fields(const Simulation& simulation, Item item, const std::vector<std::string>& names) {
  auto chosen = fields_of(simulation);
  std::erase_if(chosen, [&](const Field& field) {
    return field.item != item || (!names.empty() && std::ranges::find(names, field.name) == names.end());
  });
  const auto values = values_of(chosen, simulation);
  py::dict all;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const py::ssize_t components = components_of(chosen[i].kind, simulation.model().dimension());
    const auto items = static_cast<py::ssize_t>(values[i].size()) / components;
    std::vector<py::ssize_t> shape{items};
    if (components > 1) shape.push_back(components);
    all[py::str(name_with_unit(chosen[i]))] = py::array_t<double>(shape, values[i].data());
  }
  return all;
}

py::dict contact_points(const Simulation& simulation) {
  const Motion& motion = motion_of(simulation);
  const Model& model = simulation.model();
  py::list interface, law;
  std::vector<int> contacts;
  for (int i = 0; i < model.contact_count(); ++i) {
    interface.append(model.interface_names[static_cast<std::size_t>(model.joint(i).interface)]);
    law.append(motion.law_of(i).name);
    contacts.push_back(i);
  }
  py::dict all;
  all["interface"] = interface;
  all["law"] = law;
  const auto add = [&](const std::string& name, auto number) {
    all[py::str(name)] =
        filled<double>(contacts, 0, [&](int contact, py::ssize_t) { return number(contact); });
  };
  for (int axis = 0; axis < model.dimension(); ++axis)
    add(fmt::format("{}_m", "xyz"[axis]), [&](int c) { return model.place(model.joint(c).a)[axis]; });
  add("face", [&](int c) { return static_cast<double>(model.joint(c).face); });
  add("area_m2", [&](int c) { return model.joint(c).area; });
  for (int axis = 0; axis < model.dimension(); ++axis)
    add(fmt::format("normal_{}", "xyz"[axis]), [&](int c) { return model.normal(c)[axis]; });
  return all;
}

py::dict found_points(const Simulation& simulation) {
  const std::vector<FoundPoint> points = motion_of(simulation).found_points();
  py::list interface;
  for (const FoundPoint& point : points)
    interface.append(simulation.model().interface_names[static_cast<std::size_t>(point.interface)]);
  py::dict all;
  all["interface"] = interface;
  const auto add_whole = [&](const char* name, auto number) {
    all[name] = filled<int>(points, 0, [&](const FoundPoint& p, py::ssize_t) { return number(p); });
  };
  const auto add = [&](const std::string& name, auto number) {
    all[py::str(name)] =
        filled<double>(points, 0, [&](const FoundPoint& p, py::ssize_t) { return number(p); });
  };
  add_whole("block_a", [](const FoundPoint& p) { return p.blocks[0]; });
  add_whole("block_b", [](const FoundPoint& p) { return p.blocks[1]; });
  add_whole("face", [](const FoundPoint& p) { return p.face; });
  const int dimension = simulation.model().dimension();
  for (int axis = 0; axis < dimension; ++axis)
    add(fmt::format("{}_m", "xyz"[axis]), [&](const FoundPoint& p) { return p.position[axis]; });
  for (int axis = 0; axis < dimension; ++axis)
    add(fmt::format("normal_{}", "xyz"[axis]), [&](const FoundPoint& p) { return p.normal[axis]; });
  for (int axis = 0; axis < dimension; ++axis)
    add(fmt::format("force_{}_N", "xyz"[axis]), [&](const FoundPoint& p) { return p.force[axis]; });
  for (const FoundField& field : found_fields())
    if (field.kind == ValueKind::number)
      add(name_with_unit(field), [&](const FoundPoint& p) {
        double number = 0.0;
        field.read(p, &number);
        return number;
      });
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
