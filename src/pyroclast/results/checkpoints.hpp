#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "pyroclast/results/checkpoint_file.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/run.hpp"

namespace pyroclast {

/// Hash of a body as it was made: its model, and the laws of its contacts. A checkpoint holds for one of
/// them.
std::string body_hash(const Simulation& simulation);

/// Where the checkpoints of a run stand in its folder.
std::filesystem::path checkpoint_folder(const std::filesystem::path& run_folder);
/// The one at the end of a stage, from 0.
std::filesystem::path stage_checkpoint(const std::filesystem::path& run_folder, std::int64_t stage);

/// The newest checkpoint of a run. Throws Error when there is none; when the newest file is damaged it says
/// so, and names the newest one that is not.
CheckpointFile newest_checkpoint(const std::filesystem::path& run_folder);

/// Writes the state of a run into its folder, `checkpoints/`: before the first step, every so often, when
/// asked, and at the end of each stage. The two latest are kept, and those of the ends of stages where the
/// deck does not refuse.
class Checkpoints {
 public:
  struct Sources {
    std::string inputs, body;                  ///< hashes, see CheckpointInfo
    std::function<void(StateVisitor&)> visit;  ///< shows all of the state
    std::function<double()> wall_time;         ///< of the run so far, s
    std::function<std::uint64_t()> log_bytes;
  };

  /// \param last  number of the checkpoint that the run goes on from; 0 where it begins
  Checkpoints(std::filesystem::path run_folder, const CheckpointChoice& choice, Sources sources,
              std::int64_t last);

  /// To be called between batches: writes one where the last is old enough, or the run will stop.
  void between_batches(const Run& run, bool stops);
  /// To be called after a look that ended a stage.
  void end_stage(const Run& run);

  /// Another hash of the inputs, from the next one on.
  void set_inputs(std::string hash) { sources_.inputs = std::move(hash); }

  /// The last that was written, empty without any.
  const std::filesystem::path& last() const { return last_; }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_due() const;
  void write(const Run& run, const std::filesystem::path& path);
  std::filesystem::path next_file() const;
  void remove_old() const;

  std::filesystem::path run_folder_;
  CheckpointChoice choice_;
  Sources sources_;
  std::int64_t number_;
  std::filesystem::path last_;
  Clock::time_point written_;
  double took_ = 0.0;  ///< to write the last one, s
};

}  // namespace pyroclast
