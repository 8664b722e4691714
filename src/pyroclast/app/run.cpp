#include <cmath>
#include <cstdint>
#include <system_error>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "pyroclast/app/interrupt.hpp"
#include "pyroclast/app/load.hpp"
#include "pyroclast/app/progress.hpp"
#include "pyroclast/results/recorder.hpp"

namespace pyroclast::app {

namespace {

/// Contact points that are broken now, in any way.
std::int64_t broken(const History& history) {
  std::int64_t count = 0;
  for (const Column& column : history.columns())
    if (column.name.ends_with("_broken")) count += std::llround(*history.last(column.name));
  return count;
}

/// What a row of the history says, in short.
std::string describe_row(const History& history) {
  const auto last = [&](const char* column) { return history.last(column); };
  std::string text;
  if (last("rate_K_s") || last("exchange"))
    text += fmt::format("  T {:.0f} degC ({:.0f} to {:.0f})", *last("temperature_degC"),
                        *last("temperature_min_degC"), *last("temperature_max_degC"));
  if (last("rate_K_s")) text += fmt::format("  changing by {:.2g} K/s", *last("rate_K_s"));
  if (last("exchange"))
    text +=
        fmt::format("  {:.0f} cycles{}", *last("cycles"), *last("converged") > 0.0 ? "" : " (not at rest)");
  if (last("strain")) {
    text += fmt::format("  strain {:.5f}  stress {:6.2f} MPa", *last("strain"), *last("stress_MPa"));
    text += fmt::format("  broken: {}", broken(history));
    text += fmt::format("  unbalanced {:.1e}", *last("unbalanced_ratio"));
  }
  return text;
}

void show_progress(const Run& run, Progress& progress) {
  const double done = run.progress();
  spdlog::info("stage {} of {} ({}) {:3.0f} %, {:>14}{}", run.stage_number() + 1, run.stages().size(),
               run.stage().kind(), 100.0 * done, progress.left(done), describe_row(run.history()));
}

void print_result(const Summary& s, const std::filesystem::path& folder) {
  fmt::print("\nended           {}, after {}\n", describe(s.outcome), duration(s.wall_time));
  for (std::size_t i = 0; i < s.stages.size(); ++i) {
    const auto& [kind, outcome, report] = s.stages[i];
    const std::string label = fmt::format("stage {}", i + 1);
    fmt::print("{:<16}{}: {}\n", label, kind, describe(outcome));
    for (const auto& line : report.lines) fmt::print("{:<16}{}\n", "", line);
    for (const auto& warning : report.warnings) fmt::print("{:<16}{}\n", "warning", warning);
  }
  if (s.energy_error)
    fmt::print("energy ledger   closes within {:.3f} % of the energy turned over\n",
               100.0 * std::abs(*s.energy_error));
  if (s.heat_error) fmt::print("heat ledger     closes within {:.1e} of its largest term\n", *s.heat_error);
  for (const auto& warning : s.warnings) fmt::print("{:<16}{}\n", "warning", warning);
  fmt::print("results         {}\n", folder.string());
}

void print_start(const Simulation& simulation, const Loaded& loaded) {
  fmt::print("{}{}", describe_own_laws(), describe(simulation.specimen()));
  const Model<2>& model = simulation.model();
  fmt::print("model           {} zones, {} contacts\n", model.zone_count(), model.contact_count());
  if (const auto* conduction = simulation.field().conduction())
    fmt::print("{}", describe(*conduction, model, loaded.setup.temperatures));
  if (simulation.moves())
    fmt::print("mechanics       time step {:.3g} s, moving mass {:.3g} x the real one\n",
               simulation.mechanics().time_step(), simulation.mechanics().mass_ratio());
  fmt::print("processor       {} threads, {} instructions\n\n", loaded.team->size(),
             name(loaded.instructions));
}

int exit_code(Outcome outcome) {
  switch (outcome) {
    case Outcome::stopped:
      return 130;
    case Outcome::not_settled:
    case Outcome::unstable:
      return 2;
    default:
      return 0;
  }
}

}  // namespace

int run(const RunOptions& options) {
  Loaded loaded(options);
  RunFolder::check(output_folder(options), options.overwrite);
  const auto simulation = make_simulation(loaded.setup, loaded.team);
  print_start(*simulation, loaded);

  const RunFolder folder = make_run_folder(loaded, options);
  Run run(*simulation, std::move(loaded.setup.stages));
  Recorder recorder(folder.path(), loaded.setup, run);

  spdlog::set_pattern("%H:%M:%S %v");
  const Interrupt interrupt;
  run.stop_when([&] { return interrupt.asked(); });
  Progress progress;
  int stage = 0;
  while (run.next()) {
    recorder.record(run);
    if (run.stage_number() != stage) progress.begin_stage();
    stage = run.stage_number();
    if (progress.line_is_due()) show_progress(run, progress);
  }
  const Summary summary = recorder.finish(run);
  try {
    print_result(summary, folder.path());
  } catch (const std::system_error&) {  // the terminal may be gone; the results are not
  }
  if (options.figures) draw_figures("run", folder.path(), [&] { return interrupt.asked_twice(); });
  return exit_code(run.outcome());
}

}  // namespace pyroclast::app
