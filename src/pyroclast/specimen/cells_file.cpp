#include "pyroclast/specimen/cells_file.hpp"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "pyroclast/specimen/json_lists.hpp"

namespace pyroclast::specimen {

namespace {

/// Beginning of the name of the list of vertices; the unit follows.
constexpr std::string_view kVertices = "vertices_";
/// Likewise of the list of the sizes that blocks were to have.
constexpr std::string_view kBlockSize = "block_size_";

Vec<2> place(const Json& item) {
  const auto [x, y] = item.get<std::array<double, 2>>();
  if (item.size() != 2) throw Json::other_error::create(501, "no place in the plane", &item);
  return {{x, y}};
}

/// Returns the name of the list of vertices. Throws Error where there is none, or more than one.
std::string vertices_key(const Json& json) {
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
  return key;
}

Json places(const auto& list) {
  Json all = Json::array();
  for (const auto& place : list) all.push_back(place.c);
  return all;
}

/// Returns the table of a body.
Json table_of(const Prism& body) {
  const Region& section = body.section();
  const Loop& outline = section.loops().front();
  Json sides = Json::array();
  for (int side : outline.side) {
    while (section.sides()[side].part_of >= 0) side = section.sides()[side].part_of;
    if (section.sides()[side].is_round && !sides.empty()) continue;  // one name for all
    sides.push_back(section.sides()[side].name);
  }
  return {{"axis", body.axis() == Prism::Axis::y ? "y" : "z"},
          {"length_m", body.length()},
          {"section_m", places(outline.corners)},
          {"sides", std::move(sides)}};
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
  if (!specimen.size.empty()) json[kBlockSizeInMetres] = specimen.size;
  if (!specimen.grain.empty()) json[kStone] = specimen.grain;
  return json.dump() + "\n";
}

template std::string cells_text<2>(const Specimen<2>&);
template std::string cells_text<3>(const Specimen<3>&);

CellsFile read_cells(const std::filesystem::path& file) {
  return cells_from(read_file(file), file.string());
}

CellsFile cells_from(const std::string& text, const std::string& name) {
  CellsFile file;
  read_table(text, name, [&file](const Json& json) {
    if (json.contains("faces") || json.contains("body"))
      throw Error(fmt::format("holds blocks of space, with \"{}\", and is read as cells of the plane. {}",
                              json.contains("faces") ? "faces" : "body", kInSpace));
    const std::string key = vertices_key(json);
    file.unit = key.substr(kVertices.size());
    GivenCells<2> cells;
    cells.phases = list_in(json, "phases", "a name", text_in);
    cells.cells.vertices = list_in(json, key, fmt::format("a place, [x, y] in {}", file.unit), place);
    cells.cells.cells = list_in(json, "cells", "a list of vertices, each by its number from 0", numbers_in);
    cells.phase = list_in(json, "phase", "the number of a phase, from 0", number_in);
    const std::string size = std::string(kBlockSize) + file.unit;
    for (const auto& [list, items] : json.items())
      if (list.starts_with(kBlockSize) && list != size)
        throw Error(
            fmt::format("there is the list \"{}\"; beside \"{}\" it must be \"{}\"", list, key, size));
    if (json.contains(size))
      cells.size = list_in(json, size, fmt::format("a size in {}", file.unit), real_in);
    if (json.contains(kStone)) cells.grain = list_in(json, kStone, kStoneItem, number_or_none_in);
    file.cells = checked(std::move(cells));
  });
  return file;
}

}  // namespace pyroclast::specimen
