#pragma once

#include <limits>

#include "pyroclast/simulation/loop/heat_flow.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Stage that conducts heat alone: the body does not move. An exchange in a later stage hands the
/// temperatures over.
///
/// There is a look at multiples of the interval, at each frame, at the end, and, with a steady rate, when the
/// boundary values become constant. Frames are at multiples of their interval and at the end.
class Conduct : public Stage {
 public:
  struct Keys {
    double duration = 0.0;  ///< s
    /// Change of temperature since the last look at which a look comes, K. Looks also come at multiples of
    /// the interval, s; no change makes the stage miss one.
    double change = std::numeric_limits<double>::infinity();
    double interval = std::numeric_limits<double>::infinity();
    double frame_interval = std::numeric_limits<double>::infinity();  ///< interval, see OutputIntervals
    /// L2 norm of the temperature's rate (Conduction::rate) below which the stage ends, K/s. It does not end
    /// before the boundary values have become constant, because a fire that starts slowly is no steady state.
    std::optional<double> steady_rate{};
  };

  explicit Conduct(const Keys& keys) : keys_(keys) {}

  const char* kind() const override { return "conduct"; }
  StageNeeds needs() const override;
  HeatingPlan heating() const override { return {.duration = keys_.duration}; }
  void begin(Simulation& simulation) override;
  bool advance(Simulation& simulation, int most_evaluations) override;
  Verdict judge(Simulation& simulation) override;
  double progress(const Simulation& simulation) const override;
  StageReport report(const History& history, RowRange rows, Outcome outcome) const override;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const override;
  void visit_state(StateVisitor& visitor) override;

 private:
  double end() const { return kept_.began + keys_.duration; }
  /// Returns the rate below which the field is steady now, K/s; 0 where no field counts as steady.
  double steady_rate(const Simulation& simulation) const;
  void begin_flow(const Simulation& simulation);

  Keys keys_;
  HeatFlow flow_;
  /// All that lasts from one batch to the next.
  struct Kept {
    double began = 0.0;        ///< heating time at the beginning, s
    double steady_from = 0.0;  ///< heating time from which boundary values are constant, s
    double flow_steady = 0.0;  ///< steady rate of the present flow, K/s
    double next_frame = 0.0;   ///< heating time of the next frame, s
  } kept_;
};

StageKind conduct_kind();

}  // namespace pyroclast
