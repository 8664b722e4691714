#pragma once

#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/simulation/specimen_body.hpp"
#include "pyroclast/simulation/watching/probe.hpp"

namespace pyroclast {

/// Reads [[probes]], which may be absent. Errors are recorded in the deck.
/// \param specimen  specimen outside of which no probe may lie
std::vector<ProbePosition> read_probes(const Section& root, const specimen::SpecimenParameters& specimen);

}  // namespace pyroclast
