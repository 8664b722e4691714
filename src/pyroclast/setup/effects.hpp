#pragma once

#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

// Every statement of a deck acts on something. A statement that does not is refused; or the user is told,
// where a run without its effect may be meant, such as the first of a series of temperatures.

/// Records an error where the deck has boundaries of heat and no stage lets heat flow.
void check_flow(const Section& root, const Setup& setup);

/// Warns where the body is not at the temperature at which nothing is strained when its first stage begins,
/// and of a temperature without stress where nothing expands.
void warn_of_first_strain(const Section& root, const Setup& setup);

/// Warns of stages and boundaries that leave the specimen at its present temperature.
void warn_of_even_temperatures(const Section& root, const Setup& setup);

/// Returns the sets that no stage, record, heat boundary or other set names.
std::vector<std::string> unused_sets(const Setup& setup);

/// Returns lines about properties for heated or cooled materials, where the run neither heats nor cools, and
/// about steps of the free strain above the temperatures of the run.
std::vector<std::string> unused_properties(const Section& root, const Setup& setup);

}  // namespace pyroclast
