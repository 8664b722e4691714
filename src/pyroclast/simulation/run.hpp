#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "pyroclast/simulation/gauges.hpp"
#include "pyroclast/simulation/history.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

/// How a stage of a run went.
struct StageCourse {
  Outcome outcome = Outcome::not_begun;
  RowRange rows;  ///< in the history; the row at the start of the run belongs to no stage
};

/// Takes a simulation through a list of stages, from look to look:
///
///     while (run.next()) recorder.record(run);
///
/// The first look is that at the start. Between two looks the simulation moves in batches; only between them,
/// and at their ends, the run asks whether it shall stop, and calls back. Where batches end changes no
/// result.
class Run {
 public:
  /// \param simulation  kept by reference; must outlive this
  Run(Simulation& simulation, std::vector<std::unique_ptr<Stage>> stages);

  /// Goes on to the next look and adds a row to the history. False when the run is over, or was stopped: then
  /// there is no new look, and what was broken off has left no row.
  bool next();
  /// Takes back a stop, so that `next` goes on where the run was stopped.
  void go_on();
  /// All the rest of it.
  Outcome run();

  /// Asked before every batch; true stops the run.
  void stop_when(std::function<bool()> asked) { stop_asked_ = std::move(asked); }
  /// Calls back once, when the mechanics has done so many steps since its beginning. The batch ends there.
  /// Throws Error when that step is past, or nothing moves.
  void call_at(std::int64_t step, std::function<void(Run&)> call);
  /// Bounds the steps of a batch further.
  void limit_batch(int most_steps);
  /// Called between batches, and before the run stops; may read or write the state.
  void between_batches(std::function<void(Run&)> call) { between_batches_ = std::move(call); }

  /// Of the last look.
  bool frame_is_due() const { return frame_is_due_; }
  /// Whether that look ended its stage.
  bool stage_is_over() const { return stage_is_over_; }
  /// Number of the stage of the last look, from 0.
  int stage_number() const { return static_cast<int>(stage_); }
  const Stage& stage() const { return *stages_[stage_]; }
  /// Share of that stage that is done, 0 to 1, as far as it can be foreseen.
  double progress() const { return stage().progress(simulation_); }

  /// Number of the last stage that has begun, from 0; -1 before any.
  std::int64_t last_begun_stage() const { return stage_is_begun_ ? stage_ : stage_ - 1; }
  /// What a look would measure now, by the columns of the history; adds no row.
  std::vector<std::optional<double>> measure() const;

  /// Puts other stages behind the last one that has begun. A run whose last stage was over goes on with them,
  /// unless its verdict ended the run. Columns of theirs are added to the history, empty so far. Throws
  /// Error, and changes nothing, where one of them cannot be done, see Stage::check.
  ///
  /// \param stages  all of the run; those up to the last begun are not taken
  void change_later_stages(std::vector<std::unique_ptr<Stage>> stages);
  /// Throws Error where stages that have not begun cannot be done, see Stage::check.
  /// \param acting  now, or as it is about to be
  void check_later_stages(Acting<2> acting) const;
  /// Whether a stage has begun and is not over.
  bool stage_is_under_way() const { return stage_is_begun_ && !stage_is_over_; }
  /// Ends the stage that is under way, at the last look or where it was stopped since. Throws Error where
  /// none is.
  void end_stage();

  Outcome outcome() const { return outcome_; }
  /// Whether it has come to an end, or was stopped.
  bool has_ended() const { return outcome_ != Outcome::running; }
  const std::vector<std::unique_ptr<Stage>>& stages() const { return stages_; }
  const std::vector<StageCourse>& courses() const { return courses_; }
  const History& history() const { return history_; }
  const Simulation& simulation() const { return simulation_; }

  /// Of the run, its history and stages and the simulation: all of what a checkpoint holds. Between two
  /// batches, and after a look. What replaces it may be of a run that had the same stages up to the present
  /// one and others after it.
  void visit_state(StateVisitor& visitor);

 private:
  void check(const std::vector<std::unique_ptr<Stage>>& stages, std::size_t first, Acting<2> acting) const;
  void begin_stage();
  bool move_to_look();
  int batch() const;
  void call_back();
  void visit_courses(StateVisitor& visitor);
  void add_row();
  void end_stage(const Verdict& verdict);
  void name_columns();
  std::string place_of(const std::string& column) const;
  void require_own_columns() const;

  Simulation& simulation_;
  std::vector<std::unique_ptr<Stage>> stages_;
  std::vector<StageCourse> courses_;
  std::vector<Gauge> gauges_;
  std::size_t stages_columns_ = 0;  ///< the stages' own columns stand before those of this gauge
  History history_;
  std::function<bool()> stop_asked_ = [] { return false; };
  std::function<void(Run&)> between_batches_ = [](Run&) {};
  std::multimap<std::int64_t, std::function<void(Run&)>> calls_;  ///< by step
  int most_steps_;                                                ///< of a batch

  std::int64_t stage_ = 0;
  bool has_started_ = false;
  bool stage_is_begun_ = false;
  bool stage_is_over_ = false;
  bool stage_ends_run_ = false;  ///< by its verdict
  bool frame_is_due_ = false;
  Outcome outcome_ = Outcome::running;
};

}  // namespace pyroclast
