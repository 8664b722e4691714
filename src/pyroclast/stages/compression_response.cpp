#include "pyroclast/stages/compression_response.hpp"

#include <algorithm>
#include <cmath>

namespace pyroclast {

namespace {

constexpr double kFitFrom = 0.05, kFitTo = 1.0 / 3.0;  // of f_c
constexpr double kFewestRows = 3.0;                    // on a line that is fitted
constexpr double kFallThatProvesAPeak = 0.01;          // of f_c
constexpr double kInertiaCountsFrom = 0.1;             // of f_c

std::size_t peak_of(const CompressionRows& rows) {
  return std::max_element(rows.stress.begin(), rows.stress.end()) - rows.stress.begin();
}

}  // namespace

CompressionRows compression_rows(const History& history, RowRange rows) {
  CompressionRows read{history.values("stage_strain", rows),
                       history.values("stress_MPa", rows),
                       {},
                       history.values("kinetic_over_strain", rows)};
  for (double& stress : read.stress) stress *= 1e6;
  const auto top = history.values("stress_top_MPa", rows), bottom = history.values("stress_bottom_MPa", rows);
  for (std::size_t i = 0; i < top.size(); ++i)
    read.platen_difference.push_back(std::abs(top[i] - bottom[i]) * 1e6);
  return read;
}

std::optional<CompressionResponse> compression_response(const CompressionRows& rows) {
  if (rows.count() == 0) return std::nullopt;
  const std::size_t peak = peak_of(rows);
  CompressionResponse r;
  r.strength = rows.stress[peak];
  r.strain_at_peak = rows.strain[peak];

  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < peak; ++i) {
    const double strain = rows.strain[i], stress = rows.stress[i];
    if (stress < kFitFrom * r.strength || stress > kFitTo * r.strength) continue;
    n += 1.0;
    sx += strain;
    sy += stress;
    sxx += strain * strain;
    sxy += strain * stress;
  }
  if (n >= kFewestRows) {
    r.modulus = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    r.inelastic_strain = r.strain_at_peak - r.strength / *r.modulus;
  }
  r.peak_passed = std::any_of(rows.stress.begin() + static_cast<std::ptrdiff_t>(peak), rows.stress.end(),
                              [&](double s) { return s < (1.0 - kFallThatProvesAPeak) * r.strength; });
  return r;
}

QuasiStaticReport quasi_static_report(const CompressionRows& rows, const QuasiStaticBounds& bounds) {
  QuasiStaticReport report;
  if (rows.count() == 0) return report;
  const std::size_t peak = peak_of(rows);
  const double strength = rows.stress[peak];
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (rows.stress[i] < kInertiaCountsFrom * strength) continue;
    const bool after = i > peak;
    double& kinetic = after ? report.kinetic_after_peak : report.kinetic_to_peak;
    double& difference = after ? report.difference_after_peak : report.difference_to_peak;
    kinetic = std::max(kinetic, rows.kinetic_over_strain[i]);
    difference = std::max(difference, rows.platen_difference[i] / strength);
  }
  report.to_peak = report.kinetic_to_peak <= bounds.kinetic_over_strain &&
                   report.difference_to_peak <= bounds.platen_difference;
  report.after_peak = report.kinetic_after_peak <= bounds.kinetic_over_strain &&
                      report.difference_after_peak <= bounds.platen_difference;
  return report;
}

}  // namespace pyroclast
