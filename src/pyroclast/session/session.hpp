#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pyroclast/results/checkpoints.hpp"
#include "pyroclast/results/folder_lock.hpp"
#include "pyroclast/results/inputs.hpp"
#include "pyroclast/results/results_writer.hpp"
#include "pyroclast/results/run_folder.hpp"
#include "pyroclast/session/deck_of_run.hpp"
#include "pyroclast/simulation/loop/run.hpp"

namespace pyroclast {

/// Folder of a run, and entries of its manifest.
struct RunOutput {
  std::filesystem::path folder;
  bool overwrite = false;
  std::string command = {};
  std::string_view remedy = kOtherFolder;  ///< what to do about a folder that exists
};

/// Run from which another one is forked.
struct ForkOf {
  std::filesystem::path run;         ///< folder of a run
  std::string from_stage;            ///< number or name of the last stage in common; empty: the last of all
  std::filesystem::path more;        ///< file with stages to append; may be empty
  std::vector<std::string> changes;  ///< changes of later stages, "key=value"
};

/// Run with all that belongs to it: its deck, its simulation, and, where it has a folder, the files of the
/// folder.
///
///     while (session.next()) look_at(session.run());
///     session.finish();
class Session {
 public:
  /// Makes a run from its beginning. Throws Error where it cannot be made, or its folder may not be written.
  /// \param output  empty: nothing is written
  static std::unique_ptr<Session> begin(DeckOfRun opened, const std::optional<RunOutput>& output);
  /// Goes on with a run that was broken off, in its folder. Throws Error where the run is over, or the
  /// checkpoint is not of this program, these inputs and this body.
  /// \param checkpoint  checkpoint to go on from; empty: the newest
  static std::unique_ptr<Session> resume(const std::filesystem::path& folder,
                                         const std::filesystem::path& checkpoint, const RunChoices& choices);
  /// Makes a new run that has its first stages in common with another one, which is only read. Throws Error
  /// as `resume` does, and for a change that would act earlier.
  static std::unique_ptr<Session> fork(const ForkOf& of, const RunOutput& output, const RunChoices& choices);

  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Goes on to the next look and writes the files that are due. Returns false when the run is over, or was
  /// stopped.
  bool next();
  /// Returns the summary of the rows so far, and writes it where there is a folder.
  Summary finish();
  /// Returns the summary of the rows so far without writing it.
  Summary summary() const { return writer_.summary(run_); }
  /// Returns the names of the numbers that the summary has when the run is over.
  std::vector<std::string> summary_numbers() const { return writer_.numbers(run_); }

  /// Sets a function that is asked before every batch; true stops the run, after a checkpoint where there is
  /// a folder.
  void stop_when(const std::function<bool()>& asked);
  /// Sets a function that is called between batches, after all files that are due were written.
  void between_batches(std::function<void()> call) { between_batches_ = std::move(call); }
  /// Sets the function that returns the length of the run's log, for checkpoints.
  void log_bytes_by(std::function<std::uint64_t()> bytes) { log_bytes_ = std::move(bytes); }

  /// Makes a new run that stands where this one does, between two batches or after a look.
  /// \param changes  "key=value", of keys that act later; see `fork`
  std::unique_ptr<Session> copy(const std::vector<std::string>& changes,
                                const std::optional<RunOutput>& output);
  /// Gives the folder back, so that another process may write there; the run writes no more.
  void leave_folder();
  /// Writes a checkpoint now. Throws Error without a folder.
  void write_checkpoint();

  /// Changes keys of stages that have not begun, and adds stages behind the last one. The run is then that of
  /// the changed deck. Throws Error for a change that would act earlier.
  /// \param more  text that is appended to the deck
  void change_stages(const std::vector<std::string>& changes, const std::string& more);
  /// Changes keys of materials and contacts from now on, as if the temperature had changed. Throws Error for
  /// a key that cannot change in a run. The run departs from its deck.
  void change_materials(const std::vector<std::string>& changes);
  /// Holds, moves or loads sets from now on, as a stage of kind "drive" without ramps does at its beginning.
  /// The run departs from its deck. Throws DeckError for errors in the drives, Error for a drive that
  /// contradicts a support or the stage under way, or would let the body fly away; then nothing is changed.
  /// \param drives  tables [[drives]] of such a stage
  void drive(const std::string& drives);
  /// Ends the stage under way after the last look. The run departs from its deck.
  void end_stage();
  /// Gives the whole body one temperature, °C, and hands it over to the mechanics where there are any. The
  /// run departs from its deck. Throws Error where the temperature is computed.
  void set_temperature(double temperature);
  /// Notes in summary and manifest that from now on the run is not the one that its deck describes.
  void depart(const Departure& departure);

  Run& run() { return run_; }
  const Run& run() const { return run_; }
  Simulation& simulation() { return *simulation_; }
  const DeckOfRun& opened() const { return opened_; }
  /// Returns the folder; empty where nothing is written, or another rank writes.
  const std::filesystem::path& folder() const { return folder_; }
  /// Returns the files that were in the folder and that no run writes.
  const std::vector<std::filesystem::path>& foreign() const { return foreign_; }
  /// Returns lines about lost frames, see ResultsWriter.
  const std::vector<std::string>& lost_frames() const { return writer_.lost_frames(); }
  /// Returns the checkpoint from which a run goes on that was broken off, or forked.
  const std::optional<CheckpointInfo>& goes_on_from() const { return goes_on_from_; }
  const std::filesystem::path& last_checkpoint() const { return last_checkpoint_; }

 private:
  /// \param folder  folder of the run, on all ranks; empty without files
  Session(DeckOfRun opened, std::unique_ptr<FolderLock> lock, std::filesystem::path folder,
          std::optional<MadeSpecimen> specimen = std::nullopt);

  static std::unique_ptr<FolderLock> lock(const RunOutput& output);
  void make_folder(const RunOutput& output, std::optional<Parent> parent);
  void open(std::int64_t last_checkpoint);
  void visit_state(StateVisitor& visitor);
  void restore(const CheckpointFile& checkpoint);
  void take_over(Deck deck, Setup setup);
  Setup read(const Deck& deck) const;
  template <class Act>
  auto telling_where_to_go_on(Act act);

  std::unique_ptr<FolderLock> lock_;
  std::filesystem::path folder_;         ///< empty where nothing is written, or another rank writes
  std::filesystem::path shared_folder_;  ///< the same on all ranks; empty where nothing is written
  DeckOfRun opened_;
  Inputs inputs_;
  std::unique_ptr<Simulation> simulation_;
  ResultsWriter writer_;
  Run run_;
  bool has_files_ = false;  ///< true where results go into a folder, by this rank or the first of several
  std::optional<Checkpoints> checkpoints_;  ///< empty without files
  std::optional<CheckpointInfo> goes_on_from_;
  std::filesystem::path last_checkpoint_;
  std::vector<std::filesystem::path> foreign_;
  std::vector<Departure> departures_;
  bool checkpoint_is_due_ = false;  ///< true where a fork has yet to write its first checkpoint
  std::function<bool()> stop_asked_ = [] { return false; };
  std::function<void()> between_batches_ = [] {};
  std::function<std::uint64_t()> log_bytes_ = [] { return std::uint64_t{0}; };
};

}  // namespace pyroclast
