#include "pyroclast/results/run_folder.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/types.h>
// libmd's header needs sys/types.h before it
#include <array>
#include <chrono>

#include <nlohmann/json.hpp>
#include <sha256.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr const char* kManifest = "manifest.json";

/// The first folder on the way to `path` that does not exist.
fs::path first_missing(fs::path path) {
  path = fs::absolute(path).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();
  while (!fs::exists(path.parent_path())) path = path.parent_path();
  return path;
}

}  // namespace

std::string sha256(const std::string& text) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> digest{};
  SHA256Data(reinterpret_cast<const std::uint8_t*>(text.data()), text.size(), digest.data());
  return digest.data();
}

void RunFolder::check(const fs::path& path, bool overwrite) {
  if (fs::exists(path)) {
    if (!fs::is_directory(path)) throw Error(fmt::format("{}: exists and is not a folder", path.string()));
    if (fs::is_empty(path)) return;
    if (!overwrite)
      throw Error(fmt::format("{}: exists already; choose another folder with --out, or --overwrite it",
                              path.string()));
    if (!fs::exists(path / kManifest))
      throw Error(fmt::format("{}: is not empty and holds no {} of a run, so it is not overwritten",
                              path.string(), kManifest));
    return;
  }
  // Making it and taking it away again is the only test that knows every file system.
  const fs::path first = first_missing(path);
  std::error_code error;
  fs::create_directories(path, error);
  std::error_code ignored;
  if (fs::exists(first, ignored)) fs::remove_all(first, ignored);
  if (error) throw Error(fmt::format("{}: cannot be made ({})", path.string(), error.message()));
}

RunFolder::RunFolder(fs::path path, bool overwrite, const Manifest& manifest) : path_(std::move(path)) {
  check(path_, overwrite);
  try {
    if (fs::exists(path_))
      for (const auto& entry : fs::directory_iterator(path_)) fs::remove_all(entry);
    fs::create_directories(path_);
  } catch (const fs::filesystem_error& e) {
    throw Error(fmt::format("{}: cannot be made ({})", path_.string(), e.code().message()));
  }
  nlohmann::ordered_json json;
  json["program"] = "pyroclast";
  json["version"] = kVersion;
  json["commit"] = kCommit;
  json["command"] = manifest.command;
  json["deck"] = manifest.deck_name;
  json["deck_sha256"] = sha256(manifest.deck_text);
  json["seed"] = manifest.seed;
  json["threads"] = manifest.threads;
  json["instructions"] = manifest.instructions;
  json["started"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()));
  write_text_file(path_ / kManifest, json.dump(2) + "\n");
  write_text_file(path_ / "deck.toml", manifest.deck_text);
}

}  // namespace pyroclast
