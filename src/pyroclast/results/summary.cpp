#include "pyroclast/results/summary.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/mechanics/cracks.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/simulation/gauges.hpp"

namespace pyroclast {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// Jump over the edge on which it stands from which small and finite kinematics differ
/// (docs/validation/jumps.md).
constexpr double kLargeJump = 1.0;
/// Largest error of the energy ledger in a sound run, over the energy turned over.
constexpr double kEnergyTolerance = 0.005;
/// Largest error of the energy ledger in a sound run, over the energy that contacts dissipated, which may be
/// little of the energy turned over: measured in docs/understand/theory.md.
constexpr double kDissipationTolerance = 0.01;
/// Share of the energy turned over below which an error is no more than rounding, whatever it is compared
/// with.
constexpr double kRounding = 1e-6;
/// Largest stress that an exchange of temperatures may bring at once, over the tensile strength: measured in
/// docs/understand/theory.md.
constexpr double kExchangeStress = 1.0;
/// Error of the energy ledger, over the energy turned over, above which a run has no results: energy came
/// from nowhere, or a body flew off.
constexpr double kEnergyNonsense = 0.05;
/// Largest error of the heat ledger over its largest term. Heat is conserved to rounding, which adds up over
/// some 1e5 evaluations to far less.
constexpr double kHeatTolerance = 1e-6;

/// Ends of the names of texts that say why a result is missing, why it is in doubt, and of both.
constexpr const char *kReason = "none_because", *kDoubt = "doubtful_because", *kBecause = "because";

/// Returns the last value of a column in the first rows. Where a stage lacks the column the value stands in
/// an earlier row.
std::optional<double> last_of(const History& history, const char* column, std::size_t rows) {
  for (std::size_t row = rows; row-- > 0;)
    if (const auto value = history.cell(row, column)) return value;
  return std::nullopt;
}

std::optional<double> last_of(const History& history, const char* column) {
  return last_of(history, column, history.row_count());
}

/// Returns the energy that was put in, in all ways that there are, after the first rows, J.
double turned_over(const History& history, std::size_t rows) {
  double sum = 0.0;
  for (const auto& entry : kEnergies)
    if (entry.side == LedgerSide::put_in) sum += std::abs(last_of(history, entry.column, rows).value_or(0.0));
  return sum;
}

/// Returns the error of the energy ledger over the energy turned over, after the first rows; none where
/// nothing moves, and 0 where nothing was turned over.
std::optional<double> energy_error(const History& history, std::size_t rows) {
  const auto error = last_of(history, error_column(kEnergies), rows);
  if (!error) return std::nullopt;
  const double turnover = turned_over(history, rows);
  return turnover > 0.0 ? *error / turnover : 0.0;
}

/// Returns the error over the energy that contacts dissipated; none where that is nothing, or rounding.
std::optional<double> error_over_dissipated(const History& history, const Simulation& simulation) {
  const auto of_turnover = energy_error(history, history.row_count());
  if (!of_turnover || !simulation.moves()) return std::nullopt;
  std::set<std::string> names;
  for (const LawTable* law : simulation.motion().laws())
    for (const LossInfo& loss : law->losses)
      if (loss.is_energy()) names.insert(loss.name);
  double dissipated = 0.0;
  for (const std::string& name : names)
    dissipated += last_of(history, fmt::format("dissipated_{}_J", name).c_str()).value_or(0.0);
  if (!(dissipated > kRounding * turned_over(history, history.row_count()))) return std::nullopt;
  return std::abs(*of_turnover) <= kRounding ? 0.0 : *last_of(history, error_column(kEnergies)) / dissipated;
}

/// Returns a report without its results, which must not be taken for any, and the reason.
StageReport without_results(StageReport report, double energy_error) {
  const auto because = fmt::format("the energy ledger closes only within {:.3g} % of the energy turned over",
                                   100.0 * std::abs(energy_error));
  for (Result& result : report.results) result.value = {};
  report.results.push_back({kReason, because});
  report.lines = {"no results, because " + because};
  report.warnings = {"this stage has no results: " + because + "; a body that flies off, or too long a step"};
  return report;
}

/// Returns a value for JSON; null where there is none, as in a run that has no row yet.
OrderedJson json_of(const std::optional<double>& value) {
  return value ? OrderedJson(*value) : OrderedJson();
}

std::optional<double> heat_error(const History& history) {
  const auto error = last_of(history, error_column(kHeats));
  if (!error) return std::nullopt;
  // The largest term is that of the whole run: heat that flowed in may have flowed out again.
  double largest = 0.0;
  for (const auto& entry : kHeats)
    if (entry.side != LedgerSide::error)
      for (std::size_t row = 0; row < history.row_count(); ++row)
        largest = std::max(largest, std::abs(history.cell(row, entry.column).value_or(0.0)));
  return largest > 0.0 ? std::abs(*error) / largest : 0.0;
}

/// Returns the stress that an exchange brings where it strains a body that cannot give way, over the tensile
/// strength of the weakest contact: the largest at these temperatures. None where no contact has such a
/// strength.
std::optional<double> exchange_stress(const Simulation& simulation, double increment, double low,
                                      double high) {
  constexpr int kTemperatures = 5;
  const ConcreteMaterials& materials = simulation.materials();
  std::optional<double> largest;
  for (int i = 0; i < kTemperatures; ++i) {
    const double from = low + i * (high - low) / kTemperatures;
    const double to = low + (i + 1) * (high - low) / kTemperatures;
    double strain = 0.0;
    for (const BlockMaterial& material : materials.block_materials)
      if (!material.is_of_bearing)
        strain = std::max(strain, std::abs(material.thermal_strain(to) - material.thermal_strain(from)));
    const double stress =
        estimate_modulus(simulation.model(), materials, to) * strain * increment / (to - from);
    for (const ContactMaterial& contact : materials.contacts)
      for (std::size_t p = 0; p < contact.numbers.size(); ++p)
        if (contact.law->properties[p].key == std::string_view("f_t"))
          if (const double strength = contact.numbers[p](to); strength > 0.0)
            largest = std::max(largest.value_or(0.0), stress / strength);
  }
  return largest;
}

/// Returns the largest such stress of all stages whose fields are computed. Where a field is uniform, only
/// the differences between phases strain the body.
std::optional<double> exchange_stress(const Run& run, const Summary& s) {
  std::optional<double> largest;
  for (std::size_t i = 0; i < s.stages.size(); ++i) {
    const auto& results = s.stages[i].report.results;
    const auto increment = std::ranges::find(results, "largest_exchange_increment_K", &Result::name);
    if (increment == results.end() || run.simulation().field().is_uniform()) continue;
    const RowRange rows = run.courses()[i].rows;
    double low = run.simulation().field().mean(), high = low;
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      low = std::min(low, run.history().cell(row, "temperature_min_degC").value_or(low));
      high = std::max(high, run.history().cell(row, "temperature_max_degC").value_or(high));
    }
    if (!(high > low)) continue;
    if (const auto of_stage =
            exchange_stress(run.simulation(), std::get<double>(increment->value), low, high))
      largest = std::max(largest.value_or(0.0), *of_stage);
  }
  return largest;
}

/// Returns the first row at which a jump exceeds what small kinematics bear, of the rows on which results
/// rest.
std::optional<std::size_t> large_jump(const Run& run, const Summary& s) {
  const History& history = run.history();
  for (std::size_t i = 0; i < run.courses().size(); ++i) {
    const RowRange rows = run.courses()[i].rows;
    const auto decided_at = s.stages[i].report.decided_at;
    const std::size_t end = decided_at ? rows.first + *decided_at + 1 : rows.last;
    for (std::size_t row = rows.first; row < end; ++row)
      if (history.cell(row, "largest_jump").value_or(0.0) > kLargeJump) return row;
  }
  return std::nullopt;
}

/// Returns the last value of each entry of a ledger.
template <class Entries>
OrderedJson last_values(const Entries& entries, const History& history) {
  OrderedJson json;
  for (const auto& entry : entries)
    if (history.has(entry.column)) json[entry.name] = json_of(last_of(history, entry.column));
  return json;
}

OrderedJson json_of(const Result::Value& value) {
  return std::visit(
      [](const auto& v) -> OrderedJson {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return nullptr;
        else
          return v;
      },
      value);
}

OrderedJson json_of(const Summary::OfStage& stage) {
  OrderedJson results = OrderedJson::object();
  for (const Result& result : stage.report.results) results[result.name] = json_of(result.value);
  return {{"kind", stage.kind},
          {"outcome", describe(stage.outcome)},
          {"outcome_id", id_of(stage.outcome)},
          {"is_good", is_good(stage.outcome)},
          {"results", results},
          {"warnings", stage.report.warnings}};
}

OrderedJson whole(const std::optional<double>& value) {
  return value ? OrderedJson(static_cast<std::int64_t>(*value)) : OrderedJson();
}

OrderedJson crack_json(const History& history, const std::string& crack, const std::string& extent) {
  const auto last = [&](const char* what) { return last_of(history, (crack + what).c_str()); };
  return {{"damaged", whole(last("_damaged"))},
          {"broken", whole(last("_broken"))},
          {extent, json_of(last(("_" + extent).c_str()))},
          {"broken_" + extent, json_of(last(("_broken_" + extent).c_str()))}};
}

void add_motion(OrderedJson& json, const Summary& summary, const Run& run) {
  const Simulation& simulation = run.simulation();
  const History& history = run.history();
  json["energy_J"] = last_values(kEnergies, history);
  for (const auto& name : simulation.motion().dissipations())
    json["energy_J"][fmt::format("dissipated_{}", name)] =
        json_of(last_of(history, fmt::format("dissipated_{}_J", name).c_str()));
  json["energy_J"]["error_over_turnover"] = json_of(summary.energy_error);
  json["energy_J"]["error_over_dissipated"] = json_of(summary.error_over_dissipated);
  json["exchange_stress_over_strength"] = json_of(summary.exchange_stress);
  for (const CrackKind& kind : simulation.motion().crack_kinds())
    json["cracks"][kind.name] = crack_json(history, kind.name, extent_column(simulation.model()).name);
  json["cracks"]["mean_opening_m"] = json_of(last_of(history, "mean_opening_m"));
  json["expansion_reading"] = summary.expansion_reading;
  json["estimated_E_GPa"] = estimate_modulus(simulation.model(), simulation.materials()) * 1e-9;
  json["t_b_m"] = simulation.materials().fracture_zone;
  json["time_step_s"] = simulation.motion().time_step();
  json["mass_over_real_mass"] = simulation.motion().mass_ratio();
  json["steps"] = whole(last_of(history, "step"));
}

void add_heat(OrderedJson& json, const Summary& summary, const Run& run) {
  if (!summary.heated_face.empty()) json["heated_face"] = summary.heated_face;
  const HeatWork work = run.simulation().field().conduction()->work();
  json["heat_J"] = last_values(kHeats, run.history());
  json["heat_J"]["error_over_largest"] = json_of(summary.heat_error);
  json["heat_solver"] = {{"steps", work.steps},
                         {"steps_taken_back", work.retries},
                         {"evaluations", work.stages},
                         {"limited_steps", work.limited_steps},
                         {"largest_overshoot_K", work.largest_overshoot}};
  const Simulation& simulation = run.simulation();
  if (simulation.moves()) json["heat_solver"]["coupling"] = simulation.coupling_of_heat();
  if (simulation.cracks_hinder_heat()) {
    const std::string extent = extent_column(simulation.model()).name;
    json["heat_solver"]["gap_" + extent] = json_of(last_of(run.history(), ("heat_gap_" + extent).c_str()));
  }
}

OrderedJson json_of(const ReferenceDistances& of) {
  const CurveDistances& d = of.distances;
  return {{"rms_over_greatest", json_of(d.rms)},
          {"peak_difference", json_of(d.at_peak)},
          {fmt::format("area_between{}{}", of.area_unit.empty() ? "" : "_", of.area_unit), json_of(d.area)},
          {"share_covered", json_of(d.covered)}};
}

std::size_t block_count(const specimen::Specimen& specimen) {
  return specimen.tessellation.cells.size();
}

std::size_t block_count(const solid::SolidSpecimen& specimen) {
  return specimen.complex.cells.size();
}

template <class Specimen>
OrderedJson json_of_specimen(const Specimen& specimen) {
  OrderedJson json = {{"blocks", block_count(specimen)},
                      {"mean_block_size_m", specimen.metrics.mean_size},
                      {"aggregate_fraction_asked", specimen.fraction_asked},
                      {"aggregate_fraction_placed", specimen.fraction_placed},
                      {"aggregate_fraction_superposed", specimen.fraction_superposed}};
  for (std::size_t i = 0; i < specimen.phases.size(); ++i)
    json["fraction"][specimen.phases[i]] = specimen.fraction[i];
  return json;
}

OrderedJson json_of(const MadeSpecimen& specimen) {
  return std::visit([](const auto& s) { return json_of_specimen(s); }, specimen);
}

OrderedJson summary_json(const Summary& s, const Run& run) {
  const Simulation& simulation = run.simulation();
  OrderedJson json;
  json["title"] = s.title;
  json["outcome"] = describe(s.outcome);
  json["outcome_id"] = id_of(s.outcome);
  json["is_good"] = is_good(s.outcome) && s.is_sound;
  json["sign"] = "stress and strain of the test are positive in compression";
  json["stages"] = OrderedJson::array();
  for (const auto& stage : s.stages) json["stages"].push_back(json_of(stage));
  if (simulation.moves()) add_motion(json, s, run);
  if (simulation.field().conduction()) add_heat(json, s, run);
  for (const ReferenceDistances& of : s.references) json["references"][of.name] = json_of(of);
  if (simulation.has_specimen()) json["specimen"] = json_of(simulation.specimen());
  json["wall_time_s"] = s.wall_time;
  json["warnings"] = s.warnings;
  return json;
}

/// Adds the paths of all values that are a number, a flag, or null, in whose place a number may come.
void add_numbers(const OrderedJson& json, const std::string& path, std::set<std::string>& names) {
  for (const auto& [key, value] : json.items()) {
    const std::string own = path.empty() ? key : path + "." + key;
    if (value.is_object())
      add_numbers(value, own, names);
    else if (value.is_number() || value.is_boolean() || value.is_null())
      names.insert(own);
  }
}

/// Calls `f` for each result that a stage of the run will have and that may be a number.
template <class F>
void for_each_number(const Run& run, F f) {
  for (const auto& stage : run.stages())
    for (const Result& result : stage->report(run.history(), {}, Outcome::not_begun).results)
      if (!std::holds_alternative<std::string>(result.value) && !result.name.ends_with(kBecause)) f(result);
}

}  // namespace

void warn_of_hardening(Summary& summary) {
  std::optional<double> failed_at;
  for (std::size_t i = 0; i < summary.stages.size(); ++i) {
    StageReport& report = summary.stages[i].report;
    const auto found = std::ranges::find(report.results, "f_c_MPa", &Result::name);
    if (found == report.results.end()) continue;
    const double* const strength = std::get_if<double>(&found->value);
    if (strength == nullptr) continue;
    const double value = *strength;
    if (failed_at && value > *failed_at) {
      report.warnings.push_back(fmt::format(
          "f_c {:.2f} MPa is of a specimen that had failed at {:.2f} MPa in an earlier stage: it is "
          "hardening of the remaining body, not a strength",
          value, *failed_at));
      for (Result& result : report.results)
        if (result.name.ends_with(kDoubt)) result.value = report.warnings.back();
    }
    failed_at = std::max(failed_at.value_or(value), value);
  }
}

Summary summarize(const Run& run, std::span<const Reference> references) {
  const History& history = run.history();
  const Simulation& simulation = run.simulation();
  Summary s;
  s.outcome = run.outcome();
  for (std::size_t i = 0; i < run.stages().size(); ++i) {
    const Stage& stage = *run.stages()[i];
    const StageCourse& record = run.courses()[i];
    s.stages.push_back({stage.kind(), record.outcome, {}});
    if (record.outcome == Outcome::not_begun) continue;
    StageReport& report = s.stages.back().report;
    report = stage.report(history, record.rows, record.outcome);
    const double error = energy_error(history, record.rows.last).value_or(0.0);
    if (std::abs(error) <= kEnergyNonsense) continue;
    report = without_results(std::move(report), error);
    s.is_sound = false;
  }
  warn_of_hardening(s);
  s.references = reference_distances(references, run);
  for (ReferenceDistances& of : s.references) {
    if (!s.is_sound) of.distances = {};
    s.warnings.insert(s.warnings.end(), of.warnings.begin(), of.warnings.end());
  }
  s.energy_error = energy_error(history, history.row_count());
  s.error_over_dissipated = error_over_dissipated(history, simulation);
  s.exchange_stress = exchange_stress(run, s);
  s.heat_error = heat_error(history);
  if (run.has_ended() && !is_good(s.outcome)) s.warnings.emplace_back(describe(s.outcome));
  if (s.energy_error && std::abs(*s.energy_error) > kEnergyTolerance)
    s.warnings.push_back(fmt::format(
        "the energy ledger closes only within {:.2f} % of the energy turned over", 100.0 * *s.energy_error));
  if (s.error_over_dissipated && std::abs(*s.error_over_dissipated) > kDissipationTolerance)
    s.warnings.push_back(
        fmt::format("the energy ledger closes only within {:.2g} % of the energy that contacts dissipated, "
                    "not within {:.2g} %: a "
                    "lower mechanics.safety leaves less{}",
                    100.0 * std::abs(*s.error_over_dissipated), 100.0 * kDissipationTolerance,
                    history.has("exchange") ? ", and so does a smaller coupling.exchange_increment" : ""));
  if (s.exchange_stress && *s.exchange_stress > kExchangeStress)
    s.warnings.push_back(fmt::format(
        "exchanges of temperatures are too large: one brings up to {:.2g} of the tensile strength at once, "
        "and above {:.2g} cracks dissipate too much; a smaller coupling.exchange_increment brings less",
        *s.exchange_stress, kExchangeStress));
  if (s.heat_error && *s.heat_error > kHeatTolerance)
    s.warnings.push_back(
        fmt::format("the heat ledger closes only within {:.2g} of its largest term", *s.heat_error));
  const bool is_small =
      simulation.moves() && simulation.motion().parameters().kinematics == Kinematics::small;
  if (const auto row = is_small ? large_jump(run, s) : std::nullopt)
    s.warnings.push_back(fmt::format(
        "jumps exceed {} from {:.0f} degC{} on, before the results were decided: {} "
        "(docs/validation/jumps.md)",
        simulation.model().dimension() == 2 ? "an edge" : "a block size",
        *history.cell(*row, "temperature_degC"),
        simulation.has_press() ? fmt::format(" and strain {:.5f}", *history.cell(*row, "strain")) : "",
        simulation.model().dimension() == 2
            ? "with mechanics.kinematics = \"finite\", f_c was up to 2 % lower there, and critical "
              "temperatures "
              "8 to 28 K"
            : "blocks that turn would be softer there, but blocks of a solid cannot turn yet"));
  return s;
}

std::string summary_text(const Summary& s, const Run& run) {
  return summary_json(s, run).dump(2) + "\n";
}

std::vector<std::string> summary_numbers(const Run& run, std::span<const Reference> references) {
  std::set<std::string> names;
  for_each_number(run, [&](const Result& result) { names.insert(result.name); });
  add_numbers(summary_json(summarize(run, references), run), "", names);
  return {names.begin(), names.end()};
}

std::vector<std::string> test_results(const Run& run) {
  std::set<std::string> names;
  for_each_number(run, [&](const Result& result) {
    if (result.of == ResultOf::test) names.insert(result.name);
  });
  return {names.begin(), names.end()};
}

void write_summary(const std::filesystem::path& path, const Summary& summary, const Run& run) {
  write_text_file(path, summary_text(summary, run));
}

}  // namespace pyroclast
