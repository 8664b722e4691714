#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "pyroclast/base/ranks.hpp"
#include "pyroclast/base/state_visitor.hpp"

namespace pyroclast {

/// Description of a checkpoint, for choosing among several and for messages.
struct CheckpointInfo {
  std::int64_t number = 0;  ///< number in the order in which a run writes checkpoints, from 1
  std::string version;      ///< version of pyroclast
  std::string commit;
  int physics_version = 0;
  std::string inputs;                    ///< hash of all inputs of the run
  std::string body;                      ///< hash of model and laws, as they were made from the inputs
  int blocks_of_a_chunk = 0;             ///< see Model; sums and the order of a state go by chunks
  std::vector<std::string> stage_kinds;  ///< kinds of all stages
  std::int64_t stage = 0;                ///< number of the stage, from 0
  bool stage_is_over = false;
  std::int64_t step = 0;        ///< step of the mechanics
  double wall_time = 0.0;       ///< wall time of the run so far, s
  std::uint64_t log_bytes = 0;  ///< length of the run's log at the checkpoint

  /// Shows each entry of an info by its name in the file.
  template <class Info, class F>
  static void each(Info& info, F&& f) {
    f("number", info.number);
    f("version", info.version);
    f("commit", info.commit);
    f("physics_version", info.physics_version);
    f("inputs", info.inputs);
    f("body", info.body);
    f("blocks_of_a_chunk", info.blocks_of_a_chunk);
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
///     where the table begins, its length, its hash (XXH3), "t-state2"
///
/// The table has name, place, size and hash (XXH3) of each piece; of a piece by chunk, size and hash of each
/// chunk. Numbers are as the processor has them, little end first. The bytes are the same for any number of
/// ranks: each writes its own chunks, and the first the rest. A collective.
/// \param visit  shows the whole state
/// \param ranks  ranks that hold the body; all reach the file under the same path
/// \return the length of the checkpoint, bytes; 0 on ranks but the first
std::uint64_t write_checkpoint(const std::filesystem::path& path, const CheckpointInfo& info,
                               const std::function<void(StateVisitor&)>& visit, Ranks& ranks = one_rank());

/// Checkpoint to be read. All its errors are Errors that name the file and the fault.
class CheckpointFile {
 public:
  /// Reads the info. Throws Error when the file is cut short, damaged there, or none of this program.
  explicit CheckpointFile(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  const CheckpointInfo& info() const { return info_; }

  /// Replaces everything that `visit` shows by the contents of the file; of pieces by chunk each rank reads
  /// its own. Throws Error when a piece is damaged, or of another size, or when the file lacks one, or holds
  /// one that is not asked for.
  void restore(const std::function<void(StateVisitor&)>& visit) const;
  /// Reads all pieces and compares their hashes. Throws Error for the first piece that is damaged.
  void verify() const;

 private:
  friend class CheckpointReader;
  struct Piece {
    std::uint64_t begin = 0, item = 0;
    bool is_by_chunk = false;
    std::vector<std::uint64_t> counts, hashes;  ///< by chunk; one of a piece that is not by chunk
  };

  std::filesystem::path path_;
  CheckpointInfo info_;
  std::map<std::string, Piece, std::less<>> pieces_;
};

}  // namespace pyroclast
