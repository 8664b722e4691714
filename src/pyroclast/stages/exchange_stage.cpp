#include "pyroclast/stages/exchange_stage.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/stages/known_results.hpp"
#include "pyroclast/stages/water_results.hpp"

namespace pyroclast {

namespace {

/// Results of the exchanges of a stage.
struct ExchangeResponse {
  std::optional<double> critical_temperature;  ///< mean over the specimen when the platen ran away, °C
  double critical_time = 0.0;                  ///< heating time when it ran away, s
  double highest = absolute_zero;              ///< temperature reached anywhere, °C
  double last_mean = 0.0;                      ///< mean at the last exchange, °C
  std::int64_t exchanges = 0;
  std::int64_t not_converged = 0;  ///< exchanges after which the body did not come to rest
  double worst_ratio = 0.0;        ///< largest unbalanced ratio left by an exchange before any failure
  double cycles = 0.0;             ///< steps of all exchanges
  double largest_thrust = 0.0;     ///< largest stress on the platens, MPa, compression positive
};

ExchangeResponse exchange_response(const History& history, RowRange rows, Outcome outcome) {
  const auto column = [&](const char* name) { return history.values(name, rows); };
  const auto mean = column("temperature_degC"), hottest = column("temperature_max_degC"),
             time = column("heating_time_s"), cycles = column("cycles"), converged = column("converged"),
             ratio = column("unbalanced_ratio"),
             stress = history.has("stress_MPa") ? column("stress_MPa") : std::vector<double>(mean.size());
  ExchangeResponse r;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    ++r.exchanges;
    r.cycles += cycles[i];
    r.last_mean = mean[i];
    r.highest = std::max(r.highest, hottest[i]);
    r.largest_thrust = std::max(r.largest_thrust, stress[i]);
    if (outcome == Outcome::ran_away && i + 1 == mean.size()) {
      r.critical_temperature = mean[i];
      r.critical_time = time[i];
    } else {
      r.not_converged += converged[i] > 0.0 ? 0 : 1;
      r.worst_ratio = std::max(r.worst_ratio, ratio[i]);
    }
  }
  return r;
}

/// Returns what the answer whether a specimen fails holds for.
std::string conditions_of_answer(int dimension, bool spalls) {
  return fmt::format("of this one specimen of plain concrete{}: no steel, {}no member",
                     dimension == 2 ? " in plane stress" : "", spalls ? "" : "no spalling, ");
}

/// Returns what has left the body by the end of the rows.
std::string line_of_spalls(const History& history, RowRange rows) {
  const auto last = [&](const char* column) { return history.values(column, rows).back(); };
  const std::vector<double> pieces = history.values("spalled_pieces", rows);
  if (pieces.back() == 0.0) return "no piece left the body";
  const auto first = std::ranges::find_if(pieces, [](double count) { return count > 0.0; });
  return fmt::format(
      "{:.0f} pieces left the body, from {:.3g} min on: {:.3g} kg, {:.2g} mm in the mean, {:.2g} mm at most",
      pieces.back(), history.values("heating_time_s", rows)[first - pieces.begin()] / 60.0,
      last("spalled_mass_kg"), last("spalled_depth_mean_m") * 1e3, last("spalled_depth_max_m") * 1e3);
}

/// Returns why a stage in which nothing failed has no critical temperature.
std::string why_no_failure(bool bears_load, const ExchangeResponse& r) {
  if (!bears_load) return "no load by a platen was held";
  return fmt::format("the specimen bore its load up to {:.0f} degC in the mean", r.last_mean);
}

PlatenControl read_platen(const Section& s) {
  return s.choice<PlatenControl>(
      "platen",
      {{"force", PlatenControl::force, "its force stays; none but its weight if no load was applied"},
       {"fixed", PlatenControl::fixed, "its height stays"}},
      "motion of the upper platen");
}

}  // namespace

Coupling read_coupling(const Section& s, const Coupling* general) {
  const auto or_general = [&](auto read, auto Coupling::*key) {
    return general ? read(general->*key) : read();
  };
  const auto quantity = [&](const char* key, const Unit& unit, const Range& range, double Coupling::*value,
                            Meaning meaning) {
    return or_general([&](auto... fallback) { return s.quantity(key, unit, range, fallback..., meaning); },
                      value);
  };
  const auto number = [&](const char* key, const Range& range, double Coupling::*value, Meaning meaning) {
    return or_general([&](auto... fallback) { return s.number(key, range, fallback..., meaning); }, value);
  };
  const auto integer = [&](const char* key, double least, std::int64_t Coupling::*value, Meaning meaning) {
    return or_general(
        [&](auto... fallback) {
          return s.integer(key, Range::between(least, 1e12), static_cast<long long>(fallback)..., meaning);
        },
        value);
  };
  Coupling c;
  c.increment =
      quantity("exchange_increment", unit::temperature_difference, Range::positive().usually(0.1, 50.0),
               &Coupling::increment, "change of temperature between two exchanges, of the fastest gridpoint");
  c.unbalanced_ratio =
      number("unbalanced_ratio", Range::positive().usually(1e-8, 0.01), &Coupling::unbalanced_ratio,
             "rest, 1: unbalanced over applied forces are below this");
  c.platen_difference =
      quantity("platen_difference", unit::stress, Range::positive().usually(1e2, 1e6),
               &Coupling::platen_difference, "rest, 2: the stresses on the two platens differ by less");
  c.least_cycles = integer("least_cycles", 0, &Coupling::least_cycles, "rest, 3: not before so many steps");
  c.most_cycles = integer(
      "most_cycles", 1, &Coupling::most_cycles,
      "an exchange that did not come to rest within so many steps is flagged, and the next one follows");
  if (s.ok() && c.most_cycles < c.least_cycles) s.error("most_cycles", "must not be less than least_cycles");
  c.predictor =
      s.flag("predictor", general ? general->predictor : false,
             "whether an exchange first moves the body to the resting place that the last one foretells; "
             "stages of kind heat only");
  c.failure_strain =
      number("failure_strain", Range::inside(0.0, 1.0).usually(5e-4, 0.05), &Coupling::failure_strain,
             "the specimen has failed when its ends approach by this at one temperature");
  return c;
}

ExchangeStage::Keys read_exchange(const Section& own, const StageTables& tables) {
  ExchangeStage::Keys keys{tables.coupling, tables.output.frame_temperature, tables.dimension};
  if (const auto other = own.optional_section("coupling", "in the place of [coupling], for this stage"))
    keys.coupling = tables.coupling_table
                        ? read_coupling(other->with_defaults_of("coupling"), &tables.coupling)
                        : read_coupling(*other);
  else if (!tables.coupling_table)
    own.error("kind", "a stage that changes temperatures needs the table [coupling]");
  if (tables.has_platens)
    keys.coupling.platen = read_platen(own);
  else
    own.know({"platen"});
  if (keys.coupling.predictor && !tables.has_platens)
    own.error("kind",
              "coupling.predictor needs the table [platens]: a predictor moves a body between platens");
  return keys;
}

void ExchangeStage::begin(Simulation& simulation) {
  kept_.has_press = simulation.has_press();
  kept_.load_stress = kept_.has_press ? simulation.press().stress_held() : 0.0;
  kept_.first_temperature = simulation.field().mean();
  begin_change(simulation);
  exchange_.begin(simulation);
  kept_.last_interval = interval_of(simulation.field().mean());
}

void ExchangeStage::read(const Simulation& simulation) {
  if (kept_.is_settling)
    exchange_.read_start(simulation);
  else
    read_before_change(simulation);
}

bool ExchangeStage::advance(Simulation& simulation, int most_steps) {
  if (!kept_.is_settling) {
    kept_.is_settling = change(simulation, exchange_, most_steps);
    return false;
  }
  if (!exchange_.advance(simulation, most_steps)) return false;
  kept_.is_settling = false;
  return true;
}

Verdict ExchangeStage::judge(Simulation& simulation) {
  if (exchange_.ran_away()) return {.over = true, .last = true, .outcome = Outcome::ran_away};
  if (progress(simulation) >= 1.0) return {.over = true};
  const double interval = interval_of(simulation.field().mean());
  const bool is_new = interval != kept_.last_interval;
  kept_.last_interval = interval;
  const bool came = frame_time_came(simulation);
  return {.frame = frames_in_time() ? came : is_new};
}

/// Returns the number of the even interval between frames in which a temperature lies.
double ExchangeStage::interval_of(double temperature) const {
  return std::floor((temperature + kSameTemperature) / keys_.frame_temperature);
}

StageReport ExchangeStage::report(const History& history, RowRange rows, Outcome outcome) const {
  StageReport report;
  const ExchangeResponse r = exchange_response(history, rows, outcome);
  const bool has_rows = !rows.empty(), failed = r.critical_temperature.has_value();
  const bool bears_load =
      kept_.has_press && coupling().platen == PlatenControl::force && kept_.load_stress > 0.0;
  const bool spalls = history.has("spalled_pieces");
  const Result::Value why_none = failed ? Result::Value() : Result::Value(why_no_failure(bears_load, r));
  report.results = {
      {known::field, needs().field == FieldChoice::uniform ? "uniform" : "conduction"},
      {known::platen, kept_.has_press ? Result::Value(name(coupling().platen)) : Result::Value()},
      {known::load_stress, value_if(kept_.has_press, kept_.load_stress * 1e-6)},
      {known::critical_temperature, value_if(failed, r.critical_temperature.value_or(0.0))},
      reason_of(known::critical_temperature, why_none),
      {known::critical_time, value_if(failed, r.critical_time)},
      reason_of(known::critical_time, why_none),
      {known::answer_is,
       failed || bears_load ? Result::Value(conditions_of_answer(keys_.dimension, spalls)) : Result::Value()},
      {known::highest_temperature, value_if(has_rows, r.highest)},
      {known::largest_increment, coupling().increment},
      {known::exchanges, r.exchanges},
      {known::exchanges_not_converged, r.not_converged},
      {known::worst_unbalanced_ratio, value_if(has_rows, r.worst_ratio)},
      {known::cycles, static_cast<std::int64_t>(r.cycles)},
      {known::largest_thrust, value_if(has_rows && kept_.has_press, r.largest_thrust)},
  };
  if (!has_rows) return report;
  const std::string conditions = conditions_of_answer(keys_.dimension, spalls);
  report.lines.push_back(fmt::format(
      "{:.0f} to {:.0f} degC{} in {} exchanges of up to {:g} K, {:.0f} cycles; {} did not come to rest",
      kept_.first_temperature, r.last_mean,
      r.highest > std::max(kept_.first_temperature, r.last_mean) + 1.0
          ? fmt::format(" in the mean, {:.0f} degC where it is hottest,", r.highest)
          : "",
      r.exchanges, coupling().increment, r.cycles, r.not_converged));
  if (spalls) report.lines.push_back(line_of_spalls(history, rows));
  const std::string load = bears_load ? fmt::format("load {:.2f} MPa: ", kept_.load_stress * 1e-6) : "";
  if (failed)
    report.lines.push_back(fmt::format("{}critical temperature {:.0f} degC, after {:.3g} min of heating, {}",
                                       load, *r.critical_temperature, r.critical_time / 60.0, conditions));
  else if (kept_.has_press && coupling().platen == PlatenControl::fixed)
    report.lines.push_back(fmt::format("thrust up to {:.2f} MPa", r.largest_thrust));
  else if (bears_load)
    report.lines.push_back(fmt::format("{}no failure {}; strain {:.4f} at the end, compression positive",
                                       load, conditions, history.values("strain", rows).back()));
  else
    report.lines.push_back("no load by a platen: the run does not tell whether the specimen fails under one");
  tell_water(history, rows, report);
  if (r.not_converged > 0)
    report.warnings.push_back(
        fmt::format("{} of {} exchanges of temperature did not come to rest within the stated cycles{} "
                    "(worst unbalanced ratio {:.1e}); history.csv flags them",
                    r.not_converged, r.exchanges,
                    history.has("energy_pore_pressure_J") ? ", or ended as pore water widened a crack" : "",
                    r.worst_ratio));
  return report;
}

Forecast ExchangeStage::forecast(const Simulation&, Foreseen& foreseen) const {
  const double from = foreseen.temperature;
  const double exchanges = whole_above(foreseen_change(foreseen) / coupling().increment);
  return {
      .steps = exchanges * exchange_.expected_cycles(),
      .looks = exchanges,
      .frames =
          frames_in_time().value_or(std::abs(foreseen.temperature - from) / keys_.frame_temperature) + 1.0,
      .exchanges = exchanges,
      .heating_duration = needs().field == FieldChoice::computed ? heating().duration : 0.0};
}

void ExchangeStage::visit_state(StateVisitor& visitor) {
  auto& [is_settling, has_press, load_stress, first_temperature, last_interval] =
      kept_;  // another member does not compile until it has a name here
  visitor.visit("is_settling", is_settling);
  visitor.visit("has_press", has_press);
  visitor.visit("load_stress", load_stress);
  visitor.visit("first_temperature", first_temperature);
  visitor.visit("last_interval", last_interval);
  exchange_.visit_state(visitor);
  visit_change(visitor);
}

}  // namespace pyroclast
