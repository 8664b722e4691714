#include "pyroclast/simulation/watching/soundness.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/laws/common.hpp"
#include "pyroclast/simulation/watching/loose_pieces.hpp"

namespace pyroclast {

namespace {

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
/// Largest stress that exchanges of temperatures may bring at once in the mean, over the tensile strength:
/// measured in docs/understand/theory.md.
constexpr double kExchangeStress = 1.0;
/// Error of the energy ledger, over the energy turned over, above which a run has no results: energy came
/// from nowhere, or a body flew off.
constexpr double kEnergyNonsense = 0.05;
/// Largest error of the heat ledger over its largest term. Heat is conserved to rounding, which adds up over
/// some 1e5 evaluations to far less.
constexpr double kHeatTolerance = 1e-6;

/// Returns the energy that was put in, in all ways that there are, after the first rows, J.
double turned_over(const History& history, std::size_t rows) {
  double sum = 0.0;
  for (const Column& column : history.columns())
    if (column.role == ColumnRole::energy_put_in)
      sum += std::abs(last_of(history, column.name, rows).value_or(0.0));
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
    dissipated += last_of(history, fmt::format("dissipated_{}_J", name)).value_or(0.0);
  if (!(dissipated > kRounding * turned_over(history, history.row_count()))) return std::nullopt;
  return std::abs(*of_turnover) <= kRounding ? 0.0 : *last_of(history, error_column(kEnergies)) / dissipated;
}

/// Returns a report without its results, which must not be taken for any, and the reason.
StageReport without_results(StageReport report, double energy_error) {
  const auto because = fmt::format("the energy ledger closes only within {:.3g} % of the energy turned over",
                                   100.0 * std::abs(energy_error));
  for (Result& result : report.results) result.value = {};
  report.results.push_back(reason_of_all(because));
  report.lines = {"no results, because " + because};
  report.warnings = {"this stage has no results: " + because + "; a body that flies off, or too long a step"};
  return report;
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

/// Returns the least tensile strength of a contact at a temperature; none where no contact has one.
std::optional<double> least_tensile_strength(const ConcreteMaterials& materials, double temperature) {
  std::optional<double> least;
  for (const ContactMaterial& contact : materials.contacts)
    if (const auto strength = contact.tensile_strength(temperature, temperature); strength > 0.0)
      least = std::min(least.value_or(*strength), *strength);
  return least;
}

/// Returns the stress that an exchange brings where it strains a body that cannot give way, in the mean over
/// these temperatures, over the tensile strength of the weakest contact at the lowest of them. None where no
/// contact has such a strength. Where strength has almost gone little is left to dissipate, so the strength
/// of hot contacts does not count.
std::optional<double> exchange_stress(const Simulation& simulation, double increment, double low,
                                      double high) {
  constexpr int kTemperatures = 10;
  const ConcreteMaterials& materials = simulation.materials();
  const auto strength = least_tensile_strength(materials, low);
  if (!strength) return std::nullopt;
  double sum = 0.0;
  for (int i = 0; i < kTemperatures; ++i) {
    const double from = low + i * (high - low) / kTemperatures;
    const double to = low + (i + 1) * (high - low) / kTemperatures;
    double strain = 0.0;
    for (const BlockMaterial& material : materials.block_materials)
      if (!material.is_of_bearing)
        strain = std::max(strain, std::abs(material.thermal_strain(to) - material.thermal_strain(from)));
    sum += estimate_modulus(simulation.model(), materials, to) * strain * increment / (to - from);
  }
  return sum / kTemperatures / *strength;
}

/// Returns the largest such stress of all stages whose fields are computed. Where a field is uniform, only
/// the differences between phases strain the body.
std::optional<double> exchange_stress(const Run& run, const std::vector<ReportedStage>& stages) {
  std::optional<double> largest;
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const double increment = run.stages()[i]->exchange_increment();
    if (increment == 0.0 || stages[i].outcome == Outcome::not_begun || run.simulation().field().is_uniform())
      continue;
    const RowRange rows = run.courses()[i].rows;
    double low = run.simulation().field().mean(), high = low;
    for (std::size_t row = rows.first; row < rows.last; ++row) {
      low = std::min(low, run.history().cell(row, "temperature_min_degC").value_or(low));
      high = std::max(high, run.history().cell(row, "temperature_max_degC").value_or(high));
    }
    if (!(high > low)) continue;
    if (const auto of_stage = exchange_stress(run.simulation(), increment, low, high))
      largest = std::max(largest.value_or(0.0), *of_stage);
  }
  return largest;
}

/// Returns the first row at which a jump exceeds what small kinematics bear, of the rows on which results
/// rest.
std::optional<std::size_t> large_jump(const Run& run, const std::vector<ReportedStage>& stages) {
  const History& history = run.history();
  for (std::size_t i = 0; i < run.courses().size(); ++i) {
    const RowRange rows = run.courses()[i].rows;
    const auto decided_at = stages[i].report.decided_at;
    const std::size_t end = decided_at ? rows.first + *decided_at + 1 : rows.last;
    for (std::size_t row = rows.first; row < end; ++row)
      if (history.cell(row, "largest_jump").value_or(0.0) > kLargeJump) return row;
  }
  return std::nullopt;
}

}  // namespace

/// Returns the last value of a column in the first rows. Where a stage lacks the column the value stands in
/// an earlier row.
std::optional<double> last_of(const History& history, std::string_view column, std::size_t rows) {
  for (std::size_t row = rows; row-- > 0;)
    if (const auto value = history.cell(row, column)) return value;
  return std::nullopt;
}

std::optional<double> last_of(const History& history, std::string_view column) {
  return last_of(history, column, history.row_count());
}

void warn_of_hardening(std::vector<ReportedStage>& stages) {
  std::optional<double> failed_at;
  for (ReportedStage& stage : stages) {
    StageReport& report = stage.report;
    const auto found = std::ranges::find(report.results, kStrength.name, &Result::name);
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
        if (result.of == ResultOf::doubt) result.value = report.warnings.back();
    }
    failed_at = std::max(failed_at.value_or(value), value);
  }
}

std::vector<ReportedStage> report_stages(const Run& run) {
  std::vector<ReportedStage> stages;
  for (std::size_t i = 0; i < run.stages().size(); ++i) {
    const Stage& stage = *run.stages()[i];
    const StageCourse& course = run.courses()[i];
    ReportedStage& reported = stages.emplace_back(ReportedStage{stage.kind(), course.outcome, {}});
    if (course.outcome == Outcome::not_begun) continue;
    reported.report = stage.report(run.history(), course.rows, course.outcome);
    const double error = energy_error(run.history(), course.rows.last).value_or(0.0);
    if (std::abs(error) <= kEnergyNonsense) continue;
    reported.report = without_results(std::move(reported.report), error);
    reported.is_sound = false;
  }
  warn_of_hardening(stages);
  return stages;
}

Soundness judge_soundness(const Run& run, const std::vector<ReportedStage>& stages) {
  const History& history = run.history();
  const Simulation& simulation = run.simulation();
  Soundness s;
  s.energy_error = energy_error(history, history.row_count());
  s.error_over_dissipated = error_over_dissipated(history, simulation);
  s.exchange_stress = exchange_stress(run, stages);
  s.heat_error = heat_error(history);
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
        "exchanges of temperatures are too large: in the mean one brings {:.2g} of the tensile strength at "
        "once, and above {:.2g} cracks dissipate too much; a smaller coupling.exchange_increment brings "
        "less",
        *s.exchange_stress, kExchangeStress));
  if (s.heat_error && *s.heat_error > kHeatTolerance)
    s.warnings.push_back(
        fmt::format("the heat ledger closes only within {:.2g} of its largest term", *s.heat_error));
  const bool is_small =
      simulation.moves() && simulation.motion().parameters().kinematics == Kinematics::small;
  if (const auto row = is_small ? large_jump(run, stages) : std::nullopt)
    s.warnings.push_back(fmt::format(
        "jumps exceed {} from {:.0f} degC{} on, before the results were decided: {} "
        "(docs/validation/jumps.md)",
        simulation.model().dimension() == 2 ? "an edge" : "a block size",
        *history.cell(*row, "temperature_degC"),
        simulation.has_press() ? fmt::format(" and strain {:.5f}", *history.cell(*row, "strain")) : "",
        simulation.model().dimension() == 2
            ? "with mechanics.kinematics = \"finite\", f_c was up to 4 % lower there, and critical "
              "temperatures up to 24 K"
            : "with mechanics.kinematics = \"finite\" blocks turn, which makes a body softer there"));
  std::ranges::move(warnings_of_loose_pieces(simulation), std::back_inserter(s.warnings));
  return s;
}

}  // namespace pyroclast
