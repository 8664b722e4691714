#include "pyroclast/simulation/loop/run.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "in_plane.hpp"
#include "pyroclast/base/error.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

/// A deck of every kind of stage that a uniform field allows, with a gap to close and a controlled velocity,
/// each a few batches long.
std::string every_uniform_stage() {
  const std::string predictor = "least_cycles = 110\npredictor = true";
  return with(with(deck(kUniform + kSettle + load("stress = \"1 MPa\"") + heat("45 degC", "fixed") +
                        heat("20 degC") + kCompress + with(kFailure, "0.004", "0.0002") + kControl),
                   "least_cycles = 50", predictor),
              "most_cycles = 5000", "most_cycles = 330");
}

std::string exposed() {
  return with(with(deck(kSettle + kExpose + kHeatedFace), "6 min", "2 min"), "most_cycles = 5000",
              "most_cycles = 330");
}

/// The same with mortar that creeps, in tension less; steep, so that a stage of two exchanges creeps.
std::string creeping(const std::string& text) {
  return text +
         "[materials.mortar.creep]\nstrain = { table = [[\"20 degC\", 0], [\"820 degC\", 0.4]] }\n"
         "tension = 0.4\n";
}

/// The same of constituents that keep, lose and shrink by curves of their own where they cool.
std::string cooling(const std::string& text) {
  const std::string ratio = "residual_ratio = { table = [[\"20 degC\", 1], [\"820 degC\", 0.2]] }\n";
  std::string own = with(text, "on_cooling = \"reversible\"", "on_cooling = \"irreversible\"");
  own = with(own, "[materials.mortar]\n",
             "[materials.mortar]\ncontraction = \"2e-5 1/K\"\nquartz_step = 0.001\n"
             "quartz_range = [\"25 degC\", \"40 degC\"]\n" +
                 ratio);
  return with(own, "[contacts.mortar_mortar]\n", "[contacts.mortar_mortar]\n" + ratio);
}

/// Columns that are sums over the body or a set: where batches end may move the last digit of these alone.
bool is_sum(const std::string& column) {
  for (const char* part : {"energy_", "dissipated_", "ratio", "kinetic", "_length_m", "opening", "stress",
                           "strain", "heat_", "rate_", "temperature_degC"})
    if (column.find(part) != std::string::npos) return true;
  return false;
}

void expect_same(const History& a, const History& b) {
  ASSERT_EQ(a.columns(), b.columns());
  ASSERT_EQ(a.row_count(), b.row_count());
  for (std::size_t c = 0; c < a.columns().size(); ++c) {
    const std::string& name = a.columns()[c].name;
    double largest = 0.0;
    for (std::size_t row = 0; row < a.row_count(); ++row)
      largest = std::max(largest, std::abs(a.row(row)[c].value_or(0.0)));
    for (std::size_t row = 0; row < a.row_count(); ++row) {
      const auto x = a.row(row)[c], y = b.row(row)[c];
      ASSERT_EQ(x.has_value(), y.has_value()) << name << " in row " << row;
      if (!x) continue;
      if (is_sum(name))
        ASSERT_NEAR(*x, *y, 1e-12 * largest) << name << " in row " << row;
      else
        ASSERT_EQ(*x, *y) << name << " in row " << row;
    }
  }
}

/// What people are told of a stage once the run is over.
StageReport report_of(const Trial& trial, std::size_t stage) {
  const StageCourse& record = trial.run.courses()[stage];
  return trial.run.stages()[stage]->report(trial.run.history(), record.rows, record.outcome);
}

// Promise: where batches end changes no result.
TEST(Run, BatchesOfAnyLengthGiveTheSameHistory) {
  for (const std::string& text : {every_uniform_stage(), exposed(), creeping(every_uniform_stage()),
                                  creeping(exposed()), cooling(every_uniform_stage())}) {
    Trial whole(text);
    whole.run.run();
    ASSERT_EQ(whole.run.outcome(), Outcome::completed);
    for (const int steps : {1, 7}) {
      Trial cut(text);
      cut_batches(cut.run, steps);
      cut.run.run();
      expect_same(whole.run.history(), cut.run.history());
    }
  }
}

// Promise: the first look is that at the start, one follows at each verdict, and the run is over after the
// last.
TEST(Run, GoesFromLookToLook) {
  Trial trial(deck(kUniform + kSettle + kCompress));
  pyroclast::Run& run = trial.run;
  EXPECT_EQ(run.outcome(), Outcome::running);
  ASSERT_TRUE(run.next());
  EXPECT_TRUE(run.frame_is_due());
  EXPECT_EQ(run.history().row_count(), 1U);
  EXPECT_EQ(run.history().last("step"), 0.0);
  EXPECT_EQ(run.courses()[0].outcome, Outcome::not_begun);
  std::size_t rows = 1;
  while (run.next()) EXPECT_EQ(run.history().row_count(), ++rows);
  EXPECT_EQ(run.outcome(), Outcome::completed);
  EXPECT_TRUE(run.frame_is_due());
  EXPECT_FALSE(run.next());
  EXPECT_EQ(run.history().row_count(), rows);
  EXPECT_EQ(run.courses()[0].rows.first, 1U);
  EXPECT_EQ(run.courses()[0].rows.last, run.courses()[1].rows.first);
  EXPECT_EQ(run.courses()[1].rows.last, rows);
}

/// Stops a run at a step of the mechanics.
void stop_at(Run& run, std::int64_t step) {
  run.stop_when([&run, step] { return run.simulation().motion().steps() >= step; });
}

// Promise: a stop inside an exchange leaves no row and no verdict of it: it is not said that it did not come
// to rest.
TEST(Run, AStopInsideAnExchangeLeavesNoTraceOfIt) {
  const std::string text = deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("120 degC"));
  Trial whole(text);
  whole.run.run();
  const RowRange heated = whole.run.courses()[2].rows;
  const auto steps = whole.run.history().values("step", heated);
  Trial stopped(text);
  stop_at(stopped.run, static_cast<std::int64_t>(steps[4]) + 60);
  int frames = 0;
  while (stopped.run.next()) frames += stopped.run.frame_is_due() ? 1 : 0;
  EXPECT_EQ(stopped.run.outcome(), Outcome::stopped);
  EXPECT_EQ(frames, 3);  // at the start, after settling and after loading
  const StageCourse& record = stopped.run.courses()[2];
  EXPECT_EQ(record.outcome, Outcome::stopped);
  EXPECT_EQ(stopped.run.history().values("step", record.rows),
            std::vector<double>(steps.begin(), steps.begin() + 5));
  const StageReport report =
      stopped.run.stages()[2]->report(stopped.run.history(), record.rows, record.outcome);
  EXPECT_TRUE(report.warnings.empty());
}

// Promise: a stop waits for one batch at most, however long it is to the next look.
TEST(Run, AStopWaitsForNoLook) {
  Trial trial(with(deck(kUniform + kSettle + kCompress), "history_strain = 1e-5", "history_strain = 0.5"));
  const std::int64_t soon = 5000;
  stop_at(trial.run, soon);
  trial.run.run();
  EXPECT_EQ(trial.run.outcome(), Outcome::stopped);
  EXPECT_LT(trial.run.simulation().motion().steps(), soon + 250);
}

TEST(Run, CallsBackAtTheStepAskedForAndChangesNothing) {
  const std::string text = deck(kUniform + kSettle + kCompress);
  Trial whole(text), watched(text);
  whole.run.run();
  std::vector<std::int64_t> called;
  const auto note = [&](pyroclast::Run& run) { called.push_back(run.simulation().motion().steps()); };
  watched.run.call_at(333, note);
  watched.run.call_at(7, [&](pyroclast::Run& run) {
    note(run);
    run.call_at(8, note);
  });
  watched.run.run();
  EXPECT_EQ(called, (std::vector<std::int64_t>{7, 8, 333}));
  expect_same(whole.run.history(), watched.run.history());
  EXPECT_THROW(watched.run.call_at(333, note), Error);
}

/// Takes the state out of one run and puts it into another.
class Copy : public StateVisitor {
 public:
  bool replaces() const override { return puts; }
  bool checks() const override { return puts; }
  bool puts = false;

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    auto& kept = rows_[name];
    EXPECT_EQ(puts, kept.has_value()) << "the name stands for two things: " << name;
    if (!puts) {
      kept.emplace(piece.data, piece.data + piece.item * piece.count);
      return;
    }
    ASSERT_TRUE(piece.resize || kept->size() == piece.item * piece.count) << name;
    std::byte* to = piece.resize ? piece.resize(kept->size() / piece.item) : piece.data;
    std::ranges::copy(*kept, to);
    kept.reset();
  }

 private:
  std::map<std::string, std::optional<std::vector<std::byte>>> rows_;
};

// Promise: what a run shows is all that it keeps. A new body, whose storage is filled with NaN before, goes
// on as the old one would have done, from within a batch of any stage, to the bit.
TEST(Run, AnotherBodyWithItsStateGoesOnAlike) {
  for (const std::string& text : {every_uniform_stage(), exposed(), creeping(every_uniform_stage()),
                                  creeping(exposed()), cooling(every_uniform_stage())}) {
    Trial whole(text);
    whole.run.run();
    const auto all = whole.run.history().values("step", {0, whole.run.history().row_count()});
    for (const StageCourse& record : whole.run.courses()) {
      const std::size_t middle = (record.rows.first + record.rows.last) / 2;
      const auto step = static_cast<std::int64_t>(0.5 * (all[middle - 1] + all[middle]));
      Trial broken_off(text), resumed(text);
      stop_at(broken_off.run, step);
      cut_batches(broken_off.run, 7);
      broken_off.run.run();
      ASSERT_EQ(broken_off.run.outcome(), Outcome::stopped);

      Copy copy;
      broken_off.run.visit_state(copy);
      copy.puts = true;
      resumed.run.visit_state(copy);
      resumed.run.run();
      expect_same(whole.run.history(), resumed.run.history());
      const auto one = in_plane::mechanics(whole.simulation->motion()).read(),
                 other = in_plane::mechanics(resumed.simulation->motion()).read();
      EXPECT_EQ(one.displacements(), other.displacements());
      EXPECT_EQ(one.stresses(), other.stresses());
      for (int z = 0; z < whole.simulation->model().zone_count(); ++z)
        ASSERT_EQ(one.creep_strain(z), other.creep_strain(z));
      for (std::size_t stage = 0; stage < whole.run.courses().size(); ++stage)
        EXPECT_EQ(report_of(whole, stage).lines, report_of(resumed, stage).lines);
    }
  }
}

TEST(Run, NeedsAStage) {
  Trial trial(deck(kUniform + kSettle));
  EXPECT_THROW(pyroclast::Run(*trial.simulation, {}), Error);
}

}  // namespace
}  // namespace pyroclast
