#pragma once

#include <string>

#include "pyroclast/deck/survey.hpp"

namespace pyroclast {

/// Writes a schema as JSON, with the members of DeckSchema as names.
std::string json_of(const DeckSchema& schema);

/// Reads what json_of wrote. Throws Error where it is something else.
DeckSchema schema_of(const std::string& json);

}  // namespace pyroclast
