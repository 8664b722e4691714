#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/material/curve.hpp"
#include "pyroclast/simulation/column_info.hpp"
#include "pyroclast/simulation/loads.hpp"
#include "pyroclast/stages/record_results.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Action of a drive on a set of gridpoints.
enum class ActionKind : std::uint8_t { hold, release, velocity, force, pressure };

/// Stage that holds, moves or loads sets of gridpoints. Sets that it holds or loads stay so after the stage,
/// until another drive changes them; sets that it moved are held where they came to.
class Drive : public Stage {
 public:
  struct Action {
    std::string set;
    ActionKind kind = ActionKind::hold;
    std::vector<int> components = {};  ///< components that are held, released or moved
    double amount = 0.0;               ///< velocity, m/s, force, N, or pressure, Pa
    Vec<3> direction{};                ///< unit direction of a force
    bool is_follower = false;          ///< true for a pressure that follows the faces
    double ramp_time = 0.0;            ///< time in which the amount comes evenly to its value, s
    std::optional<Curve> factor = {};  ///< factor of the amount, over the time since the stage began, s
    std::string place = "";            ///< place in the deck, for messages

    const std::vector<int>& set_of(const Model& model) const { return model.set(set); }
  };
  /// Condition on a record that ends the stage.
  struct Until {
    /// Kind of condition. A rate is the size of the mean change since the look before.
    enum class Kind : std::uint8_t { above, below, share_of_peak, rate_above, rate_below };
    std::string record;
    Kind kind = Kind::above;
    double value = 0.0;                     ///< value in SI, or a share
    std::optional<double> least_peak = {};  ///< size above which a peak counts for share_of_peak, SI
    std::string place = "";
  };
  /// Control that makes an opening grow at a rate, whatever load this needs: also where the load, and
  /// everything it drives, must go back. A pair of forces across the opening keeps it at its prescribed
  /// value; the pair is stiffer than the body softens there. The loads of the stage follow so that the pair
  /// has nothing left to do.
  struct Control {
    std::string record;          ///< record of an opening
    double rate = 0.0;           ///< m/s
    double stiffness = 0.0;      ///< stiffness of the pair, N/m
    double response_time = 0.0;  ///< time in which the loads take over from the pair, s
    std::string place = "";
  };
  struct Keys {
    double duration = 0.0;  ///< longest duration, s
    std::vector<Action> actions;
    std::vector<Until> until;
    std::optional<Control> control = {};
    /// Unbalanced ratio at which the body rests and the stage ends, once all ramps have ended.
    std::optional<double> unbalanced_ratio;
    double look_interval = 0.0, frame_interval = 0.0;  ///< s
    std::vector<RecordParameters> records = {};        ///< records of the run
    std::vector<RecordResult> results = {};
  };

  explicit Drive(Keys keys);

  const char* kind() const override { return "drive"; }
  StageNeeds needs() const override { return {}; }
  void check(const Simulation& simulation, Acting& acting) const override;
  bool loads() const override;
  std::vector<std::string> sets() const override;
  /// Throws Error where the drive would act on a set that another drive, which is under way, keeps moving or
  /// loading.
  /// \param supports  supports with those of this drive
  void check_beside(const Drive& under_way, const Simulation& simulation, const Supports& supports) const;
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  std::vector<Column> columns() const override;
  /// Returns the columns of a drive with a control.
  static std::vector<ColumnInfo> control_columns();
  std::vector<double> values() const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  using ChangedLoads = std::map<std::string, SetLoad>;  ///< loads by set
  static bool is_motion(const Action& a) {
    return a.kind != ActionKind::force && a.kind != ActionKind::pressure;
  }
  void require_consistent() const;
  std::string describe_hold(const Model& model, const Supports& supports, int gridpoint, int component,
                            const char* first = "") const;
  void require_free(const Model& model, const Supports& supports, const std::string& set, const Vec<3>& force,
                    const std::string& place) const;
  void require_effect(const Action& action, const Acting& acting) const;
  double share(const Action& action, double time) const;
  double part(const Action& action, double time) const;
  template <class Before>
  ChangedLoads loads_at(double time, Before before) const;
  ChangedLoads loads_at(double time) const;
  ChangedLoads loads_foreseen(double time, const Acting& acting) const;
  const std::string& place_of_load(const std::string& set) const;
  const Action& longest_ramp(const std::string& set, ActionKind kind) const;
  SetLoad first_load(const std::string& set) const;
  double came(std::size_t action, const ChangedLoads& loads, double interval) const;
  void steer(const Simulation& simulation, double time, std::int64_t interval, ChangedLoads& loads);
  double unit_force() const;
  double total_load(double factor) const;
  std::int64_t steps_per_adjustment(const Simulation& simulation) const;
  static double largest_stiffness(const Simulation& simulation, const Control& control);
  std::int64_t duration_in_steps(const Simulation& simulation) const;
  std::int64_t steps_to_come(const Simulation& simulation, std::int64_t interval) const;
  void act(Simulation& simulation, std::int64_t adjustment);
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
    std::vector<SetLoad> first_loads;  ///< loads on the set of each action, when the stage began
    std::vector<double> velocity;      ///< present velocity of each action, m/s
    // Progress of what drives the body: how far each action came, m, N or Pa, and how far at most; for how
    // long, s.
    std::vector<double> came, farthest;
    double driven = 0.0;
    bool is_driven = false;                ///< true while the body is driven on
    bool is_lost = false;                  ///< true where the controlled opening left its prescribed value
    bool is_beyond_noise = false;          ///< true once the motion is no noise, so that peaks count
    std::vector<RecordPeak> record_peaks;  ///< peak of each record
    std::vector<Peak> peaks;               ///< peaks of the records of `until`
    std::vector<double> last;              ///< value of each record of `until` at the last look
    /// Greatest size of the leading record, and the greatest at a frame, SI.
    double leading_peak = 0.0, framed_peak = 0.0;
    double last_look = 0.0;  ///< time of the last look, s
    /// Controlled opening when the stage began and at the last look, m.
    double first_opening = 0.0, last_opening = 0.0;
    /// Factor of the loads by the control; force of the pair, N, positive where it opens.
    double load_factor = 0.0, pair_force = 0.0;
    double largest_pair = 0.0, largest_factor = 0.0;  ///< largest values at looks
    /// Largest sum of the loads and the pair beside them, N.
    double largest_with_pair = 0.0;
    double largest_load = 0.0;  ///< largest load without the pair, N
    double pair_work = 0.0;     ///< work of the pair, J
    double first_work = 0.0;    ///< work of the loads when the stage began, J
    /// Largest kinetic energy while peaks do not count yet, J.
    double most_kinetic = 0.0;
    BodyFigures body;
  } kept_;
};

StageKind drive_kind();

}  // namespace pyroclast
