#pragma once

#include <filesystem>

#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Stage that brings the force on the upper platen to a value and lets the body come to rest under it. The
/// platen does not tilt; its force is held from then on until a stage drives or fixes it.
class Load : public Stage {
 public:
  struct Keys {
    double stress = 0.0;            ///< force over the specimen's area, Pa, compression positive
    std::optional<double> level;    ///< stress over f_c, where the deck gives it so
    double strength = 0.0;          ///< f_c of `level`, Pa
    std::string strength_of;        ///< owner of that f_c
    std::filesystem::path run = {};  ///< run that measured it, or its summary; else empty
    double ramp_time = 0.0;         ///< time over which the force is brought up, s
    double unbalanced_ratio = 0.0;  ///< unbalanced ratio below which the body is at rest
    std::int64_t most_steps = 0;    ///< most steps after the ramp; then the stage gives up, and says so
    /// Share of the specimen's height by which its ends have come nearer since the stage began when the
    /// specimen counts as crushed.
    double failure_strain = 0.0;
  };

  explicit Load(const Keys& keys) : keys_(keys) {}

  const Keys& keys() const { return keys_; }
  const char* kind() const override { return "load"; }
  StageNeeds needs() const override { return {.press = true}; }
  double held_stress() const override { return keys_.stress; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_steps) override;
  void look(const Simulation& simulation) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  void adjust_force(Simulation& simulation) const;
  /// Returns the share of the change of force that is held for kStepsPerForce steps from a given step on.
  double share_held_from(std::int64_t steps, double time_step) const;

  Keys keys_;
  /// All that lasts from one batch to the next.
  struct Kept {
    std::int64_t steps = 0;     ///< steps since the stage began
    double first_stress = 0.0;  ///< stress held before the stage, Pa
    double first_strain = 0.0;  ///< strain of the specimen before the stage
  } kept_;
  /// Strain of the specimen and unbalanced ratio at the last look.
  double strain_seen_ = 0.0, ratio_seen_ = 0.0;
};

StageKind load_kind();

/// Returns the share of a ramp that is over, 0 to 1.
/// \param ramp_time  s; 0: there is no ramp
double ramp_share(std::int64_t steps, double time_step, double ramp_time);

}  // namespace pyroclast
