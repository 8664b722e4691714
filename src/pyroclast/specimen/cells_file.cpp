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

/// One of the lists.
/// \param read    of an item; throws Json::exception for another kind of item
/// \param needed  in words: what the items are
template <class Read>
auto list(const Json& json, const char* key, const char* needed, Read read) {
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

Cells read_cells(const std::filesystem::path& file) {
  return cells_from(read_file(file), file.string());
}

Cells cells_from(const std::string& text, const std::string& name) {
  try {
    const Json json = Json::parse(text);
    if (!json.is_object()) throw Error("is no table of lists");
    Cells cells;
    cells.phases = list(json, "phases", "a name", [](const Json& item) { return item.get<std::string>(); });
    cells.tessellation.vertices = list(json, "vertices_m", "a place, [x, y] in m", place);
    cells.tessellation.cells = list(json, "cells", "a list of vertices, each by its number from 0", numbers);
    cells.phase = list(json, "phase", "the number of a phase, from 0", number);
    return checked(std::move(cells));
  } catch (const Json::parse_error& error) {
    throw Error(fmt::format("{}: is not JSON, at byte {}", name, error.byte));
  } catch (const Json::out_of_range& error) {  // by its text, "[...] number overflow parsing '1e999'"
    const std::string_view what = error.what();
    throw Error(fmt::format("{}: {}", name, what.substr(what.find(']') + 2)));
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
}

}  // namespace pyroclast::specimen
