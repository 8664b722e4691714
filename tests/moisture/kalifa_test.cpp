#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "moisture/strip.hpp"

/// A slab of high-strength concrete with its measured temperatures: pressures and loss of water against those
/// measured. One number is fitted, the permeability at 200 degC, on the loss at 240 min and on the largest
/// pressures at 20 and 40 mm; the rest is predicted.
namespace pyroclast {
namespace {

constexpr double kThick = 0.12;      // m
constexpr double kDensity = 2430.0;  // kg/m3, by which losses are given
constexpr std::array<double, 7> kDepths{2e-3, 10e-3, 20e-3, 30e-3, 40e-3, 50e-3, 120e-3};
constexpr int kGauges = 5;  // of pressure, at kDepths[1] to [5]

struct Measured {
  std::vector<double> time;                           // s
  std::vector<std::array<double, 7>> temperature;     // degC
  std::vector<std::array<double, kGauges>> pressure;  // Pa above the atmosphere
  std::vector<double> loss;                           // kg/m2
};

Measured measured() {
  Measured m{{0.0}, {{20, 20, 20, 20, 20, 20, 20}}, {{}}, {0.0}};
  std::ifstream file(PYROCLAST_KALIFA);
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || std::isdigit(static_cast<unsigned char>(line[0])) == 0) continue;
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    double minutes = 0.0, percent = 0.0;
    row >> minutes;
    m.time.push_back(60.0 * minutes);
    for (double& t : m.temperature.emplace_back()) row >> t;
    for (double& p : m.pressure.emplace_back()) {
      row >> p;
      p *= 1e6;
    }
    row >> percent;
    m.loss.push_back(0.01 * percent * kDensity * kThick);
    EXPECT_FALSE(row.fail()) << line;
  }
  EXPECT_EQ(m.time.size(), 49U);
  return m;
}

/// Linear between gauges; beyond the first as between the first two.
double at_depth(const std::array<double, 7>& temperature, double x) {
  std::size_t k = 1;
  while (k + 1 < kDepths.size() && x > kDepths[k]) ++k;
  return temperature[k - 1] +
         (x - kDepths[k - 1]) / (kDepths[k] - kDepths[k - 1]) * (temperature[k] - temperature[k - 1]);
}

TEST(KalifaVerification, PressuresAndLossFollowTheMeasuredTemperatures) {
  const Measured m = measured();
  MoistBody<2> body = strip(120, kThick, high_strength(), {.largest_step = 20.0});
  body.moisture.start_with_saturation(0.77, 20.0);
  for (const double face : {0.0, kThick})
    body.moisture.apply(body.end(face), MoistAir{0.018, Curve::constant(0.0138)});
  const auto x = body.centroids();
  const auto pressure_at = [&](double depth) {
    const double place = depth / kThick * static_cast<double>(x.size()) - 0.5;
    const auto low = static_cast<std::size_t>(place);
    const double share = place - static_cast<double>(low);
    const auto& p = body.moisture.state().pressure;
    return (1.0 - share) * p[low] + share * p[low + 1] - water::kAtmosphere;
  };
  std::array<double, kGauges> peak{}, peak_time{}, ratio{}, true_peak{}, true_time{};
  std::vector<double> loss;
  for (std::size_t row = 1; row < m.time.size(); ++row) {
    std::vector<double> hot;
    for (const auto& place : x) hot.push_back(std::max(20.0, at_depth(m.temperature[row], place[0])));
    body.moisture.advance(m.time[row] - m.time[row - 1], hot);
    for (int g = 0; g < kGauges; ++g) {
      const double depth = kDepths[g + 1];
      if (const double p = pressure_at(depth); p > peak[g]) {
        peak[g] = p;
        peak_time[g] = m.time[row];
        ratio[g] = (p + water::kAtmosphere) / water::saturation_pressure(at_depth(m.temperature[row], depth));
      }
      if (m.pressure[row][g] > true_peak[g]) {
        true_peak[g] = m.pressure[row][g];
        true_time[g] = m.time[row];
      }
    }
    loss.push_back(body.moisture.state().ledger.left / 0.01);
  }
  double mean = 0.0;
  for (int g = 0; g < kGauges; ++g) {
    const double off = peak[g] / true_peak[g] - 1.0;
    std::printf("%2.0f mm: %.2f MPa at %.0f min, %.2f of saturation (measured: %.2f MPa at %.0f min)\n",
                1e3 * kDepths[g + 1], 1e-6 * peak[g], peak_time[g] / 60.0, ratio[g], 1e-6 * true_peak[g],
                true_time[g] / 60.0);
    mean += std::abs(off) / kGauges;
    EXPECT_NEAR(peak_time[g] / true_time[g], 1.0, 0.25) << g;
    EXPECT_GT(ratio[g], g == 0 ? 0.65 : 0.75);
    EXPECT_LT(ratio[g], 1.1);
  }
  EXPECT_LT(mean, 0.30);
  for (int g = 1; g < 4; ++g) EXPECT_GT(peak[g], peak[g - 1]);
  for (const int minutes : {120, 180, 240}) {
    const std::size_t row = static_cast<std::size_t>(minutes) / 5;
    std::printf("%d min: %.2f kg/m2 (measured: %.2f)\n", minutes, loss[row - 1], m.loss[row]);
    // too much goes out of the cold face, which is open: with it sealed 3.72, 5.45 and 6.87 kg/m2 are lost
    EXPECT_NEAR(loss[row - 1] / m.loss[row], 1.0, minutes == 120 ? 0.35 : 0.20) << minutes;
  }
  EXPECT_LT(std::abs(body.moisture.imbalance()), 1e-13 * body.moisture.state().ledger.at_start);
}

}  // namespace
}  // namespace pyroclast
