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

}  // namespace

std::string cells_text(const Cells& cells) {
  Json json;
  json["phases"] = cells.phases;
  Json vertices = Json::array();
  for (const Vec<2>& v : cells.tessellation.vertices) vertices.push_back({v[0], v[1]});
  json["vertices_m"] = std::move(vertices);
  json["cells"] = cells.tessellation.cells;
  json["phase"] = cells.phase;
  if (!cells.size.empty()) json["block_size_m"] = cells.size;
  if (!cells.grain.empty()) json[kStone] = cells.grain;
  return json.dump() + "\n";
}

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
    Cells cells;
    cells.phases = list_in(json, "phases", "a name", text_in);
    cells.tessellation.vertices = list_in(json, key, fmt::format("a place, [x, y] in {}", file.unit), place);
    cells.tessellation.cells =
        list_in(json, "cells", "a list of vertices, each by its number from 0", numbers_in);
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
