#include "pyroclast/stages/compression_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/stages/known_results.hpp"

namespace pyroclast {

namespace {

constexpr double kFitFrom = 0.05, kFitTo = 1.0 / 3.0;  // stresses between which E is fitted, over f_c
constexpr double kToe = 1.1;    // steepest slope over that of the first stretch with which there is a toe
constexpr int kStretches = 12;  // number of stretches; the last one ends at 88 % of f_c
constexpr double kStretchStep = 0.05;  // distance of stretches, over f_c
constexpr double kFewestPoints = 3.0;  // fewest points on a line that is fitted
constexpr PeakRule kSmallFall{.fall = 0.02, .lasting = 0.0}, kLargeFall{.fall = 0.1, .lasting = 0.0};
constexpr double kFoot = 1.0 / 3.0;  // stress below which a fall belongs to a toe, over f_c
constexpr double kMoves = 0.05;  // difference of the strengths by two falls that is worth a warning, over f_c
constexpr double kInertiaCountsFrom = 0.1;                  // stress from which inertia counts, over f_c
constexpr double kUnloadingFrom = 0.9, kUnloadingTo = 0.1;  // range of the fit, over the first stress
constexpr double kStartUnderLoad = 0.05;  // first stress of a stage that began under load, over f_c

std::size_t largest_of(const CompressionCurve& curve) {
  return std::max_element(curve.stress.begin(), curve.stress.end()) - curve.stress.begin();
}

/// Returns the point at which a rule finds a peak, among the points after the first wave.
/// \param foot     stress up to which the points are left out, Pa
/// \param modulus  where it is not 0, a fall must be deeper than the stress that the platen adds to a body of
///                 this modulus, Pa, while a wave passes once
std::optional<std::size_t> peak_of(const CompressionCurve& curve, double waves_until, PeakRule rule,
                                   double foot = 0.0, double modulus = 0.0) {
  Peak peak;
  std::optional<std::size_t> at;
  const double added = modulus * waves_until / kPassages;  // at a strain rate of 1/s, Pa
  const double least = rule.least;
  for (std::size_t i = 0; i < curve.count() && !peak.is_found(); ++i) {
    const double time = curve.time[i] - curve.time.front();
    if (time < waves_until || (peak.size() == 0.0 && curve.stress[i] < foot)) continue;
    if (time > 0.0) rule.least = std::max(least, added * (curve.strain[i] - curve.strain.front()) / time);
    const double before = peak.size();
    peak.take(curve.strain[i], curve.stress[i], rule);
    if (peak.size() > before) at = i;
  }
  return peak.is_found() ? at : std::nullopt;
}

struct Line {
  double slope = 0.0;   ///< Pa
  double origin = 0.0;  ///< strain at which its stress is 0
};

/// Fits a line to the points before `end` with stresses from `low` to `high`; none with fewer than three.
std::optional<Line> fit(const CompressionCurve& curve, std::size_t end, double low, double high) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < end; ++i) {
    const double strain = curve.strain[i], stress = curve.stress[i];
    if (stress < low || stress > high) continue;
    n += 1.0;
    sx += strain;
    sy += stress;
    sxx += strain * strain;
    sxy += strain * stress;
  }
  if (n < kFewestPoints) return std::nullopt;
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return Line{slope, sx / n - sy / n / slope};
}

/// Returns the steepest of `line` and the lines of all stretches that are as wide as the usual one.
Line steepest(const CompressionCurve& curve, std::size_t peak, double strength, Line line) {
  for (int i = 0; i < kStretches; ++i) {
    const double from = kFitFrom + i * kStretchStep;
    const auto other = fit(curve, peak, from * strength, (from + kFitTo - kFitFrom) * strength);
    if (other && other->slope > line.slope) line = *other;
  }
  return line;
}

void find_modulus(const CompressionCurve& curve, CompressionResponse& r) {
  const std::size_t peak = r.peak;
  const double strength = curve.stress[peak];
  auto line = fit(curve, peak, kFitFrom * strength, kFitTo * strength);
  if (!line) {
    r.modulus.none_because = "fewer than three points of the curve lie between 5 % and 1/3 of f_c";
    return;
  }
  if (const Line other = steepest(curve, peak, strength, *line); other.slope > kToe * line->slope) {
    line = other;
    r.toe = line->origin;
  }
  if (line->slope > 0.0)
    r.modulus.value = line->slope;
  else
    r.modulus.none_because = "the stress does not rise with the strain between 5 % and 1/3 of f_c";
}

void find_inelastic_strain(const CompressionCurve& curve, CompressionResponse& r) {
  std::string& none_because = r.inelastic_strain.none_because;
  if (!r.strength)
    none_because = "there is no f_c";
  else if (!r.modulus)
    none_because = "there is no E";
  else if (curve.stress.front() > kStartUnderLoad * *r.strength)
    none_because = "the stage began under load";
  else if (const double strain = curve.strain[r.peak] - r.toe - *r.strength / *r.modulus; strain >= 0.0)
    r.inelastic_strain.value = strain;
  else
    none_because = "the curve is steeper on its way to the peak than the line that gave E";
}

/// Tells whether the stress falls below that of a point, behind it, as from a peak.
bool falls_behind(const CompressionCurve& curve, std::size_t point) {
  return std::any_of(curve.stress.begin() + static_cast<std::ptrdiff_t>(point), curve.stress.end(),
                     [&](double s) { return s < (1.0 - kStrengthRule.fall) * curve.stress[point]; });
}

/// Tells why the stress has no peak, and what to do about that.
std::string none_because(const CompressionCurve& curve, std::size_t largest) {
  const auto where =
      fmt::format("{:.2f} MPa at strain {:.5f}", curve.stress[largest] * 1e-6, curve.strain[largest]);
  const char* farther = "drive the platen farther, by a larger strain at which the stage ends";
  if (!falls_behind(curve, largest))
    return fmt::format(
        "the stage ended before a peak: the stress did not fall by {:.0f} % from the largest, {}; {}",
        100.0 * kStrengthRule.fall, where, farther);
  return fmt::format(
      "the stage ended too soon behind the largest stress, {}: the largest stress is a peak if the stress "
      "stays lower for {:g} of strain; {}",
      where, kStrengthRule.lasting, farther);
}

void find_none(CompressionResponse& r, const std::string& because) {
  r.strength = {std::nullopt, because};
  r.modulus = {std::nullopt, "there is no f_c"};
  r.inelastic_strain = {std::nullopt, "there is no f_c"};
  r.by_small_fall = r.by_large_fall = {std::nullopt, because};
}

Result::Value value_of(const Finding& finding, double factor) {
  return finding ? Result::Value(factor * *finding) : Result::Value();
}

Result::Value why_none(const Finding& finding) {
  return finding ? Result::Value() : Result::Value(finding.none_because);
}

/// Writes "f_c 32.5 MPa" with so many digits, or why there is none. Specimens scatter by 3 % and more.
std::string line_of(const char* name, const Finding& finding, double factor, int digits, const char* unit) {
  if (!finding) return fmt::format("{}: none, because {}", name, finding.none_because);
  return fmt::format("{} {:.{}g}{}", name, factor * *finding, digits, unit);
}

StageReport unloading_report(const CompressionCurve& curve) {
  StageReport report;
  const bool has_points = curve.count() > 0;
  const double first = has_points ? curve.stress.front() : 0.0, last = has_points ? curve.stress.back() : 0.0;
  const auto line = fit(curve, curve.count(), kUnloadingTo * first, kUnloadingFrom * first);
  Finding modulus;
  if (line && line->slope > 0.0)
    modulus.value = line->slope;
  else
    modulus.none_because = "fewer than three points lie between 90 % and 10 % of the stress at the start";
  report.results = {{known::unloading_modulus, value_of(modulus, 1e-9)},
                    reason_of(known::unloading_modulus, has_points ? why_none(modulus) : Result::Value()),
                    {known::stress_at_end, value_if(has_points, last * 1e-6)}};
  if (!has_points) return report;
  report.lines = {fmt::format("unloaded from {:.2f} to {:.2f} MPa", first * 1e-6, last * 1e-6),
                  line_of("E in unloading", modulus, 1e-9, 3, " GPa")};
  return report;
}

}  // namespace

CompressionPoint point_of(const Press& press, const Motion& motion) {
  return motion.model().ranks().together([&] {
    return CompressionPoint{press.stage_strain(), press.stress_top(), press.stress_bottom(),
                            motion.totals().energy(), motion.totals().unbalanced_ratio()};
  });
}

void CompressionCurve::add(const CompressionPoint& point, double time_of_motion) {
  strain.push_back(point.strain);
  stress.push_back(point.stress());
  platen_difference.push_back(std::abs(point.stress_top - point.stress_bottom));
  kinetic_over_strain.push_back(point.energy.kinetic_over_elastic());
  time.push_back(time_of_motion);
}

void CompressionCurve::visit_state(StateVisitor& visitor) {
  visitor.visit("strain", strain);
  const StateRule alike = state::finite().of(strain.size());
  visitor.visit("stress", stress, alike);
  visitor.visit("platen_difference", platen_difference, alike);
  visitor.visit("kinetic_over_strain", kinetic_over_strain, state::number().of(strain.size()));
  visitor.visit("time", time, alike);
}

QuasiStaticReport quasi_static_report(const CompressionCurve& curve, std::size_t peak,
                                      const QuasiStaticBounds& bounds) {
  QuasiStaticReport report;
  if (curve.count() == 0) return report;
  const double strength = curve.stress[peak];
  const auto within = [&](double kinetic, double difference) {
    return kinetic <= bounds.kinetic_over_strain && difference <= bounds.platen_difference;
  };
  report.in_modulus = true;
  for (std::size_t i = 0; i < curve.count(); ++i) {
    if (curve.stress[i] < kInertiaCountsFrom * strength) continue;
    const bool after = i > peak;
    double& kinetic = after ? report.kinetic_after_peak : report.kinetic_to_peak;
    double& difference = after ? report.difference_after_peak : report.difference_to_peak;
    kinetic = std::max(kinetic, curve.kinetic_over_strain[i]);
    difference = std::max(difference, curve.platen_difference[i] / strength);
    if (!after && curve.stress[i] <= kFitTo * strength)
      report.in_modulus = report.difference_to_peak <= bounds.platen_difference;
  }
  report.to_peak = within(report.kinetic_to_peak, report.difference_to_peak);
  report.after_peak = within(report.kinetic_after_peak, report.difference_after_peak);
  return report;
}

CompressionResponse compression_response(const CompressionCurve& curve, double waves_until, double rest) {
  CompressionResponse r;
  if (curve.count() == 0) {
    find_none(r, "the stage ended before it loaded the specimen");
    return r;
  }
  r.peak = r.largest = largest_of(curve);
  const double largest = curve.stress[r.largest];
  if (!(largest > 0.0)) {
    find_none(
        r, fmt::format("the specimen bore no compression: the largest stress is {:.3g} MPa", largest * 1e-6));
    return r;
  }
  const auto by_fall = [&](const PeakRule& rule) -> Finding {
    const double foot = kFoot * curve.stress[r.peak];
    if (const auto at = peak_of(curve, waves_until, rule, foot, r.modulus.value.value_or(0.0)))
      return {curve.stress[*at], ""};
    return {std::nullopt,
            fmt::format("the stress never fell by {:g} % from above a third of {} before the stage ended",
                        100.0 * rule.fall, r.strength ? "f_c" : "the largest")};
  };
  const double time = curve.time[r.largest] - curve.time.front();
  if (time < waves_until && falls_behind(curve, r.largest)) {
    find_none(r, fmt::format("the largest stress, {:.2f} MPa, came after {:.3g} ms, while the first stress "
                             "wave still ran through the specimen ({:.3g} ms); load more slowly, with a "
                             "longer ramp_time",
                             largest * 1e-6, 1e3 * time, 1e3 * waves_until));
    return r;
  }
  r.bore = true;
  if (const auto peak = peak_of(curve, waves_until, strength_rule(rest))) {
    r.peak = *peak;
    r.strength.value = curve.stress[*peak];
  } else {
    r.strength.none_because = none_because(curve, r.largest);
  }
  find_modulus(curve, r);
  r.by_small_fall = by_fall(kSmallFall);
  r.by_large_fall = by_fall(kLargeFall);
  find_inelastic_strain(curve, r);
  const QuasiStaticReport inertia = quasi_static_report(curve, r.peak);
  if (r.modulus && !inertia.in_modulus)
    r.modulus = {std::nullopt, "the platens' stresses differ by more than 2 % of f_c up to 1/3 of it"};
  if (r.inelastic_strain && !inertia.to_peak)
    r.inelastic_strain = {std::nullopt, "the test was not quasi-static up to the peak"};
  return r;
}

namespace {

/// Returns why f_c does not tell the strength of a concrete; empty where nothing is against it.
std::string doubt_about(const CompressionCurve& curve, const CompressionResponse& r) {
  const double strength = *r.strength, largest = curve.stress[r.largest];
  const double by_small = r.by_small_fall.value.value_or(strength);
  const double by_large = r.by_large_fall.value.value_or(largest);
  const auto [least, most] = std::minmax({by_small, by_large, strength});
  if (most - least > kMoves * strength) {
    const bool is_between = by_small <= strength && strength <= by_large;
    return fmt::format(
        "f_c depends on how a peak is told: {:.2f} MPa by the first fall of 2 %, {}{:.2f} MPa {}; the stress "
        "falls and rises again, as where few coarse blocks fail one by one (docs/validation/peaks.md)",
        by_small * 1e-6, is_between ? "" : fmt::format("{:.2f} MPa by one that lasts, ", strength * 1e-6),
        by_large * 1e-6, r.by_large_fall ? "by one of 10 %" : "at the end without a fall of 10 %");
  }
  if (largest > (1.0 + kMoves) * strength)
    return fmt::format(
        "the specimen hardens behind its peak: from f_c, {:.2f} MPa, the stress falls by more than 10 % and "
        "rises to {:.2f} MPa at strain {:.5f}; plain concrete does not (docs/validation/after_peak.md)",
        strength * 1e-6, largest * 1e-6, curve.strain[r.largest]);
  return {};
}

}  // namespace

StageReport compression_report(const CompressionCurve& curve, const CompressionAim& aim) {
  if (aim.is_upwards) return unloading_report(curve);
  StageReport report;
  const CompressionResponse r = compression_response(curve, aim.waves_until, aim.rest);
  const QuasiStaticReport inertia = quasi_static_report(curve, r.peak);
  const bool has_points = curve.count() > 0;
  const std::string doubt = r.strength ? doubt_about(curve, r) : std::string();
  const auto doubted = [&](bool has_value) {
    return has_value && !doubt.empty() ? Result::Value(doubt) : Result::Value();
  };
  report.results = {
      {known::modulus, value_of(r.modulus, 1e-9)},
      reason_of(known::modulus, why_none(r.modulus)),
      {known::toe_strain, r.toe},
      {kStrength, value_of(r.strength, 1e-6)},
      reason_of(kStrength, why_none(r.strength)),
      doubt_of(kStrength, doubted(true)),
      {known::strain_at_peak,
       value_if(r.strength.value.has_value(), r.strength ? curve.strain[r.peak] : 0.0)},
      doubt_of(known::strain_at_peak, doubted(true)),
      {known::by_small_fall, value_of(r.by_small_fall, 1e-6)},
      reason_of(known::by_small_fall, why_none(r.by_small_fall)),
      {known::by_large_fall, value_of(r.by_large_fall, 1e-6)},
      reason_of(known::by_large_fall, why_none(r.by_large_fall)),
      {known::stress_max, value_if(has_points, has_points ? curve.stress[r.largest] * 1e-6 : 0.0)},
      {known::strain_at_stress_max, value_if(has_points, has_points ? curve.strain[r.largest] : 0.0)},
      {known::inelastic_strain, value_of(r.inelastic_strain, 1.0)},
      reason_of(known::inelastic_strain, why_none(r.inelastic_strain)),
      doubt_of(known::inelastic_strain, doubted(static_cast<bool>(r.inelastic_strain))),
      {known::quasi_static, inertia.to_peak},
      {known::quasi_static_after_peak, inertia.after_peak},
      {known::kinetic_to_peak, inertia.kinetic_to_peak},
      {known::kinetic_after_peak, inertia.kinetic_after_peak},
      {known::difference_to_peak, inertia.difference_to_peak},
      {known::difference_after_peak, inertia.difference_after_peak},
  };
  report.lines.push_back(line_of("f_c", r.strength, 1e-6, 3, " MPa"));
  if (r.strength) report.lines.back() += fmt::format(" at strain {:.2g}", curve.strain[r.peak]);
  if (r.strength && curve.stress[r.largest] > (1.0 + kRisesAgain) * *r.strength)
    report.lines.push_back(fmt::format(
        "rises again behind f_c, to {:.2f} MPa ({:+.0f} %) at strain {:.5f}", curve.stress[r.largest] * 1e-6,
        100.0 * (curve.stress[r.largest] / *r.strength - 1.0), curve.strain[r.largest]));
  if (!doubt.empty()) report.warnings.push_back(doubt);
  if (r.bore) {
    report.lines.push_back(line_of("E", r.modulus, 1e-9, 3, " GPa"));
    if (r.modulus && r.toe > 0.0)
      report.lines.back() +=
          fmt::format(", where the curve is steepest: it begins with a toe, up to strain {:.5f}", r.toe);
    if (r.strength)
      report.lines.push_back(
          line_of("inelastic strain at the peak (eps_ic)", r.inelastic_strain, 1.0, 2, ""));
  }
  if (r.strength)
    report.lines.push_back(inertia.to_peak ? "quasi-static up to the peak"
                                           : "NOT quasi-static up to the peak");
  if (!r.bore)
    report.warnings.push_back("no f_c and no E: " + r.strength.none_because);
  else if (!r.strength && !aim.to_a_value)
    report.warnings.push_back("no f_c: " + r.strength.none_because);
  if (!inertia.to_peak && r.strength)
    report.warnings.push_back(fmt::format(
        "not quasi-static up to the peak: kinetic over elastic energy up to {:.1e}, "
        "platen stresses differ by up to {:.1f} % of f_c; load more slowly or take a shorter time step",
        inertia.kinetic_to_peak, 100.0 * inertia.difference_to_peak));
  return report;
}

}  // namespace pyroclast
