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

/// Returns vectors of the plane as vectors of space.
std::vector<float> vectors_in_space(const std::vector<float>& plane) {
  std::vector<float> space;
  space.reserve(plane.size() / 2 * 3);
  for (std::size_t i = 0; i < plane.size(); i += 2) space.insert(space.end(), {plane[i], plane[i + 1], 0.0F});
  return space;
}

void write_field(Hdf5File& file, const FieldInfo& field, const std::vector<float>& values, int dimension) {
  const int components = components_of(field.kind, dimension);
  if (components == 1)
    file.dataset(path_of(field), values);
  else if (components == 2)
    file.dataset(path_of(field), vectors_in_space(values), 3);
  else
    file.dataset(path_of(field), values, components);
}

/// Writes the fields of some items, the fields of one item together.
void write_fields(Hdf5File& file, const Simulation& simulation, std::initializer_list<Item> items) {
  auto fields = fields_of(simulation);
  std::erase_if(fields, [&](const Field& field) {
    return !field.in_files || std::ranges::find(items, field.item) == items.end();
  });
  for (auto first = fields.begin(); first != fields.end();) {
    const auto last =
        std::find_if(first, fields.end(), [&](const Field& f) { return f.item != first->item; });
    const auto values = values_of<float>({first, last}, simulation);
    for (auto field = first; field != last; ++field)
      write_field(file, *field, values[field - first], simulation.model().dimension());
    first = last;
  }
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
  if (!folder.empty()) write_mesh(folder, *simulation.whole());
}

std::vector<std::string> FieldFiles::lost() const {
  std::vector<std::string> names = blocks_.lost();
  if (contacts_) std::ranges::copy(contacts_->lost(), std::back_inserter(names));
  return names;
}

void FieldFiles::write(const Simulation& simulation, const History& history, FrameRows& frames) {
  const auto row = static_cast<std::int64_t>(history.row_count()) - 1;
  FrameRows with_this = frames;
  with_this.rows.push_back(row);
  const auto times = frame_times(history, with_this);
  blocks_.write(times, [&](Hdf5File& file) {
    write_fields(file, simulation, {Item::gridpoint, Item::zone});
  });
  if (contacts_)
    contacts_->write(times, [&](Hdf5File& file) {
      write_fields(file, simulation, {Item::contact_end, Item::contact});
    });
  frames_.line(frame_line(history, columns_, frames.rows.size(), row));
  frames.rows.push_back(row);
}

}  // namespace pyroclast
