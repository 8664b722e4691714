#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/simulation/records.hpp"

namespace pyroclast {

/// Reads [[sets]], which every run may have.
std::vector<SetParameters> read_sets(const Section& root);

/// Reads [[record]], which every run may have.
std::vector<RecordParameters> read_records(const Section& root);

}  // namespace pyroclast
