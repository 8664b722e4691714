#pragma once

#include <cstddef>
#include <string>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Reads `columns` and `units`, which say what of a file is meant.
/// \param file         as the deck names it
/// \param least, most  of the quantities that are read, how many
ColumnChoice read_column_choice(const Section& section, const std::string& file, std::size_t least,
                                std::size_t most);

}  // namespace pyroclast
