#include <cerrno>
#include <charconv>
#include <csignal>
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
#include "pyroclast/base/environment.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/shell_words.hpp"
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
  command->add_option("-o,--out", options.out,
                      "Folder for the results (default: runs/<name of the deck>; of `specimen` runs/<name of "
                      "the deck>-specimen)");
  command->add_flag("--overwrite", options.overwrite, "Replace the results of an earlier run");
  command->add_flag("!--no-figures", options.figures, "Draw no figures");
}

void add_page(CLI::App* command, app::RunOptions& options) {
  command->add_flag("!--no-report", options.page, "Make no page of the run; --no-figures makes none either");
}

void add_speech(CLI::App* command, app::RunOptions& options) {
  auto* quiet = command->add_flag_callback(
      "--quiet", [&options] { options.speech = app::Speech::quiet; },
      "Print errors only; run.log has all messages");
  command
      ->add_flag_callback(
          "--verbose", [&options] { options.speech = app::Speech::verbose; }, "Print a line for each sample")
      ->excludes(quiet);
}

void add_watch(CLI::App* command, app::RunOptions& options) {
  command->add_flag(
      "--watch", options.watch,
      "Show curve and specimen during the run: in a window, or without a display in the terminal "
      "and in figures/watch.png of the folder");
}

void add_threads(CLI::App* command, int& threads) {
  command
      ->add_option(
          "-t,--threads", threads,
          "At most this many threads (default: one for each processor that is free for the program). Small "
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
      ->add_option("--set", options.changes,
                   "Change a key of the deck, or add a key: --set stages[1].to='400 degC'")
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
                   "Folders with contact laws, searched before PYROCLAST_LAW_PATH")
      ->take_all()
      ->allow_extra_args(false);
  command->add_flag("--allow-code", options.allow_code,
                    "Allow the code that the deck names, until the code changes; read the code first");
  command->add_flag("--of-study", options.of_study,
                    "Treat --set as part of a study file: code that it names needs --allow-code");
  command->add_flag("!--no-compile", options.may_compile, "Compile no contact laws from headers");
}

int command_line(int argc, char** argv) {
  CLI::App cli{"Pyroclast: how concrete breaks under load and fire, by the discrete element method",
               "pyroclast"};
  cli.set_version_flag("--version",
                       fmt::format("pyroclast {} ({}), physics version {}, instruction sets {}", kVersion,
                                   kCommit, kPhysicsVersion, describe_built_instruction_sets()));
  cli.require_subcommand(1);

  app::RunOptions options;
  options.command = shell_command({argv, argv + argc});
  auto* run = cli.add_subcommand("run", "Run a deck");
  auto* check = cli.add_subcommand("check", "Check a deck and forecast its run, without running it");
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
                  "Run this many specimens, from seed 1 or --seed on: print each result with its mean and 95 "
                  "% interval, "
                  "the curves "
                  "with their band, and the pictures of the median specimen")
      ->check(whole_number(1, 100000));
  run->add_flag("--dry-run", options.dry_run,
                "Tell the time, memory and disk of the run, as `check` does, and with --seeds those of all "
                "specimens; run nothing");
  run->add_flag_callback(
      "--no-fields", [&options] { options.changes.emplace_back("output.fields=false"); },
      "Write no fields, as [output] fields = false; then figures show the history only");

  app::ResumeOptions resume_options;
  resume_options.as.command = options.command;
  auto* resume = cli.add_subcommand(
      "resume", "Continue an interrupted run, or fork one: keep its first stages and append others");
  resume->add_option("RUN", resume_options.run, "Folder of a run")->required();
  resume->add_option("--checkpoint-file", resume_options.checkpoint,
                     "Continue from this checkpoint, not from the newest");
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
                      "Use this law, not a deck's: a name, a shared object (mine.so) or a header (mine.hpp), "
                      "which is compiled");
  stated->excludes(law_deck);
  law->add_option("--set", law_options.values, "Set a property or a choice of the law: --set f_t='3 MPa'")
      ->take_all()
      ->allow_extra_args(false)
      ->needs(stated);
  add_own_laws(law, law_options.sources);
  auto* law_path =
      law->add_option("--path", law_options.path,
                      "CSV file with columns u_n, u_s and optionally T, each with its unit: u_n [um]");
  law->add_option(
      "--interface", law_options.interface,
      "A table of [contacts], or a_a for two blocks of phase a (default: the interface of the matrix)");
  law->add_option("--steps", law_options.steps, "Steps of each leg of the path")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->default_val(1);
  law->add_option("-o,--out", law_options.out, "CSV file to write (default: standard output)");
  app::VerifyOptions verify_options;
  auto* verify = law->add_option("--verify", verify_options.laws,
                                 "Test these laws, or all, for the properties that a law must have")
                     ->expected(0, -1)
                     ->excludes(law_deck)
                     ->excludes(law_path);
  law->add_option("--paths", verify_options.paths, "Number of random paths in each dimension")
      ->check(whole_number(1, std::numeric_limits<int>::max()))
      ->needs(verify)
      ->default_val(10000);
  law->add_option("--seed", verify_options.seed, "Seed of the random paths")->needs(verify)->default_val(1);
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
      "Draw the figures of a run again, or several runs in one figure: figures compare RUN... --out FILE");
  figures->prefix_command();
  figures->set_help_flag();

  auto* report = cli.add_subcommand(
      "report", "Make the page of a run, one HTML file for any browser: report RUN [--out FILE]");
  report->prefix_command();
  report->set_help_flag();

  auto* watch =
      cli.add_subcommand("watch", "Show a run while another process computes it: watch RUN [--once]");
  watch->prefix_command();
  watch->set_help_flag();

  auto* study = cli.add_subcommand(
      "study", "Many runs: scatter, sensitivity, calibration: study run|check|status|table|report STUDY");
  study->prefix_command();
  study->set_help_flag();

  auto* converge = cli.add_subcommand("converge",
                                      "Tell how far results move with half the rate, half the exchange step, "
                                      "and half and double the block size: converge DECK");
  converge->prefix_command();
  converge->set_help_flag();

  std::string name, from = "starter";
  auto* starter = cli.add_subcommand("new", "Write a commented deck to begin with");
  starter->add_option("NAME", name, "Name of the new deck: NAME.toml")->required();
  starter->add_option("--from", from, "Case to copy, see `pyroclast list cases`")->capture_default_str();

  app::ConcreteOptions concrete_options;
  std::vector<std::string> typed{argv, argv + argc};
  typed[0] = "pyroclast";
  concrete_options.command = shell_command(typed);
  auto* concrete = cli.add_subcommand(
      "concrete",
      "Write a deck for your concrete from its strength and stiffness, and a study that calibrates the deck");
  concrete->add_option("--f_c", concrete_options.strength, "Mean compressive strength: --f_c '45 MPa'")
      ->required();
  concrete->add_option("--E", concrete_options.modulus, "Young's modulus: --E '32 GPa'")->required();
  concrete
      ->add_option("--aggregate", concrete_options.rock, "Rock of the aggregate, see `pyroclast list rocks`")
      ->required();
  concrete->add_option("--fraction", concrete_options.fraction,
                       "Area of coarse aggregate over the area of a section");
  concrete->add_option("--stones", concrete_options.stones,
                       "Mass of coarse aggregate in the mix, in the place of --fraction: '1100 kg/m3'; with "
                       "--passing, of all aggregate");
  concrete->add_option("--d_max", concrete_options.d_max, "Largest aggregate, graded by Fuller's curve");
  concrete
      ->add_option("--passing", concrete_options.passing,
                   "Share that passes each sieve, by mass, in the place of --d_max: --passing '4 mm=38 %' '8 "
                   "mm=55 %' '20 mm=100 %', or a file with two columns: --passing sieves.csv")
      ->take_all();
  concrete
      ->add_option("--d_min", concrete_options.d_min,
                   "Smallest coarse aggregate; smaller grains belong to the mortar")
      ->capture_default_str();
  concrete->add_option(
      "--width", concrete_options.width,
      "Width of the specimen (default: 150 mm), diameter of a cylinder (default: 4 times its "
      "largest aggregate); with --from: as in its deck");
  concrete->add_option("--height", concrete_options.height,
                       "Height of the specimen (default: 300 mm, of a cylinder twice its diameter); with "
                       "--from: as in its deck");
  concrete->add_flag(
      "--cylinder", concrete_options.cylinder,
      "Make a body in space: stones of three blocks across and more; smaller ones belong to the "
      "mortar");
  concrete
      ->add_option("--blocks", concrete_options.blocks,
                   "Number of blocks (default: 5 across the largest aggregate, but between 1000 and 5000 "
                   "blocks; 10000 of a cylinder)")
      ->check(whole_number(100, 1000000));
  concrete->add_option("--hot", concrete_options.hot,
                       "Also write a deck of a test at this temperature: --hot '400 degC'");
  auto* fire = concrete->add_option("--fire", concrete_options.fire,
                                    "Also write a deck of a fire: iso834, hydrocarbon, another one of "
                                    "`pyroclast list fires`, or the file of a furnace record");
  concrete->add_option("--minutes", concrete_options.minutes, "Minutes of fire: --minutes 90")->needs(fire);
  concrete->add_option("--faces", concrete_options.faces, "Sides in the fire: left, right, or both")
      ->capture_default_str()
      ->needs(fire);
  concrete->add_option("--level", concrete_options.level, "Load that is held in the fire, over f_c")
      ->capture_default_str()
      ->needs(fire);
  concrete
      ->add_option("--columns", concrete_options.columns,
                   "Columns of a furnace record with more than two: --columns time 'Furnace mean'")
      ->expected(2)
      ->needs(fire);
  concrete->add_option(
      "--from", concrete_options.from,
      "Take mortar and contacts of the hot test or the fire from this deck, such as the calibrated "
      "one");
  concrete->add_option("-o,--out", concrete_options.out, "File for the deck")->required();

  app::KeysOptions keys_options;
  auto* keys = cli.add_subcommand("keys", "Print all keys of decks, as Markdown");
  keys->add_flag("--json", keys_options.json, "Print JSON");
  keys->add_flag("--schema", keys_options.schema,
                 "Print a JSON Schema (draft 4), with which editors complete and check decks");
  keys->add_flag("--survey", keys_options.survey,
                 "Ask the readers of decks again, not the file of the build; takes a while")
      ->group("");
  auto* laws = cli.add_subcommand("laws", "Print the contact laws of the program, as Markdown");

  std::string list_of;
  auto* list = cli.add_subcommand("list", "List the names that a deck may use, a line each");
  list->add_option("WHAT", list_of, "cases, columns, curves, fields, fires, keys, laws, rocks or units");

  auto* doctor = cli.add_subcommand(
      "doctor", "List the parts that are present and those that are missing; add this list to a bug report");

  auto* manual = cli.add_subcommand("manual", "Print the manual page, for man");
  std::string shell = "bash";
  auto* completion = cli.add_subcommand("completion", "Print the completion of a shell for this program");
  completion->add_option("SHELL", shell, "bash or zsh")->capture_default_str();
  auto* commands = cli.add_subcommand("commands", "Print all commands as JSON")->group("");

  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return cli.exit(error);  // --help, --version
    throw Error(app::what_is_wrong(cli, error, std::vector<std::string>(argv + 1, argv + argc)));
  }
  if (*run && options.seeds > 1) app::scatter(options);
  if (*run && !options.dry_run) return app::run(options);
  if (*resume) return app::resume(resume_options);
  const int code = [&] {
    if (*check || *run) return app::check(options);
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
    throw Error(fmt::format("the output cannot be written ({})", std::strerror(errno)));
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that must not grow further is an error with a sentence
  forget_current_folder();
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
