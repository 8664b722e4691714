#include "pyroclast/results/frame_series.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/text_file.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"
#include "pyroclast/simulation/watching/items.hpp"

namespace pyroclast {

namespace {

constexpr std::uint8_t kVtkLine = 3, kVtkTriangle = 5, kVtkQuad = 9, kVtkTetrahedron = 10;

const char* name(MeshPart part) {
  return part == MeshPart::blocks ? "blocks" : part == MeshPart::contacts ? "contacts" : "found";
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

/// Writes a dataset of one number a row, which follows from the number of the row.
template <class Number, class Of>
void write_sequence(Hdf5File& file, const std::string& name, std::int64_t rows, Of of) {
  constexpr std::int64_t kRows = 1 << 18;  // at a time
  file.room<Number>(name, rows);
  for (std::int64_t first = 0; first < rows; first += kRows) {
    std::vector<Number> numbers;
    for (std::int64_t row = first; row < std::min(rows, first + kRows); ++row) numbers.push_back(of(row));
    file.rows(name, first, numbers);
  }
}

/// Makes room for a grid, and writes what follows from the numbers of its points and cells.
void begin_grid(Hdf5File& file, const std::string& group, std::int64_t points, std::int64_t cells,
                int corners, std::uint8_t type) {
  file.group(group);
  file.room<double>(group + "/Points", points, 3);
  write_sequence<std::int64_t>(file, group + "/Offsets", cells + 1,
                               [&](std::int64_t cell) { return cell * corners; });
  write_sequence<std::uint8_t>(file, group + "/Types", cells, [&](std::int64_t) { return type; });
  file.dataset(group + "/NumberOfPoints", std::vector{points});
  file.dataset(group + "/NumberOfCells", std::vector{cells});
  file.dataset(group + "/NumberOfConnectivityIds", std::vector{cells * corners});
}

/// Writes the points of a grid.
/// \param place  returns the place of an item, m
template <class Place>
void write_points(Hdf5File& file, const std::string& group, Item item, const Model& model, Place place) {
  in_own_slices<double>(
      item, model, 3, [&](int i, double* row) { std::ranges::copy(place(i).c, row); },
      [&](std::int64_t first, const std::vector<double>& rows) {
        file.rows(group + "/Points", first, rows);
      });
}

/// Tells VTK what the file is.
void tell_type(Hdf5File& file) {
  file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{1, 0});
  file.attribute("/VTKHDF", "Type", std::string("UnstructuredGrid"));
}

void link_mesh(Hdf5File& file, MeshPart part, int dimension) {
  const std::string grid = name(part);
  file.group("/VTKHDF");
  tell_type(file);
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

void write_blocks(Hdf5File& file, const Model& model) {
  const int corners = model.dimension() + 1, zones = count_of(Item::zone, model);
  begin_grid(file, "/blocks", count_of(Item::gridpoint, model), zones, corners,
             model.dimension() == 2 ? kVtkTriangle : kVtkTetrahedron);
  file.room<std::int64_t>("/blocks/Connectivity", std::int64_t{zones} * corners);
  file.room<std::int32_t>("/blocks/block", zones);
  file.room<std::uint8_t>("/blocks/material", zones);
  file.room<std::uint8_t>("/blocks/bearing", zones);
  file.dataset(names_of(MeshPart::blocks).second, model.material_names);
  file.share();
  write_points(file, "/blocks", Item::gridpoint, model,
               [&](int gridpoint) { return model.place(gridpoint); });
  const std::vector<int> block_of = zone_blocks(model);
  const int width = corners + 3;
  in_own_slices<double>(
      Item::zone, model, width,
      [&](int zone, double* row) {
        for (const int g : model.gridpoints_of_zone(zone)) *row++ = model.part ? model.part->gridpoint[g] : g;
        const int block = block_of[zone];
        *row++ = model.part ? model.part->block[block] : block;
        *row++ = model.block_material[block];
        *row++ = model.is_of_bearing(block) ? 1 : 0;
      },
      [&](std::int64_t first, const std::vector<double>& rows) {
        file.rows("/blocks/Connectivity", first * corners, columns_of<std::int64_t>(rows, width, 0, corners));
        file.rows("/blocks/block", first, columns_of<std::int32_t>(rows, width, corners));
        file.rows("/blocks/material", first, columns_of<std::uint8_t>(rows, width, corners + 1));
        file.rows("/blocks/bearing", first, columns_of<std::uint8_t>(rows, width, corners + 2));
      });
}

void write_contacts(Hdf5File& file, const Model& model) {
  const bool is_plane = model.dimension() == 2;
  const int ends = ends_of_contact(model.dimension()), contacts = count_of(Item::contact, model);
  const std::int64_t points = std::int64_t{ends} * contacts;
  begin_grid(file, "/contacts", points, contacts, ends, is_plane ? kVtkLine : kVtkQuad);
  write_sequence<std::int64_t>(file, "/contacts/Connectivity", points, [](std::int64_t end) { return end; });
  const char* const extent = is_plane ? "/contacts/length" : "/contacts/area";
  file.room<std::uint8_t>("/contacts/interface", contacts);
  file.dataset(names_of(MeshPart::contacts).second, model.interface_names);
  file.room<std::uint8_t>("/contacts/bearing", contacts);
  file.room<double>(extent, contacts);
  file.share();
  write_points(file, "/contacts", Item::contact_end, model, [&](int end) {
    return at_end(model, end / ends, end % ends,
                  [&](int contact) { return model.place(model.joint(contact).a); });
  });
  constexpr int kWidth = 3;
  in_own_slices<double>(
      Item::contact, model, kWidth,
      [&](int contact, double* row) {
        const Joint& c = model.joint(contact);
        *row++ = c.interface;
        *row++ = model.is_of_bearing(c) ? 1 : 0;
        *row++ = model.extent(contact);
      },
      [&](std::int64_t first, const std::vector<double>& rows) {
        file.rows("/contacts/interface", first, columns_of<std::uint8_t>(rows, kWidth, 0));
        file.rows("/contacts/bearing", first, columns_of<std::uint8_t>(rows, kWidth, 1));
        file.rows(extent, first, columns_of<double>(rows, kWidth, 2));
      });
}

}  // namespace

void write_lines(Hdf5File& file, const std::vector<Vec<3>>& points) {
  const auto count = static_cast<std::int64_t>(points.size());
  begin_grid(file, "/VTKHDF", count, count / 2, 2, kVtkLine);
  tell_type(file);
  std::vector<double> rows;
  for (const Vec<3>& point : points) rows.insert(rows.end(), point.c.begin(), point.c.end());
  file.rows("/VTKHDF/Points", 0, rows);
  write_sequence<std::int64_t>(file, "/VTKHDF/Connectivity", count, [](std::int64_t end) { return end; });
  file.group("/VTKHDF/FieldData");
  file.group("/VTKHDF/PointData");
  file.group("/VTKHDF/CellData");
}

void write_mesh(const std::filesystem::path& folder, const Model& model) {
  Hdf5File file(file_in(folder, kMeshFile), model.ranks());
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

void FrameSeries::write(std::vector<double> times, Ranks& ranks,
                        const std::function<void(Hdf5File&)>& fields) {
  Hdf5File file(file_in(folder_, file_name(part_, count())), ranks);
  if (part_ != MeshPart::found) link_mesh(file, part_, dimension_);
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
