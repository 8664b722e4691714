#include "pyroclast/session/rehearsal.hpp"

#include <algorithm>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include "pyroclast/base/error.hpp"
#include "pyroclast/simulation/loop/run.hpp"
#include "pyroclast/simulation/watching/fields.hpp"
#include "pyroclast/thermal/time_stages.hpp"

namespace pyroclast {

namespace {

constexpr int kWarmUpSteps = 10, kMostTimedSteps = 2000;
constexpr double kSecondsOfTiming = 0.5;
/// Rows of the history that take about as long as a frame, which computes and writes every contact.
constexpr double kRowsPerFrame = 4.0;
/// Bytes of a cell of history.csv: of runs of conduct, compress and expose 11 to 13.
constexpr double kBytesPerCell = 12.0;
/// Bytes that a row of the history adds to temperature_profile.csv: 2,500 of about every second row.
constexpr double kBytesPerProfile = 1250.0;
/// Share of the largest change of a temperature at which the heat solver's steps aim, see Conduction.
constexpr double kAimedChange = 0.8;

/// Returns the processor time that this thread has used, s. On a loaded machine the forecast is that of free
/// cores: other work comes and goes.
double seconds_of_thread() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Action>
double seconds_of(Action action) {
  const double start = seconds_of_thread();
  action();
  return seconds_of_thread() - start;
}

/// Returns the processor time of a step, s, of many steps in one go, as a run takes them: the last step of a
/// batch costs more, because it is measured.
double seconds_per_step(Motion& motion) {
  const auto time = [&](int steps) { return seconds_of([&] { motion.advance(steps); }) / steps; };
  const double steps = kSecondsOfTiming / time(kWarmUpSteps);
  return time(static_cast<int>(std::clamp<double>(steps, kWarmUpSteps, kMostTimedSteps)));
}

double seconds_per_exchange(Simulation& simulation) {
  return seconds_of([&] { simulation.hand_over(); });
}

/// Returns the evaluations of the heat solver. While temperatures change fast they bound its steps, later the
/// longest step does.
/// \param rise  change of temperature that boundaries may bring about, K
double expected_evaluations(const HeatConditions& heat, double stable_step, double rise, double duration) {
  const double steps = rise / (kAimedChange * heat.largest_change) + duration / heat.largest_step;
  return steps * fewest_stages(heat.scheme, std::max(1.0, duration / steps / stable_step));
}

/// Returns the processor time of an evaluation, s, by those that the solver does in a moment. Heats the
/// field, which may leave the range of its temperatures.
double seconds_per_evaluation(TemperatureField& field, double duration, double largest_change) {
  const double start = seconds_of_thread();
  const std::int64_t before = field.conduction()->work().stages;
  try {
    while (field.time() < duration && seconds_of_thread() - start < kSecondsOfTiming)
      field.advance(largest_change, duration);
  } catch (const Error&) {  // foretell_heat tells it
    field.end_advance();
  }
  return (seconds_of_thread() - start) / static_cast<double>(field.conduction()->work().stages - before);
}

/// Returns the processor time in which water flows for a duration, s, by that of the time to which the field
/// was heated.
double seconds_of_water(Simulation& simulation, double duration) {
  const std::int64_t before = simulation.moisture()->water().state().steps;
  const double seconds = seconds_of([&] { simulation.follow_heat(); });
  const auto steps = static_cast<double>(simulation.moisture()->water().state().steps - before);
  return steps > 0.0 ? seconds / steps * duration / simulation.heat().moisture->parameters.largest_step : 0.0;
}

/// Returns the size of the arrays of a frame, bytes.
double frame_bytes(const Simulation& simulation) {
  constexpr int kInFiles = 3;  // files have all components of a vector, whatever the dimension
  double numbers = 0.0;
  for (const Field& field : fields_of(simulation))
    if (field.in_files)
      numbers +=
          static_cast<double>(count_of(field.item, simulation.model())) * components_of(field.kind, kInFiles);
  return numbers * sizeof(float);
}

/// Finds out what the forecast costs. Moves and heats the simulation.
/// \param hottest  highest temperature to which the run may come, °C
Rehearsal cost_of(const Forecast& forecast, double hottest, Simulation& simulation, Run& run) {
  Rehearsal cost{forecast};
  double& seconds = cost.seconds;
  cost.history_bytes = kBytesPerCell * static_cast<double>(run.history().columns().size()) * forecast.looks;
  if (!simulation.field().is_uniform()) cost.history_bytes += kBytesPerProfile * forecast.looks;
  if (simulation.moves()) seconds += forecast.steps * seconds_per_step(simulation.motion());
  const double row = seconds_of([&] { run.next(); });
  seconds += (forecast.looks + kRowsPerFrame * forecast.frames) * row;
  if (forecast.exchanges > 0.0) seconds += forecast.exchanges * seconds_per_exchange(simulation);
  if (forecast.heating_duration > 0.0) {
    TemperatureField& field = simulation.field();
    const HeatConditions& heat = simulation.heat();
    field.begin_exposure(temperature_range(heat, forecast.heating_duration));
    // each row ends a step of the heat solver
    cost.heat_evaluations =
        forecast.looks + expected_evaluations(heat, field.conduction()->step_limit().step,
                                              hottest - field.mean(), forecast.heating_duration);
    seconds +=
        cost.heat_evaluations * seconds_per_evaluation(field, forecast.heating_duration, heat.largest_change);
    if (simulation.moisture()) seconds += seconds_of_water(simulation, forecast.heating_duration);
  }
  return cost;
}

}  // namespace

std::vector<Forecast> forecast(std::span<const std::unique_ptr<Stage>> stages, const Simulation& simulation,
                               double hottest) {
  Foreseen foreseen{simulation.field().mean(), hottest};
  std::vector<Forecast> found;
  for (const auto& stage : stages) found.push_back(stage->forecast(simulation, foreseen));
  return found;
}

Rehearsal rehearse(Setup setup, Simulation& simulation) {
  Forecast expected;
  for (const Forecast& of_stage : forecast(setup.stages, simulation, setup.temperatures.upper))
    expected += of_stage;
  const double field_bytes = setup.has_fields ? expected.frames * frame_bytes(simulation) : 0.0;
  Run run(simulation, std::move(setup.stages));
  Rehearsal cost = cost_of(expected, setup.temperatures.upper, simulation, run);
  cost.field_bytes = field_bytes;
  return cost;
}

}  // namespace pyroclast
