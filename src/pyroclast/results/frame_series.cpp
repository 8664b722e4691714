#include "pyroclast/results/frame_series.hpp"

#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"
#include "pyroclast/simulation/watching/fields.hpp"

namespace pyroclast {

namespace {

constexpr std::uint8_t kVtkLine = 3, kVtkTriangle = 5, kVtkQuad = 9, kVtkTetrahedron = 10;

const char* name(MeshPart part) {
  return part == MeshPart::blocks ? "blocks" : "contacts";
}

/// Cell field that the mesh holds for all frames.
struct CellField {
  const char* name;  ///< name in mesh.h5
  const char* shown;
};

std::vector<CellField> cell_fields(MeshPart part, int dimension) {
  if (part == MeshPart::blocks) return {{"block", "block"}, {"material", "material"}, {"bearing", "bearing"}};
  const CellField extent =
      dimension == 2 ? CellField{"length", "length [m]"} : CellField{"area", "area [m2]"};
  return {{"interface", "interface"}, {"bearing", "bearing"}, extent};
}

/// Returns the name under which VTK shows the names of materials or interfaces, and the place of these names
/// in mesh.h5.
std::pair<std::string, std::string> names_of(MeshPart part) {
  if (part == MeshPart::blocks) return {"material_names", "/blocks/material_names"};
  return {"interface_names", "/contacts/interface_names"};
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

void link_mesh(Hdf5File& file, MeshPart part, int dimension) {
  const std::string grid = name(part);
  file.group("/VTKHDF");
  file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
  for (const char* array : {"Points", "Connectivity", "Offsets", "Types", "NumberOfPoints", "NumberOfCells",
                            "NumberOfConnectivityIds"})
    file.external_link(fmt::format("/VTKHDF/{}", array), kMeshFile, fmt::format("/{}/{}", grid, array));
  file.attribute("/", "needs", std::string("mesh.h5 of the same folder, which holds the mesh of this frame"));
  const auto [shown, stored] = names_of(part);
  file.group("/VTKHDF/FieldData");
  file.external_link(fmt::format("/VTKHDF/FieldData/{}", shown), kMeshFile, stored);
  file.group("/VTKHDF/PointData");
  file.group("/VTKHDF/CellData");
  for (const CellField& field : cell_fields(part, dimension))
    file.external_link(fmt::format("/VTKHDF/CellData/{}", field.shown), kMeshFile,
                       fmt::format("/{}/{}", grid, field.name));
}

void append(std::vector<double>& values, const Vec<3>& v) {
  values.insert(values.end(), v.c.begin(), v.c.end());
}

void write_blocks(Hdf5File& file, const Model& model) {
  std::vector<double> points;
  for (int g = 0; g < model.gridpoint_count(); ++g) append(points, model.place(g));
  std::vector<std::int64_t> connectivity;
  std::vector<std::int32_t> block;
  std::vector<std::uint8_t> material, bearing;
  for (int z = 0; z < model.zone_count(); ++z) {
    const auto zone = model.gridpoints_of_zone(z);
    connectivity.insert(connectivity.end(), zone.begin(), zone.end());
  }
  for (int b : zone_blocks(model)) {
    block.push_back(b);
    material.push_back(static_cast<std::uint8_t>(model.block_material[b]));
    bearing.push_back(model.is_of_bearing(b) ? 1 : 0);
  }
  write_grid(file, "/blocks", points, connectivity, model.dimension() + 1,
             model.dimension() == 2 ? kVtkTriangle : kVtkTetrahedron);
  file.dataset("/blocks/block", block);
  file.dataset("/blocks/material", material);
  file.dataset("/blocks/bearing", bearing);
  file.dataset(names_of(MeshPart::blocks).second, model.material_names);
}

void write_contacts(Hdf5File& file, const Model& model) {
  std::vector<double> points;
  std::vector<std::int64_t> connectivity;
  std::vector<std::uint8_t> interface, bearing;
  std::vector<double> extent;
  const int ends = ends_of_contact(model.dimension());
  for (int i = 0; i < model.contact_count(); ++i) {
    const Joint& c = model.joint(i);
    for (int end = 0; end < ends; ++end) {
      append(points, at_end(model, i, end, [&](int contact) { return model.place(model.joint(contact).a); }));
      connectivity.push_back(static_cast<std::int64_t>(ends) * i + end);
    }
    interface.push_back(static_cast<std::uint8_t>(c.interface));
    bearing.push_back(model.is_of_bearing(c) ? 1 : 0);
    extent.push_back(model.extent(i));
  }
  write_grid(file, "/contacts", points, connectivity, ends, model.dimension() == 2 ? kVtkLine : kVtkQuad);
  file.dataset("/contacts/interface", interface);
  file.dataset(names_of(MeshPart::contacts).second, model.interface_names);
  file.dataset("/contacts/bearing", bearing);
  file.dataset(model.dimension() == 2 ? "/contacts/length" : "/contacts/area", extent);
}

}  // namespace

void write_mesh(const std::filesystem::path& folder, const Model& model) {
  Hdf5File file(folder / kMeshFile);
  write_blocks(file, model);
  write_contacts(file, model);
  file.close();
}

void rehearse_mesh(const Model& model) {
  Hdf5File file("");
  write_blocks(file, model);
  write_contacts(file, model);
  file.close();
}

FrameSeries::FrameSeries(std::filesystem::path folder, MeshPart part, int dimension,
                         std::vector<double> times)
    : folder_(std::move(folder)), part_(part), dimension_(dimension), times_(std::move(times)) {
  if (folder_.empty()) return;
  for (int later = count(); std::filesystem::remove(folder_ / file_name(part_, later)); ++later) continue;
  if (count() > 0) write_series();
}

std::string FrameSeries::file_name(MeshPart part, int frame) {
  return fmt::format("{}_{:04}.hdf", name(part), frame);
}

std::vector<std::string> FrameSeries::lost() const {
  std::vector<std::string> names;
  for (int frame = 0; frame < count(); ++frame)
    if (const auto name = file_name(part_, frame); !folder_.empty() && !Hdf5File::is_whole(folder_ / name))
      names.push_back(name);
  return names;
}

void FrameSeries::write(std::vector<double> times, const std::function<void(Hdf5File&)>& fields) {
  Hdf5File file(file_in(folder_, file_name(part_, count())));
  link_mesh(file, part_, dimension_);
  fields(file);
  file.close();
  times_ = std::move(times);
  write_series();
}

void FrameSeries::write_series() const {
  nlohmann::ordered_json series;
  series["file-series-version"] = "1.0";
  for (int i = 0; i < count(); ++i)
    series["files"].push_back({{"name", file_name(part_, i)}, {"time", times_[i]}});
  write_text_file(file_in(folder_, fmt::format("{}.hdf.series", name(part_))), series.dump(1) + "\n");
}

}  // namespace pyroclast
