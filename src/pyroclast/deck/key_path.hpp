#pragma once

#include <string_view>

namespace pyroclast {

/// Tells whether a path of a deck, such as "stages[1].rate", is the path of a table or stands below it. All
/// paths stand below the empty path, which is the deck's.
inline bool is_at_or_below(std::string_view path, std::string_view table) {
  if (table.empty() || path == table) return true;
  return path.starts_with(table) && (path[table.size()] == '.' || path[table.size()] == '[');
}

}  // namespace pyroclast
