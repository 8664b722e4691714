#pragma once

#include "pyroclast/app/commands.hpp"
#include "pyroclast/results/inputs.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast::app {

/// A deck of the options, and what it says, with what the command line says in place and the threads set.
struct Loaded {
  /// \param more  text that is appended to the deck
  explicit Loaded(const RunOptions& options, const std::string& more = "");

  Deck deck;
  Setup setup;
  InstructionSet instructions;
  std::shared_ptr<Team> team;
  std::vector<std::string> warnings;  ///< of deck and command line, a line each
};

/// make_simulation; of many blocks it says first that this takes a while.
std::unique_ptr<Simulation> make_simulation_aloud(const Loaded& loaded, Speech speech);

/// Where the results shall be.
std::filesystem::path output_folder(const RunOptions& options);

/// Puts deck and manifest into the folder for the results, which this process has locked.
RunFolder make_run_folder(const Loaded& loaded, const RunOptions& options, const Inputs& inputs,
                          std::optional<Parent> parent = std::nullopt);

/// Where laws come from as environment and command line say; the command that compiles one is printed.
LawSources sources_of(const OwnLawOptions& options);

/// The contact laws that are not part of the program and that it was asked to run, for the screen; empty
/// without any.
std::string describe_own_laws();

/// What came of the specimen, for the screen.
std::string describe(const specimen::Specimen& specimen);

/// A line each, for the screen; empty without any.
std::string describe_warnings(const std::vector<std::string>& warnings);

/// What the heat solver is about to do, for the screen.
/// \param temperatures  that the run may come to, °C
std::string describe(const Conduction<2>& conduction, const Model<2>& model, const Interval& temperatures);

/// A duration as one reads it, e.g. "3 min 20 s".
std::string duration(double seconds);

}  // namespace pyroclast::app
