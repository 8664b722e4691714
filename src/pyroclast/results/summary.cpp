#include "pyroclast/results/summary.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"

namespace pyroclast {

namespace {

/// Contacts are joined at the start and their normals stay; a jump of this share of the edge is no longer
/// small.
constexpr double kSmallJump = 0.1;
/// The ledger of a sound run closes within this share of the energy turned over.
constexpr double kLedgerTolerance = 0.005;

/// First row at which jumps are no longer small; null if they always are.
const Sample* large_jumps(const std::vector<Sample>& history) {
  const auto row = std::find_if(history.begin(), history.end(),
                                [](const Sample& s) { return s.largest_jump > kSmallJump; });
  return row == history.end() ? nullptr : &*row;
}

const char* name(PlatenControl control) {
  return control == PlatenControl::force ? "force" : "fixed";
}

struct StageName {
  const char* operator()(const SettleStage&) const { return "settle"; }
  const char* operator()(const LoadStage&) const { return "load"; }
  const char* operator()(const CompressStage&) const { return "compress"; }
  const char* operator()(const HeatStage&) const { return "heat"; }
  const char* operator()(const ExposeStage&) const { return "expose"; }
};

template <class T>
nlohmann::ordered_json or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json heating_json(const Summary& s) {
  if (!s.heating) return nullptr;
  const HeatingResponse& h = *s.heating;
  return {{"field", s.uniform_temperature ? "uniform" : "conduction"},
          {"expansion_reading", s.expansion_reading},
          {"platen", name(h.platen)},
          {"load_stress_MPa", h.load_stress * 1e-6},
          {"load_level", or_null(h.level)},
          {"critical_temperature_degC", or_null(h.critical_temperature)},
          {"critical_time_s", h.critical_temperature ? nlohmann::ordered_json(h.critical_time) : nullptr},
          {"highest_temperature_degC", h.highest},
          {"largest_exchange_increment_K", h.increment},
          {"exchanges", h.exchanges},
          {"exchanges_not_converged", h.not_converged},
          {"worst_unbalanced_ratio", h.worst_ratio},
          {"cycles", h.cycles},
          {"largest_thrust_MPa", h.largest_thrust * 1e-6}};
}

nlohmann::ordered_json crack_json(const CrackCount& c) {
  return {{"softening", c.softening}, {"broken", c.broken}, {"length_m", c.length}};
}

}  // namespace

Summary summarize(const Case& c, const Experiment& experiment, Outcome outcome) {
  const auto& history = experiment.history();
  Summary s;
  s.title = c.title;
  s.outcome = outcome;
  s.compression = compression_response(history, c.stages);
  s.quasi_static = quasi_static_report(history, c.stages);
  s.heating = heating_response(history, c.stages, outcome);
  s.uniform_temperature = c.heat.uniform;
  s.expansion_reading = c.expansion_reading == ExpansionReading::secant ? "secant" : "tangent";
  for (const Stage& stage : c.stages) s.stages.push_back(std::visit(StageName{}, stage));
  s.time_step = experiment.mechanics().time_step();
  s.mass_ratio = experiment.mechanics().mass_ratio();
  s.last = history.back();
  if (outcome == Outcome::interrupted || outcome == Outcome::not_settled || outcome == Outcome::unstable)
    s.warnings.push_back(describe(outcome));
  if (s.compression && !s.compression->peak_passed)
    s.warnings.push_back("the stress never fell after its largest value, so f_c is only what was reached");
  if (s.compression && !s.quasi_static.to_peak)
    s.warnings.push_back(
        fmt::format("not quasi-static up to the peak: kinetic over elastic energy up to {:.1e}, platen "
                    "stresses differ by up to "
                    "{:.1f} % of f_c; load more slowly or take a shorter time step",
                    s.quasi_static.kinetic_to_peak, 100.0 * s.quasi_static.difference_to_peak));
  if (s.heating && s.heating->not_converged > 0)
    s.warnings.push_back(fmt::format(
        "{} of {} exchanges of temperature did not come to rest within the stated cycles (worst unbalanced "
        "ratio {:.1e}); history.csv flags them",
        s.heating->not_converged, s.heating->exchanges, s.heating->worst_ratio));
  const double ledger = s.last.energy.error() / s.last.energy.turnover();
  if (std::abs(ledger) > kLedgerTolerance)
    s.warnings.push_back(fmt::format(
        "the energy ledger closes only within {:.2f} % of the energy turned over", 100.0 * ledger));
  if (const Sample* row = large_jumps(history))
    s.warnings.push_back(
        fmt::format("jumps exceed {:.0f} % of an edge from {:.0f} degC and strain {:.5f} on: contacts keep "
                    "the partners and "
                    "normals they started with, so what follows is approximate",
                    100.0 * kSmallJump, row->heat.mean, row->strain));
  return s;
}

void write_summary(const std::filesystem::path& path, const Summary& s, const specimen::Specimen& specimen) {
  nlohmann::ordered_json json;
  json["title"] = s.title;
  json["outcome"] = describe(s.outcome);
  json["sign"] = "stress and strain of the test are positive in compression";
  json["stages"] = nlohmann::json::array();
  for (const auto& stage : s.stages) json["stages"].push_back({{"kind", stage}});
  json["compression"] = nullptr;
  if (s.compression)
    json["compression"] = {
        {"E_GPa", s.compression->modulus * 1e-9},          {"f_c_MPa", s.compression->strength * 1e-6},
        {"strain_at_peak", s.compression->strain_at_peak}, {"strain_ic", s.compression->inelastic_strain},
        {"peak_passed", s.compression->peak_passed},       {"estimated_E_GPa", s.estimated_modulus * 1e-9}};
  json["quasi_static"] = nullptr;
  if (s.compression) {
    json["quasi_static"] = s.quasi_static.to_peak;
    json["quasi_static_detail"] = {
        {"kinetic_over_elastic_to_peak", s.quasi_static.kinetic_to_peak},
        {"kinetic_over_elastic_after_peak", s.quasi_static.kinetic_after_peak},
        {"platen_difference_over_f_c_to_peak", s.quasi_static.difference_to_peak},
        {"platen_difference_over_f_c_after_peak", s.quasi_static.difference_after_peak},
        {"after_peak", s.quasi_static.after_peak}};
  }
  json["heating"] = heating_json(s);
  const EnergyLedger& e = s.last.energy;
  json["energy_J"] = {{"loading", e.loading},
                      {"gravity", e.gravity},
                      {"heat", e.property_change},
                      {"mass_scaling", e.mass_scaling},
                      {"elastic_zones", e.zones},
                      {"elastic_contacts", e.contacts},
                      {"kinetic", e.kinetic},
                      {"dissipated_tension", e.dissipated.tension},
                      {"dissipated_shear", e.dissipated.shear},
                      {"dissipated_friction", e.dissipated.friction},
                      {"dissipated_compression", e.dissipated.compression},
                      {"local_damping", e.local_damping},
                      {"viscous_damping", e.viscous_damping},
                      {"error", e.error()},
                      {"error_over_turnover", e.error() / e.turnover()}};
  const Cracks& c = s.last.cracks;
  json["cracks"] = {{"tension_aggregate_mortar", crack_json(c.tension_am)},
                    {"tension_mortar_mortar", crack_json(c.tension_mm)},
                    {"shear_aggregate_mortar", crack_json(c.shear_am)},
                    {"shear_mortar_mortar", crack_json(c.shear_mm)},
                    {"mean_opening_m", c.mean_opening}};
  json["specimen"] = {{"blocks", specimen.tessellation.cells.size()},
                      {"mean_block_size_m", specimen.metrics.mean_size},
                      {"aggregate_fraction_asked", specimen.fraction_asked},
                      {"aggregate_fraction_placed", specimen.fraction_placed},
                      {"aggregate_fraction_superposed", specimen.fraction_superposed}};
  json["t_b_m"] = s.fracture_zone;
  json["time_step_s"] = s.time_step;
  json["mass_over_real_mass"] = s.mass_ratio;
  json["steps"] = s.last.step;
  json["wall_time_s"] = s.wall_time;
  json["warnings"] = s.warnings;
  write_text_file(path, json.dump(2) + "\n");
}

}  // namespace pyroclast
