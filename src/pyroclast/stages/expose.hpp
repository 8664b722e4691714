#pragma once

#include <limits>

#include "pyroclast/simulation/loop/heat_flow.hpp"
#include "pyroclast/stages/exchange_stage.hpp"

namespace pyroclast {

/// Stage that lets heat flow through the specimen by its boundary conditions.
class Expose : public ExchangeStage {
 public:
  struct Keys {
    double duration = 0.0;                                            ///< s
    double frame_interval = std::numeric_limits<double>::infinity();  ///< interval, see OutputIntervals
    ExchangeStage::Keys exchange;
  };

  explicit Expose(const Keys& keys) : ExchangeStage(keys.exchange), keys_(keys) {}

  const char* kind() const override { return "expose"; }
  StageNeeds needs() const override;
  HeatingPlan heating() const override {
    return {.duration = keys_.duration, .is_restrained = is_restrained()};
  }
  double progress(const Simulation& simulation) const override;

 private:
  void begin_change(Simulation& simulation) override;
  bool change(Simulation& simulation, Exchange& exchange, int most_evaluations) override;
  double foreseen_change(Foreseen& foreseen) const override;
  std::optional<double> frames_in_time() const override;
  bool frame_time_came(const Simulation& simulation) override;
  void visit_change(StateVisitor& visitor) override;

  Keys keys_;
  HeatFlow flow_;
  double began_ = 0.0;       ///< heating time at the beginning, s
  double next_frame_ = 0.0;  ///< heating time of the next frame, s
};

StageKind expose_kind();

}  // namespace pyroclast
