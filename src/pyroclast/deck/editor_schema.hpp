#pragma once

#include <string>

#include "pyroclast/deck/survey.hpp"

namespace pyroclast {

/// Returns a JSON Schema (draft 4), with which editors complete and check files of these keys.
///
/// The schema takes every file that the readers take. It refuses unknown keys, values of a wrong form, units
/// of another kind, numbers out of their ranges as far as an expression can tell, and missing keys and
/// tables. Readers alone see what values say together, keys without effect, files, and the names that keys
/// refer to.
std::string editor_schema(const DeckSchema& schema, const std::string& title);

}  // namespace pyroclast
