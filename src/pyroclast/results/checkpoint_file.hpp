#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// What a checkpoint says of itself, for those who choose between some and for messages.
struct CheckpointInfo {
  std::int64_t number = 0;  ///< in the order in which a run writes them, from 1
  std::string version;      ///< of pyroclast
  std::string commit;
  int physics_version = 0;
  std::string inputs;                    ///< hash of all that the run is made from
  std::string body;                      ///< hash of model and laws, as they were made of it
  std::vector<std::string> stage_kinds;  ///< of all stages
  std::int64_t stage = 0;                ///< from 0
  bool stage_is_over = false;
  std::int64_t step = 0;        ///< of the mechanics
  double wall_time = 0.0;       ///< of the run so far, s
  std::uint64_t log_bytes = 0;  ///< length of the run's log then

  /// Shows each entry of an info by its name in the file.
  template <class Info, class F>
  static void each(Info& info, F&& f) {
    f("number", info.number);
    f("version", info.version);
    f("commit", info.commit);
    f("physics_version", info.physics_version);
    f("inputs", info.inputs);
    f("body", info.body);
    f("stage_kinds", info.stage_kinds);
    f("stage", info.stage);
    f("stage_is_over", info.stage_is_over);
    f("step", info.step);
    f("wall_time", info.wall_time);
    f("log_bytes", info.log_bytes);
  }
};

/// Writes a checkpoint: whole under its name and on disk, or not at all. Throws Error when it cannot be
/// written.
///
///     "pyroclas"  pieces of plain data, one after the other  table of the pieces and the info (JSON)
///     where the table begins, its length, its hash (XXH3), "t-state1"
///
/// The table has name, place, size and hash (XXH3) of each piece. Numbers are as the processor has them,
/// little end first. \param visit  shows all that there is \return its length, bytes
std::uint64_t write_checkpoint(const std::filesystem::path& path, const CheckpointInfo& info,
                               const std::function<void(StateVisitor&)>& visit);

/// A checkpoint to be read. All errors are Errors that name the file and what is wrong.
class CheckpointFile {
 public:
  /// Reads the info. Throws Error when the file is cut short, damaged there, or none of this program.
  explicit CheckpointFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  const CheckpointInfo& info() const { return info_; }

  /// Replaces all that is shown by what the file holds. Throws Error when a piece is damaged, or of another
  /// size, or when the file lacks one, or holds one that is not asked for.
  void restore(const std::function<void(StateVisitor&)>& visit) const;
  /// Reads all pieces and compares their hashes. Throws Error for the first that is damaged.
  void verify() const;

 private:
  friend class CheckpointReader;
  struct Piece {
    std::uint64_t begin = 0, item = 0, count = 0, hash = 0;
    std::uint64_t bytes() const { return item * count; }
  };

  std::filesystem::path path_;
  CheckpointInfo info_;
  std::map<std::string, Piece, std::less<>> pieces_;
};

}  // namespace pyroclast
