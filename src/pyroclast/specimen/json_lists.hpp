#pragma once

#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"

/// Lists of files of blocks, which are JSON.
namespace pyroclast::specimen {

using Json = nlohmann::ordered_json;

/// Reads one of the lists of a table. Throws Error where it is missing, or an item is of another kind.
/// \param read    function that reads an item; throws Json::exception for another kind of item
/// \param needed  words for an item, for the message
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

/// Says, for messages, how blocks in space come.
inline constexpr const char* kInSpace =
    "Blocks in space come by [specimen] shape = \"polyhedra\" and file, which is JSON with their faces (see "
    "docs/do/bodies.md, Blocks made elsewhere)";

/// List of the sizes that blocks were to have, in m.
inline constexpr const char* kBlockSizeInMetres = "block_size_m";

/// List of the stones of blocks, and words for an item.
inline constexpr const char* kStone = "stone";
inline constexpr const char* kStoneItem = "the number of a stone, from 0, or -1 for none";

/// Reads a number from 0; throws Json::exception for anything else.
int number_in(const Json& item);

/// Reads a number from 0, or -1; throws Json::exception for anything else.
int number_or_none_in(const Json& item);

/// Reads a number; throws Json::exception for anything else.
double real_in(const Json& item);

/// Reads a list of numbers from 0; throws Json::exception for anything else.
std::vector<int> numbers_in(const Json& items);

/// Reads a text; throws Json::exception for anything else.
std::string text_in(const Json& item);

/// Reads a table of lists. Throws Error, which begins with `name`, for a text that is none, and for what
/// `read` complains of.
void read_table(const std::string& text, const std::string& name,
                const std::function<void(const Json&)>& read);

}  // namespace pyroclast::specimen
