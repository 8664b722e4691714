#pragma once

#include <cstddef>
#include <string>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Reads `columns` and `units`, by which a deck chooses columns of a file.
/// \param file         file as the deck names it
/// \param least, most  bounds on the number of quantities that are read
ColumnChoice read_column_choice(const Section& section, const std::string& file, std::size_t least,
                                std::size_t most);

/// Reads `start`, the time of a record that counts as 0; empty where the deck states none.
std::string read_start(const Section& section);

}  // namespace pyroclast
