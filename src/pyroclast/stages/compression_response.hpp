#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "pyroclast/simulation/history.hpp"

namespace pyroclast {

/// What is read of the history of one compression, a value for each of its rows; compression positive.
struct CompressionRows {
  std::vector<double> strain;               ///< since the stage began
  std::vector<double> stress;               ///< mean of both platens, Pa
  std::vector<double> platen_difference;    ///< |top - bottom|, Pa
  std::vector<double> kinetic_over_strain;  ///< kinetic over elastic energy

  std::size_t count() const { return stress.size(); }
};

CompressionRows compression_rows(const History& history, RowRange rows);

/// What a compression test says of a concrete, positive in compression (paper, Table 3).
struct CompressionResponse {
  double strength = 0.0;  ///< f_c: largest stress, mean of both platens, Pa
  double strain_at_peak = 0.0;
  /// E: slope of the line fitted to the rows from 5 % to 1/3 of f_c, Pa; empty with fewer than three of them.
  std::optional<double> modulus;
  std::optional<double> inelastic_strain;  ///< eps_ic = strain at peak - f_c / E
  bool peak_passed = false;                ///< the stress fell by more than 1 % of f_c after it
};

/// Empty without a row.
std::optional<CompressionResponse> compression_response(const CompressionRows& rows);

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
QuasiStaticReport quasi_static_report(const CompressionRows& rows, const QuasiStaticBounds& bounds = {});

}  // namespace pyroclast
