#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/body_file.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

struct DeckOfRun;

/// Choices of a user beside a deck.
struct RunChoices {
  std::optional<std::uint64_t> seed;  ///< seed in place of the deck's
  int threads = 0;                    ///< most threads; 0: as many as processors are free
  std::string instructions;           ///< instruction set of the step; empty: the best available
  std::optional<double> checkpoint;   ///< wall time between two checkpoints in place of the deck's, s
  StageRegistry kinds;
  LawSources laws = LawSources::of_environment();
  std::shared_ptr<Ranks> ranks;  ///< ranks that hold the body; null: one
  std::filesystem::path body;    ///< folder of a body that was made before; empty: it is made here
  /// Tells whether this process writes the files of a run.
  bool is_first() const { return !ranks || ranks->is_first(); }
  bool needs_code = true;  ///< false: code that the deck names and that may not run is listed in its setup
  /// Function that is called before the specimen is made, which may take long.
  std::function<void(const DeckOfRun&)> before_making = [](const DeckOfRun&) {};
};

/// Deck as it was read, with the choices applied, and the threads of its run.
struct DeckOfRun {
  /// Reads a deck. Throws DeckError, or Error for a choice that is not allowed.
  /// \param folder  folder of the deck
  DeckOfRun(Deck deck, std::filesystem::path folder, RunChoices choices);

  RunChoices choices;
  std::filesystem::path folder;
  Deck deck;
  InstructionSet instructions;
  Setup setup;
  std::shared_ptr<Team> team;
  std::optional<BodyFile> body;       ///< body that was made before, of these inputs
  std::vector<std::string> warnings;  ///< warnings of deck and choices, one line each
};

/// Returns the contact laws that are not part of the program and that this process opened.
std::vector<OwnLaw> own_laws();

}  // namespace pyroclast
