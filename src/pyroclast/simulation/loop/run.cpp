#include "pyroclast/simulation/loop/run.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

namespace {

/// Largest number of steps of a batch. A large body takes fewer, so that a stop is heard within a second.
constexpr int kMostSteps = 250;
constexpr double kMostZoneSteps = 25e6;

int most_steps(const Simulation& simulation) {
  return static_cast<int>(
      std::clamp<double>(kMostZoneSteps / simulation.model().whole_zone_count(), 1, kMostSteps));
}

void append(std::vector<Gauge>& all, std::vector<Gauge> more) {
  for (auto& gauge : more) all.push_back(std::move(gauge));
}

}  // namespace

Column stage_column() {
  return {"stage", "1", "number of the stage, from 0; that of the first row is 0 too", ColumnRole::clock,
          "stage"};
}

Run::Run(Simulation& simulation, std::vector<std::unique_ptr<Stage>> stages)
    : simulation_(simulation),
      stages_(std::move(stages)),
      courses_(stages_.size()),
      most_steps_(most_steps(simulation)) {
  if (stages_.empty()) throw Error("a run needs at least one stage");
  if (simulation.moves()) check(stages_, 0, acting_on(simulation));
  const auto add = [&](std::vector<Gauge> gauges) { append(gauges_, std::move(gauges)); };
  add(clock_gauges(simulation));
  add(temperature_gauges());
  stages_columns_ = gauges_.size();
  add(motion_gauges(simulation));
  add(record_gauges(simulation));
  add(transport_gauges(simulation));
  add(probe_gauges(simulation));
  require_own_columns();
  name_columns();
}

/// Names the columns in the stated order: number of the stage, clocks, temperatures, the stages' own, motion,
/// records, transport, probes.
void Run::name_columns() {
  history_.add_column(stage_column());
  for (std::size_t i = 0; i <= gauges_.size(); ++i) {
    if (i == stages_columns_)
      for (const auto& stage : stages_)
        for (const Column& column : stage->columns()) history_.add_column(column);
    if (i == gauges_.size()) break;
    for (const Column& column : gauges_[i].columns) history_.add_column(column);
  }
}

/// Returns the place of the record with a column of this name, to begin a message with; empty where there is
/// none.
std::string Run::place_of(const std::string& column) const {
  for (const Record& record : simulation_.records())
    if (column_of(record.parameters()).name == column && !record.parameters().place.empty())
      return record.parameters().place + ": ";
  return {};
}

/// Throws Error where two quantities would write into one column, because a record or a probe has the name of
/// another quantity.
void Run::require_own_columns() const {
  std::set<std::string> names;
  names.insert(stage_column().name);
  for (const auto& stage : stages_)
    for (const Column& column : stage->columns()) names.insert(column.name);
  for (const Gauge& gauge : gauges_)
    for (const Column& column : gauge.columns)
      if (!names.insert(column.name).second)
        throw Error(fmt::format(
            "{}history.csv would have two columns \"{}\": a [[record]] or a probe has the name of "
            "another quantity; give it another one",
            place_of(column.name), column.name));
}

/// Throws Error where one of the stages from `first` on cannot be done, or would move a body that has weight
/// or loads and that nothing holds. Platens hold a body.
void Run::check(const std::vector<std::unique_ptr<Stage>>& stages, std::size_t first, Acting acting) const {
  bool is_loaded = has_weight(simulation_);
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const Stage& stage = *stages[i];
    is_loaded = is_loaded || stage.loads();
    if (i < first) continue;
    stage.check(simulation_, acting);
    if (is_loaded && stage.needs().mechanics)
      require_held(simulation_, acting.supports,
                   stage.place().empty() ? fmt::format("stage {} ({})", i + 1, stage.kind()) : stage.place());
  }
}

bool Run::next() {
  if (outcome_ != Outcome::running) return false;
  frame_is_due_ = false;
  if (!has_started_) {
    has_started_ = true;
    if (simulation_.moves()) simulation_.motion().note_cracks();
    add_row();
    frame_is_due_ = true;
    return true;
  }
  if (stage_is_over_) ++stage_;
  if (stage_is_over_ || !stage_is_begun_) begin_stage();
  if (!move_to_look()) return false;
  if (simulation_.moves()) simulation_.motion().note_cracks();
  add_row();
  courses_[stage_].rows.last = history_.row_count();
  const auto& row = history_.row(history_.row_count() - 1);
  const bool finite =
      std::all_of(row.begin(), row.end(), [](const auto& cell) { return !cell || std::isfinite(*cell); });
  const Verdict verdict = finite ? stages_[stage_]->judge(simulation_)
                                 : Verdict{.over = true, .last = true, .outcome = Outcome::unstable};
  frame_is_due_ = verdict.over || verdict.frame;
  if (verdict.over) end_stage(verdict);
  return true;
}

void Run::go_on() {
  if (outcome_ != Outcome::stopped) return;
  outcome_ = Outcome::running;
  courses_[stage_].outcome = Outcome::running;
}

void Run::change_later_stages(std::vector<std::unique_ptr<Stage>> stages) {
  const auto kept = static_cast<std::size_t>(last_begun_stage() + 1);
  if (stages.size() < std::max<std::size_t>(kept, 1))
    throw Error(fmt::format("the run has begun {} stages, but {} are given", kept, stages.size()));
  if (simulation_.moves()) check(stages, kept, acting_on(simulation_));
  for (std::size_t i = 0; i < kept; ++i) stages[i] = std::move(stages_[i]);
  stages_ = std::move(stages);
  courses_.resize(stages_.size());
  const History old = std::exchange(history_, {});
  name_columns();
  history_.take_rows(old);  // without the columns of stages that are no more
  const bool has_more = kept < stages_.size();
  if (stage_is_over_ && !stage_ends_run_ && has_more) outcome_ = Outcome::running;
}

void Run::check_later_stages(Acting acting) const {
  check(stages_, static_cast<std::size_t>(last_begun_stage() + 1), std::move(acting));
}

void Run::end_stage() {
  go_on();
  if (!stage_is_under_way() || outcome_ != Outcome::running)
    throw Error("no stage is under way that could be ended");
  if (courses_[stage_].rows.empty()) throw Error("the stage has no sample yet, so it cannot be ended");
  end_stage(Verdict{.over = true});
}

Outcome Run::run() {
  while (next()) continue;
  return outcome_;
}

void Run::begin_stage() {
  stage_is_begun_ = true;
  stage_is_over_ = false;
  courses_[stage_] = {Outcome::running, {history_.row_count(), history_.row_count()}};
  if (simulation_.moves() && simulation_.has_press()) simulation_.press().begin_stage();
  stages_[stage_]->begin(simulation_);
}

/// Moves on to the next look; returns false when the run was stopped on the way.
bool Run::move_to_look() {
  for (bool there = false; !there;) {
    const Wishes own = asked_();
    Ranks& ranks = simulation_.ranks();
    const Wishes wishes = ranks.together([&] {
      stages_[stage_]->read(simulation_);
      return Wishes{.stop = ranks.any(own.stop), .save = ranks.any(own.save)};
    });
    between_batches_(*this, wishes);
    if (wishes.stop) {
      courses_[stage_].outcome = Outcome::stopped;
      outcome_ = Outcome::stopped;
      return false;
    }
    there = stages_[stage_]->advance(simulation_, batch());
    call_back();
  }
  return true;
}

int Run::batch() const {
  if (calls_.empty()) return most_steps_;
  const std::int64_t to_call = calls_.begin()->first - simulation_.motion().steps();
  return static_cast<int>(std::min<std::int64_t>(most_steps_, to_call));
}

void Run::call_back() {
  while (!calls_.empty() && calls_.begin()->first <= simulation_.motion().steps()) {
    const auto call = std::move(calls_.extract(calls_.begin()).mapped());
    call(*this);
  }
}

void Run::call_at(std::int64_t step, std::function<void(Run&)> call) {
  if (!simulation_.moves()) throw Error("nothing moves in this run, so there is no step to call back at");
  if (step <= simulation_.motion().steps())
    throw Error(
        fmt::format("step {} is past: the mechanics has done {} steps", step, simulation_.motion().steps()));
  calls_.emplace(step, std::move(call));
}

std::vector<std::optional<double>> Run::measure() const {
  std::vector<std::optional<double>> row(history_.columns().size());
  const auto set = [&](const Column& column, double value) { row[history_.index(column.name)] = value; };
  set(stage_column(), static_cast<double>(stage_));
  const Stage* stage = stage_is_begun_ ? stages_[stage_].get() : nullptr;  // none at the start of the run
  for (const Gauge& gauge : gauges_) {
    if (gauge.of_motion && stage && !stage->needs().mechanics) continue;
    const std::vector<double> values = gauge.read(simulation_);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!gauge.of_places || !std::isnan(values[i])) set(gauge.columns[i], values[i]);
  }
  if (!stage) return row;
  const auto columns = stage->columns();
  const auto values = stage->values();
  for (std::size_t i = 0; i < values.size(); ++i) set(columns[i], values[i]);
  return row;
}

/// Adds a row to the history, and lets the stage look; all sums travel in one message. Both see the body
/// after its creep.
void Run::add_row() {
  std::vector<std::optional<double>> row;
  const auto look = [&] {
    if (stage_is_begun_) stages_[stage_]->look(simulation_);
    row = measure();
  };
  if (simulation_.moves())
    simulation_.motion().commit_creep(look);
  else
    simulation_.ranks().together(look);
  history_.add_row(std::move(row));
}

void Run::end_stage(const Verdict& verdict) {
  stage_is_over_ = true;
  stage_ends_run_ = verdict.last;
  courses_[stage_].outcome = verdict.outcome;
  if (verdict.last || stage_ + 1 == static_cast<std::int64_t>(stages_.size())) outcome_ = verdict.outcome;
}

void Run::visit_state(StateVisitor& visitor) {
  visitor.visit("stage", stage_, state::count());
  if (stage_ < 0 || stage_ >= static_cast<std::int64_t>(stages_.size()))
    throw Error(fmt::format("the state is that of stage {}, but this run has {}", stage_, stages_.size()));
  visitor.visit("has_started", has_started_);
  visitor.visit("stage_is_begun", stage_is_begun_);
  visitor.visit("stage_is_over", stage_is_over_);
  visitor.visit("stage_ends_run", stage_ends_run_);
  visit_courses(visitor);
  {
    const StateVisitor::Scope scope(visitor, "history");
    history_.visit_state(visitor);
  }
  for (const StageCourse& course : courses_)
    visitor.require(course.rows.first <= course.rows.last && course.rows.last <= history_.row_count(),
                    "courses", "names rows that the history does not have");
  simulation_.visit_state(visitor);
  for (std::int64_t i = 0; i <= stage_; ++i) {
    const StateVisitor::Scope scope(visitor, fmt::format("stages[{}]", i));
    stages_.at(i)->visit_state(visitor);
  }
}

/// Shows the courses of the stages up to the present one; later stages have not begun.
void Run::visit_courses(StateVisitor& visitor) {
  constexpr auto kLast = static_cast<double>(Outcome::stopped);
  for (std::int64_t i = 0; i <= stage_; ++i) {
    const StateVisitor::Scope scope(visitor, fmt::format("courses[{}]", i));
    StageCourse& course = courses_[i];
    Outcome of_stage = course.outcome == Outcome::stopped ? Outcome::running : course.outcome;
    visitor.visit("outcome", of_stage, state::within(0, kLast));
    visitor.visit("first_row", course.rows.first, state::count());
    visitor.visit("last_row", course.rows.last, state::count());
    if (visitor.replaces()) course.outcome = of_stage;
  }
  Outcome outcome = outcome_ == Outcome::stopped ? Outcome::running : outcome_;
  visitor.visit("outcome", outcome, state::within(0, kLast));
  if (!visitor.replaces()) return;
  const bool has_more = stage_ + 1 < static_cast<std::int64_t>(stages_.size());
  outcome_ = stage_is_over_ && !stage_ends_run_ && has_more ? Outcome::running : outcome;
  visitor.require(outcome_ != Outcome::running || !stage_is_over_ || has_more, "outcome",
                  "says that the run goes on behind its last stage");
}

int test_stage(const Run& run) {
  int found = -1;
  bool measures_strength = false;
  for (int i = 0; i < static_cast<int>(run.stages().size()); ++i) {
    const auto results = run.stages()[i]->report(run.history(), {}, Outcome::not_begun).results;
    const bool is_strength = std::ranges::find(results, kStrength.name, &Result::name) != results.end();
    const bool is_test = std::ranges::find(results, ResultOf::test, &Result::of) != results.end();
    if (!is_strength && (measures_strength || !is_test)) continue;
    found = i;
    measures_strength = is_strength;
  }
  return found;
}

}  // namespace pyroclast
