#pragma once

#include "pyroclast/app/commands.hpp"
#include "pyroclast/results/inputs.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/session/deck_of_run.hpp"

namespace pyroclast::app {

/// Opens the deck of the options, with the changes of the command line applied and the threads set.
/// \param needs_code  false: code that the deck names and that may not run is listed in its setup
DeckOfRun open_deck(const RunOptions& options, bool needs_code = true);
/// Returns the choices for a run. With many blocks it first says that making them takes a while.
RunChoices choices_of(const RunOptions& options);

/// Returns the folder for the results.
std::filesystem::path output_folder(const RunOptions& options);

/// Prints the names of files that were in a folder and stay there.
void print_kept(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& foreign);

/// Returns the sources of laws from environment and command line; the command that compiles a law is printed.
LawSources sources_of(const OwnLawOptions& options);

/// Describes, for the screen, the contact laws outside the program that it was asked to run; empty without
/// any.
std::string describe_own_laws();

/// Describes, for the screen, the specimen as it was made.
std::string describe(const MadeSpecimen& specimen);

/// Describes, for the screen, the ranks that hold a body; empty where there is one.
std::string describe(const Ranks& ranks);
/// Describes, for the screen, how many threads a run takes at most, on each rank.
std::string describe(const Team& team);

/// Returns the warnings as lines for the screen; empty without any.
std::string describe_warnings(const std::vector<std::string>& warnings);
/// Describes the parts of a deck that are there for others than the program; empty where there are none.
std::string describe_unused(const Setup& setup);

/// Describes, for the screen, the work that lies before the heat solver.
/// \param temperatures  temperatures to which the run may come, °C
std::string describe(const HeatSolver& conduction, const Model& model, const Interval& temperatures);

/// Returns a duration for readers, e.g. "3 min 20 s".
std::string duration(double seconds);

}  // namespace pyroclast::app
