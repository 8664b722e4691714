#pragma once

#include <string>

#include "pyroclast/app/load.hpp"

namespace pyroclast::app {

// Decks of heat conduction alone. Each returns the exit code.
int run_conduction(const Loaded& loaded, const RunOptions& options);
int check_conduction(const Loaded& loaded);

/// What the heat solver is about to do, for the screen.
/// \param temperatures  that the run may come to, °C
std::string describe(const Conduction<2>& conduction, const Model<2>& model, const Interval& temperatures);

}  // namespace pyroclast::app
