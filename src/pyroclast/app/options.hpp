#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "pyroclast/base/ranks.hpp"

namespace pyroclast::app {

constexpr int kMostThreads = 1024;
constexpr int kMostRanks = 100'000;

/// Sources of contact laws that are not part of the program.
struct OwnLawOptions {
  std::vector<std::filesystem::path> folders;  ///< folders of laws, see LawSources
  bool may_compile = true;
  bool allow_code = false;  ///< permission for code met now, see CodePermission
  bool of_study = false;    ///< true where the values of --set come from a study file
};

/// Amount of text that a run prints on the screen; `run.log` has at least the lines of `usual`.
enum class Speech : std::uint8_t { quiet, usual, verbose };

struct RunOptions {
  std::filesystem::path deck;
  std::filesystem::path out;   ///< output folder; empty: runs/<name of the deck>
  std::filesystem::path body;  ///< folder of a body that was made before; empty: the run makes it
  bool overwrite = false;
  bool figures = true;
  bool page = true;  ///< false: no page of the run at its end
  bool watch = false;
  bool dry_run = false;              ///< true to tell what the run takes, and not to run
  int ranks = 0;                     ///< ranks whose parts `check` foretells; 0: none
  int threads = 0;                   ///< most threads; 0: as many as processors are free
  std::string instructions;          ///< instruction set of the step; empty: the best available
  std::optional<std::int64_t> seed;  ///< seed in place of the deck's
  bool mpi = false;                  ///< true where the ranks of an MPI job hold the body together
  int seeds = 1;                     ///< number of specimens; above 1 by the package for Python
  std::vector<std::string> changes;  ///< changes "key=value", see Deck::open
  std::optional<double> checkpoint;  ///< wall time between two checkpoints in place of the deck's, s
  OwnLawOptions laws;
  Speech speech = Speech::usual;
  std::shared_ptr<Ranks> held_by;  ///< ranks that hold the body; null: one
  std::string command;             ///< command as typed, for the manifest
};

/// Returns a validator that takes whole numbers from `least` to `most`. Its messages are words of this
/// program, because those of CLI11 differ from version to version.
CLI::Validator whole_number(std::int64_t least, std::int64_t most);

// Each of the next functions adds options that several commands have.
void add_deck(CLI::App* command, std::filesystem::path& deck);
void add_seed(CLI::App* command, std::optional<std::int64_t>& seed);
void add_output(CLI::App* command, RunOptions& options);
void add_page(CLI::App* command, RunOptions& options);
void add_speech(CLI::App* command, RunOptions& options);
void add_watching(CLI::App* command, RunOptions& options);
CLI::Option* add_mpi(CLI::App* command, RunOptions& options);
void add_threads(CLI::App* command, int& threads);
void add_processor(CLI::App* command, RunOptions& options);
void add_changes(CLI::App* command, RunOptions& options);
void add_checkpoint(CLI::App* command, RunOptions& options);
void add_own_laws(CLI::App* command, OwnLawOptions& options);

/// Adds a command whose words, and whose help, are another program's.
CLI::App* add_passed_on(CLI::App& cli, const char* name, const char* description);

}  // namespace pyroclast::app
