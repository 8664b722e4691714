#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "pyroclast/app/options.hpp"
#include "pyroclast/deck/survey.hpp"

namespace pyroclast::app {

/// Exit code where code that came with a deck was not allowed.
constexpr int kCodeNotAllowed = 3;

/// Exit code of a command that was interrupted.
constexpr int kInterrupted = 130;

/// A command of the program.
struct Command {
  CLI::App* line;  ///< its words and options on the command line
  /// Does what was asked, and returns the exit code. Throws Error for the user.
  /// \param typed  words as typed, the program first
  std::function<int(const std::vector<std::string>& typed)> act;
  /// False where results are in files, so that text which nobody could read is no fault.
  bool must_print = true;
};

/// Returns the exit code. Throws Error where the text on stdout cannot be written.
int printed(int code);

// Each of the next functions adds a command with its options to the command line.
Command add_run(CLI::App& cli);
Command add_check(CLI::App& cli);
Command add_specimen(CLI::App& cli);
Command add_resume(CLI::App& cli);
Command add_law(CLI::App& cli);
Command add_properties(CLI::App& cli);
Command add_figures(CLI::App& cli);
Command add_report(CLI::App& cli);
Command add_watch(CLI::App& cli);
Command add_study(CLI::App& cli);
Command add_converge(CLI::App& cli);
Command add_new(CLI::App& cli);
Command add_concrete(CLI::App& cli);
Command add_keys(CLI::App& cli);
Command add_laws(CLI::App& cli);
Command add_list(CLI::App& cli);
Command add_doctor(CLI::App& cli);
Command add_manual(CLI::App& cli);
Command add_completion(CLI::App& cli);
Command add_commands(CLI::App& cli);

/// Checks a deck and forecasts its run.
int check(const RunOptions& options);

/// Returns the places of all keys that a deck may have, such as "stages[].kind"; NAME stands for a name of
/// one's own.
/// \param of_tables  true to leave out forms of values, which are in several tables
std::vector<std::string> key_paths(bool of_tables = false);
/// Returns what print_list prints.
std::vector<std::string> names_of_lists();

/// Returns all keys that a deck may have, from the file that the build left where it is there.
DeckSchema known_deck_schema();
/// First line of a deck that a command writes. An editor finds the schema where `keys --schema` was saved
/// beside the deck; the line holds on any machine.
inline constexpr std::string_view kSchemaLine = "#:schema ./deck.schema.json\n";

/// Goes on as the program of studies, which runs several specimens of a deck: options.seeds of them.
[[noreturn]] void scatter(const RunOptions& options);

/// Draws the figures of a folder with the Python package; warns when that is not possible.
/// \param what    command of the package
/// \param speech  quiet: the names of the files are not printed
/// \param skip    asked before and while the figures are drawn; true ends the drawing
void draw_figures(
    const std::string& what, const std::filesystem::path& folder, Speech speech = Speech::usual,
    const std::function<bool()>& skip = [] { return false; });

/// Makes the page of a run with the Python package; warns when that is not possible.
/// \param speech  quiet: the name of the file is not printed
/// \param skip    asked before and while the page is made; true ends the making
void make_page(const std::filesystem::path& folder, Speech speech, const std::function<bool()>& skip);

}  // namespace pyroclast::app
