#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/deck/survey.hpp"

namespace pyroclast::app {

constexpr int kMostThreads = 1024;

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
  std::filesystem::path out;  ///< output folder; empty: runs/<name of the deck>
  bool overwrite = false;
  bool figures = true;
  bool page = true;  ///< false: no page of the run at its end
  bool watch = false;
  bool dry_run = false;              ///< true to tell what the run takes, and not to run
  int threads = 0;                   ///< most threads; 0: as many as processors are free
  std::string instructions;          ///< instruction set of the step; empty: the best available
  std::optional<std::int64_t> seed;  ///< seed in place of the deck's
  int seeds = 1;                     ///< number of specimens; above 1 by the package for Python
  std::vector<std::string> changes;  ///< changes "key=value", see Deck::open
  std::optional<double> checkpoint;  ///< wall time between two checkpoints in place of the deck's, s
  OwnLawOptions laws;
  Speech speech = Speech::usual;
  std::string command;  ///< command as typed, for the manifest
};

struct ResumeOptions {
  std::filesystem::path run;         ///< folder of a run
  std::filesystem::path checkpoint;  ///< checkpoint to go on from; empty: the newest
  std::string from_stage;            ///< number or name of the last stage in common, for a fork
  std::filesystem::path more;        ///< file with stages to append, for a fork
  RunOptions as;                     ///< options of the run; `deck` and `seed` come from the run itself
};

struct LawOptions {
  std::filesystem::path deck, path, out;
  std::string interface;
  std::string law;                  ///< law in place of a deck's, see find_law
  std::vector<std::string> values;  ///< properties of the law, "key=value"
  OwnLawOptions sources;
  int steps = 1;  ///< number of parts into which each leg of the path is cut
};

struct VerifyOptions {
  std::vector<std::string> laws;  ///< names of laws as find_law takes them; empty: all laws of the program
  OwnLawOptions sources;
  int paths = 10000;  ///< number of paths in each dimension
  std::uint64_t seed = 1;
};

struct PropertiesOptions {
  std::filesystem::path deck;
  std::filesystem::path out;  ///< output folder; empty: runs/<name of the deck>-properties
};

/// Reads a duration such as "5 min", s. Throws Error naming the option.
double time_option(const std::string& name, const std::string& text);

/// Exit code where code that came with a deck was not allowed.
constexpr int kCodeNotAllowed = 3;

/// Exit code of a command that was interrupted.
constexpr int kInterrupted = 130;

// Each of the next functions returns the exit code and throws Error for the user.
int check(const RunOptions& options);
int make_specimen(const RunOptions& options);
int run(const RunOptions& options);
/// Goes on with a run that was broken off, or forks one into a new folder.
int resume(const ResumeOptions& options);
int law(const LawOptions& options);
/// Tries laws; returns 1 when a law fails.
int verify_laws(const VerifyOptions& options);
int plot_properties(const PropertiesOptions& options);
/// Writes a new deck.
/// \param from  a case, see kCases
int make_deck(const std::string& name, const std::string& from);

struct ConcreteOptions {
  // quantities as typed; empty where they are not stated
  std::string strength, modulus, rock, fraction, stones, d_max, hot;
  std::string d_min = "4.75 mm", width, height;
  std::vector<std::string> passing;  ///< points of a grading, "8 mm=45 %", or a file
  std::string fire, minutes, faces = "left,right", level = "0.3";
  std::vector<std::string> columns;  ///< columns of a furnace record: time, temperature
  std::int64_t blocks = 0;           ///< 0: by the largest aggregate
  bool cylinder = false;             ///< true for a body in space
  std::filesystem::path from;        ///< deck whose mortar and contacts are taken; empty: they are guessed
  std::filesystem::path out;
  std::string command;  ///< command as typed, for the deck
};
/// Writes the deck of a concrete with first guesses, a study that calibrates it, and a deck of a hot
/// test or of a fire.
int write_concrete(const ConcreteOptions& options);

/// Returns the places of all keys that a deck may have, such as "stages[].kind"; NAME stands for a name of
/// one's own.
/// \param of_tables  true to leave out forms of values, which are in several tables
std::vector<std::string> key_paths(bool of_tables = false);
/// Returns what print_list prints.
std::vector<std::string> names_of_lists();
/// Prints a list.
/// \param what  one of names_of_lists
int print_list(const std::string& what);

/// Prints what is there and what is missing, as a report of a bug needs it.
int doctor();

struct KeysOptions {
  bool json = false;
  bool schema = false;
  bool survey = false;  ///< true to ask the readers of decks, false for what they left at the build
};
/// Prints all keys that a deck may have, as Markdown, JSON, or a JSON Schema for editors.
int print_keys(const KeysOptions& options);
/// Returns all keys that a deck may have, from the file that the build left where it is there.
DeckSchema known_deck_schema();
/// First line of a deck that a command writes. An editor finds the schema where `keys --schema` was saved
/// beside the deck; the line holds on any machine.
inline constexpr std::string_view kSchemaLine = "#:schema ./deck.schema.json\n";
int print_laws();

/// Draws figures of present results, by the command of the Python package: `run`, `compare`, `levels` ...
int figures(const std::vector<std::string>& words);

/// Goes on as the program of studies, see the Python package.
/// \param words  as typed
[[noreturn]] void study(const std::vector<std::string>& words);

/// Goes on as the program of studies, which runs several specimens of a deck: options.seeds of them.
[[noreturn]] void scatter(const RunOptions& options);

/// Draws the figures of a folder with the Python package; warns when that is not possible.
/// \param what    command of the package
/// \param speech  quiet: the names of the files are not printed
/// \param skip    asked before and while the figures are drawn; true ends the drawing
void draw_figures(
    const std::string& what, const std::filesystem::path& folder, Speech speech = Speech::usual,
    const std::function<bool()>& skip = [] { return false; });

/// Goes on as the program that makes the page of a run, see the Python package.
/// \param words  as typed
[[noreturn]] void report(const std::vector<std::string>& words);

/// Makes the page of a run with the Python package; warns when that is not possible.
/// \param speech  quiet: the name of the file is not printed
/// \param skip    asked before and while the page is made; true ends the making
void make_page(const std::filesystem::path& folder, Speech speech, const std::function<bool()>& skip);

}  // namespace pyroclast::app
