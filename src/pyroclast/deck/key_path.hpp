#pragma once

#include <string_view>

namespace pyroclast {

/// Whether a path of a deck, such as "stages[1].rate", is that of a table or stands below it. All paths stand
/// below the empty one, that of the deck.
inline bool is_at_or_below(std::string_view path, std::string_view table) {
  if (table.empty() || path == table) return true;
  return path.starts_with(table) && (path[table.size()] == '.' || path[table.size()] == '[');
}

}  // namespace pyroclast
