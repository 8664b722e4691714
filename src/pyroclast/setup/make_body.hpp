#pragma once

#include <span>
#include <variant>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_bearings.hpp"
#include "pyroclast/setup/read_blocks.hpp"
#include "pyroclast/setup/read_outline.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Returns the outline of a deck; a square or a cube stands in for an error.
/// \param sizes  sizes of blocks where they are finer in parts: circles have their sides about as long
std::variant<specimen::Region, specimen::Prism> make_outline(const Section& s, const ReadOutline& o,
                                                             const DeckSpace& space, const ReadBlocks& read,
                                                             std::span<const ReadBearing> bearings,
                                                             const specimen::BlockSizes* sizes = nullptr);

/// Tells whether the outline of a specimen is that of the deck, and does not stand in for an error in its
/// table or in a file of blocks.
bool is_outline_known(const Section& root, const specimen::SpecimenParameters& specimen);

/// Records an error for each bearing on a side that the specimen does not have.
void check_bearings(const specimen::SpecimenParameters& specimen, std::span<const ReadBearing> bearings);

}  // namespace pyroclast
