#pragma once

#include <string>

#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// Reads the key `name` of a thing whose name becomes a part of a column's name in history.csv: letters,
/// digits and _.
std::string read_name(const Section& s, Meaning meaning);

}  // namespace pyroclast
