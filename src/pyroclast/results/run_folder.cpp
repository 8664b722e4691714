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
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";
constexpr const char* kProgram = "pyroclast";

/// All that a run, `specimen` and `figures` write into the folder of a run, as patterns of fnmatch(3),
/// besides the manifest. What is not here outlives `--overwrite`.
constexpr auto kWritten = std::to_array<const char*>({
    "deck.toml",
    "history.csv",
    "summary.json",
    "laws/*",
    "specimen/aggregates.csv",
    "specimen/gradation.csv",
    "specimen/specimen.json",
    "fields/mesh.h5",
    "fields/frames.csv",
    "fields/blocks.hdf.series",
    "fields/blocks_[0-9]*.hdf",
    "fields/contacts.hdf.series",
    "fields/contacts_[0-9]*.hdf",
});
/// Names of figures, in any format.
constexpr auto kFigures = std::to_array<const char*>({
    "convergence",
    "cracks",
    "energy",
    "fracture",
    "gradation",
    "heating_cracks",
    "heating_energy",
    "heating_fracture",
    "morphology",
    "stress_strain",
    "temperature",
    "temperature_history",
    "thrust",
    "total_strain",
});
constexpr auto kFigureFormats = std::to_array<const char*>({"png", "svg", "pdf"});

/// Whether a run writes a file of this name, relative to its folder; also one that was never finished.
bool is_own(const fs::path& file) {
  std::string name = file.generic_string();
  if (name.ends_with(".partial")) name.resize(name.size() - std::string_view(".partial").size());
  const auto matches = [&](const std::string& pattern) {
    return fnmatch(pattern.c_str(), name.c_str(), FNM_PATHNAME) == 0;
  };
  if (name == kManifest || std::ranges::any_of(kWritten, matches)) return true;
  return std::ranges::any_of(kFigures, [&](const char* figure) {
    return std::ranges::any_of(kFigureFormats, [&](const char* format) {
      return matches(fmt::format("figures/{}.{}", figure, format));
    });
  });
}

/// Whether a folder holds the manifest of a run, and not another program's.
bool holds_a_run(const fs::path& folder) {
  std::ifstream file(folder / kManifest);
  const auto manifest = nlohmann::json::parse(file, nullptr, /*allow_exceptions=*/false);
  return manifest.is_object() && manifest.value("program", nlohmann::json()) == kProgram;
}

/// Removes what an earlier run wrote, except for its manifest: while that stands, the folder is known as a
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
    if (name != kManifest) fs::remove(folder / name);
  std::error_code not_empty;
  for (const auto& name : folders)
    if (name == "specimen" || name == "fields" || name == "figures") fs::remove(folder / name, not_empty);
  std::ranges::sort(foreign);
  return foreign;
}

/// Makes a folder and those above it that are missing; appends to `made` those that were not there.
std::error_code make_folders(const fs::path& path, std::vector<fs::path>& made) {
  // A folder above may go between two calls: another run was only checking, too.
  constexpr int kAttempts = 10;
  std::error_code error;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) return {};
    if (fs::exists(status)) return std::make_error_code(std::errc::not_a_directory);
    const fs::path parent = path.parent_path();
    if (parent != path)
      if (const auto above = make_folders(parent, made)) return above;
    if (fs::create_directory(path, error)) made.push_back(path);
    if (error != std::errc::no_such_file_or_directory) return error;
  }
  return error;
}

/// As `make_folders` needs it: absolute, without dots and a slash at the end.
fs::path plain(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

}  // namespace

void RunFolder::check(const fs::path& path, bool overwrite) {
  if (fs::exists(path)) {
    if (!fs::is_directory(path)) throw Error(fmt::format("{}: exists and is not a folder", path.string()));
    if (fs::is_empty(path)) return;
    if (!overwrite)
      throw Error(fmt::format("{}: exists already; choose another folder with --out, or --overwrite it",
                              path.string()));
    if (!holds_a_run(path))
      throw Error(fmt::format("{}: is not empty and holds no {} of a run, so it is not overwritten",
                              path.string(), kManifest));
    return;
  }
  // Making it and taking it away again is the only test that knows every file system. Another run may have
  // begun in a folder above meanwhile; that one is not empty then, and stays.
  std::vector<fs::path> made;
  const std::error_code error = make_folders(plain(path), made);
  std::error_code not_empty;
  for (auto folder = made.rbegin(); folder != made.rend(); ++folder) fs::remove(*folder, not_empty);
  if (error) throw Error(fmt::format("{}: cannot be made ({})", path.string(), error.message()));
}

RunFolder::RunFolder(fs::path path, bool overwrite, const Manifest& manifest) : path_(std::move(path)) {
  check(path_, overwrite);
  try {
    if (fs::exists(path_)) foreign_ = remove_own_files(path_);
  } catch (const fs::filesystem_error& e) {
    throw Error(fmt::format("{}: cannot be overwritten ({})", e.path1().string(), e.code().message()));
  }
  std::vector<fs::path> made;
  if (const std::error_code error = make_folders(plain(path_), made))
    throw Error(fmt::format("{}: cannot be made ({})", path_.string(), error.message()));
  nlohmann::ordered_json json;
  json["program"] = kProgram;
  json["version"] = kVersion;
  json["commit"] = kCommit;
  json["physics_version"] = kPhysicsVersion;
  json["command"] = manifest.command;
  json["deck"] = manifest.deck_name;
  json["deck_sha256"] = sha256(manifest.deck_text);
  json["seed"] = manifest.seed;
  json["threads"] = manifest.threads;
  json["instructions"] = manifest.instructions;
  json["started"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  for (const OwnLaw& law : manifest.laws)
    json["laws"].push_back({{"name", law.name},
                            {"shared_object", law.shared_object.string()},
                            {"compiler", law.compiler},
                            {"header", law.header.string()}});
  write_text_file(path_ / kManifest, json.dump(2) + "\n");
  write_text_file(path_ / "deck.toml", manifest.deck_text);
  for (const OwnLaw& law : manifest.laws)
    if (!law.header.empty()) {
      fs::create_directory(path_ / "laws");
      write_text_file(path_ / "laws" / law.header.filename(), law.header_text);
    }
}

}  // namespace pyroclast
