#pragma once

#include <vector>

#include "pyroclast/simulation/watching/column.hpp"

namespace pyroclast {

/// Returns all columns that histories may have, those of stages included.
std::vector<Column> possible_columns();

}  // namespace pyroclast
