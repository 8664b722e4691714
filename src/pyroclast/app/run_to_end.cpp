#include "pyroclast/app/run_to_end.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/app/interrupt.hpp"
#include "pyroclast/app/on_ranks.hpp"
#include "pyroclast/app/progress.hpp"
#include "pyroclast/app/specimen_scatter.hpp"
#include "pyroclast/app/watcher.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/session/foretold_heat.hpp"
#include "pyroclast/session/rehearsal.hpp"
#include "pyroclast/simulation/watching/items.hpp"

namespace pyroclast::app {

namespace {

/// Sums the contact points that each mode has broken by now.
std::int64_t broken(const History& history) {
  std::int64_t count = 0;
  for (const Column& column : history.columns())
    if (column.name.ends_with("_broken")) count += std::llround(*history.last(column.name));
  return count;
}

/// Describes a value of a record, in the unit in which figures draw it; none: its blocks have left the body.
std::string describe_record(const Record& record, const std::optional<double>& value) {
  if (!value) return fmt::format("  {} gone", record.parameters().name);
  const Column column = column_of(record.parameters());
  struct Shown {
    std::string_view unit, as;
    double factor;
  };
  constexpr Shown kShown[] = {{"m", "mm", 1e3}, {"m2", "cm2", 1e4}, {"N", "kN", 1e-3}};
  for (const auto& [unit, as, factor] : kShown)
    if (column.unit == unit)
      return fmt::format("  {} {:.4g} {}", record.parameters().name, factor * *value, as);
  return fmt::format("  {} {:.4g} {}", record.parameters().name, *value, column.unit);
}

/// Describes the last row of the history, in short.
std::string describe_row(const Run& run) {
  const History& history = run.history();
  const auto last = [&](const char* column) { return history.last(column); };
  std::string text;
  if (last("rate_K_s") || last("exchange"))
    text += fmt::format("  T {:.0f} degC ({:.0f} to {:.0f})", *last("temperature_degC"),
                        *last("temperature_min_degC"), *last("temperature_max_degC"));
  if (last("rate_K_s")) text += fmt::format("  changing by {:.2g} K/s", *last("rate_K_s"));
  if (last("exchange"))
    text +=
        fmt::format("  {:.0f} cycles{}", *last("cycles"), *last("converged") > 0.0 ? "" : " (not at rest)");
  if (last("strain"))
    text += fmt::format("  strain {:.5f}  stress {:6.2f} MPa", *last("strain"), *last("stress_MPa"));
  if (last("unbalanced_ratio")) {
    for (const Record& record : run.simulation().records())
      text += describe_record(record, last(column_of(record.parameters()).name.c_str()));
    text += fmt::format("  broken: {}", broken(history));
    text += fmt::format("  unbalanced {:.1e}", *last("unbalanced_ratio"));
  }
  return text;
}

std::int64_t steps_so_far(const Run& run) {
  return run.simulation().moves() ? run.simulation().motion().steps() : 0;
}

/// Returns the steps of the stages after the one at hand, as `check` forecasts them; none where such a stage
/// has work that is not counted in steps.
std::optional<double> steps_after(const Session& session) {
  const auto& run = session.run();
  const auto forecasts = forecast({run.stages().begin() + run.stage_number(), run.stages().end()},
                                  run.simulation(), session.opened().setup.temperatures.upper);
  double steps = 0.0;
  for (std::size_t i = 1; i < forecasts.size(); ++i) {
    if (forecasts[i].heating_duration > 0.0 && forecasts[i].steps <= 0.0) return std::nullopt;
    steps += forecasts[i].steps;
  }
  return steps;
}

std::string progress_line(const Run& run, const Progress& progress) {
  const double done = run.progress();
  return fmt::format("stage {} of {} ({}) {:3.0f} %, {:>14}{}", run.stage_number() + 1, run.stages().size(),
                     run.stage().kind(), 100.0 * done, progress.left(done, steps_so_far(run)),
                     describe_row(run));
}

/// Describes a run that has not come to a look for a while.
std::string doing_line(const Run& run) {
  std::string text =
      fmt::format("stage {} of {} ({})", run.stage_number() + 1, run.stages().size(), run.stage().kind());
  if (const std::string doing = run.stage().doing(); !doing.empty()) text += " " + doing;
  if (run.simulation().moves()) text += fmt::format(", step {}", run.simulation().motion().steps());
  return text;
}

/// Says how far the strength of one specimen can be trusted; empty where the run measured none, or another
/// specimen's scatter is not known.
std::string describe_scatter(const Summary& s, const specimen::SpecimenParameters& specimen) {
  const auto has_strength = [](const ReportedStage& stage) {
    return std::ranges::any_of(stage.report.results, [](const Result& result) {
      return result.name == kStrength.name && std::holds_alternative<double>(result.value);
    });
  };
  const auto like = studied_like(specimen);
  if (!like || std::ranges::none_of(s.stages, has_strength)) return "";
  return fmt::format(
      "one specimen    f_c scatters by {:.0f} % from seed to seed with such blocks; `pyroclast run DECK "
      "--seeds 5` "
      "tells the mean\n",
      100.0 * like->scatter);
}

std::string describe(const Summary& s, const specimen::SpecimenParameters& specimen,
                     const std::filesystem::path& folder) {
  std::string text =
      fmt::format("\nended           {}, after {}\n", describe(s.outcome), duration(s.wall_time));
  for (std::size_t i = 0; i < s.stages.size(); ++i) {
    const auto& [kind, outcome, report, is_sound] = s.stages[i];
    const std::string label = fmt::format("stage {}", i + 1);
    text += fmt::format("{:<16}{}: {}\n", label, kind, describe(outcome));
    for (const auto& line : report.lines) text += fmt::format("{:<16}{}\n", "", line);
    text += describe_warnings(report.warnings);
  }
  if (s.soundness.energy_error)
    text += fmt::format("energy ledger   closes within {:.3f} % of the energy turned over{}\n",
                        100.0 * std::abs(*s.soundness.energy_error),
                        s.soundness.error_over_dissipated
                            ? fmt::format(", {:.2g} % of the energy that contacts dissipated",
                                          100.0 * std::abs(*s.soundness.error_over_dissipated))
                            : "");
  if (s.soundness.heat_error)
    text +=
        fmt::format("heat ledger     closes within {:.1e} of its largest term\n", *s.soundness.heat_error);
  return text + describe_scatter(s, specimen) + describe_warnings(s.warnings) +
         fmt::format("results         {}", folder.string());
}

int exit_code(const Summary& summary) {
  if (summary.outcome == Outcome::stopped) return kInterrupted;
  return is_good(summary.outcome) && summary.is_sound() ? 0 : 2;
}

/// Returns the result of `act`. An Error of it stands in the log too: who watches the run then knows its end.
template <class Act>
auto noting_errors(RunLog& log, Act act) {
  try {
    return act();
  } catch (const Error& error) {
    log.note(fmt::format("error: {}", error.what()));
    throw;
  }
}

}  // namespace

std::string describe_start(Session& session) {
  const Simulation& simulation = session.simulation();
  const DeckOfRun& opened = session.opened();
  std::string text = describe_warnings(opened.warnings) + describe_unused(opened.setup) +
                     describe_own_laws() +
                     (simulation.told() ? simulation.told()->text : describe(*simulation.specimen())) +
                     describe_warnings(simulation.warnings_of_specimen());
  text += fmt::format("model           {} zones, {} contacts\n", simulation.model().whole_zone_count(),
                      count_of(Item::contact, simulation.model()));
  if (const auto* conduction = simulation.field().conduction())
    text += describe(*conduction, simulation.model(), opened.setup.temperatures);
  if (may_leave_range(opened.setup, simulation))
    if (const auto told = foretell_heat(opened.setup, simulation))
      if (const std::string warning = warning_of(*told, opened.setup); !warning.empty())
        text += describe_warnings({warning});
  if (simulation.moves())
    text += fmt::format("mechanics       time step {:.3g} s, moving mass {:.3g} x the real one\n",
                        simulation.motion().time_step(), simulation.motion().mass_ratio());
  return text + fmt::format("processor       {}{}, {} instructions\n", describe(simulation.ranks()),
                            describe(*opened.team), name(opened.instructions));
}

int run_to_end(Session& session, RunLog& log, const RunOptions& options) {
  const Interrupt interrupt;
  const Run& run = session.run();
  Ranks& ranks = run.simulation().ranks();
  const std::filesystem::path& folder = session.folder();
  std::optional<Watcher> watcher;
  if (options.watch && ranks.is_first()) watcher.emplace(folder, log);
  session.log_bytes_by([&] { return log.bytes(); });
  session.stop_when([&] { return interrupt.asked(); });
  Progress progress(steps_so_far(run));
  progress.begin_stage(steps_after(session));
  session.between_batches([&] {
    if (watcher) watcher->look_after();
    if (progress.is_long_silent()) log.say_now(doing_line(run));
  });
  int stage = run.stage_number();
  const auto to_the_end = [&] {
    while (session.next()) {
      if (run.stage_number() != stage) progress.begin_stage(steps_after(session));
      stage = run.stage_number();
      if (progress.line_is_due() || log.speech() == Speech::verbose)
        log.say_now(progress_line(run, progress));
    }
    return session.finish();
  };
  const Summary summary = noting_errors(log, to_the_end);
  if (!ranks.is_first()) return exit_code(summary);
  if (watcher) watcher->see_out([&] { return interrupt.asked_twice(); });
  log.say(describe(summary, session.opened().setup.specimen, folder));
  if (summary.outcome == Outcome::stopped)
    log.say(fmt::format("to go on        pyroclast resume {}", shell_path(folder)));
  if (options.figures) {
    log.say(fmt::format("figures         drawn in {} ...", (folder / "figures").string()));
    draw_figures("run", folder, log.speech(), [&] { return interrupt.asked_twice(); });
  }
  if (options.figures && options.page)
    make_page(folder, log.speech(), [&] { return interrupt.asked_twice(); });
  return exit_code(summary);
}

namespace {

int run_from_start(const RunOptions& options) {
  const std::filesystem::path folder = output_folder(options);
  const auto session =
      Session::begin(open_deck(options), RunOutput{folder, options.overwrite, options.command});
  print_kept(folder, session->foreign());
  RunLog log(file_in(session->folder(), "run.log"), options.speech);
  log.say(describe_start(*session));
  return run_to_end(*session, log, options);
}

}  // namespace

int run_on_ranks(RunOptions& options, const std::function<int()>& act) {
  return on_ranks([&](const RanksOfRun& given) {
    options.held_by = given.ranks;
    if (options.threads == 0) options.threads = given.threads;
    if (!given.ranks->is_first()) options.speech = Speech::quiet;
    return act();
  });
}

Command add_run(CLI::App& cli) {
  const auto options = std::make_shared<RunOptions>();
  auto* run = cli.add_subcommand("run", "Run a deck");
  add_deck(run, options->deck);
  add_own_laws(run, options->laws);
  add_seed(run, options->seed);
  add_changes(run, *options);
  add_output(run, *options);
  run->add_option("--body", options->body,
                  "Take the body that `pyroclast specimen` wrote into this folder, and make none");
  add_page(run, *options);
  add_processor(run, *options);
  add_checkpoint(run, *options);
  add_speech(run, *options);
  add_watching(run, *options);
  auto* const mpi = add_mpi(run, *options);
  run->add_option("--seeds", options->seeds,
                  "Run this many specimens, from seed 1 or --seed on: print each result with its mean and 95 "
                  "% interval, "
                  "the curves "
                  "with their band, and the pictures of the median specimen")
      ->check(whole_number(1, 100000))
      ->excludes(mpi);
  run->add_flag("--dry-run", options->dry_run,
                "Tell the time, memory and disk of the run, as `check` does, and with --seeds those of all "
                "specimens; run nothing")
      ->excludes(mpi);
  run->add_flag_callback(
      "--no-fields", [options] { options->changes.emplace_back("output.fields=false"); },
      "Write no fields, as [output] fields = false; then figures show the history only");
  return {run,
          [options](const std::vector<std::string>& typed) {
            options->command = shell_command(typed);
            if (options->mpi) return run_on_ranks(*options, [&] { return run_from_start(*options); });
            if (options->seeds > 1) scatter(*options);
            if (options->dry_run) return printed(check(*options));
            require_one_copy("say --mpi, and they hold parts of one body");
            return run_from_start(*options);
          },
          false};
}

}  // namespace pyroclast::app
