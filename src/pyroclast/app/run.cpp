#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "pyroclast/app/conduct.hpp"
#include "pyroclast/app/interrupt.hpp"
#include "pyroclast/app/load.hpp"
#include "pyroclast/app/progress.hpp"
#include "pyroclast/experiment/experiment.hpp"
#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/results/specimen_files.hpp"
#include "pyroclast/results/summary.hpp"

namespace pyroclast::app {

namespace {

/// Writes results as they come and shows the progress.
class Recorder : public Observer {
 public:
  explicit Recorder(const std::filesystem::path& folder, const Model<2>& model)
      : history_(folder / "history.csv"), fields_(folder / "fields", model) {}

  void sample(const Experiment& experiment, const Sample& s) override {
    history_.write(s);
    if (s.stage != stage_) {
      stage_ = s.stage;
      progress_.begin_stage();
    }
    if (!progress_.line_is_due()) return;
    const double done = experiment.progress();
    const std::string heat = s.heat.exchange > 0
                                 ? fmt::format("  T {:.0f} degC, {} cycles{}", s.heat.mean, s.heat.cycles,
                                               s.heat.converged ? "" : " (not at rest)")
                                 : "";
    spdlog::info(
        "stage {} of {} {:3.0f} %, {:>14}{}  strain {:.5f}  stress {:6.2f} MPa  broken: tension {}, shear {} "
        " "
        "unbalanced {:.1e}  kinetic/strain {:.1e}",
        s.stage + 1, experiment.stages().size(), 100.0 * done, progress_.left(done), heat, s.strain,
        s.stress() * 1e-6, s.cracks.broken_tension(), s.cracks.broken_shear(), s.unbalanced_ratio,
        s.kinetic_over_strain);
  }

  void frame(const Experiment& experiment, const Sample& s) override { fields_.write(experiment, s); }

  bool stop_requested() override { return Interrupt::asked(); }

 private:
  HistoryFile history_;
  FieldFiles fields_;
  Progress progress_;
  int stage_ = 0;
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
  RunFolder::check(output_folder(options), options.overwrite);
  if (loaded.c.conduct) return run_conduction(loaded, options);

  Simulation simulation(loaded.c);
  auto& mechanics = *simulation.mechanics;
  fmt::print("{}", describe(simulation.specimen));
  fmt::print(
      "model           {} zones, {} contacts, time step {:.3g} s, moving mass {:.3g} x the real one\n"
      "processor       {} threads, {} instructions\n\n",
      simulation.body.model.zone_count(), simulation.body.model.contact_count(), mechanics.time_step(),
      mechanics.mass_ratio(), loaded.threads, name(mechanics.instructions()));

  const RunFolder folder = make_run_folder(loaded, options);
  write_specimen_files(folder.path() / "specimen", simulation.specimen, loaded.c.specimen.aggregates);
  Recorder recorder(folder.path(), simulation.body.model);

  spdlog::set_pattern("%H:%M:%S %v");
  const auto start = Clock::now();
  Experiment experiment(simulation, loaded.c.stages, loaded.c.sampling, recorder);
  const Outcome outcome = [&] {
    const Interrupt interrupt;
    return experiment.run();
  }();

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
