#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/simulation/simulation.hpp"
#include "pyroclast/simulation/watching/gauges.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

/// Course of a stage of a run.
struct StageCourse {
  Outcome outcome = Outcome::not_begun;
  RowRange rows;  ///< rows in the history; the row at the start of the run belongs to no stage
};

/// What a rank asks for between two batches. What one rank asks for, all do.
struct Wishes {
  bool stop = false;  ///< stop the run
  bool save = false;  ///< keep the state
};

/// Run of a simulation through a list of stages, from look to look:
///
///     while (run.next()) writer.write(run);
///
/// The first look is the one at the start. Between two looks the simulation moves in batches. The run asks
/// whether it shall stop, and calls back, only between batches. Where batches end changes no result.
class Run {
 public:
  /// \param simulation  simulation, kept by reference; must outlive this object
  Run(Simulation& simulation, std::vector<std::unique_ptr<Stage>> stages);

  /// Goes on to the next look and adds a row to the history. Returns false when the run is over, or was
  /// stopped: then there is no new look, and the part that was broken off has left no row.
  bool next();
  /// Takes back a stop, so that `next` goes on where the run was stopped.
  void go_on();
  /// Runs to the end.
  Outcome run();

  /// Sets a function that the run asks before every batch; true stops the run, on all ranks.
  void stop_when(std::function<bool()> asked) {
    ask([asked = std::move(asked)] { return Wishes{.stop = asked()}; });
  }
  /// Sets a function that the run asks before every batch.
  void ask(std::function<Wishes()> asked) { asked_ = std::move(asked); }
  /// Sets a function that the run calls once, when the mechanics has done so many steps since its beginning.
  /// The batch ends there. Throws Error when that step is past, or nothing moves.
  void call_at(std::int64_t step, std::function<void(Run&)> call);
  /// Sets a function that the run calls between batches, and before it stops, with what is to be done; the
  /// function may read or write the state.
  void between_batches(std::function<void(Run&, const Wishes&)> call) { between_batches_ = std::move(call); }

  /// Tells whether a frame is due at the last look.
  bool frame_is_due() const { return frame_is_due_; }
  /// Tells whether the last look ended its stage.
  bool stage_is_over() const { return stage_is_over_; }
  /// Returns the number of the stage of the last look, from 0.
  int stage_number() const { return static_cast<int>(stage_); }
  const Stage& stage() const { return *stages_[stage_]; }
  /// Returns the share of the stage that is done, 0 to 1, as far as it can be foreseen.
  double progress() const { return stage().progress(simulation_); }

  /// Returns the number of the last stage that has begun, from 0; -1 before any.
  std::int64_t last_begun_stage() const { return stage_is_begun_ ? stage_ : stage_ - 1; }
  /// Returns what a look would measure now, by the columns of the history; adds no row.
  std::vector<std::optional<double>> measure() const;

  /// Puts other stages behind the last one that has begun. A run whose last stage was over goes on with them,
  /// unless the verdict of that stage ended the run. Columns of the new stages are added to the history,
  /// empty so far. Throws Error, and changes nothing, where one of the stages cannot be done, see
  /// Stage::check.
  ///
  /// \param stages  all stages of the run; those up to the last begun are not taken
  void change_later_stages(std::vector<std::unique_ptr<Stage>> stages);
  /// Throws Error where stages that have not begun cannot be done, see Stage::check.
  /// \param acting  supports and loads that act now, or are about to act
  void check_later_stages(Acting acting) const;
  /// Tells whether a stage has begun and is not over.
  bool stage_is_under_way() const { return stage_is_begun_ && !stage_is_over_; }
  /// Ends the stage that is under way, at the last look or where the run was stopped since. Throws Error
  /// where no stage is under way.
  void end_stage();

  Outcome outcome() const { return outcome_; }
  /// Tells whether the run has come to an end, or was stopped.
  bool has_ended() const { return outcome_ != Outcome::running; }
  const std::vector<std::unique_ptr<Stage>>& stages() const { return stages_; }
  const std::vector<StageCourse>& courses() const { return courses_; }
  const History& history() const { return history_; }
  const Simulation& simulation() const { return simulation_; }

  /// Shows the whole content of a checkpoint: the run, its history and stages and the simulation. Call it
  /// between two batches, or after a look. The state that replaces it may come from a run that had the same
  /// stages up to the present one and others after it.
  void visit_state(StateVisitor& visitor);

 private:
  void check(const std::vector<std::unique_ptr<Stage>>& stages, std::size_t first, Acting acting) const;
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
  std::size_t stages_columns_ = 0;  ///< gauge before whose columns the stages' own columns stand
  History history_;
  std::function<Wishes()> asked_ = [] { return Wishes{}; };
  std::function<void(Run&, const Wishes&)> between_batches_ = [](Run&, const Wishes&) {};
  std::multimap<std::int64_t, std::function<void(Run&)>> calls_;  ///< functions to call, by step
  const int most_steps_;                                          ///< most steps of a batch

  std::int64_t stage_ = 0;
  bool has_started_ = false;
  bool stage_is_begun_ = false;
  bool stage_is_over_ = false;
  bool stage_ends_run_ = false;  ///< true where the verdict of the stage ends the run
  bool frame_is_due_ = false;
  Outcome outcome_ = Outcome::running;
};

/// Returns the column of the stage of a row.
Column stage_column();

/// Returns the stage that is the test of a run, from 0: the last that measures a strength, else the last with
/// a result that a laboratory would report; -1 where no stage has one.
int test_stage(const Run& run);

}  // namespace pyroclast
