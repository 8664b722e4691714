#pragma once

#include <string>

namespace pyroclast {

/// Column that a history may have, with its meaning. Words in capitals in the name, such as NAME and
/// INTERFACE, stand for names of the deck.
struct ColumnInfo {
  std::string name;
  std::string unit;
  std::string meaning;
};

}  // namespace pyroclast
