#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <new>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "pyroclast/app/command_names.hpp"
#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/say_aside.hpp"
#include "pyroclast/app/watcher.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/version.hpp"

namespace {

using namespace pyroclast;

/// Returns a validator that takes whole numbers from `least` to `most`. Its messages are words of this
/// program, because those of CLI11 differ from version to version.
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

void add_output(CLI::App* command, app::RunOptions& options) {
  command->add_option(
      "-o,--out", options.out,
      "Folder for the results (default: runs/<name of the deck>, of a specimen <...>-specimen)");
  command->add_flag("--overwrite", options.overwrite, "Replace the results of an earlier run");
  command->add_flag("!--no-figures", options.figures, "Draw no figures");
}

void add_page(CLI::App* command, app::RunOptions& options) {
  command->add_flag("!--no-report", options.page, "Make no page of the run; --no-figures makes none either");
}

void add_speech(CLI::App* command, app::RunOptions& options) {
  auto* quiet = command->add_flag_callback(
      "--quiet", [&options] { options.speech = app::Speech::quiet; },
      "Print nothing but errors; run.log has it all");
  command
      ->add_flag_callback(
          "--verbose", [&options] { options.speech = app::Speech::verbose; }, "Print a line for each look")
      ->excludes(quiet);
}

void add_watch(CLI::App* command, app::RunOptions& options) {
  command->add_flag("--watch", options.watch,
                    "Show curve and specimen as they grow: in a window, or without a display in the terminal "
                    "and in figures/watch.png of the folder");
}

void add_threads(CLI::App* command, int& threads) {
  command
      ->add_option("-t,--threads", threads,
                   "At most so many threads (default: as many as processors are free for the program). Small "
                   "bodies, and "
                   "runs beside other work, take fewer; results are the same for any number")
      ->check(whole_number(1, app::kMostThreads));
}

void add_processor(CLI::App* command, app::RunOptions& options) {
  add_threads(command, options.threads);
  command->add_option("--instructions", options.instructions,
                      "Instruction set: portable, avx2 or avx512 (default: the best that the processor has); "
                      "results are the same for any");
}

void add_changes(CLI::App* command, app::RunOptions& options) {
  command
      ->add_option(
          "--set", options.changes,
          "Another value for a key of the deck, or one that it does not have: --set stages[1].to='400 degC'")
      ->take_all()
      ->allow_extra_args(false);
}

void add_checkpoint(CLI::App* command, app::RunOptions& options) {
  command->add_option_function<std::string>(
      "--checkpoint",
      [&options](const std::string& text) { options.checkpoint = app::time_option("--checkpoint", text); },
      "Wall time between two checkpoints, instead of the deck's: --checkpoint '5 min'");
}

void add_own_laws(CLI::App* command, app::OwnLawOptions& options) {
  command
      ->add_option("--law-path", options.folders,
                   "Folders with contact laws, before those of PYROCLAST_LAW_PATH")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--allow-code", options.allow_code,
                    "Let code that the deck names run, now and until it changes; read it first");
  command->add_flag("--of-study", options.of_study,
                    "What --set says comes from the file of a study: code that it names needs your word");
  command->add_flag("!--no-compile", options.may_compile,
                    "Compile no contact law that a deck states as a header");
}

int command_line(int argc, char** argv) {
  CLI::App cli{"Pyroclast: how concrete breaks under load and fire, by the discrete element method",
               "pyroclast"};
  cli.set_version_flag("--version",
                       fmt::format("pyroclast {} ({}), physics version {}, instruction sets {}", kVersion,
                                   kCommit, kPhysicsVersion, describe_built_instruction_sets()));
  cli.require_subcommand(1);

  app::RunOptions options;
  for (int i = 0; i < argc; ++i) options.command += fmt::format("{}{}", i == 0 ? "" : " ", argv[i]);
  auto* run = cli.add_subcommand("run", "Run a deck");
  auto* check = cli.add_subcommand("check", "Check a deck and tell what its run will be, without running it");
  auto* specimen = cli.add_subcommand("specimen", "Make only the specimen of a deck, with its pictures");
  for (auto* command : {run, check, specimen}) {
    add_deck(command, options.deck);
    add_own_laws(command, options.laws);
    add_seed(command, options.seed);
    add_changes(command, options);
  }
  for (auto* command : {run, specimen}) add_output(command, options);
  add_page(run, options);
  for (auto* command : {run, check}) add_processor(command, options);
  add_threads(specimen, options.threads);

  add_checkpoint(run, options);
  add_speech(run, options);
  add_watch(run, options);
  run->add_option("--seeds", options.seeds,
                  "Run so many specimens, from --seed or 1 on: each result with its mean and 95 % interval, "
                  "the curves "
                  "with their band, and the pictures of the median specimen")
      ->check(whole_number(1, 100000));
  run->add_flag_callback(
      "--no-fields", [&options] { options.changes.emplace_back("output.fields=false"); },
      "Write no fields, as [output] fields = false; figures are those of the history");

  app::ResumeOptions resume_options;
  resume_options.as.command = options.command;
  auto* resume = cli.add_subcommand(
      "resume", "Go on with a run that was broken off, or fork one: other stages after some that are done");
  resume->add_option("RUN", resume_options.run, "Folder of a run")->required();
  resume->add_option("--checkpoint-file", resume_options.checkpoint, "Go on from this one, not the newest");
  auto* from_stage = resume->add_option("--from-stage", resume_options.from_stage,
                                        "Fork: the last stage in common, by its number from 0 or its name");
  resume->add_option("--stages", resume_options.more, "Fork: append the [[stages]] of this file")
      ->excludes(from_stage);
  add_changes(resume, resume_options.as);
  add_output(resume, resume_options.as);
  add_page(resume, resume_options.as);
  add_processor(resume, resume_options.as);
  add_own_laws(resume, resume_options.as.laws);
  add_checkpoint(resume, resume_options.as);
  add_speech(resume, resume_options.as);
  add_watch(resume, resume_options.as);

  app::LawOptions law_options;
  auto* law = cli.add_subcommand("law",
                                 "Drive a contact law along a path of jumps and temperatures, or try laws on "
                                 "random paths: law --verify");
  auto* law_deck = law->add_option("DECK", law_options.deck, "TOML file that describes the run");
  auto* stated =
      law->add_option("--law", law_options.law,
                      "A law instead of a deck's: a name, a shared object (mine.so) or a header (mine.hpp), "
                      "which is compiled");
  stated->excludes(law_deck);
  law->add_option("--set", law_options.values, "With --law: a property of it, --set f_t='3 MPa', or a choice")
      ->take_all()
      ->allow_extra_args(false)
      ->needs(stated);
  add_own_laws(law, law_options.sources);
  auto* law_path = law->add_option("--path", law_options.path,
                                   "CSV: columns u_n, u_s and optionally T, each with its unit: u_n [um]");
  law->add_option("--interface", law_options.interface,
                  "A table of [contacts], or a_a for two blocks of phase a (default: that of the matrix)");
  law->add_option("--steps", law_options.steps, "Cut each leg of the path into so many steps")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->default_val(1);
  law->add_option("-o,--out", law_options.out, "CSV file to write (default: standard output)");
  app::VerifyOptions verify_options;
  auto* verify =
      law->add_option("--verify", verify_options.laws,
                      "Instead: try these laws, or all, against the properties that a law must have")
          ->expected(0, -1)
          ->excludes(law_deck)
          ->excludes(law_path);
  law->add_option("--paths", verify_options.paths, "Random paths in each dimension")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->needs(verify)
      ->default_val(10000);
  law->add_option("--seed", verify_options.seed, "Of the random paths")->needs(verify)->default_val(1);
  law->callback([&] {
    verify_options.sources = law_options.sources;
    if (*verify) return;
    if (!*law_deck && !*stated) throw CLI::RequiredError("DECK, or --law");
    if (!*law_path) throw CLI::RequiredError(law_path->get_name());
  });

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

  auto* report = cli.add_subcommand(
      "report", "Make the page of a run, which needs nothing but a browser: report RUN [--out FILE]");
  report->prefix_command();
  report->set_help_flag();

  auto* watch = cli.add_subcommand("watch", "Show a run that another process computes: watch RUN [--once]");
  watch->prefix_command();
  watch->set_help_flag();

  auto* study = cli.add_subcommand(
      "study", "Many runs: scatter, sensitivity, calibration: study run|check|status|table|report STUDY");
  study->prefix_command();
  study->set_help_flag();

  auto* converge = cli.add_subcommand("converge",
                                      "Say what half the rate, half the exchange step, and half and double "
                                      "the block size move: converge DECK");
  converge->prefix_command();
  converge->set_help_flag();

  std::string name, from = "starter";
  auto* starter = cli.add_subcommand("new", "Write a commented deck to begin with");
  starter->add_option("NAME", name, "The deck will be NAME.toml")->required();
  starter->add_option("--from", from, "Case that it is a copy of, see `pyroclast list cases`")
      ->capture_default_str();

  app::ConcreteOptions concrete_options;
  for (int i = 0; i < argc; ++i) {
    const std::string word = i == 0 ? "pyroclast" : argv[i];
    const bool is_plain = word.find_first_of(" '\"%$\\\n") == std::string::npos;
    concrete_options.command +=
        fmt::format("{}{}", i == 0 ? "" : " ", is_plain ? word : fmt::format("'{}'", word));
  }
  auto* concrete = cli.add_subcommand(
      "concrete",
      "Write the deck of a concrete by its strength and stiffness, and a study that calibrates it");
  concrete->add_option("--f_c", concrete_options.strength, "Its mean strength: --f_c '45 MPa'")->required();
  concrete->add_option("--E", concrete_options.modulus, "Its Young's modulus: --E '32 GPa'")->required();
  concrete->add_option("--aggregate", concrete_options.rock, "Its rock, see `pyroclast list rocks`")
      ->required();
  concrete->add_option("--fraction", concrete_options.fraction,
                       "Area of coarse aggregate over that of a section");
  concrete->add_option(
      "--stones", concrete_options.stones,
      "Instead: mass of the aggregate in the mix, '1100 kg/m3'; with --passing, of all of it");
  concrete->add_option("--d_max", concrete_options.d_max, "Largest aggregate, graded by Fuller's curve");
  concrete
      ->add_option(
          "--passing", concrete_options.passing,
          "Instead: what passes each sieve, by mass: --passing '4 mm=38 %' '8 mm=55 %' '20 mm=100 %'")
      ->take_all();
  concrete
      ->add_option("--d_min", concrete_options.d_min,
                   "Smallest coarse aggregate; the mortar has what is smaller")
      ->capture_default_str();
  concrete->add_option("--width", concrete_options.width,
                       "Of the specimen (default: 150 mm; with --from: its deck's)");
  concrete->add_option("--height", concrete_options.height,
                       "Of the specimen (default: 300 mm; with --from: its deck's)");
  concrete
      ->add_option("--blocks", concrete_options.blocks,
                   "Number of blocks (default: 5 in the largest aggregate, but 1000 to 5000 of them)")
      ->check(whole_number(100, 1000000));
  concrete->add_option("--hot", concrete_options.hot,
                       "Write a test at this temperature too: --hot '400 degC'");
  concrete->add_option("--from", concrete_options.from,
                       "With --hot: take mortar and contacts from this deck, such as the calibrated one");
  concrete->add_option("-o,--out", concrete_options.out, "The deck will be this file")->required();

  app::KeysOptions keys_options;
  auto* keys = cli.add_subcommand("keys", "Print every key that a deck may hold, as Markdown");
  keys->add_flag("--json", keys_options.json, "As JSON");
  keys->add_flag("--schema", keys_options.schema,
                 "As a JSON Schema (draft 4), with which editors complete and check decks");
  keys->add_flag(
          "--survey", keys_options.survey,
          "Ask the readers of decks, which takes a while, and not the file that they left at the build")
      ->group("");
  auto* laws = cli.add_subcommand("laws", "Print the contact laws of the program, as Markdown");

  std::string list_of;
  auto* list = cli.add_subcommand("list", "List what a deck may name, a line each");
  list->add_option("WHAT", list_of, "cases, columns, curves, fields, fires, keys, laws, rocks or units");

  auto* doctor =
      cli.add_subcommand("doctor", "Say what is there and what is missing; a report of a bug needs it");

  auto* manual = cli.add_subcommand("manual", "Print the manual page, for man");
  std::string shell = "bash";
  auto* completion = cli.add_subcommand("completion", "Print the completion of a shell for this program");
  completion->add_option("SHELL", shell, "bash or zsh")->capture_default_str();
  auto* commands = cli.add_subcommand("commands", "Print all of this as JSON")->group("");

  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);  // --help, --version
    throw Error(app::what_is_wrong(cli, error, std::vector<std::string>(argv + 1, argv + argc)));
  }
  if (*run && options.seeds > 1) app::scatter(options);
  if (*run) return app::run(options);
  if (*resume) return app::resume(resume_options);
  const int code = [&] {
    if (*check) return app::check(options);
    if (*specimen) return app::make_specimen(options);
    if (*law) return *verify ? app::verify_laws(verify_options) : app::law(law_options);
    if (*properties) return app::plot_properties(properties_options);
    if (*figures) return app::figures(figures->remaining());
    if (*report) app::report(report->remaining());
    if (*watch) app::watch(watch->remaining());
    if (*study) app::study(study->remaining());
    if (*concrete) return app::write_concrete(concrete_options);
    if (*converge) {
      std::vector<std::string> words = converge->remaining();
      words.insert(words.begin(), "converge");
      app::study(words);
    }
    if (*keys) return app::print_keys(keys_options);
    if (*laws) return app::print_laws();
    if (*list) return app::print_list(list_of);
    if (*doctor) return app::doctor();
    if (*manual) app::manual();
    if (*completion) return app::completion(shell);
    if (*commands) return app::print_commands(cli);
    return app::make_deck(name, from);
  }();
  if (std::fflush(stdout) != 0)
    throw Error(fmt::format("what is printed cannot be written ({})", std::strerror(errno)));
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return command_line(argc, argv);
  } catch (const pyroclast::CodeNotAllowed& e) {
    app::say_aside(fmt::format("error: {}\n", e.what()));
    return app::kCodeNotAllowed;
  } catch (const pyroclast::Error& e) {
    app::say_aside(fmt::format("error: {}\n", e.what()));
  } catch (const std::bad_alloc&) {
    app::say_aside("error: out of memory\n");
  } catch (const std::exception& e) {
    app::say_aside(fmt::format("error: {}\n", e.what()));
  }
  return 1;
}
