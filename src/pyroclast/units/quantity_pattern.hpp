#pragma once

#include <string>

#include "pyroclast/base/range.hpp"
#include "pyroclast/base/unit.hpp"

namespace pyroclast {

// Regular expressions (ECMA 262) for editors, which cannot know all units: they match every quantity that
// parse_quantity reads, and refuse most others.

/// Returns an expression that matches quantities of a kind. It refuses texts without number, without the unit
/// that the kind needs, and with any of some hundred units of other kinds.
std::string quantity_pattern(const Unit& unit);

/// Returns an expression that matches quantities out of the range alone: negative numbers or zeros, and whole
/// parts of decimals beyond an end, in units that people write for the kind; empty if no such can be told.
std::string out_of_range_pattern(const Unit& unit, const Range& range);

}  // namespace pyroclast
