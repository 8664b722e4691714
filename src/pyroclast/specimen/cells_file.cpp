#include "pyroclast/specimen/cells_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {

namespace {

using Json = nlohmann::ordered_json;

/// Beginnings of the names of the lists of vertices and of the sizes that blocks were to have; the unit
/// follows.
constexpr const char *kVertices = "vertices_", *kBlockSize = "block_size_";
/// Name of the list of the stones of blocks.
constexpr const char* kStone = "stone";

/// Reads one of the lists of a table. Throws Error where it is missing, or an item is of another kind.
/// \param read    function that reads an item; throws Json::exception for another kind of item
/// \param needed  words for an item
template <class Read>
auto list_in(const Json& table, const std::string& key, const std::string& needed, Read read) {
  const auto found = table.find(key);
  if (found == table.end() || !found->is_array()) throw Error(fmt::format("there is no list \"{}\"", key));
  std::vector<decltype(read(*found))> items;
  try {
    for (const Json& item : *found) items.push_back(read(item));
  } catch (const Json::exception&) {
    throw Error(fmt::format("{}[{}]: must be {}", key, items.size(), needed));
  }
  return items;
}

/// Reads a number from `least`; throws Json::exception for anything else.
template <int Least = 0>
int number_in(const Json& item) {
  if (const double value = item.get<double>();
      !item.is_number_integer() || value < Least || value > std::numeric_limits<int>::max())
    throw Json::other_error::create(501, "no number of an item", &item);
  return item.get<int>();
}

std::vector<int> numbers_in(const Json& items) {
  std::vector<int> all;
  for (const Json& item : items.get_ref<const Json::array_t&>()) all.push_back(number_in(item));
  return all;
}

template <class Value>
Value value_in(const Json& item) {
  return item.get<Value>();
}

template <int Dim>
Vec<Dim> coordinates_in(const Json& item) {
  const auto stated = item.get<std::array<double, Dim>>();
  if (item.size() != Dim) throw Json::other_error::create(501, "another number of coordinates", &item);
  return {stated};
}

/// Lays corners of a section that jut into the body by no more than `slack` (m) onto the line between their
/// neighbours.
void straighten(std::vector<Vec<2>>& section, double slack) {
  const double sense = area(section) < 0.0 ? -1.0 : 1.0;
  const std::size_t n = section.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec<2>&from = section[(i + n - 1) % n], &to = section[(i + 1) % n];
    const Vec<2> along = to - from, off = section[i] - from;
    const double in = sense * cross(along, off) / norm(along);
    if (in > kExact * norm(along) && in <= slack)
      section[i] = from + (dot(off, along) / dot(along, along)) * along;
  }
}

Prism body_in(const Json& json, std::size_t cells) {
  const auto found = json.find("body");
  if (found == json.end() || !found->is_object()) throw Error("there is no table \"body\"");
  const auto sides = list_in(*found, "sides", "a name", value_in<std::string>);
  auto corners = list_in(*found, "section_m", "a place, [x, y] in m", coordinates_in<2>);
  const Json axis = found->value("axis", Json()), length = found->value("length_m", Json());
  if (axis != "y" && axis != "z") throw Error(R"(body: "axis" must be "y" or "z")");
  if (!length.is_number() || !(length.get<double>() > 0.0))
    throw Error("body: \"length_m\" must be a number above 0");
  if (sides.empty()) throw Error("body: \"sides\" must name a side");
  for (auto side = sides.begin(); side != sides.end(); ++side)
    if (std::find(sides.begin(), side, *side) != side)
      throw Error(fmt::format("body: two sides are called \"{}\"", *side));
  if (corners.size() >= 3 && cells > 0)
    straighten(corners, kOffSide * std::cbrt(std::abs(area(corners)) * length.get<double>() /
                                             static_cast<double>(cells)));
  std::vector<Hole> holes;
  std::vector<Notch> notches;
  if (found->contains("holes"))
    holes = list_in(*found, "holes", "a table with name, corners_m and is_round", [](const Json& hole) {
      std::vector<Vec<2>> around;
      for (const Json& corner : hole.at("corners_m")) around.push_back(coordinates_in<2>(corner));
      return Hole{hole.at("name"), std::move(around), hole.at("is_round")};
    });
  if (found->contains("notches"))
    notches = list_in(
        *found, "notches", "a table with name, mouth_m, tip_m, width_m and point_m", [](const Json& notch) {
          return Notch{notch.at("name"), coordinates_in<2>(notch.at("mouth_m")),
                       coordinates_in<2>(notch.at("tip_m")), notch.at("width_m"), notch.at("point_m")};
        });
  auto section =
      Region::polygon(std::move(corners), sides, sides.size() == 1).with_holes(holes).with_notches(notches);
  return {std::move(section), axis == "y" ? Prism::Axis::y : Prism::Axis::z, length.get<double>()};
}

/// Returns the unit of the vertices. Throws Error where they are missing, come twice, or beside sizes in
/// another unit.
std::string unit_in(const Json& json) {
  std::string key;
  for (const auto& [name, items] : json.items()) {
    if (!name.starts_with(kVertices)) continue;
    if (!key.empty())
      throw Error(fmt::format("there are the lists \"{}\" and \"{}\"; only one is allowed", key, name));
    key = name;
  }
  if (key.empty())
    throw Error(
        "there is no list \"vertices_m\", nor one in another unit of length, such as \"vertices_mm\"");
  const std::string unit = key.substr(std::string_view(kVertices).size());
  for (const auto& [name, items] : json.items())
    if (name.starts_with(kBlockSize) && name != kBlockSize + unit)
      throw Error(fmt::format("there is the list \"{}\"; beside \"{}\" it must be \"{}\"", name, key,
                              kBlockSize + unit));
  return unit;
}

template <int Dim>
GivenCells<Dim> given_in(const Json& json, const ToMetres& to_metres) {
  const std::string unit = unit_in(json), vertices = kVertices + unit, size = kBlockSize + unit;
  std::function<double(double)> in_metres;
  try {
    if (to_metres) in_metres = to_metres(unit);
  } catch (const Error& error) {
    throw Error(fmt::format("\"{}\": {}", vertices, error.what()));
  }
  GivenCells<Dim> given;
  given.phases = list_in(json, "phases", "a name", value_in<std::string>);
  given.cells.vertices =
      list_in(json, vertices, fmt::format("a place, [x, y{}] in {}", Dim == 2 ? "" : ", z", unit),
              coordinates_in<Dim>);
  constexpr const char* kOfVertices = "a list of vertices, each by its number from 0";
  if constexpr (Dim == 3)
    for (auto& corners : list_in(json, "faces", kOfVertices, numbers_in))
      given.cells.faces.push_back({.corners = std::move(corners)});
  given.cells.cells = list_in(
      json, "cells", Dim == 2 ? kOfVertices : "a list of faces, each by its number from 0", numbers_in);
  given.phase = list_in(json, "phase", "the number of a phase, from 0", number_in<>);
  if (json.contains(size)) given.size = list_in(json, size, "a size in " + unit, value_in<double>);
  if (json.contains(kStone))
    given.stone = list_in(json, kStone, "the number of a stone, from 0, or -1 for none", number_in<-1>);
  if constexpr (Dim == 3) given.outline = body_in(json, given.cells.cells.size());
  if (!in_metres) return given;
  for (Vec<Dim>& vertex : given.cells.vertices)
    for (double& x : vertex.c) x = in_metres(x);
  for (double& its : given.size) its = in_metres(its);
  return given;
}

Json places(const auto& list) {
  Json all = Json::array();
  for (const auto& place : list) all.push_back(place.c);
  return all;
}

/// Returns the table of a body.
Json table_of(const Prism& body) {
  const Region& section = body.section();
  Json sides = Json::array(), corners = Json::array();
  for (auto [from, to, side] : body.around()) {
    corners.push_back(from.c);
    while (section.sides()[side].part_of >= 0) side = section.sides()[side].part_of;
    if (section.sides()[side].is_round && !sides.empty()) continue;  // one name for all
    sides.push_back(section.sides()[side].name);
  }
  Json table = {{"axis", body.axis() == Prism::Axis::y ? "y" : "z"},
                {"length_m", body.length()},
                {"section_m", std::move(corners)},
                {"sides", std::move(sides)}};
  for (std::size_t i = 1; i < section.loops().size(); ++i) {
    const Loop& hole = section.loops()[i];
    const Side& side = section.sides()[hole.side.front()];
    table["holes"].push_back(
        {{"name", side.name}, {"corners_m", places(hole.corners)}, {"is_round", side.is_round}});
  }
  for (const Notch& notch : section.notches())
    table["notches"].push_back({{"name", notch.name},
                                {"mouth_m", notch.mouth.c},
                                {"tip_m", notch.tip.c},
                                {"width_m", notch.width},
                                {"point_m", notch.point}});
  return table;
}

}  // namespace

template <int Dim>
std::string cells_text(const Specimen<Dim>& specimen) {
  Json json;
  json["phases"] = specimen.phases;
  if constexpr (Dim == 3) json["body"] = table_of(specimen.outline);
  json["vertices_m"] = places(specimen.cells.vertices);
  if constexpr (Dim == 3) {
    json["faces"] = Json::array();
    for (const Facet<3>& face : specimen.cells.faces) json["faces"].push_back(face.corners);
  }
  json["cells"] = specimen.cells.cells;
  json["phase"] = specimen.phase;
  if (!specimen.size.empty()) json["block_size_m"] = specimen.size;
  if (!specimen.stone.empty()) json[kStone] = specimen.stone;
  return json.dump() + "\n";
}

template std::string cells_text<2>(const Specimen<2>&);
template std::string cells_text<3>(const Specimen<3>&);

FileOfCells read_cells(const std::filesystem::path& file, const ToMetres& to_metres, double join) {
  return cells_from(read_file(file), file.string(), to_metres, join);
}

FileOfCells cells_from(const std::string& text, const std::string& name, const ToMetres& to_metres,
                       double join) {
  const std::string begin = name.empty() ? "" : name + ": ";
  const auto completed_in = [&]<int Dim>(GivenCells<Dim> given) {
    given.origin = name;
    return completed(std::move(given), join);
  };
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw Error("is no table of lists");
    if (json.contains("faces") || json.contains("body")) return completed_in(given_in<3>(json, to_metres));
    return completed_in(given_in<2>(json, to_metres));
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format(
        "{}is not JSON, at byte {}: blocks made elsewhere come as JSON, to which the Python package turns "
        "arrays, meshes and images",
        begin, error.byte));
  } catch (const Json::out_of_range& error) {  // the text is "[...] number overflow parsing '1e999'"
    const std::string_view what = error.what();
    throw Error(fmt::format("{}{}", begin, what.substr(what.find(']') + 2)));
  } catch (const Error& error) {
    throw Error(begin + error.what());
  }
}

}  // namespace pyroclast::specimen
