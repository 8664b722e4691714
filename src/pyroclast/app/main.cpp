#include <cstdio>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/version.hpp"

namespace {

using namespace pyroclast;

void add_deck(CLI::App* command, std::filesystem::path& deck) {
  command->add_option("DECK", deck, "TOML file that describes the run")->required();
}

void add_seed(CLI::App* command, std::optional<std::uint64_t>& seed) {
  command->add_option("--seed", seed, "Seed of the specimen, instead of the deck's");
}

void add_output(CLI::App* command, app::RunOptions& options) {
  command->add_option("-o,--out", options.out, "Folder for the results (default: runs/<name of the deck>)");
  command->add_flag("--overwrite", options.overwrite, "Replace the results of an earlier run");
  command->add_flag("!--no-figures", options.figures, "Draw no figures");
}

void add_threads(CLI::App* command, int& threads) {
  command->add_option("-t,--threads", threads, "Threads; results are the same for any number")
      ->check(CLI::PositiveNumber);
}

void add_processor(CLI::App* command, app::RunOptions& options) {
  add_threads(command, options.threads);
  command->add_option("--instructions", options.instructions,
                      "Instruction set: portable, avx2 or avx512 (default: the best that the processor has); "
                      "results are the same for any");
}

int command_line(int argc, char** argv) {
  CLI::App cli{"Pyroclast: how concrete breaks under load and fire, by the discrete element method",
               "pyroclast"};
  cli.set_version_flag("--version", fmt::format("pyroclast {} ({})", kVersion, kCommit));
  cli.require_subcommand(1);

  app::RunOptions options;
  for (int i = 0; i < argc; ++i) options.command += fmt::format("{}{}", i == 0 ? "" : " ", argv[i]);
  auto* run = cli.add_subcommand("run", "Run a deck");
  auto* check = cli.add_subcommand("check", "Check a deck and tell what its run will be, without running it");
  auto* specimen = cli.add_subcommand("specimen", "Make only the specimen of a deck, with its pictures");
  for (auto* command : {run, check, specimen}) {
    add_deck(command, options.deck);
    add_seed(command, options.seed);
    command
        ->add_option("--set", options.changes,
                     "Another value for a key of the deck: --set stages[1].to='400 degC'")
        ->take_all()
        ->allow_extra_args(false);
  }
  for (auto* command : {run, specimen}) add_output(command, options);
  for (auto* command : {run, check}) add_processor(command, options);
  add_threads(specimen, options.threads);

  app::LawOptions law_options;
  auto* law =
      cli.add_subcommand("law", "Drive the contact law of a deck along a path of jumps and temperatures");
  auto* deck = law->add_option("DECK", law_options.deck, "TOML file that describes a run");
  auto* stated =
      law->add_option("--law", law_options.law,
                      "A law instead of a deck's: a name, a shared object (mine.so) or a header (mine.hpp), "
                      "which is compiled");
  stated->excludes(deck);
  law->add_option("--set", law_options.values, "With --law: a property of it, --set f_t='3 MPa', or a choice")
      ->take_all()
      ->allow_extra_args(false)
      ->needs(stated);
  law->add_option("--law-path", law_options.folders, "Folders with laws, before those of PYROCLAST_LAW_PATH");
  law->add_flag("!--no-compile", law_options.may_compile, "Compile no law in a header");
  law->add_option("--path", law_options.path,
                  "CSV: columns u_n, u_s and optionally T, each with its unit: u_n [um]")
      ->required();
  law->add_option("--interface", law_options.interface, "Which contact")
      ->check(CLI::IsMember({"mortar-mortar", "aggregate-mortar", "aggregate-aggregate"}))
      ->default_val("mortar-mortar");
  law->add_option("--steps", law_options.steps, "Cut each leg of the path into so many steps")
      ->check(CLI::PositiveNumber)
      ->default_val(1);
  law->add_option("-o,--out", law_options.out, "CSV file to write (default: standard output)");

  app::PropertiesOptions properties_options;
  auto* properties = cli.add_subcommand("plot-properties",
                                        "Draw and tabulate the properties of a deck over the temperature");
  add_deck(properties, properties_options.deck);
  properties->add_option("-o,--out", properties_options.out,
                         "Folder for table and figure (default: runs/<name of the deck>-properties)");

  auto* figures = cli.add_subcommand(
      "figures",
      "Draw figures of runs that are there, several in one too: figures compare RUN... --out FILE");
  figures->prefix_command();
  figures->set_help_flag();

  std::string name;
  auto* starter = cli.add_subcommand("new", "Write a commented starter deck");
  starter->add_option("NAME", name, "The deck will be NAME.toml")->required();

  auto* keys = cli.add_subcommand("keys", "Print every key that a deck may hold, as Markdown");

  CLI11_PARSE(cli, argc, argv);
  if (*run) return app::run(options);
  if (*check) return app::check(options);
  if (*specimen) return app::make_specimen(options);
  if (*law) return app::law(law_options);
  if (*properties) return app::plot_properties(properties_options);
  if (*figures) return app::figures(figures->remaining());
  if (*keys) return app::print_keys();
  return app::make_deck(name);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return command_line(argc, argv);
  } catch (const pyroclast::Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "error: out of memory\n");
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
  }
  return 1;
}
