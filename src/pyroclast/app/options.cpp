#include "pyroclast/app/options.hpp"

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast::app {

namespace {

/// Reads a duration such as "5 min", s. Throws Error naming the option.
double time_option(const std::string& name, const std::string& text) {
  double seconds = 0.0;
  try {
    seconds = parse_quantity(text, unit::time);
  } catch (const QuantityError& error) {
    throw Error(fmt::format("{}: {}", name, error.what()));
  }
  if (!(seconds >= 0.0)) throw Error(fmt::format("{} \"{}\": must not be negative", name, text));
  return seconds;
}

}  // namespace

CLI::Validator whole_number(std::int64_t least, std::int64_t most) {
  return CLI::Validator(
      [=](const std::string& text) {
        std::int64_t number = 0;
        const char* const end = text.data() + text.size();
        const auto [at, error] = std::from_chars(text.data(), end, number);
        if (error == std::errc() && at == end && number >= least && number <= most) return std::string();
        return fmt::format("{} is not a whole number from {} to {}", text, least, most);
      },
      fmt::format("from {} to {}", least, most));
}

void add_deck(CLI::App* command, std::filesystem::path& deck) {
  command->add_option("DECK", deck, "TOML file that describes the run")->required();
}

void add_seed(CLI::App* command, std::optional<std::int64_t>& seed) {
  command->add_option("--seed", seed, "Seed of the specimen, instead of the deck's, 0 or more")
      ->check(whole_number(0, specimen::kLargestSeed));
}

void add_output(CLI::App* command, RunOptions& options) {
  command->add_option("-o,--out", options.out,
                      "Folder for the results (default: runs/<name of the deck>; of `specimen` runs/<name of "
                      "the deck>-specimen)");
  command->add_flag("--overwrite", options.overwrite, "Replace the results of an earlier run");
  command->add_flag("!--no-figures", options.figures, "Draw no figures");
}

void add_page(CLI::App* command, RunOptions& options) {
  command->add_flag("!--no-report", options.page, "Make no page of the run; --no-figures makes none either");
}

void add_speech(CLI::App* command, RunOptions& options) {
  auto* quiet = command->add_flag_callback(
      "--quiet", [&options] { options.speech = Speech::quiet; },
      "Print errors only; run.log has all messages");
  command
      ->add_flag_callback(
          "--verbose", [&options] { options.speech = Speech::verbose; }, "Print a line for each sample")
      ->excludes(quiet);
}

void add_watching(CLI::App* command, RunOptions& options) {
  command->add_flag(
      "--watch", options.watch,
      "Show curve and specimen during the run: in a window, or without a display in the terminal "
      "and in figures/watch.png of the folder");
}

CLI::Option* add_mpi(CLI::App* command, RunOptions& options) {
  return command->add_flag("--mpi", options.mpi,
                           "Hold the body by the ranks of an MPI job: mpirun -n 4 pyroclast run DECK --mpi; "
                           "results are the same for any number");
}

void add_threads(CLI::App* command, int& threads) {
  command
      ->add_option(
          "-t,--threads", threads,
          "At most this many threads (default: one for each processor that is free for the program). Small "
          "bodies, and "
          "runs beside other work, take fewer; results are the same for any number")
      ->check(whole_number(1, kMostThreads));
}

void add_processor(CLI::App* command, RunOptions& options) {
  add_threads(command, options.threads);
  command->add_option("--instructions", options.instructions,
                      "Instruction set: portable, avx2 or avx512 (default: the best that the processor has); "
                      "results are the same for any");
}

void add_changes(CLI::App* command, RunOptions& options) {
  command
      ->add_option("--set", options.changes,
                   "Change a key of the deck, or add a key: --set stages[1].to='400 degC'")
      ->take_all()
      ->allow_extra_args(false);
}

void add_checkpoint(CLI::App* command, RunOptions& options) {
  command->add_option_function<std::string>(
      "--checkpoint",
      [&options](const std::string& text) { options.checkpoint = time_option("--checkpoint", text); },
      "Wall time between two checkpoints, instead of the deck's: --checkpoint '5 min'");
}

void add_own_laws(CLI::App* command, OwnLawOptions& options) {
  command
      ->add_option("--law-path", options.folders,
                   "Folders with contact laws, searched before PYROCLAST_LAW_PATH")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--allow-code", options.allow_code,
                    "Allow the code that the deck names, until the code changes; read the code first");
  command->add_flag("--of-study", options.of_study,
                    "Treat --set as part of a study file: code that it names needs --allow-code");
  command->add_flag("!--no-compile", options.may_compile, "Compile no contact laws from headers");
}

CLI::App* add_passed_on(CLI::App& cli, const char* name, const char* description) {
  auto* command = cli.add_subcommand(name, description);
  command->prefix_command();
  command->set_help_flag();
  return command;
}

int printed(int code) {
  if (std::fflush(stdout) != 0)
    throw Error(fmt::format("the output cannot be written ({})", std::strerror(errno)));
  return code;
}

}  // namespace pyroclast::app
