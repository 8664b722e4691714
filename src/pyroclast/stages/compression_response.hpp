#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/simulation/press.hpp"
#include "pyroclast/simulation/stage.hpp"
#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

/// The peak of a stress over the strain of a stage.
inline constexpr PeakRule kStrengthRule;

/// The curve of one compression, at even strains whatever the rows of the history are; compression positive.
struct CompressionCurve {
  std::vector<double> strain;               ///< since the stage began
  std::vector<double> stress;               ///< mean of both platens, Pa
  std::vector<double> platen_difference;    ///< |top - bottom|, Pa
  std::vector<double> kinetic_over_strain;  ///< kinetic over elastic energy
  std::vector<double> time;                 ///< s

  std::size_t count() const { return stress.size(); }
  /// Adds a point: what the press reads now.
  void add(const Press<2>& press, const Mechanics<2>& mechanics);
  void visit_state(StateVisitor& visitor);
};

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

/// Points below 10 % of the peak stress are left out: the kinetic energy of the driven motion itself is there
/// from the start, while elastic energy grows with the square of the stress, so their ratio says nothing
/// before.
///
/// \param peak  point of f_c, or of the largest stress where there is no f_c
QuasiStaticReport quasi_static_report(const CompressionCurve& curve, std::size_t peak,
                                      const QuasiStaticBounds& bounds = {});

/// What a compression test says of a concrete, positive in compression (paper, Table 3).
struct CompressionResponse {
  bool bore = false;  ///< the specimen bore compression, and not that of the first wave alone
  /// f_c: peak of the stress by kStrengthRule, mean of both platens, Pa. None where nothing was compressed,
  /// where the stress never fell so, and where a larger one came while the first stress wave still ran.
  Finding strength;
  std::size_t peak = 0;     ///< point of f_c, or of the largest stress where there is no f_c
  std::size_t largest = 0;  ///< point of the largest stress, whenever it came
  /// The largest stress before the first fall by 2 % and by 10 %, lasting or not, Pa: how far f_c depends on
  /// the rule.
  std::optional<double> by_small_fall, by_large_fall;
  /// E: slope of the line fitted to the points from 5 % to 1/3 of f_c, Pa; of the largest stress where there
  /// is no f_c for the want of a fall. Where the curve begins with a toe, that is, where it is steeper from
  /// 1/3 to 2/3 by more than a tenth, that of the steepest stretch as wide.
  Finding modulus;
  double toe = 0.0;          ///< strain at which that steepest line begins; 0 without a toe
  Finding inelastic_strain;  ///< eps_ic = strain at peak - toe - f_c / E
};

/// \param waves_until  time since the first point up to which stress is that of a wave, s
CompressionResponse compression_response(const CompressionCurve& curve, double waves_until = 0.0);

/// What a stage was to do.
struct CompressionAim {
  bool is_upwards = false;   ///< the platen was moved up, to unload
  bool to_a_value = false;   ///< it ends at a stress or a strain: without a peak is nothing to warn of
  double waves_until = 0.0;  ///< see compression_response
};

/// All of this, as the report of a stage.
StageReport compression_report(const CompressionCurve& curve, const CompressionAim& aim = {});

}  // namespace pyroclast
