#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/simulation/acting/acting.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

class Simulation;

/// End of a stage or a run, or its present state.
enum class Outcome : std::uint8_t {
  not_begun,
  running,
  completed,
  steady,         ///< temperatures no longer changed
  not_reached,    ///< the stage did not come to its goal
  stress_fallen,  ///< the stress fell below the stated fraction of the peak
  ran_away,       ///< the specimen failed under its load
  crushed,        ///< the specimen failed while it was being loaded
  not_settled,    ///< the body did not come to rest within the stated steps
  control_lost,   ///< a controlled opening could not follow its prescribed values
  unstable,       ///< a result is not finite
  stopped         ///< the run was stopped from outside
};

/// Describes an outcome in words, for people.
const char* describe(Outcome outcome);
/// Returns the word of an outcome for programs: "not_settled".
const char* id_of(Outcome outcome);
/// Tells whether a run with this outcome did what its deck asks, so that its results may be used.
bool is_good(Outcome outcome);

/// Verdict of a stage on the look that was just taken.
struct Verdict {
  bool over = false;  ///< true where the stage is over
  bool last = false;  ///< true where the run is over with the stage
  /// True where the fields are worth keeping; they are kept at the end of a stage anyhow.
  bool frame = false;
  Outcome outcome = Outcome::completed;
};

/// Kind of temperatures that a stage needs.
enum class FieldChoice : std::uint8_t { any, uniform, computed };

/// Need for even heating times at which a stage keeps frames, stated in the deck.
enum class FramesInTime : std::uint8_t { none, optional, needed };

/// Needs of stages of a kind.
struct StageNeeds {
  bool mechanics = true;                 ///< true for a stage that moves the body
  bool press = false;                    ///< true for a stage that moves the body by platens
  bool exchanges = false;                ///< true for a stage that hands temperatures over to the mechanics
  FieldChoice field = FieldChoice::any;  ///< kind of temperatures
  FramesInTime frames_in_time = FramesInTime::none;
};

/// Heating by a stage.
struct HeatingPlan {
  double duration = 0.0;          ///< time for which boundaries act, s
  std::optional<double> to = {};  ///< temperature of a uniform field at the end, °C
  bool is_restrained = false;     ///< true where platens that are held in place restrain the specimen
};

/// Probable cost of a stage.
struct Forecast {
  double steps = 0.0;             ///< steps of the mechanics
  double looks = 0.0;             ///< rows of the history
  double frames = 0.0;            ///< frames of the fields
  double exchanges = 0.0;         ///< exchanges of temperatures with the mechanics
  double heating_duration = 0.0;  ///< duration of conduction, s

  Forecast& operator+=(const Forecast& other);
};

/// Temperatures when a stage begins, as far as they can be foreseen.
struct Foreseen {
  double temperature = 0.0;  ///< mean temperature, °C
  double hottest = 0.0;      ///< highest temperature that boundaries may bring about, °C
};

/// What a result is of.
enum class ResultOf : std::uint8_t {
  test,         ///< the test: a laboratory would report it
  computation,  ///< the computation, or what the deck asked for: steps, tolerances, times of a driven test
  reason,       ///< text: why another result has no value
  doubt         ///< text: why another result does not tell what it should
};

/// Returns the word for it in files, "test".
const char* name_of(ResultOf of);

/// Number of digits of a result that a reader sees in as many as it has, up to four.
inline constexpr int kAnyDigits = -1;

/// What a result is, for readers that do not know its name.
struct ResultInfo {
  const char* name;  ///< name, with the unit as its end where it has one: "f_c_MPa"
  const char* unit;  ///< unit; "1" for a number, a count or a flag, "" for a text
  const char* label;
  const char* meaning;
  ResultOf of = ResultOf::test;
  int digits = kAnyDigits;    ///< digits behind the point in the unit in which a reader sees it
  const char* shown_in = "";  ///< unit in which a reader sees it: "1e-3" of strains; empty: its unit
};

/// Strength of a test: the last stage that measures it is the test of a run.
inline constexpr ResultInfo kStrength{
    "f_c_MPa", "MPa", "f_c", "compressive strength: stress at the peak", ResultOf::test, 1};

/// Result of a stage.
struct Result {
  using Value = std::variant<std::monostate, double, std::int64_t, bool, std::string>;

  // The makers are implicit, so that a report reads as a list of names and values.
  Result(std::string its_name, Value its_value, ResultOf its_of = ResultOf::test)
      : name(std::move(its_name)), value(std::move(its_value)), of(its_of), label(name) {}
  Result(const ResultInfo& info, Value its_value)
      : name(info.name),
        value(std::move(its_value)),
        of(info.of),
        unit(info.unit),
        label(info.label),
        meaning(info.meaning),
        digits(info.digits),
        shown_in(info.shown_in) {}

  std::string name;
  Value value;  ///< value; monostate where there is none
  ResultOf of;
  std::string unit = "1";
  std::string label;
  std::string meaning = {};
  int digits = kAnyDigits;
  std::string shown_in = {};
  std::string about = {};  ///< name of the result to which this one belongs; of a reason empty: the stage
};

/// Returns why a result has no value, or why it is in doubt: "E_none_because" of "E_GPa".
/// \param why  reason; none where there is none
Result reason_of(const ResultInfo& info, Result::Value why);
Result doubt_of(const ResultInfo& info, Result::Value why);
/// Returns a reason for all results of a stage.
Result reason_of_all(std::string why);

/// Returns the value where it is there, else none.
Result::Value value_if(bool is_there, double value);

/// Returns the last value of a column in some rows; none where there are no rows.
Result::Value last_value(const History& history, std::string_view column, RowRange rows);

/// Report on a stage.
struct StageReport {
  std::vector<Result> results;
  std::vector<std::string> lines;  ///< lines for people
  /// Warnings, each of which keeps the results from being taken at face value.
  std::vector<std::string> warnings;
  /// Row of the stage, from 0, after which nothing changed the results; empty: the last row.
  std::optional<std::size_t> decided_at = {};
};

/// Stage: an operation on a simulation that goes on until its verdict says that it is over.
///
/// A run calls `begin`, and then repeatedly calls `read` and `advance` until a look is due, takes the look,
/// in which the stage may `look` too, and asks `judge`. All numbers that a stage keeps between two batches
/// are shown to `visit_state`.
class Stage {
 public:
  virtual ~Stage() = default;

  /// Returns the name by which a deck asks for the stage.
  virtual const char* kind() const = 0;
  virtual StageNeeds needs() const = 0;
  /// Returns the place where the deck asks for the stage, "deck.toml:40: stages[0]"; empty where no deck
  /// does.
  const std::string& place() const { return place_; }
  void set_place(std::string place) { place_ = std::move(place); }
  /// Describes what goes on between two looks where that may take long, "moving the platen down"; may be
  /// empty.
  virtual std::string doing() const { return {}; }
  virtual HeatingPlan heating() const { return {}; }
  /// Returns the largest change of temperature that the stage hands over at once, K; 0 where it hands over
  /// none.
  virtual double exchange_increment() const { return 0.0; }
  /// Returns the names of the sets on which the stage acts.
  virtual std::vector<std::string> sets() const { return {}; }

  /// Throws Error where the stage cannot be done, before any stage is begun.
  /// \param acting  supports and loads before the stage, which changes them to those that it leaves
  virtual void check(const Simulation&, Acting&) const {}
  /// Tells whether the stage loads the body from outside.
  virtual bool loads() const { return false; }
  /// Returns the stress that the stage brings on the upper platen and holds, Pa, compression positive; 0
  /// where it brings none.
  virtual double held_stress() const { return 0.0; }
  /// Prepares supports and loads of the body; moves nothing.
  virtual void begin(Simulation& simulation) = 0;
  /// Reads what the next batch needs of the body to steer it. What it reads travels with the question whether
  /// to stop, see Ranks::together; so it may be called twice.
  virtual void read(const Simulation&) {}
  /// Moves on by one batch: at most `most_steps` steps of the mechanics, or as many evaluations of the heat
  /// solver as it takes at once (HeatSolver::stages_per_batch). Returns true when a look is due. Where
  /// batches end changes no result.
  virtual bool advance(Simulation& simulation, int most_steps) = 0;
  /// Takes what `judge` asks of the body. What it takes travels with the row of the history, see
  /// Ranks::together; so it may be called twice.
  virtual void look(const Simulation&) {}
  /// Judges each look that `advance` asked for.
  virtual Verdict judge(Simulation& simulation) = 0;
  /// Returns the share that is done, 0 to 1, as far as it can be foreseen.
  virtual double progress(const Simulation& simulation) const = 0;

  /// Returns the stage's own columns in the history; at each look of the stage `values` returns their values,
  /// in the same order.
  virtual std::vector<Column> columns() const { return {}; }
  virtual std::vector<double> values() const { return {}; }

  /// Names all results that the stage can have, whatever became of it; results that the stage does not have
  /// are empty.
  /// \param rows  rows of the stage in the history; none before its first look
  virtual StageReport report(const History& history, RowRange rows, Outcome outcome) const = 0;
  /// Forecasts the cost of the stage.
  /// \param foreseen  temperatures at the beginning of the stage, which changes them to those that it leaves
  virtual Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const = 0;

  virtual void visit_state(StateVisitor& visitor) = 0;

 private:
  std::string place_;
};

}  // namespace pyroclast
