#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/simulation/history.hpp"
#include "pyroclast/simulation/stage.hpp"

namespace pyroclast {

/// What is read of the history of one compression, a value for each of its rows; compression positive.
struct CompressionRows {
  std::vector<double> strain;               ///< since the stage began
  std::vector<double> stress;               ///< mean of both platens, Pa
  std::vector<double> platen_difference;    ///< |top - bottom|, Pa
  std::vector<double> kinetic_over_strain;  ///< kinetic over elastic energy
  std::vector<double> time;                 ///< s

  std::size_t count() const { return stress.size(); }
};

CompressionRows compression_rows(const History& history, RowRange rows);

/// A number that a test gave, or the reason why it gave none.
struct Finding {
  std::optional<double> value;
  std::string none_because;  ///< empty where there is a value

  explicit operator bool() const { return value.has_value(); }
  double operator*() const { return *value; }
};

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
  /// The platens' stresses agree within their bound from 10 % to 1/3 of f_c, where E comes from. The kinetic
  /// energy of the driven motion itself is still large beside the elastic one there, and changes no force.
  bool in_modulus = false;
};

/// Rows below 10 % of the peak stress are left out: the kinetic energy of the driven motion itself is there
/// from the start, while elastic energy grows with the square of the stress, so their ratio says nothing
/// before.
QuasiStaticReport quasi_static_report(const CompressionRows& rows, const QuasiStaticBounds& bounds = {});

/// What a compression test says of a concrete, positive in compression (paper, Table 3).
struct CompressionResponse {
  /// f_c: largest stress, mean of both platens, Pa. None where nothing was compressed, and where it came
  /// while the first stress wave still ran.
  Finding strength;
  double strain_at_peak = 0.0;
  /// E: slope of the line fitted to the rows from 5 % to 1/3 of f_c, Pa. Where the curve begins with a toe,
  /// that is, where it is steeper from 1/3 to 2/3 by more than a tenth, that of the steepest stretch as wide.
  Finding modulus;
  double toe = 0.0;          ///< strain at which that steepest line begins; 0 without a toe
  Finding inelastic_strain;  ///< eps_ic = strain at peak - toe - f_c / E
  bool peak_passed = false;  ///< the stress fell by more than 1 % of f_c after it
};

/// \param waves_until  time since the first row up to which stress is that of a wave, s
CompressionResponse compression_response(const CompressionRows& rows, double waves_until = 0.0);

/// What a stage was to do.
struct CompressionAim {
  bool is_upwards = false;   ///< the platen was moved up, to unload
  bool to_a_value = false;   ///< it ends at a stress or a strain: without a peak is nothing to warn of
  double waves_until = 0.0;  ///< see compression_response
};

/// All of this, as the report of a stage.
StageReport compression_report(const CompressionRows& rows, const CompressionAim& aim = {});

}  // namespace pyroclast
