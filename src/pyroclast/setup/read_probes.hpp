#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/probe.hpp"
#include "pyroclast/specimen/region.hpp"

namespace pyroclast {

/// Reads [[probes]], which may be absent. Errors are recorded in the deck.
/// \param region  the specimen; no probe may lie outside
std::vector<ProbePosition> read_probes(const Section& root, const specimen::Region& region);

}  // namespace pyroclast
