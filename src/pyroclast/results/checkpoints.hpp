#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/base/clock.hpp"
#include "pyroclast/results/checkpoint_file.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Returns the hash of a body as it was made: its model, and the laws of its contacts. A checkpoint fits one
/// body only. The hash is the same for any number of ranks: a collective.
std::string body_hash(const Simulation& simulation);

/// Returns the folder of the checkpoints in a run's folder.
std::filesystem::path checkpoint_folder(const std::filesystem::path& run_folder);
/// Returns the checkpoint at the end of a stage, from 0.
std::filesystem::path stage_checkpoint(const std::filesystem::path& run_folder, std::int64_t stage);

/// Returns the states at the ends of the first stages of a run: those that a fork inherits stand in the
/// folders of other runs. \param count   number of stages \param inputs  hash of the run's inputs
std::vector<StageState> stage_states(const std::filesystem::path& run_folder, std::int64_t count,
                                     const std::string& inputs);

/// Returns the newest checkpoint of a run. Throws Error when there is none. When the newest file is damaged
/// the Error says so, and names the newest undamaged one.
CheckpointFile newest_checkpoint(const std::filesystem::path& run_folder);

/// Writer of a run's state into `checkpoints/` of its folder: before the first step, at intervals, when
/// asked, and at the end of each stage. The two latest checkpoints are kept, and those of the ends of stages
/// unless the deck refuses.
class Checkpoints {
 public:
  struct Sources {
    std::string inputs, body;                  ///< hashes, see CheckpointInfo
    std::function<void(StateVisitor&)> visit;  ///< function that shows the whole state
    std::function<double()> wall_time;         ///< wall time of the run so far, s
    std::function<std::uint64_t()> log_bytes;
  };

  /// \param run_folder  folder that all ranks reach
  /// \param last  number of the checkpoint from which the run goes on; 0 where it begins
  Checkpoints(std::filesystem::path run_folder, const CheckpointChoice& choice, Sources sources,
              std::int64_t last);

  /// Tells whether the last checkpoint is old enough for a next one, by the clock of this rank.
  bool is_due() const;
  /// Writes a checkpoint: a collective. Call it between batches.
  void write(const Run& run) { write(run, next_file()); }
  /// Writes the checkpoint of a stage: a collective. Call it after a look that ended the stage.
  void end_stage(const Run& run);

  /// Sets another hash of the inputs, from the next checkpoint on.
  void set_inputs(std::string hash) { sources_.inputs = std::move(hash); }

  /// Returns the last checkpoint that was written; empty without any.
  const std::filesystem::path& last() const { return last_; }

 private:
  void write(const Run& run, const std::filesystem::path& path);
  std::filesystem::path next_file() const;
  void remove_old() const;

  std::filesystem::path run_folder_;
  CheckpointChoice choice_;
  Sources sources_;
  std::int64_t number_;
  std::filesystem::path last_;
  Clock::time_point written_;
  double took_ = 0.0;  ///< time to write the last checkpoint, s
};

}  // namespace pyroclast
