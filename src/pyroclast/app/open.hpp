#pragma once

#include "pyroclast/app/commands.hpp"
#include "pyroclast/results/inputs.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/session/open.hpp"

namespace pyroclast::app {

/// The deck of the options, and what it says, with what the command line says in place and the threads set.
/// \param needs_code  else what the deck names and may not run is in its setup
Opened open_deck(const RunOptions& options, bool needs_code = true);
/// Of a run; of many blocks it says first that making them takes a while.
RunChoices choices_of(const RunOptions& options);

/// Where the results shall be.
std::filesystem::path output_folder(const RunOptions& options);

/// Names what was in a folder and stays there.
void print_kept(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& foreign);

/// Where laws come from as environment and command line say; the command that compiles one is printed.
LawSources sources_of(const OwnLawOptions& options);

/// The contact laws that are not part of the program and that it was asked to run, for the screen; empty
/// without any.
std::string describe_own_laws();

/// What came of the specimen, for the screen.
std::string describe(const specimen::Specimen& specimen);

/// How many threads a run takes at most, for the screen.
std::string describe(const Team& team);

/// A line each, for the screen; empty without any.
std::string describe_warnings(const std::vector<std::string>& warnings);
/// What of a deck is there for others than the program; empty where nothing is.
std::string describe_unused(const Setup& setup);

/// What the heat solver is about to do, for the screen.
/// \param temperatures  that the run may come to, °C
std::string describe(const Conduction<2>& conduction, const Model<2>& model, const Interval& temperatures);

/// A duration as one reads it, e.g. "3 min 20 s".
std::string duration(double seconds);

}  // namespace pyroclast::app
