#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/results/inputs.hpp"

namespace pyroclast {

/// A contact law that is not part of the program.
struct OwnLaw {
  std::string name;
  std::filesystem::path shared_object;
  std::filesystem::path header;  ///< that it was compiled from; may be empty
  std::string compiler;
};

/// What a run goes on from that was begun in another folder.
struct Parent {
  std::filesystem::path folder;
  std::int64_t stage = 0;            ///< the last that both have in common, from 0
  std::vector<std::string> changes;  ///< "key=value", and files of more stages
};

/// Why a run is not the one that its deck describes.
struct Departure {
  std::string why;
  /// A script did something to the run that its checkpoints do not hold: nothing but the script goes on with
  /// it.
  bool is_change = true;

  bool operator==(const Departure&) const = default;
};

/// What a run was made from.
struct Manifest {
  std::string deck_name;
  Inputs inputs;
  std::uint64_t seed = 0;
  int threads = 1;           ///< the most that the run takes
  std::string instructions;  ///< instruction set of the step
  std::string command;
  std::vector<OwnLaw> laws;
  std::optional<Parent> parent;
};

/// One folder holding everything of one run. Refused when it holds anything, unless overwriting was asked
/// for; even then only a folder with the manifest of a run is taken, and only files that a run writes are
/// removed from it.
class RunFolder {
 public:
  /// Throws Error when the folder, which this process has locked, may not be written.
  static void check(const std::filesystem::path& path, bool overwrite);
  /// Throws Error where a folder that a run writes into, or a file that it appends to, is a link.
  static void require_no_links(const std::filesystem::path& path);
  /// Throws Error when it is not the folder of a run.
  static void require(const std::filesystem::path& path);

  /// Those that the manifest has.
  static std::vector<Departure> departures(const std::filesystem::path& path);
  /// Adds one to the manifest, unless it is there.
  static void note_departure(const std::filesystem::path& path, const Departure& departure);
  /// The deck of a run that goes on with other stages, and what it names.
  static void replace_inputs(const std::filesystem::path& path, const Inputs& inputs);

  /// Puts `deck.toml`, `manifest.json` and `inputs/` into the folder, which this process has locked.
  RunFolder(std::filesystem::path path, bool overwrite, const Manifest& manifest);

  const std::filesystem::path& path() const { return path_; }
  /// Files that were in the folder and that no run writes: they are still there. Relative to it, in order.
  const std::vector<std::filesystem::path>& foreign() const { return foreign_; }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> foreign_;
};

}  // namespace pyroclast
