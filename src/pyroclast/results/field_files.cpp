#include "pyroclast/results/field_files.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/results/history_file.hpp"
#include "pyroclast/setup/read_frame.hpp"
#include "pyroclast/simulation/cracks.hpp"

namespace pyroclast {

namespace {

const std::filesystem::path& created(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

void append(std::vector<float>& values, const Vec<2>& v) {
  values.insert(values.end(), {static_cast<float>(v[0]), static_cast<float>(v[1]), 0.0F});
}

void append(std::vector<float>& values, std::initializer_list<double> tensor) {
  for (const double component : tensor) values.push_back(static_cast<float>(component));
}

/// Name of an array with its unit. A slash would part the name.
std::string array(const char* place, std::string_view name, std::string_view unit) {
  std::string with_unit = fmt::format("{} [{}]", name, unit);
  std::ranges::replace(with_unit, '/', '|');
  return fmt::format("/VTKHDF/{}/{}", place, with_unit);
}

void write_temperatures(Hdf5File& file, const TemperatureField& field) {
  const auto& temperature = field.gridpoints();
  file.dataset(fmt::format("/VTKHDF/{}", kFrameTemperature),
               std::vector<float>(temperature.begin(), temperature.end()));
}

/// Components of a symmetric tensor, in the order of VTK: XX, YY, ZZ, XY, YZ, XZ.
constexpr int kTensor = 6;

/// What a zone has crept: XX, YY, ZZ, XY. Across the plane it acts on nothing.
std::array<double, 4> creep_of(const Simulation& simulation, int zone) {
  const Mechanics<2>& mechanics = simulation.mechanics();
  if (!mechanics.creeps()) return {};
  const Model<2>& model = simulation.model();
  const auto& creep =
      simulation.materials().solids[model.block_material[model.block_of(model.zones[zone][0])]].creep;
  const auto strain = mechanics.creep_strain(zone);
  return {strain[0], strain[1], creep ? creep_across(strain, creep->choices.poisson) : 0.0, strain[2]};
}

/// Of a zone in plane stress: that of its displacements, and across the plane that which leaves it free of
/// stress there.
/// \param creep  as of creep_of
void append_strain(std::vector<float>& values, const SymmetricTensor<2>& stress, const ZoneProperties& zone,
                   const std::array<double, 4>& creep) {
  const double in_plane = (stress[0] + stress[1]) / (2.0 * (zone.lambda + zone.mu));
  const auto direct = [&](double s) { return (s - zone.lambda * in_plane) / (2.0 * zone.mu); };
  append(
      values,
      {direct(stress[0]) + zone.thermal_strain + creep[0], direct(stress[1]) + zone.thermal_strain + creep[1],
       direct(0.0) + zone.thermal_strain + creep[2], 0.5 * stress[2] / zone.mu + creep[3], 0.0, 0.0});
}

void write_motion(Hdf5File& file, const Simulation& simulation) {
  const Mechanics<2>& mechanics = simulation.mechanics();
  const int zones = mechanics.model().zone_count();
  std::vector<float> displacement, stress, strain, crept;
  displacement.reserve(3 * mechanics.model().position.size());
  for (auto* values : {&stress, &strain}) values->reserve(kTensor * static_cast<std::size_t>(zones));
  for (const auto& u : mechanics.displacements()) append(displacement, u);
  for (int zone = 0; zone < zones; ++zone) {
    const auto s = mechanics.stress(zone);
    append(stress, {s[0], s[1], 0.0, s[2], 0.0, 0.0});
    const auto creep = creep_of(simulation, zone);
    append_strain(strain, s, mechanics.properties_of_zone(zone), creep);
    if (mechanics.creeps()) append(crept, {creep[0], creep[1], creep[2], creep[3], 0.0, 0.0});
  }
  file.dataset(array("PointData", "displacement", "m"), displacement, 3);
  file.dataset(array("CellData", "stress", "Pa"), stress, kTensor);
  file.dataset(array("CellData", "strain", "1"), strain, kTensor);
  if (mechanics.creeps()) file.dataset(array("CellData", "creep_strain", "1"), crept, kTensor);
}

std::string_view name_of(const HistoryInfo& info) {
  return info.name;
}

/// Numbers of the contacts' histories that go into files, by name, in the order of the laws; zero where a law
/// has none.
std::vector<HistoryInfo> remembered_by(const Mechanics<2>& mechanics) {
  std::vector<HistoryInfo> all;
  const LawTable* last = nullptr;
  for (int i = 0; i < mechanics.model().contact_count(); ++i) {
    const LawTable* const law = &mechanics.law_of(i);
    if (std::exchange(last, law) == law) continue;
    for (const HistoryInfo& info : law->history(2))
      if (info.in_files && std::ranges::find(all, std::string_view(info.name), name_of) == all.end())
        all.push_back(info);
  }
  return all;
}

/// The traction on a contact as the stress in its direction: σ n n + τ (n t + t n).
void append_stress(std::vector<float>& values, const ContactState<2>& state, const ContactFrame<2>& frame) {
  const auto &n = frame.normal, &t = frame.tangents[0];
  const double normal = state.normal_traction, shear = state.shear_traction[0];
  append(values,
         {normal * n[0] * n[0] + 2.0 * shear * n[0] * t[0], normal * n[1] * n[1] + 2.0 * shear * n[1] * t[1],
          0.0, normal * n[0] * n[1] + shear * (n[0] * t[1] + n[1] * t[0]), 0.0, 0.0});
}

/// The most that a contact between blocks is damaged by any mode, 1: it is a crack. Those of bearings are
/// none.
double crack(const Mechanics<2>& mechanics, int contact) {
  if (mechanics.model().is_of_bearing(mechanics.model().contacts[contact])) return 0.0;
  double most = 0.0;
  for (const auto mode : kCrackModes) most = std::max(most, mechanics.remembered(contact, mode));
  return most;
}

/// What contacts are to heat, where cracks hinder it.
void write_heat_of_contacts(Hdf5File& file, const Simulation& simulation) {
  const auto& temperature = simulation.field().gridpoints();
  const auto conductance = simulation.field().conduction()->gaps()->conductances(temperature);
  std::vector<float> jump;
  for (std::size_t i = 0; i < conductance.size(); ++i) {
    const auto& c = simulation.model().contacts[i];
    const bool conducts = !simulation.model().is_of_bearing(c);
    jump.push_back(conducts ? static_cast<float>(temperature[c.b] - temperature[c.a]) : 0.0F);
  }
  file.dataset(array("CellData", "heat_conductance", "W m-2 K-1"),
               std::vector<float>(conductance.begin(), conductance.end()));
  file.dataset(array("CellData", "temperature_jump", "K"), jump);
}

void write_contacts(Hdf5File& file, const Mechanics<2>& mechanics) {
  const auto& model = mechanics.model();
  const auto infos = remembered_by(mechanics);
  std::vector<float> displacement, opening, tangential_jump, normal_traction, shear_traction, stress, cracked;
  std::vector<std::vector<float>> remembered(infos.size());
  displacement.reserve(6 * model.contacts.size());
  for (auto* values : {&opening, &tangential_jump, &normal_traction, &shear_traction, &cracked})
    values->reserve(model.contacts.size());
  const auto u = mechanics.displacements();
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& c = model.contacts[i];
    const auto& partner = model.contacts[i ^ 1];  // the two contacts of an edge stand together
    const Vec<2> here = 0.5 * (u[c.a] + u[c.b]);
    append(displacement, here);
    append(displacement, 0.5 * (here + 0.5 * (u[partner.a] + u[partner.b])));
    const auto state = mechanics.contact(i);
    for (std::size_t n = 0; n < infos.size(); ++n)
      remembered[n].push_back(static_cast<float>(state.remembered(std::string_view(infos[n].name))));
    append_stress(stress, state, mechanics.frame_of_forces(i));
    cracked.push_back(static_cast<float>(crack(mechanics, i)));
    opening.push_back(static_cast<float>(state.opening));
    tangential_jump.push_back(static_cast<float>(state.tangential_jump[0]));
    normal_traction.push_back(static_cast<float>(state.normal_traction));
    shear_traction.push_back(static_cast<float>(state.shear_traction[0]));
  }
  file.dataset(array("PointData", "displacement", "m"), displacement, 3);
  for (std::size_t n = 0; n < infos.size(); ++n)
    file.dataset(array("CellData", infos[n].name, infos[n].unit.si), remembered[n]);
  file.dataset(array("CellData", "crack", "1"), cracked);
  file.dataset(array("CellData", "opening", "m"), opening);
  file.dataset(array("CellData", "tangential_jump", "m"), tangential_jump);
  file.dataset(array("CellData", "normal_traction", "Pa"), normal_traction);
  file.dataset(array("CellData", "shear_traction", "Pa"), shear_traction);
  file.dataset(array("CellData", "stress", "Pa"), stress, kTensor);
}

/// What frames.csv has of the history, where that has it.
constexpr std::array<const char*, 7> kFrameColumns{
    "stage", "step", "time_s", "strain", "stress_MPa", "temperature_degC", "heating_time_s"};

std::vector<std::string> frame_columns(const History& history) {
  std::vector<std::string> names;
  for (const char* name : kFrameColumns)
    if (history.has(name)) names.emplace_back(name);
  return names;
}

std::string frame_line(const History& history, const std::vector<std::string>& columns, std::size_t frame,
                       std::int64_t row) {
  std::vector<std::optional<double>> cells;
  for (const auto& name : columns) cells.push_back(history.cell(static_cast<std::size_t>(row), name));
  return fmt::format("{},{}", frame, printed_row(cells));
}

/// Of frames.csv.
std::string text_of(const History& history, const std::vector<std::string>& columns,
                    const FrameRecords& frames) {
  std::string text = fmt::format("frame,{}\n", fmt::join(columns, ","));
  for (std::size_t i = 0; i < frames.rows.size(); ++i)
    text += frame_line(history, columns, i, frames.rows[i]) + "\n";
  return text;
}

/// Of frames on a common axis, s: 0 when heating begins, and the real heating time while it lasts. Before and
/// after it, and in runs that do not heat, the time of the mechanics goes on.
std::vector<double> frame_times(const History& history, const FrameRecords& frames) {
  const auto cell = [&](std::int64_t row, const char* name, double otherwise) {
    if (!history.has(name)) return otherwise;
    return history.cell(static_cast<std::size_t>(row), name).value_or(otherwise);
  };
  std::vector<double> times;
  double moved = 0.0, heated = 0.0, at_rest = 0.0,
         begun = 0.0;  // at_rest: of the mechanics while nothing heats
  for (const std::int64_t row : frames.rows) {
    const double was_moved = std::exchange(moved, cell(row, "time_s", moved));
    const double was_heated = std::exchange(heated, cell(row, "heating_time_s", heated));
    if (was_heated == 0.0 && heated > 0.0) begun = at_rest;
    if (heated == was_heated) at_rest += moved - was_moved;
    times.push_back(heated + at_rest);
  }
  for (double& t : times) t -= begun;
  return times;
}

}  // namespace

FieldFiles::FieldFiles(const std::filesystem::path& folder, const Simulation& simulation,
                       const History& history, const FrameRecords& frames)
    : columns_(frame_columns(history)),
      frames_(created(folder) / "frames.csv", text_of(history, columns_, frames)),
      blocks_(folder, MeshPart::blocks, frame_times(history, frames)) {
  if (simulation.moves()) contacts_.emplace(folder, MeshPart::contacts, frame_times(history, frames));
  write_mesh(folder, simulation.model());
}

std::vector<std::string> FieldFiles::lost() const {
  std::vector<std::string> names = blocks_.lost();
  if (contacts_) std::ranges::copy(contacts_->lost(), std::back_inserter(names));
  return names;
}

void FieldFiles::write(const Simulation& simulation, const History& history, FrameRecords& frames) {
  const auto row = static_cast<std::int64_t>(history.row_count()) - 1;
  FrameRecords with_this = frames;
  with_this.rows.push_back(row);
  const auto times = frame_times(history, with_this);
  blocks_.write(times, [&](Hdf5File& file) {
    if (simulation.moves()) write_motion(file, simulation);
    write_temperatures(file, simulation.field());
  });
  if (contacts_)
    contacts_->write(times, [&](Hdf5File& file) {
      write_contacts(file, simulation.mechanics());
      if (simulation.cracks_hinder_heat()) write_heat_of_contacts(file, simulation);
    });
  frames_.line(frame_line(history, columns_, frames.rows.size(), row));
  frames.rows.push_back(row);
}

}  // namespace pyroclast
