#include "pyroclast/experiment/response.hpp"

#include <algorithm>
#include <cmath>

namespace pyroclast {

namespace {

constexpr double kFitFrom = 0.05, kFitTo = 1.0 / 3.0;  // of f_c
constexpr double kFallThatProvesAPeak = 0.01;          // of f_c
constexpr double kInertiaCountsFrom = 0.1;             // of f_c

std::vector<Sample> compression_rows(const std::vector<Sample>& history, const std::vector<Stage>& stages) {
  std::vector<Sample> rows;
  for (const auto& s : history)
    if (s.stage < static_cast<int>(stages.size()) && std::holds_alternative<CompressStage>(stages[s.stage]))
      rows.push_back(s);
  return rows;
}

std::vector<Sample>::const_iterator peak_of(const std::vector<Sample>& rows) {
  return std::max_element(rows.begin(), rows.end(),
                          [](const Sample& a, const Sample& b) { return a.stress() < b.stress(); });
}

}  // namespace

std::optional<CompressionResponse> compression_response(const std::vector<Sample>& history,
                                                        const std::vector<Stage>& stages) {
  const auto rows = compression_rows(history, stages);
  if (rows.empty()) return std::nullopt;
  const auto peak = peak_of(rows);
  CompressionResponse r;
  r.strength = peak->stress();
  r.strain_at_peak = peak->stage_strain;

  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (auto row = rows.begin(); row != peak; ++row) {
    if (row->stress() < kFitFrom * r.strength || row->stress() > kFitTo * r.strength) continue;
    n += 1.0;
    sx += row->stage_strain;
    sy += row->stress();
    sxx += row->stage_strain * row->stage_strain;
    sxy += row->stage_strain * row->stress();
  }
  if (n < 3.0) return std::nullopt;
  r.modulus = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  r.inelastic_strain = r.strain_at_peak - r.strength / r.modulus;
  r.peak_passed = std::any_of(peak, rows.end(), [&](const Sample& s) {
    return s.stress() < (1.0 - kFallThatProvesAPeak) * r.strength;
  });
  return r;
}

QuasiStaticReport quasi_static_report(const std::vector<Sample>& history, const std::vector<Stage>& stages,
                                      const QuasiStaticBounds& bounds) {
  const auto rows = compression_rows(history, stages);
  QuasiStaticReport report;
  if (rows.empty()) return report;
  const auto peak = peak_of(rows);
  for (auto row = rows.begin(); row != rows.end(); ++row) {
    if (row->stress() < kInertiaCountsFrom * peak->stress()) continue;
    const bool after = row > peak;
    const double difference = std::abs(row->stress_top - row->stress_bottom) / peak->stress();
    double& kinetic = after ? report.kinetic_after_peak : report.kinetic_to_peak;
    double& worst_difference = after ? report.difference_after_peak : report.difference_to_peak;
    kinetic = std::max(kinetic, row->kinetic_over_strain);
    worst_difference = std::max(worst_difference, difference);
  }
  report.to_peak = report.kinetic_to_peak <= bounds.kinetic_over_strain &&
                   report.difference_to_peak <= bounds.platen_difference;
  report.after_peak = report.kinetic_after_peak <= bounds.kinetic_over_strain &&
                      report.difference_after_peak <= bounds.platen_difference;
  return report;
}

}  // namespace pyroclast
