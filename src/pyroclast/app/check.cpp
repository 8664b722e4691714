#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <sys/resource.h>

#include "pyroclast/app/conduct.hpp"
#include "pyroclast/app/load.hpp"
#include "pyroclast/app/progress.hpp"
#include "pyroclast/experiment/simulation.hpp"

namespace pyroclast::app {

namespace {

constexpr int kWarmUpSteps = 10, kMostTimedSteps = 2000;
constexpr double kSecondsOfTiming = 0.5;

/// Timed over many steps in one go, as a run takes them: the last of a batch costs more, for it is measured.
double seconds_per_step(Mechanics<2>& mechanics) {
  const auto time = [&](int steps) {
    const auto start = Clock::now();
    mechanics.advance(steps);
    return seconds_since(start) / steps;
  };
  const double steps = kSecondsOfTiming / time(kWarmUpSteps);
  return time(static_cast<int>(std::clamp<double>(steps, kWarmUpSteps, kMostTimedSteps)));
}

double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

/// Steps that a stage takes at most; settling and the rest after a load are not known beforehand and left
/// out. A computed temperature field is counted as if it reached its whole range.
double most_steps(const Case& c, const Stage& stage, double from, double time_step) {
  if (const auto* compress = std::get_if<CompressStage>(&stage))
    return (compress->stop_strain * c.specimen.height / compress->velocity + 0.5 * compress->ramp_time) /
           time_step;
  if (const auto* load = std::get_if<LoadStage>(&stage)) return load->ramp_time / time_step;
  const auto exchanges = [](const Coupling& coupling, double change) {
    return static_cast<double>(coupling.most_cycles) * std::ceil(change / coupling.increment);
  };
  if (const auto* heat = std::get_if<HeatStage>(&stage))
    return exchanges(heat->coupling, std::abs(heat->to - from));
  if (const auto* expose = std::get_if<ExposeStage>(&stage); expose)
    return exchanges(expose->coupling, c.temperatures.upper - c.temperatures.lower);
  return 0.0;
}

double most_steps(const Case& c, double time_step) {
  double steps = 0.0, temperature = c.heat.initial;
  for (const auto& stage : c.stages) {
    steps += most_steps(c, stage, temperature, time_step);
    if (const auto* heat = std::get_if<HeatStage>(&stage)) temperature = heat->to;
  }
  return steps;
}

}  // namespace

int check(const RunOptions& options) {
  const Loaded loaded(options);
  const Case& c = loaded.c;
  if (c.conduct) return check_conduction(loaded);
  Simulation simulation(c);
  auto& mechanics = *simulation.mechanics;
  const auto& model = simulation.body.model;
  const double modulus = estimate_modulus(simulation.body, simulation.materials);

  fmt::print("deck            {} is valid: {}\n", loaded.deck.name(), c.title);
  fmt::print("{}", describe(simulation.specimen));
  fmt::print("model           {} blocks with the platens, {} zones, {} gridpoints, {} contacts\n",
             model.block_count(), model.zone_count(), model.gridpoint_count(), model.contact_count());

  const TimeStepLimit limit = mechanics.real_mass_limit();
  const int g = limit.gridpoint;
  const int block = model.block_of(g);
  fmt::print("time step       {:.3g} s, {}\n", mechanics.time_step(),
             c.mechanics.mass == MassChoice::scaled
                 ? fmt::format("by density scaling of all {} gridpoints: moving mass {:.3g} x the real one",
                               model.gridpoint_count(), mechanics.mass_ratio())
                 : "with real mass");
  fmt::print(
      "                with real mass {:.3g} s, set by gridpoint {} of block {} ({}) at ({:.2f}, {:.2f}) "
      "mm\n",
      limit.step, g, block, model.material_names[model.block_material[block]], 1e3 * model.position[g][0],
      1e3 * model.position[g][1]);
  fmt::print("materials       E about {:.2f} GPa (uniform stress estimate, a lower bound), t_b {:.3f} mm\n",
             modulus * 1e-9, 1e3 * simulation.materials.fracture_zone);

  if (const auto* conduction = simulation.field->conduction())
    fmt::print("{}", describe(*conduction, model, c.temperatures));
  const double steps = most_steps(c, mechanics.time_step());
  const double step_time = seconds_per_step(mechanics);
  fmt::print(
      "run             {} stages, at most {:.3g} steps after settling, about {} on {} threads with {} "
      "instructions, "
      "{:.0f} MB of memory\n",
      c.stages.size(), steps, duration(steps * step_time), loaded.threads, name(mechanics.instructions()),
      peak_memory() * 1e-6);
  return 0;
}

}  // namespace pyroclast::app
