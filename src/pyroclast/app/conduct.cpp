#include "pyroclast/app/conduct.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "pyroclast/app/interrupt.hpp"
#include "pyroclast/app/progress.hpp"
#include "pyroclast/experiment/simulation.hpp"
#include "pyroclast/results/field_files.hpp"
#include "pyroclast/results/heat_summary.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/results/specimen_files.hpp"

namespace pyroclast::app {

namespace {

/// Writes results as they come and shows the progress.
class HeatRecorder : public HeatObserver {
 public:
  HeatRecorder(const std::filesystem::path& folder, const Model<2>& model, const Case& c)
      : duration_(c.conduct->duration),
        history_(folder / "history.csv", model, c.probes),
        fields_(folder / "fields", model) {}

  void look(const TemperatureField& field) override {
    history_.write(field);
    if (!progress_.line_is_due()) return;
    const double done = field.time() / duration_;
    spdlog::info("{:3.0f} %, {:>14}  after {}  T {:.0f} degC, {:.0f} to {:.0f}, changing by {:.2g} K/s",
                 100.0 * done, progress_.left(done), duration(field.time()), field.mean(), field.minimum(),
                 field.maximum(), field.conduction()->rate());
  }

  void frame(const TemperatureField& field) override { fields_.write(field); }

  bool stop_requested() override { return Interrupt::asked(); }

 private:
  double duration_;
  HeatHistoryFile history_;
  HeatFieldFiles fields_;
  Progress progress_;
};

void print_result(const HeatSummary& s, const std::filesystem::path& folder) {
  fmt::print("\nended           {}, after {}\n", describe(s.outcome), duration(s.wall_time));
  fmt::print("temperature     mean {:.1f} degC, {:.1f} to {:.1f}, after {}; changing by {:.2g} K/s\n", s.mean,
             s.minimum, s.maximum, duration(s.time), s.rate);
  fmt::print(
      "heat            {:.4g} kJ stored; from convection {:.4g}, radiation {:.4g}, flux {:.4g}, prescribed "
      "temperatures {:.4g} kJ\n",
      s.heat.stored * 1e-3, s.heat.boundary.convection * 1e-3, s.heat.boundary.radiation * 1e-3,
      s.heat.boundary.flux * 1e-3, s.heat.prescribed * 1e-3);
  fmt::print("heat ledger     closes within {:.1e} of its largest term\n", s.ledger_error());
  fmt::print("solver          {} steps, {} taken back, {} evaluations\n", s.steps, s.retries, s.stages);
  for (const auto& warning : s.warnings) fmt::print("warning         {}\n", warning);
  fmt::print("results         {}\n", folder.string());
}

}  // namespace

std::string describe(const Conduction<2>& conduction, const Model<2>& model, const Interval& temperatures) {
  const HeatStepLimit limit = conduction.step_limit();
  const Vec<2>& at = model.position[conduction.nodes().gridpoint[limit.node]];
  return fmt::format(
      "heat            {} nodes, {:.0f} to {:.0f} degC; stable step {:.3g} s at first, set at ({:.2f}, "
      "{:.2f}) mm\n",
      conduction.nodes().count(), temperatures.lower, temperatures.upper, limit.step, 1e3 * at[0],
      1e3 * at[1]);
}

int run_conduction(const Loaded& loaded, const RunOptions& options) {
  const Case& c = loaded.c;
  HeatSimulation simulation(c);
  const auto& model = simulation.body.model;
  fmt::print("{}{}\n", describe(simulation.specimen),
             describe(*simulation.field->conduction(), model, c.temperatures));

  const RunFolder folder = make_run_folder(loaded, options);
  write_specimen_files(folder.path() / "specimen", simulation.specimen, c.specimen.aggregates);
  HeatRecorder recorder(folder.path(), model, c);

  spdlog::set_pattern("%H:%M:%S %v");
  const auto start = Clock::now();
  const HeatOutcome outcome = [&] {
    const Interrupt interrupt;
    return run_heat(*simulation.field, c.heat, *c.conduct, recorder);
  }();

  HeatSummary summary = summarize(c, *simulation.field, outcome);
  summary.wall_time = seconds_since(start);
  write_summary(folder.path() / "summary.json", summary);
  print_result(summary, folder.path());
  if (options.figures) draw_figures("run", folder.path());
  return outcome == HeatOutcome::interrupted ? 130 : 0;
}

int check_conduction(const Loaded& loaded) {
  const Case& c = loaded.c;
  const HeatSimulation simulation(c);
  const auto& model = simulation.body.model;
  fmt::print("deck            {} is valid: {}\n", loaded.deck.name(), c.title);
  fmt::print("{}", describe(simulation.specimen));
  fmt::print("model           {} blocks, {} zones, {} gridpoints\n", model.block_count(), model.zone_count(),
             model.gridpoint_count());
  fmt::print("{}", describe(*simulation.field->conduction(), model, c.temperatures));
  fmt::print("run             heat conduction alone for {}, {} probes, on {} threads\n",
             duration(c.conduct->duration), c.probes.size(), loaded.threads);
  return 0;
}

}  // namespace pyroclast::app
