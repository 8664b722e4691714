#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pyroclast/stages/drive_keys.hpp"
#include "pyroclast/stages/opening_control.hpp"
#include "pyroclast/stages/until.hpp"

namespace pyroclast {

/// Stage that holds, moves or loads sets of gridpoints. Sets that it holds or loads stay so after the stage,
/// until another drive changes them; sets that it moved are held where they came to.
class Drive : public Stage {
 public:
  explicit Drive(DriveKeys keys);

  const char* kind() const override { return "drive"; }
  StageNeeds needs() const override { return {}; }
  void check(const Simulation& simulation, Acting& acting) const override;
  bool loads() const override { return keys_.loads(); }
  std::vector<std::string> sets() const override;
  /// Throws Error where the drive would act on a set that another drive, which is under way, keeps moving or
  /// loading.
  /// \param supports  supports with those of this drive
  void check_beside(const Drive& under_way, const Simulation& simulation, const Supports& supports) const;
  void begin(Simulation& simulation) override;
  void read(const Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  void look(const Simulation& simulation) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  std::vector<Column> columns() const override;
  std::vector<double> values() const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  double load_factor() const { return control_ ? control_->load_factor() : 0.0; }
  LoadBefore before() const;
  double came(std::size_t action, const LoadsBySet& loads, double interval) const;
  std::int64_t steps_per_adjustment(const Simulation& simulation) const;
  std::int64_t duration_in_steps(const Simulation& simulation) const;
  std::int64_t steps_to_come(const Simulation& simulation, std::int64_t interval) const;
  std::int64_t steps_per_look(const Simulation& simulation) const;
  double time(const Simulation& simulation) const;
  void act(Simulation& simulation, std::int64_t adjustment);
  void halt(Simulation& simulation);

  DriveKeys keys_;
  RecordWatch watch_;
  std::optional<OpeningControl> control_;
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
    bool is_driven = false;  ///< true while the body is driven on
    BodyFigures body;
  } kept_;
  double ratio_seen_ = 0.0;  ///< unbalanced ratio at the last look
};

StageKind drive_kind();

}  // namespace pyroclast
