#pragma once

#include <filesystem>
#include <string>

#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// What the figures of a run show, as figures.py decides it: a reference of something else would have no
/// effect.
struct DrawnTables {
  bool strain_stress = false;       ///< a compression at the end
  bool temperature_strain = false;  ///< an expansion under a held load
  bool temperature_stress = false;  ///< a thrust between held platens
  bool time_temperature = false;    ///< heat conduction
};

/// Reads which curves the figures draw beside the results: a built-in reference, or a CSV file of the user's.
/// The run itself has no use for it; figures take it from the folder of the run. A wrong name, and a
/// file that figures could not draw, or of which none shows anything, are errors of the deck. Returns the
/// table of a file in the names and units of figures, as CSV; empty without one.
///
/// \param output  the table [output]
/// \param folder  from which a relative file name is taken
std::string read_reference(const Section& output, const std::filesystem::path& folder,
                           const DrawnTables& drawn);

}  // namespace pyroclast
