#include "pyroclast/setup/read_stages.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"
#include "pyroclast/setup/read_frame.hpp"
#include "pyroclast/stages/exchange_stage.hpp"

namespace pyroclast {

namespace {

/// Change of the temperature between two frames, K, where the deck does not say.
constexpr double kFrameTemperature = 50.0;

OutputIntervals read_output(const Section& s, bool moves, bool has_platens, FramesInTime frames_in_time) {
  OutputIntervals output;
  s.know({"history_strain", "frame_strain", "frame_temperature", "frame_interval"});
  if (moves && has_platens) {
    output.history_strain = s.number("history_strain", Range::positive(),
                                     "strain between two rows of history.csv while compressing");
    output.frame_strain = s.number("frame_strain", Range::positive(),
                                   "strain between two frames of the fields while compressing");
  }
  if (moves) {
    output.frame_temperature = s.quantity(
        "frame_temperature", unit::temperature_difference, Range::positive(), kFrameTemperature,
        "while temperatures change: frames of the fields at its multiples, of the mean temperature");
  }
  if (frames_in_time == FramesInTime::needed ||
      (frames_in_time == FramesInTime::optional && s.has("frame_interval")))
    output.frame_interval =
        s.quantity("frame_interval", unit::time, Range::positive(),
                   "frames of the fields at its multiples, of the heating time; \"conduct\" needs this key, "
                   "\"expose\" takes it in the place of frame_temperature");
  return output;
}

/// Reads the temperature without stress; returns none after an error.
std::optional<StressFree> read_stress_free(const Section& s, const std::filesystem::path& folder,
                                           int dimension) {
  const Range range = Range::at_least(absolute_zero).usually(-30.0, 80.0);
  s.describe("stress_free",
             {.value = "temperature, or { frame = file }",
              .form = ValueForm::quantity,
              .unit = unit::temperature,
              .range = range,
              .name = "stress_free"},
             "temperature at which the body was put together, and nothing is strained: thermal strain counts "
             "from there, and the highest temperature so far is no less; without this key 20 °C");
  if (!s.is_table("stress_free"))
    return StressFree{{}, {s.quantity("stress_free", unit::temperature, range, "")}, ""};
  const Section frame = s.section("stress_free", "temperature of each gridpoint, as another run left it");
  const std::string name =
      frame.text("frame",
                 "file `blocks_<k>.hdf` of the fields of another run, with the `mesh.h5` beside it: "
                 "each gridpoint has the temperature of the nearest one there");
  if (!frame.ok()) return std::nullopt;
  const auto file = folder / name;
  frame.names_file("frame", file);
  frame.needs_file(file.parent_path() / kMeshFile);
  try {
    StressFree field = read_frame_temperatures(file, dimension);
    field.place = fmt::format("{}: coupling.stress_free.frame", frame.where("frame"));
    return field;
  } catch (const Error& error) {
    frame.error("frame", error.what());
    return std::nullopt;
  }
}

}  // namespace

ReadStages read_stages(const Section& root, const StageRegistry& kinds,
                       const std::vector<RecordParameters>& records, const DeckSpace& space,
                       const std::filesystem::path& folder) {
  std::vector<Choice<const StageKind*>> options;
  for (const StageKind& kind : kinds.kinds()) options.push_back({kind.name, &kind, Meaning(kind.meaning)});
  const auto sections =
      root.sections("stages", "the test: stages in this order; see [Stages](../understand/deck.md#stages)");
  std::vector<const StageKind*> chosen;
  for (const Section& s : sections) chosen.push_back(s.choice("kind", options, "kind of the stage"));
  const auto any = [&](auto needs) {
    return std::ranges::any_of(chosen, [&](const StageKind* kind) { return needs(kind->needs); });
  };
  // Where no stage could be read, the keys of mechanics are known at least.
  const bool moves = chosen.empty() || any([](const StageNeeds& n) { return n.mechanics; });
  FramesInTime frames_in_time = FramesInTime::none;
  for (const StageKind* kind : chosen) frames_in_time = std::max(frames_in_time, kind->needs.frames_in_time);
  StageTables tables;
  tables.has_platens = root.has("platens");
  tables.records = records;
  tables.folder = folder;
  tables.dimension = space.dimension();
  tables.has_thickness = space.shape != Shape::cylinder;
  constexpr Meaning kOutput =
      "how often rows and frames are written, both at the end of each stage too; may be left out where the "
      "deck needs none of its keys";
  const bool needs_output = (moves && tables.has_platens) || frames_in_time == FramesInTime::needed;
  tables.output =
      read_output(needs_output ? root.section("output", kOutput) : root.section_or_none("output", kOutput),
                  moves, tables.has_platens, frames_in_time);
  if (moves)
    tables.coupling_table = root.optional_section(
        "coupling",
        "how temperatures are handed to the mechanics; needed by stages that change "
        "them; see [Exchanges of temperature](../understand/deck.md#exchanges-of-temperature)");
  else
    root.know({"coupling"});
  // A body that only stands at other temperatures than it was made at exchanges none.
  const bool exchanges = any([](const StageNeeds& n) { return n.exchanges; });
  ReadStages read;
  if (tables.coupling_table && tables.coupling_table->has("stress_free"))
    read.stress_free = read_stress_free(*tables.coupling_table, folder, space.dimension());
  if (tables.coupling_table && !exchanges) {
    if (tables.coupling_table->keys() == std::vector<std::string>{"stress_free"})
      tables.coupling_table.reset();
    else
      root.warn(
          "coupling",
          fmt::format(
              "no stage exchanges temperatures with the mechanics, so nothing in the table{} has an effect",
              tables.coupling_table->has("stress_free") ? " but stress_free" : ""));
  }
  if (tables.coupling_table) tables.coupling = read_coupling(*tables.coupling_table);
  read.any_moves = moves;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    read.stages.push_back(chosen[i]->read(sections[i], tables));
    read.stages.back()->set_place(fmt::format("{}: {}", sections[i].where("kind"), sections[i].path()));
    const std::string name =
        sections[i].text("name", "", "for `resume --from-stage`; without one the kind is the name");
    read.names.push_back(name.empty() ? chosen[i]->name : name);
  }
  return read;
}

}  // namespace pyroclast
