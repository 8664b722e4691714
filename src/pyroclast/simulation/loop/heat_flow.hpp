#pragma once

#include <limits>

#include "pyroclast/base/rounding.hpp"
#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/thermal/temperature_field.hpp"

namespace pyroclast {

/// Returns the first multiple of an interval after a heating time, s; infinite for an infinite interval.
inline double next_multiple(double interval, double time) {
  if (interval == std::numeric_limits<double>::infinity()) return interval;
  return interval * (whole_below(time / interval) + 1.0);
}

/// Heat flow: conducts heat through a computed field in batches.
class HeatFlow {
 public:
  /// Begins to conduct until one of these limits is met, see TemperatureField::advance.
  void begin(double largest_change, double until, double steady_rate = 0.0) {
    largest_change_ = largest_change;
    until_ = until;
    steady_rate_ = steady_rate;
    flows_ = true;
  }
  bool flows() const { return flows_; }
  /// Conducts heat for one batch; returns true when a limit is met.
  bool advance(TemperatureField& field) {
    if (!advances_) field.begin_advance(largest_change_, until_, steady_rate_);
    advances_ = !field.advance(field.conduction()->stages_per_batch());
    flows_ = advances_;
    return !advances_;
  }

  void visit_state(StateVisitor& visitor) {
    visitor.visit("largest_change", largest_change_, state::number());
    visitor.visit("until", until_);
    visitor.visit("steady_rate", steady_rate_);
    visitor.visit("flows", flows_);
    visitor.visit("advances", advances_);
  }

 private:
  double largest_change_ = 0.0;  ///< K
  double until_ = 0.0;           ///< s
  double steady_rate_ = 0.0;     ///< K/s
  bool flows_ = false;
  bool advances_ = false;  ///< true while an advance of the field is under way
};

}  // namespace pyroclast
