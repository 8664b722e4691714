#include "pyroclast/results/field_files.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/results/history_file.hpp"

namespace pyroclast {

namespace {

const std::filesystem::path& created(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

void append(std::vector<float>& values, const Vec<2>& v) {
  values.insert(values.end(), {static_cast<float>(v[0]), static_cast<float>(v[1]), 0.0F});
}

void write_temperatures(Hdf5File& file, const TemperatureField& field) {
  const auto& temperature = field.gridpoints();
  file.dataset("/VTKHDF/PointData/temperature", std::vector<float>(temperature.begin(), temperature.end()));
}

void write_motion(Hdf5File& file, const Mechanics<2>& mechanics) {
  std::vector<float> displacement, stress;
  displacement.reserve(3 * mechanics.model().position.size());
  stress.reserve(3 * mechanics.model().zones.size());
  for (const auto& u : mechanics.displacements()) append(displacement, u);
  for (const auto& s : mechanics.stresses())
    for (double component : s) stress.push_back(static_cast<float>(component));
  file.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  file.dataset("/VTKHDF/CellData/stress", stress, 3);
}

/// Numbers of the contacts' histories that go into files, by name, in the order of the laws; zero where a law
/// has none.
std::vector<std::string_view> remembered_names(const Mechanics<2>& mechanics) {
  std::vector<std::string_view> names;
  const LawTable* last = nullptr;
  for (int i = 0; i < mechanics.model().contact_count(); ++i) {
    const LawTable* const law = &mechanics.law_of(i);
    if (std::exchange(last, law) == law) continue;
    for (const HistoryInfo& info : law->history(2))
      if (info.in_files && std::ranges::find(names, std::string_view(info.name)) == names.end())
        names.emplace_back(info.name);
  }
  return names;
}

void write_contacts(Hdf5File& file, const Mechanics<2>& mechanics) {
  const auto& model = mechanics.model();
  const auto names = remembered_names(mechanics);
  std::vector<float> displacement, opening, tangential_jump, normal_traction, shear_traction;
  std::vector<std::vector<float>> remembered(names.size());
  displacement.reserve(6 * model.contacts.size());
  for (auto* values : {&opening, &tangential_jump, &normal_traction, &shear_traction})
    values->reserve(model.contacts.size());
  const auto u = mechanics.displacements();
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& c = model.contacts[i];
    const auto& partner = model.contacts[i ^ 1];  // the two contacts of an edge stand together
    const Vec<2> here = 0.5 * (u[c.a] + u[c.b]);
    append(displacement, here);
    append(displacement, 0.5 * (here + 0.5 * (u[partner.a] + u[partner.b])));
    const auto state = mechanics.contact(i);
    for (std::size_t n = 0; n < names.size(); ++n)
      remembered[n].push_back(static_cast<float>(state.remembered(names[n])));
    opening.push_back(static_cast<float>(state.opening));
    tangential_jump.push_back(static_cast<float>(state.tangential_jump[0]));
    normal_traction.push_back(static_cast<float>(state.normal_traction));
    shear_traction.push_back(static_cast<float>(state.shear_traction[0]));
  }
  file.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  for (std::size_t n = 0; n < names.size(); ++n)
    file.dataset(fmt::format("/VTKHDF/CellData/{}", names[n]), remembered[n]);
  file.dataset("/VTKHDF/CellData/opening", opening);
  file.dataset("/VTKHDF/CellData/tangential_jump", tangential_jump);
  file.dataset("/VTKHDF/CellData/normal_traction", normal_traction);
  file.dataset("/VTKHDF/CellData/shear_traction", shear_traction);
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

}  // namespace

FieldFiles::FieldFiles(const std::filesystem::path& folder, const Simulation& simulation,
                       const History& history, const FrameRecords& frames)
    : columns_(frame_columns(history)),
      frames_(created(folder) / "frames.csv", text_of(history, columns_, frames)),
      blocks_(folder, MeshPart::blocks, frames.times) {
  if (simulation.moves()) contacts_.emplace(folder, MeshPart::contacts, frames.times);
  write_mesh(folder, simulation.model());
}

void FieldFiles::write(const Simulation& simulation, const History& history, FrameRecords& frames) {
  const double time = simulation.moves() ? simulation.mechanics().time() : simulation.heating_time();
  blocks_.write(time, [&](Hdf5File& file) {
    if (simulation.moves()) write_motion(file, simulation.mechanics());
    write_temperatures(file, simulation.field());
  });
  if (contacts_)
    contacts_->write(time, [&](Hdf5File& file) { write_contacts(file, simulation.mechanics()); });
  const auto row = static_cast<std::int64_t>(history.row_count()) - 1;
  frames_.line(frame_line(history, columns_, frames.rows.size(), row));
  frames.rows.push_back(row);
  frames.times.push_back(time);
}

}  // namespace pyroclast
