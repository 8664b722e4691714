#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "pyroclast/base/state_visitor.hpp"
#include "pyroclast/simulation/acting/press.hpp"
#include "pyroclast/simulation/loop/stage.hpp"
#include "pyroclast/stages/peak.hpp"

namespace pyroclast {

/// Rule of the peak of a stress over the strain of a stage.
inline constexpr PeakRule kStrengthRule;
/// Returns that rule for a body that rests where its platens differ by a stress, Pa: a fall is deeper.
constexpr PeakRule strength_rule(double rest) {
  PeakRule rule = kStrengthRule;
  rule.least = rest;
  return rule;
}
/// Rise of the stress above f_c, behind it, that is reported, over f_c.
inline constexpr double kRisesAgain = 0.005;

/// Passages of the first stress wave through the specimen after which the stress is no longer that of a wave.
inline constexpr double kPassages = 2.0;

/// What a compression asks of the body after some steps.
struct CompressionPoint {
  double strain = 0.0;                           ///< strain since the stage began
  double stress_top = 0.0, stress_bottom = 0.0;  ///< Pa
  EnergyLedger energy;
  double unbalanced_ratio = 0.0;

  double stress() const { return 0.5 * (stress_top + stress_bottom); }
};

/// Reads the press and the body.
CompressionPoint point_of(const Press& press, const Motion& motion);

/// Curve of one compression, at even strains whatever the rows of the history are; compression positive.
struct CompressionCurve {
  std::vector<double> strain;               ///< strain since the stage began
  std::vector<double> stress;               ///< mean stress of both platens, Pa
  std::vector<double> platen_difference;    ///< |top - bottom|, Pa
  std::vector<double> kinetic_over_strain;  ///< kinetic over elastic energy
  std::vector<double> time;                 ///< s

  std::size_t count() const { return stress.size(); }
  /// Adds a point.
  /// \param time_of_motion  time of the mechanics since the start, s
  void add(const CompressionPoint& point, double time_of_motion);
  void visit_state(StateVisitor& visitor);
};

/// Number that a test gave, or the reason why it gave none.
struct Finding {
  std::optional<double> value;
  std::string none_because;  ///< reason why there is no value; empty where there is one

  explicit operator bool() const { return value.has_value(); }
  double operator*() const { return *value; }
};

/// Bounds within which a run counts as quasi-static. Both measure inertia: kinetic over elastic energy, and
/// the difference between the platens' stresses over the largest stress.
struct QuasiStaticBounds {
  double kinetic_over_strain = 0.01;
  double platen_difference = 0.02;
};

/// Nearness of a compression stage to static equilibrium.
struct QuasiStaticReport {
  double kinetic_to_peak = 0.0, kinetic_after_peak = 0.0;        ///< worst kinetic over elastic energy
  double difference_to_peak = 0.0, difference_after_peak = 0.0;  ///< worst |top - bottom| over f_c
  bool to_peak = false, after_peak = false;                      ///< true within the bounds
  /// True where the platens' stresses agree within their bound from 10 % to 1/3 of f_c, from which E is
  /// taken. There the kinetic energy of the driven motion itself is still large beside the elastic energy,
  /// and changes no force.
  bool in_modulus = false;
};

/// Compares a curve with the bounds. Points below 10 % of the peak stress are left out. There the kinetic
/// energy of the driven motion is present from the start, while elastic energy grows with the square of the
/// stress, so their ratio says nothing.
///
/// \param peak  point of f_c, or of the largest stress where there is no f_c
QuasiStaticReport quasi_static_report(const CompressionCurve& curve, std::size_t peak,
                                      const QuasiStaticBounds& bounds = {});

/// Results of a compression test, positive in compression (paper, Table 3).
struct CompressionResponse {
  bool bore = false;  ///< true where the specimen bore compression beyond that of the first wave
  /// f_c: peak of the stress by kStrengthRule, mean of both platens, Pa. None where nothing was compressed,
  /// where the stress never fell enough, and where a larger stress came while the first stress wave still
  /// ran.
  Finding strength;
  std::size_t peak = 0;     ///< point of f_c, or of the largest stress where there is no f_c
  std::size_t largest = 0;  ///< point of the largest stress, whenever it came
  /// Largest stress before the first fall by 2 % and by 10 %, lasting or not, Pa. They show how far f_c
  /// depends on the rule. The first wave shakes the curve for longer than it runs, by no more than the stress
  /// that the platen adds during one passage: shallower falls do not count, nor do falls before the stress
  /// first comes to a third of f_c, where the ends of the specimen are pressed flat.
  Finding by_small_fall, by_large_fall;
  /// E: slope of the line fitted to the points from 5 % to 1/3 of f_c, Pa; of the largest stress where there
  /// is no f_c because the stress never fell. The curve begins with a toe where it is over a tenth steeper
  /// from 1/3 to 2/3. E is then the slope of the steepest stretch of the same width.
  Finding modulus;
  double toe = 0.0;          ///< strain at which the steepest line begins; 0 without a toe
  Finding inelastic_strain;  ///< eps_ic = strain at peak - toe - f_c / E
};

/// Returns the results of a compression curve.
/// \param waves_until  time since the first point up to which the stress is that of a wave, s: that of
/// kPassages
/// \param rest  difference of the platens with which the body rested before, Pa
CompressionResponse compression_response(const CompressionCurve& curve, double waves_until = 0.0,
                                         double rest = 0.0);

/// Aim of a compression stage.
struct CompressionAim {
  bool is_upwards = false;  ///< true where the platen was moved up, to unload
  /// True where the stage ends at a stress or a strain; then a missing peak is no reason to warn.
  bool to_a_value = false;
  double waves_until = 0.0;  ///< time of the first wave, see compression_response
  double rest = 0.0;         ///< difference of the platens at rest, see compression_response
};

/// Reports all results of a compression as the report of a stage.
StageReport compression_report(const CompressionCurve& curve, const CompressionAim& aim = {});

}  // namespace pyroclast
