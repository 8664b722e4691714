#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/simulation/loads.hpp"
#include "pyroclast/stages/record_results.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// What a drive does to a set of gridpoints.
enum class ActionKind : std::uint8_t { hold, release, velocity, force, pressure };

/// Holds, moves or loads sets of gridpoints. What it holds or loads stays so after it, until another drive
/// changes it; what it moved is held where it came to.
class Drive : public Stage {
 public:
  struct Action {
    std::string set;
    ActionKind kind = ActionKind::hold;
    std::vector<int> components = {};  ///< held, released or moved
    double amount = 0.0;               ///< m/s, N or Pa
    Vec<2> direction{};                ///< of a force, unit
    bool is_follower = false;          ///< of a pressure
    double ramp_time = 0.0;            ///< in which the amount comes to its value, evenly, s
    std::optional<Curve> factor = {};  ///< of the amount, over the time since the stage began, s
    std::string place = "";            ///< in the deck, for messages

    const std::vector<int>& set_of(const Model<2>& model) const { return model.set(set); }
  };
  /// A condition on a record that ends the stage.
  struct Until {
    /// Rates are sizes of the mean change since the look before.
    enum class Kind : std::uint8_t { above, below, share_of_peak, rate_above, rate_below };
    std::string record;
    Kind kind = Kind::above;
    double value = 0.0;                     ///< in SI, or a share
    std::optional<double> least_peak = {};  ///< of share_of_peak, above which a peak counts, SI
    std::string place = "";
  };
  /// Makes an opening grow at a rate, whatever the load must do for that: also where the load must go back,
  /// and what it drives with it. A pair of forces across the opening, stiffer than the body softens there,
  /// holds it to its course, and the loads of the stage follow so that the pair has nothing left to do.
  struct Control {
    std::string record;          ///< an opening
    double rate = 0.0;           ///< m/s
    double stiffness = 0.0;      ///< of the pair, N/m
    double response_time = 0.0;  ///< in which the loads take over what the pair does, s
    std::string place = "";
  };
  struct Keys {
    double duration = 0.0;  ///< s, at the latest
    std::vector<Action> actions;
    std::vector<Until> until;
    std::optional<Control> control = {};
    /// The stage ends when the body rests at this ratio, once all ramps have ended.
    std::optional<double> unbalanced_ratio;
    double look_interval = 0.0, frame_interval = 0.0;  ///< s
    std::vector<RecordParameters> records = {};        ///< of the run
    std::vector<RecordResult> results = {};
  };

  explicit Drive(Keys keys);

  const char* kind() const override { return "drive"; }
  StageNeeds needs() const override { return {}; }
  void check(const Simulation& simulation, Acting<2>& acting) const override;
  bool loads() const override;
  std::vector<std::string> sets() const override;
  /// Throws Error where it would act on what another one, which is under way, moves or loads again and again.
  void check_beside(const Drive& under_way, const Simulation& simulation) const;
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  std::vector<Column> columns() const override;
  std::vector<double> values() const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  using ChangedLoads = std::map<std::string, SetLoad<2>>;  ///< by set
  static bool is_motion(const Action& a) {
    return a.kind != ActionKind::force && a.kind != ActionKind::pressure;
  }
  void require_consistent() const;
  void require_effect(const Action& action, const Acting<2>& acting) const;
  double share(const Action& action, double time) const;
  double part(const Action& action, double time) const;
  template <class Before>
  ChangedLoads loads_at(double time, Before before) const;
  ChangedLoads loads_at(double time) const;
  ChangedLoads loads_at_end(const Simulation& simulation, const Acting<2>& acting) const;
  const Action& longest_ramp(const std::string& set, ActionKind kind) const;
  SetLoad<2> first_load(const std::string& set) const;
  double came(std::size_t action, const ChangedLoads& loads, double interval) const;
  void steer(const Simulation& simulation, double time, ChangedLoads& loads);
  double unit_force() const;
  double total_load(double factor) const;
  std::int64_t steps_per_adjustment() const;
  std::int64_t duration_in_steps(const Simulation& simulation) const;
  std::int64_t steps_to_come(const Simulation& simulation) const;
  void act(Simulation& simulation);
  void take_peaks(const Simulation& simulation);
  bool is_met(std::size_t condition, const Simulation& simulation);
  bool is_beyond_noise(double share, const Simulation& simulation);
  bool has_fallen(const Simulation& simulation);
  void add_control(StageReport& report, double work) const;
  std::string describe_unmet(std::size_t condition) const;
  double time(const Simulation& simulation) const;
  std::int64_t steps_in(const Simulation& simulation, double interval) const;
  void halt(Simulation& simulation);

  Keys keys_;
  std::optional<std::string> leading_;  ///< record that the test is about: the first force, else stress
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t steps = 0;
    std::int64_t frames = 0;
    std::vector<SetLoad<2>> first_loads;  ///< of the set of each load, when the stage began
    std::vector<double> velocity;         ///< of each action now, m/s
    // What drives the body on: how far each action came, m, N or Pa, and how far at most; for how long, s.
    std::vector<double> came, farthest;
    double driven = 0.0;
    bool is_driven = false;                        ///< now
    bool is_lost = false;                          ///< the controlled opening left its course
    bool is_beyond_noise = false;                  ///< since when peaks count
    std::vector<RecordPeak> record_peaks;          ///< of each record
    std::vector<Peak> peaks;                       ///< of the records of `until`
    std::vector<double> last;                      ///< likewise: value at the last look
    double leading_peak = 0.0, framed_peak = 0.0;  ///< of the leading record: greatest size; with a frame, SI
    double last_look = 0.0;                        ///< s
    double first_opening = 0.0, last_opening = 0.0;   ///< controlled, when the stage began, m
    double load_factor = 0.0, pair_force = 0.0;       ///< of the control; N, opening it
    double largest_pair = 0.0, largest_factor = 0.0;  ///< at looks
    double largest_with_pair = 0.0;                   ///< of the loads and the pair beside them, N
    double largest_load = 0.0;                        ///< of the loads alone, N
    double pair_work = 0.0;                           ///< J
    double first_work = 0.0;                          ///< of loads, when the stage began, J
    double most_kinetic = 0.0;                        ///< energy, while peaks do not count yet, J
    BodyFigures body;
  } kept_;
};

StageKind drive_kind();

}  // namespace pyroclast
