#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pyroclast/experiment/experiment.hpp"

namespace pyroclast {

/// What the heating stages of a run came to.
struct HeatingResponse {
  double load_stress = 0.0;     ///< held while heating, Pa, compression positive
  std::optional<double> level;  ///< over f_c, where the deck gives it so
  PlatenControl platen = PlatenControl::force;
  /// Temperature at which the platen ran away, mean over the specimen, °C.
  std::optional<double> critical_temperature;
  double critical_time = 0.0;  ///< heating time then, s
  double highest = 0.0;        ///< temperature reached anywhere, °C
  double increment = 0.0;      ///< change of temperature between two exchanges, K
  int exchanges = 0;
  int not_converged = 0;        ///< exchanges after which the body did not come to rest
  double worst_ratio = 0.0;     ///< largest unbalanced ratio left by an exchange before any failure
  std::int64_t cycles = 0;      ///< in all
  double largest_thrust = 0.0;  ///< largest stress on the platens, Pa, compression positive
};

/// Empty when no temperature was handed over.
std::optional<HeatingResponse> heating_response(const std::vector<Sample>& history,
                                                const std::vector<Stage>& stages, Outcome outcome);

}  // namespace pyroclast
