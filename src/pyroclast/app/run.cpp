#include <chrono>
#include <csignal>

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "pyroclast/app/load.hpp"
#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/results/specimen_files.hpp"
#include "pyroclast/results/summary.hpp"

namespace pyroclast::app {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

volatile std::sig_atomic_t interrupted = 0;

/// The first signal asks for a clean end; the next one has its usual effect.
void on_signal(int signal) {
  interrupted = 1;
  std::signal(signal, SIG_DFL);
}

/// Writes results as they come and shows the progress.
class Recorder : public Observer {
 public:
  explicit Recorder(const std::filesystem::path& folder, const Model<2>& model)
      : history_(folder / "history.csv"), fields_(folder / "fields", model) {}

  void sample(const Experiment& experiment, const Sample& s) override {
    history_.write(s);
    if (s.stage != stage_) {
      stage_ = s.stage;
      stage_start_ = Clock::now();
    }
    if (seconds_since(last_line_) < kSecondsBetweenLines) return;
    last_line_ = Clock::now();
    const double done = experiment.progress();
    const std::string left = done > kLeastProgressToForesee
                                 ? duration(seconds_since(stage_start_) / done * (1.0 - done)) + " left"
                                 : "";
    const std::string heat = s.heat.exchange > 0
                                 ? fmt::format("  T {:.0f} degC, {} cycles{}", s.heat.mean, s.heat.cycles,
                                               s.heat.converged ? "" : " (not at rest)")
                                 : "";
    spdlog::info(
        "stage {} of {} {:3.0f} %, {:>14}{}  strain {:.5f}  stress {:6.2f} MPa  broken: tension {}, shear {} "
        " "
        "unbalanced {:.1e}  kinetic/strain {:.1e}",
        s.stage + 1, experiment.stages().size(), 100.0 * done, left, heat, s.strain, s.stress() * 1e-6,
        s.cracks.broken_tension(), s.cracks.broken_shear(), s.unbalanced_ratio, s.kinetic_over_strain);
  }

  void frame(const Experiment& experiment, const Sample& s) override { fields_.write(experiment, s); }

  bool stop_requested() override { return interrupted != 0; }

 private:
  static constexpr double kSecondsBetweenLines = 5.0;
  static constexpr double kLeastProgressToForesee = 1e-3;

  HistoryFile history_;
  FieldFiles fields_;
  int stage_ = 0;
  Clock::time_point last_line_{}, stage_start_ = Clock::now();
};

void print_heating(const HeatingResponse& h, const std::string& expansion) {
  fmt::print(
      "heating         to {:.0f} degC in {} exchanges of up to {:g} K, {} cycles; {} did not come to rest; "
      "{} expansion\n",
      h.highest, h.exchanges, h.increment, h.cycles, h.not_converged, expansion);
  if (h.platen == PlatenControl::fixed)
    fmt::print("thrust          up to {:.2f} MPa\n", h.largest_thrust * 1e-6);
  else
    fmt::print("load            {:.2f} MPa{}: {}\n", h.load_stress * 1e-6,
               h.level ? fmt::format(", {:g} of f_c", *h.level) : "",
               h.critical_temperature
                   ? fmt::format("critical temperature {:.0f} degC", *h.critical_temperature)
                   : "no failure");
}

void print_result(const Summary& s, const std::filesystem::path& folder) {
  fmt::print("\nended           {}, after {}\n", describe(s.outcome), duration(s.wall_time));
  if (s.compression)
    fmt::print("result          E {:.2f} GPa, f_c {:.2f} MPa at strain {:.5f}, eps_ic {:.5f}\n",
               s.compression->modulus * 1e-9, s.compression->strength * 1e-6, s.compression->strain_at_peak,
               s.compression->inelastic_strain);
  if (s.heating) print_heating(*s.heating, s.expansion_reading);
  fmt::print("energy ledger   closes within {:.3f} % of the energy turned over\n",
             100.0 * std::abs(s.last.energy.error() / s.last.energy.turnover()));
  if (s.compression)
    fmt::print("motion          {} up to the peak\n",
               s.quasi_static.to_peak ? "quasi-static" : "NOT quasi-static");
  for (const auto& warning : s.warnings) fmt::print("warning         {}\n", warning);
  fmt::print("results         {}\n", folder.string());
}

}  // namespace

int run(const RunOptions& options) {
  const Loaded loaded(options);
  const auto out = output_folder(options);
  RunFolder::check(out, options.overwrite);

  Simulation simulation(loaded.c);
  auto& mechanics = *simulation.mechanics;
  fmt::print("{}", describe(simulation.specimen));
  fmt::print(
      "model           {} zones, {} contacts, time step {:.3g} s, moving mass {:.3g} x the real one, {} "
      "threads\n\n",
      simulation.body.model.zone_count(), simulation.body.model.contact_count(), mechanics.time_step(),
      mechanics.mass_ratio(), loaded.threads);

  const RunFolder folder(
      out, options.overwrite,
      {loaded.deck.name(), loaded.deck.text(), loaded.c.specimen.seed, loaded.threads, options.command});
  write_specimen_files(folder.path() / "specimen", simulation.specimen, loaded.c.specimen.aggregates);
  Recorder recorder(folder.path(), simulation.body.model);

  spdlog::set_pattern("%H:%M:%S %v");
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  const auto start = Clock::now();
  Experiment experiment(simulation, loaded.c.stages, loaded.c.sampling, recorder);
  const Outcome outcome = experiment.run();
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);

  Summary summary = summarize(loaded.c, experiment, outcome);
  summary.wall_time = seconds_since(start);
  summary.estimated_modulus = estimate_modulus(simulation.body, simulation.materials);
  summary.fracture_zone = simulation.materials.fracture_zone;
  write_summary(folder.path() / "summary.json", summary, simulation.specimen);
  print_result(summary, folder.path());
  if (options.figures) draw_figures("run", folder.path());
  switch (outcome) {
    case Outcome::interrupted:
      return 130;
    case Outcome::not_settled:
    case Outcome::unstable:
      return 2;
    default:
      return 0;
  }
}

}  // namespace pyroclast::app
