#include "pyroclast/specimen/grading_curve.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast::specimen {
namespace {

/// Number of equal parts, by size, into which each interval between two sieves is cut.
constexpr int kParts = 16;

/// Returns the integral of 1 - 3/2 u + 1/2 u^3 over D from 0 to a diameter, m, with u = sqrt(1 - (s / D)^2);
/// u is 0 where D is below s.
double integral_to(double diameter, double s) {
  const double part = std::min(1.0, s / diameter), u = std::sqrt((1.0 - part) * (1.0 + part));
  return diameter * (1.0 - u) + 0.75 * s * std::acos(part) + 0.25 * s * part * u;
}

}  // namespace

double share_at(const GradingCurve& curve, double size) {
  const auto next = std::ranges::upper_bound(curve.sizes, size) - curve.sizes.begin();
  if (next == 0) return curve.shares.front();
  if (next == std::ssize(curve.sizes)) return curve.shares.back();
  const double part = (size - curve.sizes[next - 1]) / (curve.sizes[next] - curve.sizes[next - 1]);
  return curve.shares[next - 1] + part * (curve.shares[next] - curve.shares[next - 1]);
}

GradingCurve above(const GradingCurve& curve, double d_min) {
  if (d_min < curve.sizes.front() || d_min >= curve.sizes.back())
    throw Error(
        fmt::format("must lie from the smallest sieve of the curve, "
                    "{:.6g} m, to below its largest, {:.6g} m",
                    curve.sizes.front(), curve.sizes.back()));
  const double below = share_at(curve, d_min), all = curve.shares.back();
  if (below >= all) throw Error("leaves no stones: all pass a sieve of this size");
  GradingCurve result{{d_min}, {0.0}};
  for (std::size_t i = 0; i < curve.sizes.size(); ++i) {
    if (curve.sizes[i] <= d_min) continue;
    const double share = (curve.shares[i] - below) / (all - below);
    if (share == 0.0) result = {{}, {}};  // no stone is as small
    result.sizes.push_back(curve.sizes[i]);
    result.shares.push_back(share);
    if (curve.shares[i] == all) break;
  }
  result.shares.back() = 1.0;
  return result;
}

GradingCurve of_section(const GradingCurve& curve) {
  GradingCurve result;
  const auto add = [&](double s) {
    double share = share_at(curve, s);
    for (std::size_t i = 1; i < curve.sizes.size(); ++i) {
      const double high = curve.sizes[i], low = std::max(s, curve.sizes[i - 1]);
      if (high <= low) continue;
      const double density = (curve.shares[i] - curve.shares[i - 1]) / (high - curve.sizes[i - 1]);
      share += density * (integral_to(high, s) - integral_to(low, s));
    }
    result.sizes.push_back(s);
    result.shares.push_back(std::min(1.0, share));
  };
  for (std::size_t i = 1; i < curve.sizes.size(); ++i)
    for (int part = 0; part < kParts; ++part)
      add(curve.sizes[i - 1] + part * (curve.sizes[i] - curve.sizes[i - 1]) / kParts);
  result.sizes.push_back(curve.sizes.back());
  result.shares.push_back(1.0);
  return result;
}

}  // namespace pyroclast::specimen
