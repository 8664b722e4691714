#include "pyroclast/results/history_file.hpp"

#include <array>

#include <fmt/format.h>

namespace pyroclast {

namespace {

struct Column {
  const char* name;
  double (*value)(const Sample&);
};

constexpr auto kColumns = std::to_array<Column>({
    {"stage", [](const Sample& s) { return static_cast<double>(s.stage); }},
    {"step", [](const Sample& s) { return static_cast<double>(s.step); }},
    {"time_s", [](const Sample& s) { return s.time; }},
    {"heating_time_s", [](const Sample& s) { return s.heat.time; }},
    {"temperature_degC", [](const Sample& s) { return s.heat.mean; }},
    {"temperature_min_degC", [](const Sample& s) { return s.heat.minimum; }},
    {"temperature_max_degC", [](const Sample& s) { return s.heat.maximum; }},
    {"exchange", [](const Sample& s) { return static_cast<double>(s.heat.exchange); }},
    {"cycles", [](const Sample& s) { return static_cast<double>(s.heat.cycles); }},
    {"converged", [](const Sample& s) { return s.heat.converged ? 1.0 : 0.0; }},
    {"strain", [](const Sample& s) { return s.strain; }},
    {"stage_strain", [](const Sample& s) { return s.stage_strain; }},
    {"specimen_strain", [](const Sample& s) { return s.specimen_strain; }},
    {"stress_MPa", [](const Sample& s) { return s.stress() * 1e-6; }},
    {"stress_top_MPa", [](const Sample& s) { return s.stress_top * 1e-6; }},
    {"stress_bottom_MPa", [](const Sample& s) { return s.stress_bottom * 1e-6; }},
    {"lateral_strain", [](const Sample& s) { return s.lateral_strain; }},
    {"unbalanced_ratio", [](const Sample& s) { return s.unbalanced_ratio; }},
    {"kinetic_over_strain", [](const Sample& s) { return s.kinetic_over_strain; }},
    {"largest_jump", [](const Sample& s) { return s.largest_jump; }},
    {"tension_am_softening",
     [](const Sample& s) { return static_cast<double>(s.cracks.tension_am.softening); }},
    {"tension_am_broken", [](const Sample& s) { return static_cast<double>(s.cracks.tension_am.broken); }},
    {"tension_am_length_m", [](const Sample& s) { return s.cracks.tension_am.length; }},
    {"tension_mm_softening",
     [](const Sample& s) { return static_cast<double>(s.cracks.tension_mm.softening); }},
    {"tension_mm_broken", [](const Sample& s) { return static_cast<double>(s.cracks.tension_mm.broken); }},
    {"tension_mm_length_m", [](const Sample& s) { return s.cracks.tension_mm.length; }},
    {"shear_am_softening", [](const Sample& s) { return static_cast<double>(s.cracks.shear_am.softening); }},
    {"shear_am_broken", [](const Sample& s) { return static_cast<double>(s.cracks.shear_am.broken); }},
    {"shear_am_length_m", [](const Sample& s) { return s.cracks.shear_am.length; }},
    {"shear_mm_softening", [](const Sample& s) { return static_cast<double>(s.cracks.shear_mm.softening); }},
    {"shear_mm_broken", [](const Sample& s) { return static_cast<double>(s.cracks.shear_mm.broken); }},
    {"shear_mm_length_m", [](const Sample& s) { return s.cracks.shear_mm.length; }},
    {"mean_opening_m", [](const Sample& s) { return s.cracks.mean_opening; }},
    {"energy_loading_J", [](const Sample& s) { return s.energy.loading; }},
    {"energy_gravity_J", [](const Sample& s) { return s.energy.gravity; }},
    {"energy_heat_J", [](const Sample& s) { return s.energy.property_change; }},
    {"energy_mass_scaling_J", [](const Sample& s) { return s.energy.mass_scaling; }},
    {"energy_zones_J", [](const Sample& s) { return s.energy.zones; }},
    {"energy_contacts_J", [](const Sample& s) { return s.energy.contacts; }},
    {"energy_kinetic_J", [](const Sample& s) { return s.energy.kinetic; }},
    {"dissipated_tension_J", [](const Sample& s) { return s.energy.dissipated.tension; }},
    {"dissipated_shear_J", [](const Sample& s) { return s.energy.dissipated.shear; }},
    {"dissipated_friction_J", [](const Sample& s) { return s.energy.dissipated.friction; }},
    {"dissipated_compression_J", [](const Sample& s) { return s.energy.dissipated.compression; }},
    {"energy_local_damping_J", [](const Sample& s) { return s.energy.local_damping; }},
    {"energy_viscous_damping_J", [](const Sample& s) { return s.energy.viscous_damping; }},
    {"energy_error_J", [](const Sample& s) { return s.energy.error(); }},
});

struct HeatColumn {
  const char* name;
  double (*value)(const TemperatureField&, const HeatLedger&);
};

constexpr auto kHeatColumns = std::to_array<HeatColumn>({
    {"time_s", [](const TemperatureField& f, const HeatLedger&) { return f.time(); }},
    {"temperature_degC", [](const TemperatureField& f, const HeatLedger&) { return f.mean(); }},
    {"temperature_min_degC", [](const TemperatureField& f, const HeatLedger&) { return f.minimum(); }},
    {"temperature_max_degC", [](const TemperatureField& f, const HeatLedger&) { return f.maximum(); }},
    {"rate_K_s", [](const TemperatureField& f, const HeatLedger&) { return f.conduction()->rate(); }},
    {"heat_stored_J", [](const TemperatureField&, const HeatLedger& h) { return h.stored; }},
    {"heat_prescribed_J", [](const TemperatureField&, const HeatLedger& h) { return h.prescribed; }},
    {"heat_flux_J", [](const TemperatureField&, const HeatLedger& h) { return h.boundary.flux; }},
    {"heat_convection_J", [](const TemperatureField&, const HeatLedger& h) { return h.boundary.convection; }},
    {"heat_radiation_J", [](const TemperatureField&, const HeatLedger& h) { return h.boundary.radiation; }},
    {"heat_error_J", [](const TemperatureField&, const HeatLedger& h) { return h.error(); }},
});

}  // namespace

std::string HistoryFile::header() {
  std::string line;
  for (const auto& column : kColumns) line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  return line;
}

HistoryFile::HistoryFile(const std::filesystem::path& path) : file_(path) {
  file_.line(header());
}

void HistoryFile::write(const Sample& sample) {
  std::string line;
  for (const auto& column : kColumns) {
    if (!line.empty()) line += ',';
    line += fmt::format("{}", column.value(sample));
  }
  file_.line(line);
}

HeatHistoryFile::HeatHistoryFile(const std::filesystem::path& path, const Model<2>& model,
                                 const std::vector<ProbeCase>& probes)
    : file_(path) {
  std::vector<std::string> names;
  for (const auto& column : kHeatColumns) names.emplace_back(column.name);
  for (const auto& probe : probes) {
    names.push_back(fmt::format("probe_{}_degC", probe.name));
    probes_.emplace_back(model, probe.position);
  }
  file_.line(fmt::format("{}", fmt::join(names, ",")));
}

void HeatHistoryFile::write(const TemperatureField& field) {
  const HeatLedger ledger = field.conduction()->ledger();
  std::vector<double> row;
  for (const auto& column : kHeatColumns) row.push_back(column.value(field, ledger));
  for (const auto& probe : probes_) row.push_back(probe.read(field.gridpoints()));
  file_.line(fmt::format("{}", fmt::join(row, ",")));
}

}  // namespace pyroclast
