#pragma once

#include "pyroclast/stages/exchange_stage.hpp"

namespace pyroclast {

/// Stage that changes the temperature of the whole specimen evenly (paper, section 4).
class Heat : public ExchangeStage {
 public:
  struct Keys {
    double to = 0.0;    ///< temperature at the end, °C
    double rate = 0.0;  ///< rate, K/s, positive; heating or cooling follows from `to`
    ExchangeStage::Keys exchange;
  };

  explicit Heat(const Keys& keys) : ExchangeStage(keys.exchange), keys_(keys) {}

  const char* kind() const override { return "heat"; }
  StageNeeds needs() const override { return {.exchanges = true, .field = FieldChoice::uniform}; }
  HeatingPlan heating() const override { return {.to = keys_.to, .is_restrained = is_restrained()}; }
  double progress(const Simulation& simulation) const override;

 private:
  void begin_change(Simulation& simulation) override;
  void read_before_change(const Simulation& simulation) override;
  bool change(Simulation& simulation, Exchange& exchange, int most_evaluations) override;
  double foreseen_change(Foreseen& foreseen) const override;
  void visit_change(StateVisitor& visitor) override;

  Keys keys_;
  Press::EvenMotion strain_;       ///< even motion so far
  double stress_ = 0.0;            ///< on the platens, Pa, tension positive
  Press::EvenMotion last_strain_;  ///< even motion before the last exchange
  double last_change_ = 0.0;       ///< change of temperature at the last exchange, K; 0 before any
};

StageKind heat_kind();

}  // namespace pyroclast
