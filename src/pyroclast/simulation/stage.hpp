#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/simulation/acting.hpp"
#include "pyroclast/simulation/history.hpp"

namespace pyroclast {

class Simulation;

/// How a stage or a run ended, or where it stands.
enum class Outcome : std::uint8_t {
  not_begun,
  running,
  completed,
  steady,         ///< temperatures no longer changed
  not_reached,    ///< what a stage should come to
  stress_fallen,  ///< below the stated fraction of the peak
  ran_away,       ///< the specimen failed under its load
  crushed,        ///< it failed while it was being loaded
  not_settled,    ///< did not come to rest within the stated steps
  control_lost,   ///< a controlled opening left its course
  unstable,       ///< a result is not finite
  stopped         ///< from outside
};

/// In words, for people.
const char* describe(Outcome outcome);
/// For programs: "not_settled".
const char* id_of(Outcome outcome);
/// Whether a run that ended so did what its deck asks, so that its results may be taken for such.
bool is_good(Outcome outcome);

/// What a stage says of the look that was just taken.
struct Verdict {
  bool over = false;   ///< the stage is over
  bool last = false;   ///< and the run with it
  bool frame = false;  ///< the fields are worth keeping; they are kept at the end of a stage anyhow
  Outcome outcome = Outcome::completed;
};

/// What the temperatures of a stage are.
enum class FieldChoice : std::uint8_t { any, uniform, computed };

/// Whether the deck says at which even heating times a stage keeps frames.
enum class FramesInTime : std::uint8_t { none, optional, needed };

/// What stages of a kind need of a simulation.
struct StageNeeds {
  bool mechanics = true;                 ///< moves the body
  bool press = false;                    ///< by platens
  bool exchanges = false;                ///< hands temperatures over to the mechanics
  FieldChoice field = FieldChoice::any;  ///< of temperatures
  FramesInTime frames_in_time = FramesInTime::none;
};

/// How a stage heats.
struct HeatingPlan {
  double duration = 0.0;          ///< for which boundaries act, s
  std::optional<double> to = {};  ///< temperature of a uniform field at its end, °C
  bool is_restrained = false;     ///< between platens that are held in place
};

/// What a stage will probably cost.
struct Forecast {
  double steps = 0.0;             ///< of the mechanics
  double looks = 0.0;             ///< rows of the history
  double frames = 0.0;            ///< of the fields
  double exchanges = 0.0;         ///< of temperatures with the mechanics
  double heating_duration = 0.0;  ///< of conduction, s

  Forecast& operator+=(const Forecast& other);
};

/// Where the simulation stands when a stage begins, as far as it can be foreseen.
struct Foreseen {
  double temperature = 0.0;  ///< mean, °C
  double hottest = 0.0;      ///< that boundaries may bring about, °C
};

/// A result with its unit in the name: "f_c_MPa".
struct Result {
  using Value = std::variant<std::monostate, double, std::int64_t, bool, std::string>;

  std::string name;
  Value value;  ///< monostate: there is none
};

/// The value where it is there, else none.
Result::Value value_if(bool is_there, double value);

/// Of a column at the last of some rows; none where there are no rows.
Result::Value last_value(const History& history, std::string_view column, RowRange rows);

/// What came of a stage.
struct StageReport {
  std::vector<Result> results;
  std::vector<std::string> lines;     ///< for people
  std::vector<std::string> warnings;  ///< each keeps the results from being taken at face value
  /// Row of the stage, from 0, after which nothing changed the results; empty: its last.
  std::optional<std::size_t> decided_at = {};
};

/// Something that is done to a simulation until its verdict says that it is over.
///
/// A run calls `begin`, and then again and again `advance` until a look is due, takes the look, and asks
/// `judge`. All that a stage keeps between two batches are the numbers that it shows to `visit_state`.
class Stage {
 public:
  virtual ~Stage() = default;

  /// The name by which a deck asks for it.
  virtual const char* kind() const = 0;
  virtual StageNeeds needs() const = 0;
  /// Where the deck asks for it, "deck.toml:40: stages[0]"; empty where no deck does.
  const std::string& place() const { return place_; }
  void set_place(std::string place) { place_ = std::move(place); }
  /// What goes on between two looks where that may take long, "moving the platen down"; may be empty.
  virtual std::string doing() const { return {}; }
  virtual HeatingPlan heating() const { return {}; }
  /// Names of the sets that it acts on.
  virtual std::vector<std::string> sets() const { return {}; }

  /// Throws Error where the stage cannot be done, before any stage is begun.
  /// \param acting  before the stage, which changes it to what it leaves
  virtual void check(const Simulation&, Acting<2>&) const {}
  /// Whether it loads the body from outside.
  virtual bool loads() const { return false; }
  /// Prepares what acts on the body; moves nothing.
  virtual void begin(Simulation& simulation) = 0;
  /// Moves on by one batch: at most so many steps of the mechanics, or evaluations of the heat solver. True
  /// when a look is due. Where batches end changes no result.
  virtual bool advance(Simulation& simulation, int most_steps) = 0;
  /// Called after each look that `advance` asked for.
  virtual Verdict judge(Simulation& simulation) = 0;
  /// Share that is done, 0 to 1, as far as it can be foreseen.
  virtual double progress(const Simulation& simulation) const = 0;

  /// Columns of its own in the history, and at each look of the stage their values, in the same order.
  virtual std::vector<Column> columns() const { return {}; }
  virtual std::vector<double> values() const { return {}; }

  /// Names all results that the stage can have, whatever became of it; those that it does not have are empty.
  /// \param rows  of the stage, in the history; none before its first look
  virtual StageReport report(const History& history, RowRange rows, Outcome outcome) const = 0;
  /// \param foreseen  at the beginning of the stage; the stage changes it to what it leaves
  virtual Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const = 0;

  virtual void visit_state(StateVisitor& visitor) = 0;

 private:
  std::string place_;
};

}  // namespace pyroclast
