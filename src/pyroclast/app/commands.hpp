#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pyroclast::app {

constexpr int kMostThreads = 1024;

/// Contact laws that are not part of the program.
struct OwnLawOptions {
  std::vector<std::filesystem::path> folders;  ///< see LawSources
  bool may_compile = true;
  bool allow_code = false;  ///< see CodePermission
  bool of_study = false;    ///< --set says what a study file does
};

/// How much a run says on the screen; `run.log` has the lines of `usual` at least.
enum class Speech : std::uint8_t { quiet, usual, verbose };

struct RunOptions {
  std::filesystem::path deck;
  std::filesystem::path out;  ///< empty: runs/<name of the deck>
  bool overwrite = false;
  bool figures = true;
  bool watch = false;
  int threads = 0;                   ///< at most; 0: as many as processors are free
  std::string instructions;          ///< instruction set of the step; empty: the best that there is
  std::optional<std::int64_t> seed;  ///< instead of the deck's
  std::vector<std::string> changes;  ///< "key=value", see Deck::open
  std::optional<double> checkpoint;  ///< wall time between two checkpoints instead of the deck's, s
  OwnLawOptions laws;
  Speech speech = Speech::usual;
  std::string command;  ///< as typed, for the manifest
};

struct ResumeOptions {
  std::filesystem::path run;         ///< folder of a run
  std::filesystem::path checkpoint;  ///< to go on from; empty: the newest
  std::string from_stage;            ///< of a fork: number or name of the last stage in common
  std::filesystem::path more;        ///< of a fork: a file with stages to append
  RunOptions as;                     ///< `deck` and `seed` are the run's
};

struct LawOptions {
  std::filesystem::path deck, path, out;
  std::string interface;
  std::string law;                  ///< instead of a deck's, see find_law
  std::vector<std::string> values;  ///< "key=value" of its properties
  OwnLawOptions sources;
  int steps = 1;  ///< each leg of the path is cut into as many
};

struct VerifyOptions {
  std::vector<std::string> laws;  ///< as find_law takes them; empty: all of the program
  OwnLawOptions sources;
  int paths = 10000;  ///< in each dimension
  std::uint64_t seed = 1;
};

struct PropertiesOptions {
  std::filesystem::path deck;
  std::filesystem::path out;  ///< empty: runs/<name of the deck>-properties
};

/// Reads a duration such as "5 min", s. Throws Error naming the option.
double time_option(const std::string& name, const std::string& text);

/// Exit code where code that came with a deck was not allowed.
constexpr int kCodeNotAllowed = 3;

// Each returns the exit code and throws Error for the user.
int check(const RunOptions& options);
int make_specimen(const RunOptions& options);
int run(const RunOptions& options);
/// Goes on with a run that was broken off, or forks one into a new folder.
int resume(const ResumeOptions& options);
int law(const LawOptions& options);
/// 1 when a law fails.
int verify_laws(const VerifyOptions& options);
int plot_properties(const PropertiesOptions& options);
/// \param from  a case, see kCases
int make_deck(const std::string& name, const std::string& from);
/// \param what  curves, fields, fires, units, keys, cases or laws
int print_list(const std::string& what);
int print_keys();
int print_laws();

/// Draws figures of results that are there, by the command of the Python package: `run`, `compare`, `levels`
/// ...
int figures(const std::vector<std::string>& words);

/// Goes on as the program of studies, see the Python package. \param words  as typed
[[noreturn]] void study(const std::vector<std::string>& words);

/// Draws the figures of a folder with the Python package; warns when that is not possible.
/// \param what  the package's command
/// \param speech  quiet: the names of the files are not printed
/// \param skip    asked before and while they are drawn; true ends it
void draw_figures(
    const std::string& what, const std::filesystem::path& folder, Speech speech = Speech::usual,
    const std::function<bool()>& skip = [] { return false; });

}  // namespace pyroclast::app
