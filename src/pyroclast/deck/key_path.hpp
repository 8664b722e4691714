#pragma once

#include <string>
#include <string_view>

namespace pyroclast {

/// Tells whether a path of a deck, such as "stages[1].rate", is the path of a table or stands below it. All
/// paths stand below the empty path, which is the deck's.
inline bool is_at_or_below(std::string_view path, std::string_view table) {
  if (table.empty() || path == table) return true;
  return path.starts_with(table) && (path[table.size()] == '.' || path[table.size()] == '[');
}

/// Returns the path of a key of a table.
inline std::string joined_path(std::string_view table, std::string_view key) {
  return table.empty() ? std::string(key) : std::string(table).append(1, '.').append(key);
}

/// Tells whether a path of a description, such as "stages[]", stands for an array of tables.
inline bool is_array_path(std::string_view path) {
  return path.ends_with("[]");
}
/// Returns a path without the "[]" of an array.
inline std::string without_brackets(std::string_view path) {
  return std::string(is_array_path(path) ? path.substr(0, path.size() - 2) : path);
}

}  // namespace pyroclast
