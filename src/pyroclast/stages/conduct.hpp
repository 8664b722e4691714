#pragma once

#include <limits>

#include "pyroclast/simulation/heat_flow.hpp"
#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Conducts heat alone: the body does not move. An exchange in a later stage hands the temperatures over.
///
/// There is a look at multiples of the interval, at each frame, at the end, and, with a steady rate, when the
/// boundary values become constant; frames are at multiples of their interval and at the end.
class Conduct : public Stage {
 public:
  struct Keys {
    double duration = 0.0;  ///< s
    /// Looks come when a temperature has changed by so much since the last one, K, and at multiples of the
    /// interval, s. No interval is missed for the sake of a change.
    double change = std::numeric_limits<double>::infinity();
    double interval = std::numeric_limits<double>::infinity();
    double frame_interval = std::numeric_limits<double>::infinity();  ///< see OutputIntervals
    /// Ends when the L2 norm of the temperature's rate (Conduction::rate) falls below, K/s. Not before the
    /// boundary values have become constant, because a fire that starts slowly is no steady state.
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
  /// Rate below which the field is steady now, K/s; 0: none is.
  double steady_rate(const Simulation& simulation) const;
  void begin_flow(const Simulation& simulation);

  Keys keys_;
  HeatFlow flow_;
  /// All that lasts from one batch to the next.
  struct Kept {
    double began = 0.0;        ///< heating time, s
    double steady_from = 0.0;  ///< boundary values are constant, s
    double flow_steady = 0.0;  ///< steady rate of the present flow, K/s
    double next_frame = 0.0;   ///< s
  } kept_;
};

StageKind conduct_kind();

}  // namespace pyroclast
