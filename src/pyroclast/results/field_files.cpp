#include "pyroclast/results/field_files.hpp"

#include <cstdint>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/hdf5_file.hpp"

namespace pyroclast {

namespace {

constexpr std::uint8_t kVtkLine = 3;
constexpr std::uint8_t kVtkTriangle = 5;

std::filesystem::path with_folder(std::filesystem::path folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

void write_grid(Hdf5File& file, const std::string& group, const std::vector<double>& points,
                const std::vector<std::int64_t>& connectivity, int corners, std::uint8_t type) {
  const auto cells = static_cast<std::int64_t>(connectivity.size()) / corners;
  std::vector<std::int64_t> offsets;
  for (std::int64_t i = 0; i <= cells; ++i) offsets.push_back(i * corners);
  file.group(group);
  file.dataset(group + "/Points", points, 3);
  file.dataset(group + "/Connectivity", connectivity);
  file.dataset(group + "/Offsets", offsets);
  file.dataset(group + "/Types", std::vector<std::uint8_t>(static_cast<std::size_t>(cells), type));
  file.dataset(group + "/NumberOfPoints",
               std::vector<std::int64_t>{static_cast<std::int64_t>(points.size()) / 3});
  file.dataset(group + "/NumberOfCells", std::vector<std::int64_t>{cells});
  file.dataset(group + "/NumberOfConnectivityIds",
               std::vector<std::int64_t>{static_cast<std::int64_t>(connectivity.size())});
}

void link_grid(Hdf5File& file, const std::string& grid, std::initializer_list<const char*> cell_fields) {
  file.group("/VTKHDF");
  file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
  for (const char* part : {"Points", "Connectivity", "Offsets", "Types", "NumberOfPoints", "NumberOfCells",
                           "NumberOfConnectivityIds"})
    file.external_link(fmt::format("/VTKHDF/{}", part), "mesh.h5", fmt::format("/{}/{}", grid, part));
  file.group("/VTKHDF/PointData");
  file.group("/VTKHDF/CellData");
  for (const char* field : cell_fields)
    file.external_link(fmt::format("/VTKHDF/CellData/{}", field), "mesh.h5",
                       fmt::format("/{}/{}", grid, field));
}

void append(std::vector<double>& values, const Vec<2>& v) {
  values.insert(values.end(), {v[0], v[1], 0.0});
}
void append(std::vector<float>& values, const Vec<2>& v) {
  values.insert(values.end(), {static_cast<float>(v[0]), static_cast<float>(v[1]), 0.0F});
}

}  // namespace

FieldFiles::FieldFiles(std::filesystem::path folder, const Model<2>& model)
    : folder_(with_folder(std::move(folder))), frames_(folder_ / "frames.csv") {
  frames_.line("frame,stage,step,time_s,strain,stress_MPa,temperature_degC,heating_time_s");
  write_mesh(model);
}

void FieldFiles::write_mesh(const Model<2>& model) const {
  Hdf5File file(folder_ / "mesh.h5");
  std::vector<double> points;
  for (const auto& x : model.position) append(points, x);
  std::vector<std::int64_t> connectivity;
  std::vector<std::int32_t> block;
  std::vector<std::uint8_t> material;
  for (const auto& zone : model.zones) connectivity.insert(connectivity.end(), zone.begin(), zone.end());
  for (int b : zone_blocks(model)) {
    block.push_back(b);
    material.push_back(static_cast<std::uint8_t>(model.block_material[b]));
  }
  write_grid(file, "/blocks", points, connectivity, 3, kVtkTriangle);
  file.dataset("/blocks/block", block);
  file.dataset("/blocks/material", material);

  points.clear();
  connectivity.clear();
  std::vector<std::uint8_t> interface;
  std::vector<double> length;
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    const auto& c = model.contacts[i];
    const auto& partner = model.contacts[i ^ 1];  // the two contacts of an edge stand together
    append(points, model.position[c.a]);
    append(points, 0.5 * (model.position[c.a] + model.position[partner.a]));
    connectivity.insert(connectivity.end(),
                        {static_cast<std::int64_t>(2 * i), static_cast<std::int64_t>(2 * i + 1)});
    interface.push_back(static_cast<std::uint8_t>(c.interface));
    length.push_back(c.area / model.thickness);
  }
  write_grid(file, "/contacts", points, connectivity, 2, kVtkLine);
  file.dataset("/contacts/interface", interface);
  file.dataset("/contacts/length", length);
  file.close();
}

void FieldFiles::write(const Experiment& experiment, const Sample& sample) {
  const auto& mechanics = experiment.mechanics();
  const auto& model = mechanics.model();
  const int frame = frame_count();

  Hdf5File blocks(folder_ / fmt::format("blocks_{:04}.hdf", frame));
  link_grid(blocks, "blocks", {"block", "material"});
  std::vector<float> displacement, stress;
  for (const auto& u : mechanics.displacement()) append(displacement, u);
  for (const auto& s : mechanics.stress())
    for (double component : s) stress.push_back(static_cast<float>(component));
  blocks.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  blocks.dataset("/VTKHDF/CellData/stress", stress, 3);
  const auto& temperature = experiment.field().gridpoints();
  blocks.dataset("/VTKHDF/PointData/temperature", std::vector<float>(temperature.begin(), temperature.end()));
  blocks.close();

  Hdf5File contacts(folder_ / fmt::format("contacts_{:04}.hdf", frame));
  link_grid(contacts, "contacts", {"interface", "length"});
  displacement.clear();
  std::vector<float> tension, shear, opening, slip, normal_traction, shear_traction, closure;
  for (std::size_t i = 0; i < model.contacts.size(); ++i) {
    const auto& c = model.contacts[i];
    const auto& partner = model.contacts[i ^ 1];
    const auto& u = mechanics.displacement();
    const Vec<2> here = 0.5 * (u[c.a] + u[c.b]);
    append(displacement, here);
    append(displacement, 0.5 * (here + 0.5 * (u[partner.a] + u[partner.b])));
    const auto& state = mechanics.contacts()[i];
    tension.push_back(static_cast<float>(state.history.tension_damage));
    shear.push_back(static_cast<float>(state.history.shear_damage));
    closure.push_back(static_cast<float>(state.history.closure));
    opening.push_back(static_cast<float>(state.opening));
    slip.push_back(static_cast<float>(state.tangential_jump[0]));
    normal_traction.push_back(static_cast<float>(state.normal_traction));
    shear_traction.push_back(static_cast<float>(state.shear_traction[0]));
  }
  contacts.dataset("/VTKHDF/PointData/displacement", displacement, 3);
  contacts.dataset("/VTKHDF/CellData/tension_damage", tension);
  contacts.dataset("/VTKHDF/CellData/shear_damage", shear);
  contacts.dataset("/VTKHDF/CellData/opening", opening);
  contacts.dataset("/VTKHDF/CellData/slip", slip);
  contacts.dataset("/VTKHDF/CellData/normal_traction", normal_traction);
  contacts.dataset("/VTKHDF/CellData/shear_traction", shear_traction);
  contacts.dataset("/VTKHDF/CellData/closure", closure);
  contacts.close();

  times_.push_back(sample.time);
  frames_.line(fmt::format("{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", frame, sample.stage, sample.step,
                           sample.time, sample.strain, sample.stress() * 1e-6, sample.heat.mean,
                           sample.heat.time));
  write_series("blocks");
  write_series("contacts");
}

void FieldFiles::write_series(const std::string& kind) const {
  nlohmann::ordered_json series;
  series["file-series-version"] = "1.0";
  for (int i = 0; i < frame_count(); ++i)
    series["files"].push_back({{"name", fmt::format("{}_{:04}.hdf", kind, i)}, {"time", times_[i]}});
  write_text_file(folder_ / (kind + ".hdf.series"), series.dump(1) + "\n");
}

}  // namespace pyroclast
