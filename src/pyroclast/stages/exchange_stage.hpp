#pragma once

#include <optional>

#include "pyroclast/stages/registry.hpp"

namespace pyroclast {

/// Difference below which temperatures are the same, K.
inline constexpr double kSameTemperature = 1e-6;

/// Stage that changes temperatures and hands them over to the mechanics: a look follows each exchange.
class ExchangeStage : public Stage {
 public:
  struct Keys {
    Coupling coupling;
    double frame_temperature = 0.0;  ///< interval, see OutputIntervals
    int dimension = 2;               ///< dimension of the body
  };

  void begin(Simulation& simulation) final;
  void read(const Simulation& simulation) final;
  bool advance(Simulation& simulation, int most_steps) final;
  Verdict judge(Simulation& simulation) final;
  double exchange_increment() const final { return coupling().increment; }
  std::vector<Column> columns() const final { return Exchange::columns(); }
  std::vector<double> values() const final { return exchange_.values(); }
  StageReport report(const History& history, RowRange rows, Outcome outcome) const final;
  Forecast forecast(const Simulation& simulation, Foreseen& foreseen) const final;
  void visit_state(StateVisitor& visitor) final;

 protected:
  explicit ExchangeStage(const Keys& keys) : keys_(keys), exchange_(keys.coupling) {}

  const Coupling& coupling() const { return keys_.coupling; }
  bool is_restrained() const { return keys_.coupling.platen == PlatenControl::fixed; }
  double first_temperature() const {
    return kept_.first_temperature;
  }  ///< Returns the mean at the beginning, °C.

  virtual void begin_change(Simulation& simulation) = 0;
  /// Reads what `change` needs of the body, see Stage::read.
  virtual void read_before_change(const Simulation&) {}
  /// Changes the temperatures towards the next exchange by one batch, and hands them over at the end; returns
  /// true when done.
  virtual bool change(Simulation& simulation, Exchange& exchange, int most_evaluations) = 0;
  /// Returns the change of temperature to come as far as it can be foreseen, K, and sets the temperature at
  /// its end.
  virtual double foreseen_change(Foreseen& foreseen) const = 0;
  /// Returns the frames to come where the heating time decides when they are due; empty where the temperature
  /// decides.
  virtual std::optional<double> frames_in_time() const { return std::nullopt; }
  /// Tells, once, whether such a frame is due.
  virtual bool frame_time_came(const Simulation&) { return false; }
  virtual void visit_change(StateVisitor& visitor) = 0;

 private:
  double interval_of(double temperature) const;

  Keys keys_;
  Exchange exchange_;
  /// All that lasts from one batch to the next.
  struct Kept {
    bool is_settling =
        false;  ///< true from handing the temperatures over until the body has come to rest at them
    bool has_press = false;
    double load_stress = 0.0;  ///< stress held at the beginning, Pa
    double first_temperature = 0.0;
    double last_interval = 0.0;  ///< interval of temperature in which the last row of the history lay
  } kept_;
};

/// Reads the keys that stages with exchanges share. Errors are recorded in the deck.
ExchangeStage::Keys read_exchange(const Section& own, const StageTables& tables);

/// Reads [coupling].
Coupling read_coupling(const Section& s, const Coupling* general = nullptr);

}  // namespace pyroclast
