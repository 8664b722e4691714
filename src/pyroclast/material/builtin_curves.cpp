#include "pyroclast/material/builtin_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

constexpr Interval eurocode_range{20.0, 1200.0};  // degC

using Points = std::vector<std::pair<double, double>>;

Curve table(const Points& points) {
  std::vector<double> temperatures;
  std::vector<double> values;
  for (const auto& [temperature, value] : points) {
    temperatures.push_back(temperature);
    values.push_back(value);
  }
  return Curve::table(std::move(temperatures), std::move(values), temperature_axis());
}

Curve function(std::function<double(double)> f, Interval range, std::vector<double> breaks = {}) {
  return Curve::function("built-in curve", std::move(f), range, temperature_axis(), std::move(breaks));
}

// ---- EN 1992-1-2:2004 -------------------------------------------------------------------------------------

const Points& siliceous_strength() {
  static const Points points = {{20, 1.0},    {100, 1.0},   {200, 0.95}, {300, 0.85}, {400, 0.75},
                                {500, 0.60},  {600, 0.45},  {700, 0.30}, {800, 0.15}, {900, 0.08},
                                {1000, 0.04}, {1100, 0.01}, {1200, 0.0}};
  return points;
}

const Points& calcareous_strength() {
  static const Points points = {{20, 1.0},    {100, 1.0},   {200, 0.97}, {300, 0.91}, {400, 0.85},
                                {500, 0.74},  {600, 0.60},  {700, 0.43}, {800, 0.27}, {900, 0.15},
                                {1000, 0.06}, {1100, 0.02}, {1200, 0.0}};
  return points;
}

// Returns no strain at 1200 degC: the table has none.
const Points& peak_strain() {
  static const Points points = {{20, 0.0025},  {100, 0.0040}, {200, 0.0055}, {300, 0.0070},
                                {400, 0.0100}, {500, 0.0150}, {600, 0.0250}, {1100, 0.0250}};
  return points;
}

const Points& ultimate_strain() {
  static const Points points = {{20, 0.0200},  {100, 0.0225}, {200, 0.0250},  {300, 0.0275},
                                {400, 0.0300}, {500, 0.0325}, {600, 0.0350},  {700, 0.0375},
                                {800, 0.0400}, {900, 0.0425}, {1000, 0.0450}, {1100, 0.0475}};
  return points;
}

/// Thermal elongation a + b T + c T^3, constant once it reaches its greatest value.
struct Elongation {
  double a;
  double b;
  double c;
  double greatest;

  double polynomial(double T) const { return a + b * T + c * T * T * T; }
  double strain(double T) const { return std::min(polynomial(T), greatest); }

  /// Returns the strain since 20 degC over the temperature rise. The polynomial is divided in closed form, so
  /// that 20 degC is no special case: the limit there is the slope b + 3 c T0^2.
  double secant(double T) const {
    constexpr double T0 = kReferenceTemperature;
    if (polynomial(T) < greatest) return b + c * (T * T + T * T0 + T0 * T0);
    return (greatest - polynomial(T0)) / (T - T0);
  }
};

constexpr Elongation siliceous_elongation{-1.8e-4, 9e-6, 2.3e-11, 14e-3};
constexpr Elongation calcareous_elongation{-1.2e-4, 6e-6, 1.4e-11, 12e-3};

Curve elongation(const Elongation& e, double end_of_growth) {
  return function([e](double T) { return e.strain(T); }, eurocode_range, {end_of_growth});
}

Curve secant_expansion(const Elongation& e, double end_of_growth) {
  return function([e](double T) { return e.secant(T); }, eurocode_range, {end_of_growth});
}

/// Returns a + b (T/100) + c (T/100)^2, W/(m K).
Curve conductivity(double a, double b, double c) {
  return function([=](double T) { return a + (b + c * T / 100.0) * T / 100.0; }, eurocode_range);
}

double dry_specific_heat(double T) {
  if (T <= 100.0) return 900.0;
  if (T <= 200.0) return 900.0 + (T - 100.0);
  if (T <= 400.0) return 1000.0 + (T - 200.0) / 2.0;
  return 1100.0;
}

double moist_specific_heat(double T, double peak) {
  if (T < 100.0 || T > 200.0) return dry_specific_heat(T);
  const double moist = T <= 115.0 ? peak : peak + (1000.0 - peak) * (T - 115.0) / 85.0;
  return std::max(moist, dry_specific_heat(T));
}

double specific_heat_peak(double moisture_percent) {
  if (moisture_percent <= 1.5) return 900.0 + (1470.0 - 900.0) * moisture_percent / 1.5;
  return 1470.0 + (2020.0 - 1470.0) * (moisture_percent - 1.5) / 1.5;
}

/// Returns 1.5 f_c/eps_c1, the initial slope of the stress-strain curve of Table 3.1, relative to 20 degC.
Curve apparent_modulus() {
  const Curve strength = table(siliceous_strength());
  const Curve strain = table(peak_strain());
  const double reference = strength(kReferenceTemperature) / strain(kReferenceTemperature);
  return function([=](double T) { return strength(T) / strain(T) / reference; }, strain.range(),
                  {100, 200, 300, 400, 500, 600, 700, 800, 900, 1000});
}

std::vector<NamedCurve> eurocode_curves() {
  const std::string table_3_1 = "EN 1992-1-2:2004 Table 3.1";
  const std::string clause_elongation = "EN 1992-1-2:2004 3.3.1(1)";
  const std::string clause_heat = "EN 1992-1-2:2004 3.3.2(1)-(2)";
  return {
      {"en1992_siliceous_strength", "compressive strength ratio, siliceous aggregate; 0 at 1200 degC",
       table_3_1, "1", table(siliceous_strength())},
      {"en1992_calcareous_strength", "compressive strength ratio, calcareous aggregate; 0 at 1200 degC",
       table_3_1, "1", table(calcareous_strength())},
      {"en1992_tensile_strength", "tensile strength ratio; 0 at 600 degC, where the clause ends",
       "EN 1992-1-2:2004 3.2.2.2(2)", "1", table({{20, 1}, {100, 1}, {600, 0}})},
      {"en1992_peak_strain", "strain at the compressive strength, normal weight concrete", table_3_1, "1",
       table(peak_strain())},
      {"en1992_ultimate_strain", "strain at the end of the softening branch, normal weight concrete",
       table_3_1, "1", table(ultimate_strain())},
      {"en1992_apparent_modulus",
       "modulus ratio from the stress-strain curve, siliceous aggregate; includes transient creep and is "
       "thus a "
       "lower bound of the elastic modulus",
       "initial slope 1.5 f_c/eps_c1 of EN 1992-1-2:2004 3.2.2.1 and Table 3.1", "1", apparent_modulus()},
      {"en1992_siliceous_elongation",
       "thermal elongation, siliceous aggregate; 1.84e-7 at 20 degC as the standard has it",
       clause_elongation, "1", elongation(siliceous_elongation, 700.0)},
      {"en1992_calcareous_elongation",
       "thermal elongation, calcareous aggregate; 1.12e-7 at 20 degC as the standard has it",
       clause_elongation, "1", elongation(calcareous_elongation, 805.0)},
      {"en1992_siliceous_expansion", "secant thermal expansion coefficient from 20 degC, siliceous aggregate",
       "elongation of EN 1992-1-2:2004 3.3.1(1) since 20 degC, divided by T - 20", "1/K",
       secant_expansion(siliceous_elongation, 700.0)},
      {"en1992_calcareous_expansion",
       "secant thermal expansion coefficient from 20 degC, calcareous aggregate",
       "elongation of EN 1992-1-2:2004 3.3.1(1) since 20 degC, divided by T - 20", "1/K",
       secant_expansion(calcareous_elongation, 805.0)},
      {"en1992_conductivity_upper", "thermal conductivity, upper limit", "EN 1992-1-2:2004 3.3.3(2)",
       "W/(m K)", conductivity(2.0, -0.2451, 0.0107)},
      {"en1992_conductivity_lower", "thermal conductivity, lower limit", "EN 1992-1-2:2004 3.3.3(2)",
       "W/(m K)", conductivity(1.36, -0.136, 0.0057)},
      {"en1992_specific_heat_u0", "specific heat, dry concrete", clause_heat, "J/(kg K)",
       en1992_specific_heat(0.0)},
      {"en1992_specific_heat_u1_5", "specific heat, moisture 1.5 % of the concrete's weight", clause_heat,
       "J/(kg K)", en1992_specific_heat(1.5)},
      {"en1992_specific_heat_u3", "specific heat, moisture 3 % of the concrete's weight", clause_heat,
       "J/(kg K)", en1992_specific_heat(3.0)},
      {"en1992_density", "density ratio (loss of water)", "EN 1992-1-2:2004 3.3.2(3)", "1",
       table({{20, 1}, {115, 1}, {200, 0.98}, {400, 0.95}, {1200, 0.88}})},
  };
}

// ---- Publications -----------------------------------------------------------------------------------------

double theta(double T) {
  return (T - kReferenceTemperature) / 100.0;
}

double glasgow_fracture_energy(double T) {
  constexpr double kEnd = 6.8, kLeast = 0.2;  // theta where the formula ends, and the least ratio
  const double t = std::min(theta(T), kEnd), beyond = std::max(theta(T) - kEnd, 0.0);
  return std::max(1.0 + (0.39 - 0.07 * t) * t + (0.39 - 0.14 * kEnd) * beyond, kLeast);
}

double glasgow_free_thermal_strain(double T) {
  return 0.006 * std::log(7.0 / (7.0 - std::min(theta(T), 6.0)));
}

// Load-induced thermal strains for each unit of stress over strength, both in compression.

double glasgow_creep(double T) {
  constexpr double A = 0.0005, B = 0.00125, C = 0.0085, kink = 4.5;
  const double t = theta(T), below = std::min(t, kink), above = std::max(t - kink, 0.0);
  return (A * below + B) * below + (C * above + 2.0 * A * kink + B) * above;
}

/// End of the published polynomial, degC; beyond it the curve goes on with its last slope.
constexpr double kTorelliEnd = 500.0;
/// Temperature below which the polynomial has the wrong sign, degC.
constexpr double kTorelliBegin = 32.333513018427276;

double torelli_creep(double T) {
  constexpr std::array<double, 5> b = {-2.7031065533e-5, 1.0209170592e-6, -6.1200423753e-9, 1.2632648735e-11,
                                       -6.9158539621e-15};
  const auto slope = [&](double x) {
    double sum = 0.0;
    for (std::size_t i = b.size(); i-- > 0;) sum = sum * x + b[i];
    return sum;
  };
  const auto integral = [&](double x) {
    double sum = 0.0;
    for (std::size_t i = b.size(); i-- > 0;) sum = sum * x + b[i] / static_cast<double>(i + 1);
    return sum * x;
  };
  const double x = std::clamp(T, kTorelliBegin, kTorelliEnd);
  return integral(x) - integral(kTorelliBegin) +
         slope(kTorelliEnd) * (std::max(T, kTorelliEnd) - kTorelliEnd);
}

double li_purkiss_strength(double T) {
  const double x = T / 100.0;
  return 1.002 + (0.025 + (-0.03 + 0.00165 * x) * x) * x;
}

double asce_heat_capacity(double T) {  // MJ/(m3 K)
  if (T <= 200.0) return 0.005 * T + 1.7;
  if (T <= 400.0) return 2.7;
  if (T <= 500.0) return 0.013 * T - 2.5;
  if (T <= 600.0) return 10.5 - 0.013 * T;
  return 2.7;
}

/// Returns the conductivity of air by Sutherland's law with White's constants, W/(m K).
double air_conductivity(double T) {
  constexpr double k_0 = 0.0241, T_0 = 273.0, S = 194.0;  // W/(m K), K, K
  const double absolute = T + 273.15;
  return k_0 * std::pow(absolute / T_0, 1.5) * (T_0 + S) / (absolute + S);
}

std::vector<NamedCurve> published_curves() {
  // These formulas were read in the SIFEL code, not in the publications.
  const std::string glasgow = "Glasgow group: Pearce, Nielsen and Bicanic, second-hand";
  const std::string li_purkiss = "Li and Purkiss, second-hand";
  return {
      {"glasgow_modulus", "modulus ratio (1 - 0.1 theta)^2 with theta = (T - 20)/100; 0.0484 at 800 degC",
       glasgow, "1", function([](double T) { return std::pow(1.0 - 0.1 * theta(T), 2); }, {20.0, 800.0})},
      {"glasgow_tensile_strength",
       "tensile strength ratio 1 - 0.016 theta^2, theta = (T - 20)/100, up to theta = 7.9 where it is near 0",
       glasgow, "1", function([](double T) { return 1.0 - 0.016 * theta(T) * theta(T); }, {20.0, 810.0})},
      {"glasgow_fracture_energy",
       "fracture energy ratio 1 + 0.39 theta - 0.07 theta^2, theta = (T - 20)/100; greatest near 300 degC; "
       "the last slope beyond 700 degC, and 0.2 from 738 degC on, a choice",
       glasgow, "1", function(glasgow_fracture_energy, eurocode_range, {700.0, 738.3})},
      {"glasgow_free_thermal_strain",
       "free thermal strain 0.006 ln(7/(7 - theta)), theta = (T - 20)/100, constant from theta = 6", glasgow,
       "1", function(glasgow_free_thermal_strain, eurocode_range, {620.0})},
      {"glasgow_creep",
       "load-induced thermal strain for each unit of stress over strength, 0.0005 theta^2 + 0.00125 theta, "
       "theta = (T - 20)/100, with the slope growing by 0.017 from theta = 4.5",
       glasgow, "1", function(glasgow_creep, {20.0, 800.0}, {470.0})},
      {"torelli_creep",
       "load-induced thermal strain for each unit of stress over strength, the integral of a polynomial from "
       "32.3 degC, where it becomes positive, to 500 degC; the last slope beyond",
       "Torelli, Gillie, Mandal and Tran 2018, coefficients second-hand (TFEL)", "1",
       function(torelli_creep, {20.0, 800.0}, {kTorelliBegin, kTorelliEnd})},
      {"etc_creep",
       "load-induced thermal strain for each unit of stress over strength; the last slope beyond 600 degC",
       "ETC model of Gernay and Franssen, second-hand", "1",
       table({{20, 0},
              {100, 0.001},
              {200, 0.00175},
              {300, 0.00235},
              {400, 0.00489},
              {500, 0.01056},
              {600, 0.02667},
              {800, 0.05889}})},
      {"li_purkiss_strength",
       "compressive strength ratio 1.002 + 0.025 x - 0.03 x^2 + 0.00165 x^3, x = T/100; 1.0058 at 20 degC",
       li_purkiss, "1", function(li_purkiss_strength, {20.0, 800.0})},
      {"li_purkiss_modulus",
       "modulus ratio (800 - T)/740 above 60 degC; ends at 780 degC because no stiffness is left at 800 degC",
       li_purkiss, "1", table({{20, 1}, {60, 1}, {780, 20.0 / 740.0}})},
      {"asce_siliceous_conductivity", "thermal conductivity, normal strength concrete, siliceous aggregate",
       "ASCE Manual 78 (1992)", "W/(m K)", table({{20, 1.4875}, {800, 1.0}, {1200, 1.0}})},
      {"asce_siliceous_heat_capacity",
       "heat capacity per volume (density times specific heat), normal strength concrete, siliceous "
       "aggregate",
       "ASCE Manual 78 (1992)", "J/(m3 K)",
       function([](double T) { return 1e6 * asce_heat_capacity(T); }, eurocode_range, {200, 400, 500, 600})},
      {"air_conductivity", "thermal conductivity of air at the pressure of the atmosphere, within 2 %",
       "White, Viscous Fluid Flow, Sutherland's law", "W/(m K)",
       function(air_conductivity, {-100.0, 1700.0})},
      {"paper_aggregate_expansion",
       "secant thermal expansion coefficient of aggregate from 20 degC, fitted to the unloaded heating test",
       "paper Eq. (18), 9e-6 + 7e-8 T", "1/K",
       function([](double T) { return 9e-6 + 7e-8 * T; }, {20.0, 800.0})},
      {"paper_mortar_expansion",
       "secant thermal expansion coefficient of mortar from 20 degC, fitted to the unloaded heating test; "
       "negative above 122 degC",
       "paper Eq. (18), 9e-7 - 6e-11 T^2", "1/K",
       function([](double T) { return 9e-7 - 6e-11 * T * T; }, {20.0, 800.0})},
  };
}

std::vector<NamedCurve> all_curves() {
  std::vector<NamedCurve> curves = eurocode_curves();
  const std::vector<NamedCurve> published = published_curves();
  curves.insert(curves.end(), published.begin(), published.end());
  return curves;
}

/// Property of a curve by the words with which its name ends.
struct PropertyOfName {
  std::string_view ending, property;
};

constexpr auto kProperties = std::to_array<PropertyOfName>({
    {"_strength", "strength"},
    {"_modulus", "modulus"},
    {"_elongation", "thermal strain"},
    {"_thermal_strain", "thermal strain"},
    {"_expansion", "expansion"},
    {"_fracture_energy", "fracture energy"},
    {"_creep", "creep"},
    {"s_conductivity", "conductivity"},
    {"_conductivity_upper", "conductivity"},
    {"_conductivity_lower", "conductivity"},
    {"_specific_heat_u0", "specific heat"},
    {"_specific_heat_u1_5", "specific heat"},
    {"_specific_heat_u3", "specific heat"},
});

std::vector<NamedCurve> with_properties(std::vector<NamedCurve> curves) {
  for (NamedCurve& curve : curves)
    for (const auto& [ending, property] : kProperties)
      if (curve.name.ends_with(ending)) curve.property = property;
  return curves;
}

}  // namespace

const CurveCatalogue& builtin_curves() {
  static const CurveCatalogue catalogue("built-in curve", with_properties(all_curves()));
  return catalogue;
}

Curve en1992_specific_heat(double moisture_percent) {
  if (!(0.0 <= moisture_percent && moisture_percent <= 3.0)) {
    throw Error(
        fmt::format("EN 1992-1-2 specific heat: the moisture content {} % is not between 0 and 3 % of the "
                    "concrete's weight",
                    moisture_percent));
  }
  const double peak = specific_heat_peak(moisture_percent);
  return function([peak](double T) { return moist_specific_heat(T, peak); }, eurocode_range,
                  {100, 115, 200, 400})
      .described_as(
          fmt::format("specific heat of EN 1992-1-2:2004 3.3.2 at {} % moisture", moisture_percent));
}

}  // namespace pyroclast
