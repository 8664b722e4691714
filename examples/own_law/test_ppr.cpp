// The law against closed forms of the paper; no program is needed, only the header.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "ppr.hpp"

namespace {

using Law = ppr::Law;

int failures = 0;

void expect(const char* what, double value, double wanted, double tolerance) {
  if (std::abs(value - wanted) <= tolerance * std::abs(wanted)) return;
  std::printf("%s is %.15g, not %.15g\n", what, value, wanted);
  ++failures;
}

Law::Properties<double> properties(double normal_energy, double shear_energy) {
  Law::Properties<double> p;
  p.normal_energy = normal_energy;
  p.shear_energy = shear_energy;
  p.normal_strength = 2.5e6;
  p.shear_strength = 4e6;
  p.normal_shape = 5.0;
  p.shear_shape = 1.7;
  p.normal_slope = 0.01;
  p.shear_slope = 0.02;
  p.friction = 0.6;
  return p;
}

/// A contact point in a plane body, on its way; the work is summed by the trapezoidal rule.
struct Point {
  explicit Point(const Law::Properties<double>& p) : constants(Law::derive(p)) {}

  void go(double opening, double sheared, int steps) {
    const double from_n = at[0], from_s = at[1];
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const std::array<double, 2> to{from_n + share * (opening - from_n),
                                     from_s + share * (sheared - from_s)};
      const auto r = Law::update<2, double>(constants, to[0], {{to[1]}}, internals, losses);
      const std::array<double, 2> traction{r.normal_traction, r.shear_traction[0]};
      for (int k : {0, 1}) {
        work += 0.5 * (traction[k] + last[k]) * (to[k] - at[k]);
        peak[k] = std::max(peak[k], traction[k]);
      }
      last = traction;
      at = to;
      stored = r.stored;
    }
  }

  Law::Constants<double> constants;
  Law::Internals<2, double> internals;
  Law::Losses<double> losses{};
  std::array<double, 2> at{}, last{}, peak{};
  double work = 0.0, stored = 0.0;
};

void check(double normal_energy, double shear_energy) {
  const auto p = properties(normal_energy, shear_energy);
  constexpr int kSteps = 20000;

  Point tension(p);
  tension.go(1.01 * tension.constants.normal.last, 0.0, kSteps);
  expect("work of separation in tension", tension.losses.separation, normal_energy, 1e-10);
  expect("area below the curve in tension", tension.work, normal_energy, 1e-5);
  expect("strength in tension", tension.peak[0], p.normal_strength, 1e-4);
  expect("damage in tension", tension.internals.tension_damage, 1.0, 0.0);

  Point shear(p);
  shear.go(0.0, 1.01 * shear.constants.shear.last, kSteps);
  expect("work of separation in shear", shear.losses.separation, shear_energy, 1e-10);
  expect("area below the curve in shear", shear.work, shear_energy, 1e-5);
  expect("strength in shear", shear.peak[1], p.shear_strength, 1e-4);

  // the peak stands where lambda says, and the work does not hang on how the way is cut
  Point at_peak(p);
  at_peak.go(p.normal_slope * at_peak.constants.normal.last, 0.0, 1);
  expect("traction at lambda delta", at_peak.last[0], p.normal_strength, 1e-12);
  at_peak.go(2.0 * at_peak.constants.normal.last, 0.0, 3);
  expect("work of separation in four steps", at_peak.losses.separation, normal_energy, 1e-12);

  // halfway, back to the origin, and on: nothing is lost on the way back
  Point half(p);
  half.go(0.2 * half.constants.normal.last, 0.0, 100);
  const double lost = half.losses.separation, traction = half.last[0];
  half.go(0.1 * half.constants.normal.last, 0.0, 1);
  expect("traction on the way to the origin", half.last[0], 0.5 * traction, 1e-12);
  half.go(0.2 * half.constants.normal.last, 0.0, 1);
  expect("lost on the way back", half.losses.separation, lost, 0.0);

  // torn and sheared at once: what went in was lost or is stored
  Point mixed(p);
  mixed.go(0.05 * mixed.constants.normal.last, 0.05 * mixed.constants.shear.last, kSteps);
  expect("energy in mixed mode", mixed.losses.separation + mixed.losses.friction + mixed.stored, mixed.work,
         1e-5);

  // closed again, what is broken rubs: Coulomb's law
  Point rubbed(p);
  rubbed.go(0.0, 1.01 * rubbed.constants.shear.last, kSteps);
  rubbed.go(-1e6 / rubbed.constants.normal.stiffness, rubbed.at[1], 100);
  rubbed.go(rubbed.at[0], 2.0 * rubbed.constants.shear.last, 100);
  expect("friction", rubbed.last[1], 0.6e6, 1e-9);
  expect("energy of friction", rubbed.losses.separation + rubbed.losses.friction + rubbed.stored, rubbed.work,
         1e-3);
}

}  // namespace

int main() {
  check(60.0, 60.0);
  check(60.0, 240.0);
  check(90.0, 45.0);
  for (double x : {1e-9, 0.003, 0.5, 0.999, 1.0})
    for (double y : {0.002, 0.7, 4.0, 9.0}) expect("power", ppr::power(x, y), std::pow(x, y), 1e-11);
  if (failures == 0) std::puts("ok");
  return failures == 0 ? 0 : 1;
}
