#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/setup/read_bearings.hpp"
#include "pyroclast/setup/read_outline.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/simulation/specimen_body.hpp"

namespace pyroclast {

/// Finer blocks as a deck asks for them: near a part that has a name, or near a place.
struct ReadFiner {
  Section section;
  specimen::FinerPart part;
};

/// Blocks as a deck asks for them: by their number, or by their size.
struct ReadBlocks {
  specimen::BlockParameters parameters;
  double size = 0.0;  ///< m; 0: their number is stated
  std::vector<ReadFiner> finer;

  /// Returns the size of a block in a specimen of this area, m.
  double size_in(double area) const {
    return size > 0.0 ? size : std::sqrt(area / std::max(1, parameters.count));
  }
  /// Returns the size of a block in a solid of this volume, m.
  double size_in_solid(double volume) const {
    return size > 0.0 ? size : std::cbrt(volume / std::max(1, parameters.count));
  }
};

/// Reads [blocks]. Errors are recorded in the deck.
/// \param folder      folder to which files are relative
/// \param is_covered  true where aggregates or inclusions say of which phase blocks are
ReadBlocks read_blocks(const Section& s, const std::filesystem::path& folder, const ReadOutline& outline,
                       const DeckSpace& space, bool is_covered);

/// Makes blocks finer in parts: finds the places of these, and the number of all blocks, or the size of those
/// far from them. Tells whether it could; records an error where blocks do not become finer, or are too few.
bool make_finer(const Section& blocks, ReadBlocks& read, std::span<const ReadBearing> bearings,
                std::span<const SetParameters> sets, const specimen::SpecimenParameters& p);

/// Returns the number of blocks of a size. Records an error where it is out of range.
int count_of(const Section& blocks, const specimen::SpecimenParameters& specimen, double size);

}  // namespace pyroclast
