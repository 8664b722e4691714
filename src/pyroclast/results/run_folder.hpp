#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/results/body_file.hpp"
#include "pyroclast/results/inputs.hpp"

namespace pyroclast {

/// Contact law that is not part of the program.
struct OwnLaw {
  std::string name;
  std::filesystem::path shared_object;
  std::filesystem::path header;  ///< header from which the law was compiled; may be empty
  std::string compiler;
};

/// State at the end of a stage, in the folder of the run that computed the stage.
struct StageState {
  std::filesystem::path file;
  std::string inputs;  ///< hash of that run's inputs, see CheckpointInfo
};

/// Run in another folder from which this run goes on.
struct Parent {
  std::filesystem::path folder;
  std::int64_t stage = 0;            ///< last stage that both have in common, from 0
  std::vector<std::string> changes;  ///< changes, "key=value", and files of more stages
  std::vector<StageState> states;    ///< states of the common stages that are over, from stage 0 on
};

/// Departure: a reason why a run is not the one that its deck describes.
struct Departure {
  std::string why;
  /// True where a script changed the run in a way that its checkpoints do not hold: only the script can go on
  /// with the run.
  bool is_change = true;

  bool operator==(const Departure&) const = default;
};

/// Record of everything from which a run was made.
struct Manifest {
  std::string deck_name;
  Inputs inputs;
  std::uint64_t seed = 0;
  int threads = 1;           ///< most threads of the run
  std::string instructions;  ///< instruction set of the step
  std::string command;
  std::vector<OwnLaw> laws;
  std::optional<Parent> parent;
  std::optional<BodyOfRun> body = {};  ///< body that was made before
};

/// What to do about a folder that exists, by options of the program.
inline constexpr std::string_view kOtherFolder = "choose another folder with --out, or --overwrite it";

/// Folder that holds everything of one run. A folder that is not empty is refused, unless overwriting was
/// asked for. Even then it must have the manifest of a run, and only files that a run writes are removed from
/// it.
class RunFolder {
 public:
  /// Name of the file with the deck of the run, as it was run.
  static constexpr const char* kDeck = "deck.toml";

  /// Throws Error when the folder, which this process has locked, may not be written.
  /// \param remedy  what to do about a folder that exists, in words that the user can follow
  static void check(const std::filesystem::path& path, bool overwrite,
                    std::string_view remedy = kOtherFolder);
  /// Throws Error where a folder into which a run writes, or a file to which it appends, is a link.
  static void require_no_links(const std::filesystem::path& path);
  /// Removes the figures of a run, its page and the tables that come with them, which show how far the run
  /// had come; also files in these places that were never finished. Throws Error naming the file that cannot
  /// go.
  static void remove_drawn(const std::filesystem::path& path);
  /// Throws Error when the path is not the folder of a run.
  static void require(const std::filesystem::path& path);

  /// Returns the departures in the manifest.
  static std::vector<Departure> departures(const std::filesystem::path& path);
  /// Adds a departure to the manifest, unless it is there.
  static void note_departure(const std::filesystem::path& path, const Departure& departure);
  /// Returns the body of a run that did not make one; empty where the run made its own.
  static std::optional<BodyOfRun> body(const std::filesystem::path& path);
  /// Returns the states of stages that a fork did not compute itself, from stage 0 on.
  static std::vector<StageState> inherited_states(const std::filesystem::path& path);
  /// Replaces the deck of a run that goes on with other stages, and the files that the deck names.
  static void replace_inputs(const std::filesystem::path& path, const Inputs& inputs);

  /// Writes `deck.toml`, `manifest.json` and `inputs/` into the folder, which this process has locked.
  RunFolder(std::filesystem::path path, bool overwrite, const Manifest& manifest);

  const std::filesystem::path& path() const { return path_; }
  /// Returns the files that were in the folder, that no run writes and that are still there: relative to the
  /// folder, in order.
  const std::vector<std::filesystem::path>& foreign() const { return foreign_; }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> foreign_;
};

}  // namespace pyroclast
