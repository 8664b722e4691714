#include "pyroclast/session/foretold_heat.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/clock.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/simulation/contact_gaps.hpp"

namespace pyroclast {

namespace {

constexpr double kMostSeconds = 10.0;  // of wall time
constexpr double kChange = 5.0;        // of a temperature between two looks, K
/// A range that is proposed ends at a multiple of this, at least half of it above the hottest temperature, K.
constexpr double kRounding = 50.0;

/// Returns the temperatures beyond which gases and prescribed temperatures cannot take the specimen; none
/// where a flux may take it anywhere.
std::optional<Interval> bounds_of(const Setup& setup, const HeatConditions& heat) {
  HeatConditions unstated = heat;
  unstated.temperature_range.reset();
  const bool has_flux = std::ranges::any_of(heat.boundaries, [](const HeatBoundaryCondition& boundary) {
    return std::holds_alternative<HeatFlux>(boundary.condition);
  });
  if (has_flux) return std::nullopt;
  const Interval gas = temperature_range(unstated, setup.exposure);
  return Interval{std::min(gas.lower, setup.temperatures.lower),
                  std::max(gas.upper, setup.temperatures.upper)};
}

/// Returns these temperatures where the curves of the heat solver hold them; else the run's.
Interval widest_range(const Setup& setup, const HeatConditions& heat) {
  const auto wide = bounds_of(setup, heat);
  if (!wide) return setup.temperatures;
  for (const BlockMaterial& material : setup.block_materials)
    if (!material.is_of_bearing &&
        !(material.conductivity->holds(*wide) && material.specific_heat->holds(*wide)))
      return setup.temperatures;
  return *wide;
}

/// Follows the heat of a deck as far as it stays within a range, °C.
ForetoldHeat follow_heat(const Setup& setup, const Simulation& simulation, const Interval& range) {
  const HeatConditions& heat = simulation.heat();
  TemperatureField field(simulation.model(),
                         make_conduction(simulation.model(), setup.block_materials, heat, range));
  if (heat.cracks) field.set_gaps(contact_gaps(simulation.model(), heat.cracks->gaps, nullptr));
  ForetoldHeat told{
      .hottest = field.maximum(), .exposure = setup.exposure, .leaves_at = {}, .range = setup.temperatures};
  const auto start = Clock::now();
  try {
    while (field.time() < setup.exposure && !simulation.ranks().any(seconds_since(start) >= kMostSeconds)) {
      field.advance(kChange, setup.exposure);
      told.followed = field.time();
      if (field.maximum() <= told.hottest) continue;
      told.hottest = field.maximum();
      told.hottest_at = field.time();
    }
  } catch (const Error&) {  // a temperature left the range
    told.leaves_at = field.conduction()->time();
  }
  return told;
}

std::string minutes(double seconds) {
  constexpr double kTenMinutes = 600.0;
  return seconds < kTenMinutes ? fmt::format("{:.2g}", seconds / 60.0)
                               : fmt::format("{:.0f}", seconds / 60.0);
}

}  // namespace

bool may_leave_range(const Setup& setup, const Simulation& simulation) {
  if (simulation.field().is_uniform() || setup.exposure <= 0.0) return false;
  const auto bounds = bounds_of(setup, simulation.heat());
  return !bounds || !setup.temperatures.holds(*bounds, absolute_zero);
}

std::optional<ForetoldHeat> foretell_heat(const Setup& setup, const Simulation& simulation) {
  if (simulation.field().is_uniform() || setup.exposure <= 0.0) return std::nullopt;
  const Interval wide = widest_range(setup, simulation.heat());
  ForetoldHeat told = follow_heat(setup, simulation, setup.temperatures);
  if (!told.leaves_at || setup.temperatures.holds(wide, absolute_zero)) return told;
  const auto leaves_at = told.leaves_at;
  told = follow_heat(setup, simulation, wide);
  told.leaves_at = leaves_at;
  return told;
}

std::string describe(const ForetoldHeat& heat) {
  const bool is_whole = heat.followed >= heat.exposure;
  return fmt::format("the hottest place comes to {:.0f} degC after {} min{}", heat.hottest,
                     minutes(heat.hottest_at),
                     is_whole ? "" : fmt::format("; followed for {} min", minutes(heat.followed)));
}

std::string warning_of(const ForetoldHeat& heat, const Setup& setup) {
  if (!heat.leaves_at) return {};
  const Interval& range = heat.range;
  const bool is_too_hot = heat.hottest > range.upper - kChange;
  std::string text = fmt::format(
      "by heat alone a temperature leaves heat.temperature_range, {:.6g} to {:.6g} degC, at {} of {} min, "
      "and the run would be broken off there",
      range.lower, range.upper, minutes(*heat.leaves_at), minutes(heat.exposure));
  if (!is_too_hot) return text + ": state a wider range";
  const bool is_known = heat.followed >= heat.exposure;
  const Interval wanted{range.lower, kRounding * std::ceil((heat.hottest + 0.5 * kRounding) / kRounding)};
  if (is_known) text += fmt::format("; it comes to {:.0f} degC", heat.hottest);
  std::vector<std::string> cures;
  for (const ReadCurve& read : setup.curves)
    if (!read.curve.holds(wanted))
      cures.push_back(fmt::format("{} ends at {:.6g} degC ({})", read.path, read.curve.range().upper,
                                  describe_farther(read.property, wanted, builtin_curves())));
  text += is_known ? fmt::format(": end the range at {:.0f} degC", wanted.upper)
                   : std::string(": end the range higher");
  return cures.empty() ? text
                       : fmt::format("{}, with curves that reach it: {}", text, fmt::join(cures, "; "));
}

}  // namespace pyroclast
