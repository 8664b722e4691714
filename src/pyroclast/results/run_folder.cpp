#include "pyroclast/results/run_folder.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string_view>
#include <system_error>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fnmatch.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/sha256.hpp"
#include "pyroclast/mechanics/instruction_set.hpp"
#include "pyroclast/results/publish.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";
constexpr const char* kReferences = "references.json";
constexpr const char* kProgram = "pyroclast";

/// Files that a run and `specimen` write into the folder of a run, as patterns of fnmatch(3), besides the
/// manifest. Files outlive `--overwrite` that neither these patterns nor those of drawn files and figures
/// name.
constexpr auto kWritten = std::to_array<const char*>({
    RunFolder::kDeck,
    kReferences,
    "run.json",
    "body.h5",
    "history.csv",
    "temperature_profile.csv",
    "isotherm.csv",
    "spalls.csv",
    "spalled_blocks.csv",
    "properties.csv",
    "summary.json",
    "lock",
    "run.log",
    "inputs/*",
    "checkpoints/*.state",
    "specimen/aggregates.csv",
    "specimen/gradation.csv",
    "specimen/grain_fit.csv",
    "specimen/outlines.csv",
    "specimen/stones.obj",
    "specimen/specimen.json",
    "fields/mesh.h5",
    "fields/frames.csv",
    "fields/blocks.hdf.series",
    "fields/blocks_[0-9]*.hdf",
    "fields/contacts.hdf.series",
    "fields/contacts_[0-9]*.hdf",
    "fields/found.hdf.series",
    "fields/found_[0-9]*.hdf",
});
constexpr auto kFolders =
    std::to_array<std::string_view>({"specimen", "fields", "figures", "checkpoints", "inputs"});
/// Files that grow line by line, and are written under their own names. Other files get theirs once they are
/// whole.
constexpr auto kGrowing = std::to_array<std::string_view>(
    {"history.csv", "temperature_profile.csv", "isotherm.csv", "run.log", "fields/frames.csv"});
/// Files that `figures` and `report` write besides figures. Like these they show how far a run has come.
constexpr auto kDrawn = std::to_array<const char*>({
    "report.html",
    "figures/fracture.csv",
    "figures/heating_fracture.csv",
});
/// Names of figures of a run, in any format.
constexpr auto kFigures = std::to_array<const char*>({
    "convergence",
    "cracks",
    "cracks_inside",
    "energy",
    "fracture",
    "heating_cracks",
    "heating_energy",
    "heating_fracture",
    "isotherm",
    "plane_*",
    "records",
    "spalling",
    "stress_strain",
    "temperature",
    "temperature_history",
    "temperature_profile",
    "thrust",
    "total_strain",
    "watch",
    "water",
    "water_profile",
});
/// Names of figures that are the same however far a run has come.
constexpr auto kFiguresOfInputs = std::to_array<const char*>({"gradation", "morphology", "properties"});
constexpr auto kFigureFormats = std::to_array<const char*>({"png", "svg", "pdf"});

/// Returns the name of a file, relative to its folder, without the ending of a file that was never finished.
std::string finished(const fs::path& file) {
  std::string name = file.generic_string();
  if (!name.ends_with(".partial")) return name;
  name.resize(name.size() - std::string_view(".partial").size());
  // Python puts a dot and eight hexadecimal digits before the ending, see writing.py
  constexpr std::size_t kDigits = 8;
  if (const auto end = name.find_last_not_of("0123456789abcdef");
      end != std::string::npos && name[end] == '.' && name.size() - end == kDigits + 1)
    name.resize(end);
  return name;
}

bool matches(const std::string& name, const std::string& pattern) {
  return fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0;
}

bool is_figure(const std::string& name, const auto& figures) {
  return std::ranges::any_of(figures, [&](const char* figure) {
    return std::ranges::any_of(kFigureFormats, [&](const char* format) {
      return matches(name, fmt::format("figures/{}.{}", figure, format));
    });
  });
}

/// Tells whether a file shows how far a run has come, also one that was never finished.
bool is_drawn(const fs::path& file) {
  const std::string name = finished(file);
  return std::ranges::any_of(kDrawn, [&](const char* drawn) { return matches(name, drawn); }) ||
         is_figure(name, kFigures);
}

/// Tells whether a run writes a file of this name, relative to its folder; also one that was never finished.
bool is_own(const fs::path& file) {
  const std::string name = finished(file);
  return name == kManifest || is_drawn(file) || is_figure(name, kFiguresOfInputs) ||
         std::ranges::any_of(kWritten, [&](const char* written) { return matches(name, written); });
}

/// Keys of the manifest.
constexpr const char* kDepartures = "not_reproducible_from_the_deck";
constexpr const char* kParent = "parent";
constexpr const char* kStates = "states";
constexpr const char* kBody = "body";

/// Reads the manifest of a folder; no object where there is none.
nlohmann::ordered_json manifest_of(const fs::path& folder) {
  std::ifstream file(folder / kManifest);
  return nlohmann::ordered_json::parse(file, nullptr, /*allow_exceptions=*/false);
}

nlohmann::ordered_json json_of(const std::vector<InputFile>& inputs) {
  auto json = nlohmann::ordered_json::array();
  for (const InputFile& input : inputs) {
    json.push_back(
        {{"name", input.name}, {"sha256", sha256(input.contents)}, {"source", input.source.string()}});
    if (!input.verdict.empty()) json.back()["verdict"] = input.verdict;
  }
  return json;
}

void write_inputs(const fs::path& folder, const Inputs& inputs) {
  if (!inputs.files.empty()) fs::create_directory(folder / "inputs");
  for (const InputFile& input : inputs.files) write_text_file(folder / input.name, input.contents);
  if (!inputs.references.empty()) write_text_file(folder / kReferences, inputs.references);
  write_text_file(folder / RunFolder::kDeck, inputs.deck_text);
}

std::string whole_path(const fs::path& path) {
  return fs::absolute(path).lexically_normal().string();
}

/// Tells whether a folder holds the manifest of a run, and not another program's.
bool holds_a_run(const fs::path& folder) {
  const auto manifest = manifest_of(folder);
  return manifest.is_object() && manifest.value("program", nlohmann::ordered_json()) == kProgram;
}

/// Removes the files of an earlier run except for its manifest: while that stands, the folder is known as a
/// run's. Links to folders are not followed. Returns the other files, relative to the folder.
std::vector<fs::path> remove_own_files(const fs::path& folder) {
  std::vector<fs::path> own, foreign, folders;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const fs::path name = entry.path().lexically_relative(folder);
    if (entry.is_directory() && !entry.is_symlink())
      folders.push_back(name);
    else
      (is_own(name) ? own : foreign).push_back(name);
  }
  for (const auto& name : own)
    if (name != kManifest && name != "lock") fs::remove(folder / name);
  std::error_code not_empty;
  for (const auto& name : folders)
    if (std::ranges::find(kFolders, name) != kFolders.end()) fs::remove(folder / name, not_empty);
  std::ranges::sort(foreign);
  return foreign;
}

}  // namespace

void RunFolder::check(const fs::path& path, bool overwrite, std::string_view remedy) {
  const bool holds_files = std::ranges::any_of(
      fs::directory_iterator(path), [](const auto& entry) { return entry.path().filename() != "lock"; });
  if (!holds_files) return;
  if (!overwrite) throw Error(fmt::format("{}: exists already; {}", path.string(), remedy));
  if (!holds_a_run(path))
    throw Error(fmt::format("{}: is not empty and holds no {} of a run, so it is not overwritten",
                            path.string(), kManifest));
}

void RunFolder::require_no_links(const fs::path& path) {
  const auto require = [&](std::string_view name) { require_no_link(path / name); };
  std::ranges::for_each(kFolders, require);
  std::ranges::for_each(kGrowing, require);
}

void RunFolder::require(const fs::path& path) {
  if (!fs::is_directory(path))
    throw Error(fmt::format("{}: there is no such folder of a run", path.string()));
  if (!holds_a_run(path))
    throw Error(fmt::format("{}: holds no {} of pyroclast, so it is not the folder of a run", path.string(),
                            kManifest));
}

void RunFolder::remove_drawn(const fs::path& path) {
  std::vector<fs::path> drawn;
  for (const fs::path& folder : {path, path / "figures"}) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
      const fs::path name = entry.path().lexically_relative(path);
      const bool is_unfinished = name.extension() == ".partial" && is_own(name);
      if (!entry.is_directory() && (is_drawn(name) || is_unfinished)) drawn.push_back(entry.path());
    }
  }
  for (const fs::path& file : drawn) {
    std::error_code error;
    if (!fs::remove(file, error) && error)
      throw Error(fmt::format("{}: cannot be removed ({})", file.string(), error.message()));
  }
}

std::vector<Departure> RunFolder::departures(const fs::path& path) {
  const auto manifest = manifest_of(path);
  if (!manifest.is_object() || !manifest.contains(kDepartures)) return {};
  std::vector<Departure> all;
  for (const auto& one : manifest[kDepartures]) {
    if (!one.is_object()) continue;
    // an entry of another form also tells that something was done to the run
    const auto why = one.value("why", nlohmann::ordered_json());
    all.push_back({why.is_string() ? why.get<std::string>() : why.dump(),
                   one.value("changed_by_script", nlohmann::ordered_json(true)) != false});
  }
  return all;
}

void RunFolder::note_departure(const fs::path& path, const Departure& departure) {
  const auto known = departures(path);
  if (std::ranges::find(known, departure) != known.end()) return;
  auto manifest = manifest_of(path);
  if (!manifest[kDepartures].is_array()) manifest[kDepartures] = nlohmann::ordered_json::array();
  manifest[kDepartures].push_back({{"why", departure.why}, {"changed_by_script", departure.is_change}});
  write_text_file(path / kManifest, manifest.dump(2) + "\n");
}

std::optional<BodyOfRun> RunFolder::body(const fs::path& path) {
  const auto manifest = manifest_of(path);
  if (!manifest.is_object() || !manifest.contains(kBody)) return std::nullopt;
  try {
    const auto& body = manifest[kBody];
    return BodyOfRun{body.at("folder").get<std::string>(), body.at("hash").get<std::string>()};
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: {} is no folder and hash of a body", (path / kManifest).string(), kBody));
  }
}

std::vector<StageState> RunFolder::inherited_states(const fs::path& path) {
  const auto manifest = manifest_of(path);
  const auto parent = manifest.is_object() ? manifest.value(kParent, nlohmann::ordered_json()) : manifest;
  std::vector<StageState> states;
  if (!parent.is_object() || !parent.contains(kStates)) return states;
  try {
    for (const auto& one : parent[kStates])
      states.push_back({one.at("file").get<std::string>(), one.at("inputs").get<std::string>()});
  } catch (const nlohmann::json::exception&) {
    throw Error(fmt::format("{}: {}.{} is no list of states of stages", (path / kManifest).string(), kParent,
                            kStates));
  }
  return states;
}

void RunFolder::replace_inputs(const fs::path& path, const Inputs& inputs) {
  auto manifest = manifest_of(path);
  manifest["deck_sha256"] = sha256(inputs.deck_text);
  if (!inputs.files.empty()) manifest["inputs"] = json_of(inputs.files);
  write_inputs(path, inputs);
  write_text_file(path / kManifest, manifest.dump(2) + "\n");
}

RunFolder::RunFolder(fs::path path, bool overwrite, const Manifest& manifest) : path_(std::move(path)) {
  check(path_, overwrite);
  try {
    foreign_ = remove_own_files(path_);
  } catch (const fs::filesystem_error& e) {
    throw Error(fmt::format("{}: cannot be overwritten ({})", e.path1().string(), e.code().message()));
  }
  nlohmann::ordered_json json;
  json["program"] = kProgram;
  json["version"] = kVersion;
  json["commit"] = kCommit;
  json["physics_version"] = kPhysicsVersion;
  json["command"] = manifest.command;
  json["deck"] = manifest.deck_name;
  json["deck_sha256"] = sha256(manifest.inputs.deck_text);
  if (!manifest.inputs.files.empty()) json["inputs"] = json_of(manifest.inputs.files);
  json["seed"] = manifest.seed;
  json["threads"] = manifest.threads;
  json["instructions"] = manifest.instructions;
  json["built_instructions"] = describe_built_instruction_sets();
  json["started"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  for (const OwnLaw& law : manifest.laws)
    json["laws"].push_back({{"name", law.name},
                            {"shared_object", law.shared_object.string()},
                            {"compiler", law.compiler},
                            {"header", law.header.string()}});
  if (manifest.body)
    json[kBody] = {{"folder", whole_path(manifest.body->folder)}, {"hash", manifest.body->hash}};
  if (manifest.parent) {
    json[kParent] = {{"folder", whole_path(manifest.parent->folder)},
                     {"from_stage", manifest.parent->stage},
                     {"changes", manifest.parent->changes},
                     {kStates, nlohmann::ordered_json::array()}};
    for (const StageState& state : manifest.parent->states)
      json[kParent][kStates].push_back({{"file", whole_path(state.file)}, {"inputs", state.inputs}});
  }
  write_text_file(path_ / kManifest, json.dump(2) + "\n");
  write_inputs(path_, manifest.inputs);
}

}  // namespace pyroclast
