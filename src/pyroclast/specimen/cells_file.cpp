#include "pyroclast/specimen/cells_file.hpp"

#include <array>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/specimen/from_cells.hpp"

namespace pyroclast::specimen {

namespace {

using Json = nlohmann::ordered_json;

/// Beginning of the name of the list of vertices; the unit follows.
constexpr std::string_view kVertices = "vertices_";

/// Reads one of the lists. Throws Error where it is missing, or an item is of another kind.
/// \param read    function that reads an item; throws Json::exception for another kind of item
/// \param needed  words for an item, for the message
template <class Read>
auto list(const Json& json, const std::string& key, const std::string& needed, Read read) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array()) throw Error(fmt::format("there is no list \"{}\"", key));
  std::vector<decltype(read(*found))> items;
  try {
    for (const Json& item : *found) items.push_back(read(item));
  } catch (const Json::exception&) {
    throw Error(fmt::format("{}[{}]: must be {}", key, items.size(), needed));
  }
  return items;
}

int number(const Json& item) {
  if (const double value = item.get<double>();
      !item.is_number_integer() || value < 0 || value > std::numeric_limits<int>::max())
    throw Json::other_error::create(501, "no number from 0", &item);
  return item.get<int>();
}

std::vector<int> numbers(const Json& items) {
  std::vector<int> all;
  for (const Json& item : items.get_ref<const Json::array_t&>()) all.push_back(number(item));
  return all;
}

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
  return json.dump() + "\n";
}

CellsFile read_cells(const std::filesystem::path& file) {
  return cells_from(read_file(file), file.string());
}

CellsFile cells_from(const std::string& text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw Error("is no table of lists");
    const std::string key = vertices_key(json), unit = key.substr(kVertices.size());
    Cells cells;
    cells.phases = list(json, "phases", "a name", [](const Json& item) { return item.get<std::string>(); });
    cells.tessellation.vertices = list(json, key, fmt::format("a place, [x, y] in {}", unit), place);
    cells.tessellation.cells = list(json, "cells", "a list of vertices, each by its number from 0", numbers);
    cells.phase = list(json, "phase", "the number of a phase, from 0", number);
    return {checked(std::move(cells)), unit};
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format("{}: is not JSON, at byte {}", name, error.byte));
  } catch (const Json::out_of_range& error) {  // the text is "[...] number overflow parsing '1e999'"
    const std::string_view what = error.what();
    throw Error(fmt::format("{}: {}", name, what.substr(what.find(']') + 2)));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace pyroclast::specimen
