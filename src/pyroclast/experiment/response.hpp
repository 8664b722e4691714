#pragma once

#include <optional>
#include <vector>

#include "pyroclast/experiment/experiment.hpp"

namespace pyroclast {

/// What a compression test says of a concrete, positive in compression (paper, Table 3).
struct CompressionResponse {
  double modulus = 0.0;   ///< E: slope of the line fitted to the rows from 5 % to 1/3 of f_c, Pa
  double strength = 0.0;  ///< f_c: largest stress, mean of both platens, Pa
  double strain_at_peak = 0.0;
  double inelastic_strain = 0.0;  ///< eps_ic = strain at peak - f_c / E
  bool peak_passed = false;       ///< the stress fell by more than 1 % of f_c after it
};

/// Empty when the history holds too little of a compression stage (fewer than three rows on the fitted line).
std::optional<CompressionResponse> compression_response(const std::vector<Sample>& history,
                                                        const std::vector<Stage>& stages);

/// Bounds within which a run counts as quasi-static. Both measure inertia: kinetic over elastic energy, and
/// the difference between the platens' stresses over the largest stress.
struct QuasiStaticBounds {
  double kinetic_over_strain = 0.01;
  double platen_difference = 0.02;
};

/// How near to static equilibrium a compression stage stayed.
struct QuasiStaticReport {
  double kinetic_to_peak = 0.0, kinetic_after_peak = 0.0;        ///< worst kinetic over elastic energy
  double difference_to_peak = 0.0, difference_after_peak = 0.0;  ///< worst |top - bottom| over f_c
  bool to_peak = false, after_peak = false;                      ///< within the bounds
};

/// Rows below 10 % of the peak stress are left out: the kinetic energy of the driven motion itself is there
/// from the start, while elastic energy grows with the square of the stress, so their ratio says nothing
/// before.
QuasiStaticReport quasi_static_report(const std::vector<Sample>& history, const std::vector<Stage>& stages,
                                      const QuasiStaticBounds& bounds = {});

}  // namespace pyroclast
