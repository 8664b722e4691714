#pragma once

#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Brings the force on the upper platen to a value and lets the body come to rest under it. The platen does
/// not tilt; its force is held from then on until a stage drives or fixes it.
class Load : public Stage {
 public:
  struct Keys {
    double stress = 0.0;            ///< force over the specimen's area, Pa, compression positive
    std::optional<double> level;    ///< stress over f_c, where the deck gives it so
    double strength = 0.0;          ///< that f_c, Pa
    std::string strength_of;        ///< whose it is
    double ramp_time = 0.0;         ///< time over which the force is brought up, s
    double unbalanced_ratio = 0.0;  ///< at rest when below
    std::int64_t most_steps = 0;    ///< after the ramp; gives up, and says so, after as many
    /// The specimen is crushed when its ends have come nearer by this share of its height since the stage
    /// began.
    double failure_strain = 0.0;
  };

  explicit Load(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "load"; }
  StageNeeds needs() const override { return {.press = true}; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  void adjust_force(Simulation& simulation) const;
  /// Share of the change of force that is held for kStepsPerForce steps from one on.
  double share_held_from(std::int64_t steps, double time_step) const;

  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t steps = 0;     ///< since the stage began
    double first_stress = 0.0;  ///< held before, Pa
    double first_strain = 0.0;  ///< of the specimen, before
  } kept_;
};

StageKind load_kind();

/// Share of a ramp that is over, 0 to 1.
/// \param ramp_time  s; 0: there is none
double ramp_share(std::int64_t steps, double time_step, double ramp_time);

}  // namespace pyroclast
