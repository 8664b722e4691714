#include "pyroclast/results/field_files.hpp"

#include <vector>

#include <fmt/format.h>

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
  displacement.reserve(3 * mechanics.displacements().size());
  stress.reserve(3 * mechanics.stresses().size());
  for (const auto& u : mechanics.displacements()) append(displacement, u);
  for (const auto& s : mechanics.stresses())
    for (double component : s) stress.push_back(static_cast<float>(component));
  file.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  file.dataset("/VTKHDF/CellData/stress", stress, 3);
}

void write_contacts(Hdf5File& file, const Mechanics<2>& mechanics) {
  const auto& model = mechanics.model();
  std::vector<float> displacement, tension, shear, opening, slip, normal_traction, shear_traction, closure;
  displacement.reserve(6 * model.contacts.size());
  for (auto* values : {&tension, &shear, &opening, &slip, &normal_traction, &shear_traction, &closure})
    values->reserve(model.contacts.size());
  const auto u = mechanics.displacements();
  for (int i = 0; i < model.contact_count(); ++i) {
    const auto& c = model.contacts[i];
    const auto& partner = model.contacts[i ^ 1];  // the two contacts of an edge stand together
    const Vec<2> here = 0.5 * (u[c.a] + u[c.b]);
    append(displacement, here);
    append(displacement, 0.5 * (here + 0.5 * (u[partner.a] + u[partner.b])));
    const auto state = mechanics.contact(i);
    tension.push_back(static_cast<float>(state.history.tension_damage));
    shear.push_back(static_cast<float>(state.history.shear_damage));
    closure.push_back(static_cast<float>(state.history.closure));
    opening.push_back(static_cast<float>(state.opening));
    slip.push_back(static_cast<float>(state.tangential_jump[0]));
    normal_traction.push_back(static_cast<float>(state.normal_traction));
    shear_traction.push_back(static_cast<float>(state.shear_traction[0]));
  }
  file.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  file.dataset("/VTKHDF/CellData/tension_damage", tension);
  file.dataset("/VTKHDF/CellData/shear_damage", shear);
  file.dataset("/VTKHDF/CellData/opening", opening);
  file.dataset("/VTKHDF/CellData/slip", slip);
  file.dataset("/VTKHDF/CellData/normal_traction", normal_traction);
  file.dataset("/VTKHDF/CellData/shear_traction", shear_traction);
  file.dataset("/VTKHDF/CellData/closure", closure);
}

}  // namespace

FieldFiles::FieldFiles(const std::filesystem::path& folder, const Model<2>& model)
    : frames_(created(folder) / "frames.csv"),
      blocks_(folder, MeshPart::blocks),
      contacts_(folder, MeshPart::contacts) {
  frames_.line("frame,stage,step,time_s,strain,stress_MPa,temperature_degC,heating_time_s");
  write_mesh(folder, model);
}

void FieldFiles::write(const Experiment& experiment, const Sample& sample) {
  const int frame = blocks_.count();
  const auto& mechanics = experiment.mechanics();
  blocks_.write(sample.time, [&](Hdf5File& file) {
    write_motion(file, mechanics);
    write_temperatures(file, experiment.field());
  });
  contacts_.write(sample.time, [&](Hdf5File& file) { write_contacts(file, mechanics); });
  frames_.line(fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", frame, sample.stage, sample.step,
                           sample.time, sample.strain, sample.stress() * 1e-6, sample.heat.mean,
                           sample.heat.time));
}

HeatFieldFiles::HeatFieldFiles(const std::filesystem::path& folder, const Model<2>& model)
    : frames_(created(folder) / "frames.csv"), blocks_(folder, MeshPart::blocks) {
  frames_.line("frame,time_s,temperature_degC");
  write_mesh(folder, model);
}

void HeatFieldFiles::write(const TemperatureField& field) {
  const int frame = blocks_.count();
  blocks_.write(field.time(), [&](Hdf5File& file) { write_temperatures(file, field); });
  frames_.line(fmt::format("{},{:.9g},{:.9g}", frame, field.time(), field.mean()));
}

}  // namespace pyroclast
