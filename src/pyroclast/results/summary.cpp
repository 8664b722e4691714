#include "pyroclast/results/summary.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/specimen_files.hpp"
#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// Returns a value for JSON; null where there is none, as in a run that has no row yet.
OrderedJson json_of(const std::optional<double>& value) {
  return value ? OrderedJson(*value) : OrderedJson();
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

OrderedJson json_of(const ReportedStage& stage) {
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

/// Returns the last values of the cracks of each mode and interface.
OrderedJson crack_json(const History& history) {
  OrderedJson json;
  for (const Column& column : history.columns()) {
    if (column.role == ColumnRole::crack_opening) json[column.name] = json_of(last_of(history, column.name));
    if (column.mode.empty()) continue;
    const std::string kind = fmt::format("{}_{}", column.mode, column.interface);
    const auto last = last_of(history, column.name);
    json[kind][column.name.substr(kind.size() + 1)] = column.unit == "1" ? whole(last) : json_of(last);
  }
  return json;
}

void add_motion(OrderedJson& json, const Summary& summary, const Run& run) {
  const Simulation& simulation = run.simulation();
  const History& history = run.history();
  json["energy_J"] = last_values(kEnergies, history);
  for (const auto& name : simulation.motion().dissipations())
    json["energy_J"][fmt::format("dissipated_{}", name)] =
        json_of(last_of(history, fmt::format("dissipated_{}_J", name)));
  json["energy_J"]["error_over_turnover"] = json_of(summary.soundness.energy_error);
  json["energy_J"]["error_over_dissipated"] = json_of(summary.soundness.error_over_dissipated);
  json["exchange_stress_over_strength"] = json_of(summary.soundness.exchange_stress);
  json["cracks"] = crack_json(history);
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
  json["heat_J"]["error_over_largest"] = json_of(summary.soundness.heat_error);
  json["heat_solver"] = {{"steps", work.steps},
                         {"steps_taken_back", work.retries},
                         {"evaluations", work.stages},
                         {"limited_steps", work.limited_steps},
                         {"largest_overshoot_K", work.largest_overshoot}};
  const Simulation& simulation = run.simulation();
  if (simulation.moves()) json["heat_solver"]["coupling"] = simulation.coupling_of_heat();
  if (simulation.cracks_hinder_heat()) {
    const std::string extent = simulation.model().dimension() == 2 ? "gap_length_m" : "gap_area_m2";
    json["heat_solver"][extent] = json_of(last_of(run.history(), "heat_" + extent));
  }
}

OrderedJson spalling_json(const Simulation& simulation) {
  const Spalling& spalling = *simulation.spalling();
  OrderedJson json;
  json["pieces"] = spalling.spalls().size();
  json["blocks"] = spalling.blocks_gone();
  json["first_s"] = json_of(
      spalling.spalls().empty() ? std::nullopt : std::optional(spalling.spalls().front().heating_time));
  json["mass_kg"] = spalling.mass_gone();
  json["mean_depth_m"] = spalling.mean_depth();
  json["largest_depth_m"] = spalling.largest_depth();
  json["lost_section"] = spalling.lost_section();
  for (std::size_t bar = 0; bar < spalling.rule().bars.size(); ++bar) {
    const auto temperature = [&](const TemperatureField& field) {
      const double value = spalling.temperature_at(bar, field);
      return json_of(std::isnan(value) ? std::nullopt : std::optional(value));
    };
    json["bars"][name_of_bar(spalling.rule().bars[bar])] = {
        {"bare_from_s", json_of(spalling.bare_from(bar))},
        {"temperature_degC", temperature(simulation.field())},
        {"temperature_unspalled_degC", temperature(simulation.unspalled_field())}};
  }
  return json;
}

OrderedJson json_of(const ReferenceDistances& of) {
  const CurveDistances& d = of.distances;
  return {{"rms_over_greatest", json_of(d.rms)},
          {"peak_difference", json_of(d.at_peak)},
          {fmt::format("area_between{}{}", of.area_unit.empty() ? "" : "_", of.area_unit), json_of(d.area)},
          {"share_covered", json_of(d.covered)}};
}

OrderedJson summary_json(const Summary& s, const Run& run) {
  const Simulation& simulation = run.simulation();
  OrderedJson json;
  json["title"] = s.title;
  json["outcome"] = describe(s.outcome);
  json["outcome_id"] = id_of(s.outcome);
  json["is_good"] = is_good(s.outcome) && s.is_sound();
  json["stages"] = OrderedJson::array();
  for (const auto& stage : s.stages) json["stages"].push_back(json_of(stage));
  if (simulation.moves()) add_motion(json, s, run);
  if (simulation.field().conduction()) add_heat(json, s, run);
  if (simulation.spalling()) json["spalling"] = spalling_json(simulation);
  for (const ReferenceDistances& of : s.references) json["references"][of.name] = json_of(of);
  if (simulation.specimen()) json["specimen"] = specimen_facts(*simulation.specimen());
  if (const SpecimenTold* told = simulation.told(); told && !told->facts.empty())
    json["specimen"] = OrderedJson::parse(told->facts);
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
      if (!result.unit.empty()) f(result);
}

}  // namespace

Summary summarize(const Run& run, std::span<const Reference> references) {
  Summary s;
  s.outcome = run.outcome();
  s.stages = report_stages(run);
  s.references = reference_distances(references, run);
  for (ReferenceDistances& of : s.references) {
    if (!s.is_sound()) of.distances = {};
    s.warnings.insert(s.warnings.end(), of.warnings.begin(), of.warnings.end());
  }
  s.soundness = judge_soundness(run, s.stages);
  if (run.has_ended() && !is_good(s.outcome)) s.warnings.emplace_back(describe(s.outcome));
  s.warnings.insert(s.warnings.end(), s.soundness.warnings.begin(), s.soundness.warnings.end());
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
