#pragma once

#include <optional>

#include "pyroclast/setup/setup.hpp"

namespace pyroclast::app {

/// Compressed specimens of a study, by the size of their blocks over d_max: how many fell clearly, and the
/// scatter of f_c from seed to seed (docs/validation/peaks.md).
struct StudiedStrength {
  double size;
  int fell_clearly, of;
  double scatter;  ///< standard deviation over the mean
};

/// Returns the specimens that are most like another; none where that is no plane body of blocks and
/// aggregates.
std::optional<StudiedStrength> studied_like(const specimen::SpecimenParameters& specimen);

}  // namespace pyroclast::app
