#include "pyroclast/stages/compression_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace pyroclast {

namespace {

constexpr double kFitFrom = 0.05, kFitTo = 1.0 / 3.0;       // of f_c
constexpr double kToe = 1.1;                                // steepest slope over that of the first stretch
constexpr int kStretches = 12;                              // the last one ends at 88 %
constexpr double kStretchStep = 0.05;                       // of f_c
constexpr double kFewestRows = 3.0;                         // on a line that is fitted
constexpr double kFallThatProvesAPeak = 0.01;               // of f_c
constexpr double kInertiaCountsFrom = 0.1;                  // of f_c
constexpr double kUnloadingFrom = 0.9, kUnloadingTo = 0.1;  // of the stress at which unloading began
constexpr double kStartUnderLoad = 0.05;                    // of f_c

std::size_t peak_of(const CompressionRows& rows) {
  return std::max_element(rows.stress.begin(), rows.stress.end()) - rows.stress.begin();
}

struct Line {
  double slope = 0.0;   ///< Pa
  double origin = 0.0;  ///< strain at which its stress is 0
};

/// Fitted to the rows before `end` with stresses from `low` to `high`; none with fewer than three.
std::optional<Line> fit(const CompressionRows& rows, std::size_t end, double low, double high) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < end; ++i) {
    const double strain = rows.strain[i], stress = rows.stress[i];
    if (stress < low || stress > high) continue;
    n += 1.0;
    sx += strain;
    sy += stress;
    sxx += strain * strain;
    sxy += strain * stress;
  }
  if (n < kFewestRows) return std::nullopt;
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  return Line{slope, sx / n - sy / n / slope};
}

/// Of all stretches as wide as the usual one.
Line steepest(const CompressionRows& rows, std::size_t peak, double strength, Line line) {
  for (int i = 0; i < kStretches; ++i) {
    const double from = kFitFrom + i * kStretchStep;
    const auto other = fit(rows, peak, from * strength, (from + kFitTo - kFitFrom) * strength);
    if (other && other->slope > line.slope) line = *other;
  }
  return line;
}

void find_modulus(const CompressionRows& rows, std::size_t peak, CompressionResponse& r) {
  const double strength = *r.strength;
  auto line = fit(rows, peak, kFitFrom * strength, kFitTo * strength);
  if (!line) {
    r.modulus.none_because = "fewer than three rows of the history lie between 5 % and 1/3 of f_c";
    return;
  }
  if (const Line other = steepest(rows, peak, strength, *line); other.slope > kToe * line->slope) {
    line = other;
    r.toe = line->origin;
  }
  if (line->slope > 0.0)
    r.modulus.value = line->slope;
  else
    r.modulus.none_because = "the stress does not rise with the strain between 5 % and 1/3 of f_c";
}

void find_inelastic_strain(const CompressionRows& rows, CompressionResponse& r) {
  std::string& none_because = r.inelastic_strain.none_because;
  if (!r.modulus)
    none_because = "there is no E";
  else if (rows.stress.front() > kStartUnderLoad * *r.strength)
    none_because = "the stage began under load";
  else if (const double strain = r.strain_at_peak - r.toe - *r.strength / *r.modulus; strain >= 0.0)
    r.inelastic_strain.value = strain;
  else
    none_because = "the curve is steeper on its way to the peak than the line that gave E";
}

void find_none(CompressionResponse& r, const std::string& because) {
  r.strength = {std::nullopt, because};
  r.modulus = {std::nullopt, "there is no f_c"};
  r.inelastic_strain = {std::nullopt, "there is no f_c"};
}

Result::Value value_of(const Finding& finding, double factor) {
  return finding ? Result::Value(factor * *finding) : Result::Value();
}

Result::Value reason_of(const Finding& finding) {
  return finding ? Result::Value() : Result::Value(finding.none_because);
}

/// "f_c 32.47 MPa", or why there is none.
std::string line_of(const char* name, const Finding& finding, double factor, int digits, const char* unit) {
  if (!finding) return fmt::format("{}: none, because {}", name, finding.none_because);
  return fmt::format("{} {:.{}f}{}", name, factor * *finding, digits, unit);
}

StageReport unloading_report(const CompressionRows& rows) {
  StageReport report;
  const bool has_rows = rows.count() > 0;
  const double first = has_rows ? rows.stress.front() : 0.0, last = has_rows ? rows.stress.back() : 0.0;
  const auto line = fit(rows, rows.count(), kUnloadingTo * first, kUnloadingFrom * first);
  Finding modulus;
  if (line && line->slope > 0.0)
    modulus.value = line->slope;
  else
    modulus.none_because = "fewer than three rows lie between 90 % and 10 % of the stress at the start";
  report.results = {{"E_unloading_GPa", value_of(modulus, 1e-9)},
                    {"E_unloading_none_because", has_rows ? reason_of(modulus) : Result::Value()},
                    {"stress_at_end_MPa", value_if(has_rows, last * 1e-6)}};
  if (!has_rows) return report;
  report.lines = {fmt::format("unloaded from {:.2f} to {:.2f} MPa", first * 1e-6, last * 1e-6),
                  line_of("E in unloading", modulus, 1e-9, 2, " GPa")};
  return report;
}

}  // namespace

CompressionRows compression_rows(const History& history, RowRange rows) {
  CompressionRows read{history.values("stage_strain", rows),
                       history.values("stress_MPa", rows),
                       {},
                       history.values("kinetic_over_strain", rows),
                       history.values("time_s", rows)};
  for (double& stress : read.stress) stress *= 1e6;
  const auto top = history.values("stress_top_MPa", rows), bottom = history.values("stress_bottom_MPa", rows);
  for (std::size_t i = 0; i < top.size(); ++i)
    read.platen_difference.push_back(std::abs(top[i] - bottom[i]) * 1e6);
  return read;
}

QuasiStaticReport quasi_static_report(const CompressionRows& rows, const QuasiStaticBounds& bounds) {
  QuasiStaticReport report;
  if (rows.count() == 0) return report;
  const std::size_t peak = peak_of(rows);
  const double strength = rows.stress[peak];
  const auto within = [&](double kinetic, double difference) {
    return kinetic <= bounds.kinetic_over_strain && difference <= bounds.platen_difference;
  };
  report.in_modulus = true;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (rows.stress[i] < kInertiaCountsFrom * strength) continue;
    const bool after = i > peak;
    double& kinetic = after ? report.kinetic_after_peak : report.kinetic_to_peak;
    double& difference = after ? report.difference_after_peak : report.difference_to_peak;
    kinetic = std::max(kinetic, rows.kinetic_over_strain[i]);
    difference = std::max(difference, rows.platen_difference[i] / strength);
    if (!after && rows.stress[i] <= kFitTo * strength)
      report.in_modulus = report.difference_to_peak <= bounds.platen_difference;
  }
  report.to_peak = within(report.kinetic_to_peak, report.difference_to_peak);
  report.after_peak = within(report.kinetic_after_peak, report.difference_after_peak);
  return report;
}

CompressionResponse compression_response(const CompressionRows& rows, double waves_until) {
  CompressionResponse r;
  if (rows.count() == 0) {
    find_none(r, "the stage ended before its first row of the history");
    return r;
  }
  const std::size_t peak = peak_of(rows);
  const double strength = rows.stress[peak], time = rows.time[peak] - rows.time.front();
  r.strain_at_peak = rows.strain[peak];
  if (!(strength > 0.0)) {
    find_none(r, fmt::format("the specimen bore no compression: the largest stress is {:.3g} MPa",
                             strength * 1e-6));
    return r;
  }
  r.peak_passed = std::any_of(rows.stress.begin() + static_cast<std::ptrdiff_t>(peak), rows.stress.end(),
                              [&](double s) { return s < (1.0 - kFallThatProvesAPeak) * strength; });
  if (time < waves_until && r.peak_passed) {
    find_none(r, fmt::format("the largest stress, {:.2f} MPa, came after {:.3g} ms, while the first stress "
                             "wave still ran through the specimen ({:.3g} ms); load more slowly, with a "
                             "longer ramp_time",
                             strength * 1e-6, 1e3 * time, 1e3 * waves_until));
    return r;
  }
  r.strength.value = strength;
  find_modulus(rows, peak, r);
  find_inelastic_strain(rows, r);
  const QuasiStaticReport inertia = quasi_static_report(rows);
  if (r.modulus && !inertia.in_modulus)
    r.modulus = {std::nullopt, "the platens' stresses differ by more than 2 % of f_c up to 1/3 of it"};
  if (r.inelastic_strain && !inertia.to_peak)
    r.inelastic_strain = {std::nullopt, "the test was not quasi-static up to the peak"};
  return r;
}

StageReport compression_report(const CompressionRows& rows, const CompressionAim& aim) {
  if (aim.is_upwards) return unloading_report(rows);
  StageReport report;
  CompressionResponse response = compression_response(rows, aim.waves_until);
  const bool bore = response.strength.value.has_value();
  const bool before_peak = bore && !response.peak_passed;
  if (before_peak)
    response.strength = response.inelastic_strain = {
        std::nullopt, fmt::format("the stage ended before a peak, at {:.2f} MPa and strain {:.5f}",
                                  *response.strength * 1e-6, response.strain_at_peak)};
  const QuasiStaticReport inertia = quasi_static_report(rows);
  if (bore) report.decided_at = peak_of(rows);
  report.results = {
      {"E_GPa", value_of(response.modulus, 1e-9)},
      {"E_none_because", reason_of(response.modulus)},
      {"toe_strain", response.toe},
      {"f_c_MPa", value_of(response.strength, 1e-6)},
      {"f_c_none_because", reason_of(response.strength)},
      {"strain_at_peak", response.strength ? Result::Value(response.strain_at_peak) : Result::Value()},
      {"strain_ic", value_of(response.inelastic_strain, 1.0)},
      {"strain_ic_none_because", reason_of(response.inelastic_strain)},
      {"peak_passed", response.peak_passed},
      {"quasi_static", inertia.to_peak},
      {"quasi_static_after_peak", inertia.after_peak},
      {"kinetic_over_elastic_to_peak", inertia.kinetic_to_peak},
      {"kinetic_over_elastic_after_peak", inertia.kinetic_after_peak},
      {"platen_difference_over_f_c_to_peak", inertia.difference_to_peak},
      {"platen_difference_over_f_c_after_peak", inertia.difference_after_peak},
  };
  report.lines.push_back(line_of("f_c", response.strength, 1e-6, 2, " MPa"));
  if (response.strength) report.lines.back() += fmt::format(" at strain {:.5f}", response.strain_at_peak);
  if (bore) {
    report.lines.push_back(line_of("E", response.modulus, 1e-9, 2, " GPa"));
    if (response.modulus && response.toe > 0.0)
      report.lines.back() += fmt::format(
          ", where the curve is steepest: it begins with a toe, up to strain {:.5f}", response.toe);
    if (!before_peak) report.lines.push_back(line_of("eps_ic", response.inelastic_strain, 1.0, 5, ""));
  }
  report.lines.push_back(inertia.to_peak ? "quasi-static up to the peak" : "NOT quasi-static up to the peak");
  if (!bore) report.warnings.push_back("no f_c and no E: " + response.strength.none_because);
  if (before_peak && !aim.to_a_value) report.warnings.push_back("no f_c: " + response.strength.none_because);
  if (!inertia.to_peak && bore)
    report.warnings.push_back(fmt::format(
        "not quasi-static up to the peak: kinetic over elastic energy up to {:.1e}, "
        "platen stresses differ by up to {:.1f} % of f_c; load more slowly or take a shorter time step",
        inertia.kinetic_to_peak, 100.0 * inertia.difference_to_peak));
  return report;
}

}  // namespace pyroclast
