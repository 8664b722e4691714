#pragma once

#include <cstddef>
#include <string>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Reads `columns` and `units`, which say what of a file is meant.
/// \param file   as the deck names it
/// \param count  of the quantities that are read
ColumnChoice read_column_choice(const Section& section, const std::string& file, std::size_t count);

}  // namespace pyroclast
