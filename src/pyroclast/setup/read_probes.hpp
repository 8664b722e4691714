#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/probe.hpp"

namespace pyroclast {

/// Reads [[probes]], which may be absent. What is wrong is recorded in the deck.
/// \param width, height  of the specimen, m; no probe may lie outside
std::vector<ProbePosition> read_probes(const Section& root, double width, double height);

}  // namespace pyroclast
