#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/watching/records.hpp"

namespace pyroclast {

/// Reads [[sets]], which every run may have.
std::vector<SetParameters> read_sets(const Section& root, const DeckSpace& space);

/// Reads [[record]], which every run may have.
std::vector<RecordParameters> read_records(const Section& root, const DeckSpace& space);

}  // namespace pyroclast
