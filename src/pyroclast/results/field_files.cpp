#include "pyroclast/results/field_files.hpp"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/results/history_file.hpp"
#include "pyroclast/simulation/watching/fields.hpp"
#include "pyroclast/simulation/watching/found_fields.hpp"

namespace pyroclast {

namespace {

const std::filesystem::path& created(const std::filesystem::path& folder) {
  if (!folder.empty()) std::filesystem::create_directories(folder);
  return folder;
}

/// Returns the path of a field's array, whose name is that of the field with its unit.
std::string path_of(const FieldInfo& field) {
  const bool is_of_points = field.item == Item::gridpoint || field.item == Item::contact_end;
  return fmt::format("/VTKHDF/{}/{} [{}]", is_of_points ? "PointData" : "CellData", field.name,
                     product_of(field.unit));
}

/// Writes the fields of items.
void write_fields(Hdf5File& file, const Simulation& simulation, std::initializer_list<Item> items) {
  const std::vector<Field> all = fields_of(simulation);
  const int dimension = simulation.model().dimension();
  const auto components = [&](const Field& field) { return components_of(field.kind, dimension); };
  // vectors of the plane are written as vectors of space
  const auto padding = [&](const Field& field) { return components(field) == 2 ? 1 : 0; };
  std::vector<std::vector<Field>> of_items;
  for (const Item item : items) {
    const int count = count_of(item, simulation.model());
    auto& fields = of_items.emplace_back(all);
    std::erase_if(fields, [&](const Field& field) { return !field.in_files || field.item != item; });
    for (const Field& field : fields)
      file.room<float>(path_of(field), count,
                       components(field) == 1 ? 0 : components(field) + padding(field));
  }
  file.share();
  for (const std::vector<Field>& fields : of_items) {
    const int width = width_of(fields, simulation);
    own_values_in_slices(fields, simulation, [&](std::int64_t first, const std::vector<float>& rows) {
      int column = 0;
      for (const Field& field : fields) {
        file.rows(path_of(field), first,
                  columns_of<float>(rows, width, column, components(field), padding(field)));
        column += components(field);
      }
    });
  }
}

/// Writes the points of pairs that press as lines to the middle of their overlap, with their fields.
void write_found(Hdf5File& file, const Simulation& simulation) {
  const std::vector<FoundPoint> points = simulation.motion().found_points();
  std::vector<Vec<3>> ends;
  std::vector<std::int32_t> block_a, block_b, face;
  std::vector<std::uint8_t> interface;
  for (const FoundPoint& point : points) {
    ends.insert(ends.end(), {point.position, point.middle});
    block_a.push_back(point.blocks[0]);
    block_b.push_back(point.blocks[1]);
    face.push_back(point.face);
    interface.push_back(static_cast<std::uint8_t>(point.interface));
  }
  write_lines(file, ends);
  for (const FoundField& field : found_fields()) {
    if (!field.in_files) continue;
    const auto values = values_of(field, points);
    const int components = components_of(field.kind, 3);
    file.dataset(path_of(field), columns_of<float>(values, components, 0, components, 0),
                 components == 1 ? 0 : components);
  }
  file.dataset("/VTKHDF/CellData/block_a", block_a);
  file.dataset("/VTKHDF/CellData/block_b", block_b);
  file.dataset("/VTKHDF/CellData/face", face);
  file.dataset("/VTKHDF/CellData/interface", interface);
  file.dataset("/VTKHDF/FieldData/interface_names", simulation.model().interface_names);
}

/// Columns of the history that frames.csv has, where the history has them.
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

/// Returns the text of frames.csv.
std::string text_of(const History& history, const std::vector<std::string>& columns,
                    const FrameRows& frames) {
  std::string text = fmt::format("frame,{}\n", fmt::join(columns, ","));
  for (std::size_t i = 0; i < frames.rows.size(); ++i)
    text += frame_line(history, columns, i, frames.rows[i]) + "\n";
  return text;
}

/// Returns the times of frames on a common axis, s: 0 when heating begins, and the real heating time while it
/// lasts. Before and after it, and in runs that do not heat, the time of the mechanics goes on.
std::vector<double> frame_times(const History& history, const FrameRows& frames) {
  const auto cell = [&](std::int64_t row, const char* name, double otherwise) {
    if (!history.has(name)) return otherwise;
    return history.cell(static_cast<std::size_t>(row), name).value_or(otherwise);
  };
  std::vector<double> times;
  double moved = 0.0, heated = 0.0, at_rest = 0.0,
         begun = 0.0;  // at_rest: time of the mechanics while nothing heats
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
                       const History& history, const FrameRows& frames)
    : columns_(frame_columns(history)),
      frames_(file_in(created(folder), "frames.csv"), text_of(history, columns_, frames)),
      blocks_(folder, MeshPart::blocks, simulation.model().dimension(), frame_times(history, frames)) {
  if (simulation.moves())
    contacts_.emplace(folder, MeshPart::contacts, simulation.model().dimension(),
                      frame_times(history, frames));
  if (simulation.moves() && simulation.motion().parameters().found.is_on)
    found_.emplace(folder, MeshPart::found, simulation.model().dimension(), frame_times(history, frames));
  write_mesh(folder, simulation.model());
}

std::vector<std::string> FieldFiles::lost() const {
  std::vector<std::string> names = blocks_.lost();
  for (const auto* series : {&contacts_, &found_})
    if (*series) std::ranges::copy((*series)->lost(), std::back_inserter(names));
  return names;
}

void FieldFiles::write(const Simulation& simulation, const History& history, FrameRows& frames) {
  const auto row = static_cast<std::int64_t>(history.row_count()) - 1;
  FrameRows with_this = frames;
  with_this.rows.push_back(row);
  const auto times = frame_times(history, with_this);
  Ranks& ranks = simulation.model().ranks();
  blocks_.write(times, ranks, [&](Hdf5File& file) {
    write_fields(file, simulation, {Item::gridpoint, Item::zone});
  });
  if (contacts_)
    contacts_->write(times, ranks, [&](Hdf5File& file) {
      write_fields(file, simulation, {Item::contact_end, Item::contact});
    });
  if (found_) found_->write(times, ranks, [&](Hdf5File& file) { write_found(file, simulation); });
  frames_.line(frame_line(history, columns_, frames.rows.size(), row));
  frames.rows.push_back(row);
}

}  // namespace pyroclast
