#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast {

struct Opened;

/// What a user says beside a deck.
struct RunChoices {
  std::optional<std::uint64_t> seed;  ///< instead of the deck's
  int threads = 0;                    ///< at most; 0: as many as processors are free
  std::string instructions;           ///< instruction set of the step; empty: the best that there is
  std::optional<double> checkpoint;   ///< wall time between two checkpoints instead of the deck's, s
  StageRegistry kinds;
  LawSources laws = LawSources::of_environment();
  bool needs_code = true;  ///< else what the deck names and may not run is in its setup
  /// Called before the specimen is made, which may take long.
  std::function<void(const Opened&)> before_making = [](const Opened&) {};
};

/// A deck, and what it says with the choices in place of it, and the threads of its run.
struct Opened {
  /// Throws DeckError, or Error for a choice that cannot be.
  /// \param folder  of the deck
  Opened(Deck deck, std::filesystem::path folder, RunChoices choices);

  RunChoices choices;
  std::filesystem::path folder;
  Deck deck;
  InstructionSet instructions;
  Setup setup;
  std::shared_ptr<Team> team;
  std::vector<std::string> warnings;  ///< of deck and choices, a line each
};

/// The contact laws that are not part of the program and that this process opened.
std::vector<OwnLaw> own_laws();

}  // namespace pyroclast
