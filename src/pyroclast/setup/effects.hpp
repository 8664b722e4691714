#pragma once

#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

// What a deck states acts on something: else it is refused, or told where a run without it may be meant, such
// as the first of a series of temperatures.

/// Records an error where the deck has boundaries of heat and no stage lets heat flow.
void check_flow(const Section& root, const Setup& setup);

/// Warns where the body is not at the temperature at which nothing is strained when its first stage begins,
/// and of a temperature without stress where nothing expands.
void warn_of_first_strain(const Section& root, const Setup& setup);

/// Warns of stages and boundaries that leave the specimen at the temperature that it has.
void warn_of_even_temperatures(const Section& root, const Setup& setup);

/// Sets that no stage, record, heat boundary or other set names.
std::vector<std::string> unused_sets(const Setup& setup);

/// Lines about what the deck says of materials that are heated or cooled, where the run does neither, and
/// about steps of the free strain that it stays below.
std::vector<std::string> unused_properties(const Section& root, const Setup& setup);

}  // namespace pyroclast
