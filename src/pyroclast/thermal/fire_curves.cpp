#include "pyroclast/thermal/fire_curves.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pyroclast {
namespace {

constexpr double minute = 60.0;  // s
constexpr double hour = 3600.0;  // s
// Formulas have no end of their own; fire resistance is not classified beyond six hours.
constexpr Interval six_hours{0.0, 6.0 * hour};

/// Makes a curve of a formula.
/// \param gas_temperature  function of the time in minutes, °C
Curve formula(std::function<double(double)> gas_temperature) {
  return Curve::function(
      "fire curve", [f = std::move(gas_temperature)](double t) { return f(t / minute); }, six_hours,
      time_axis());
}

/// Makes a curve that is linear between points (minutes, degC).
Curve table(const std::vector<std::pair<double, double>>& points) {
  std::vector<double> times;
  std::vector<double> temperatures;
  for (const auto& [minutes, temperature] : points) {
    times.push_back(minutes * minute);
    temperatures.push_back(temperature);
  }
  return Curve::table(std::move(times), std::move(temperatures), time_axis());
}

double iso834(double minutes) {
  return 20.0 + 345.0 * std::log10(8.0 * minutes + 1.0);
}

double astm_e119_formula(double minutes) {
  const double root = std::sqrt(minutes * minute / hour);
  return 20.0 + 750.0 * (1.0 - std::exp(-3.79553 * root)) + 170.41 * root;
}

double external(double minutes) {
  return 20.0 + 660.0 * (1.0 - 0.687 * std::exp(-0.32 * minutes) - 0.313 * std::exp(-3.8 * minutes));
}

/// Returns the gas temperature of a hydrocarbon fire that rises by `rise` kelvin, °C.
double hydrocarbon(double minutes, double rise) {
  return 20.0 + rise * (1.0 - 0.325 * std::exp(-0.167 * minutes) - 0.675 * std::exp(-2.5 * minutes));
}

std::vector<NamedCurve> all_fires() {
  return {
      {"iso834", "standard fire of buildings", "ISO 834-1; EN 1991-1-2:2002 3.2.1", "degC", formula(iso834)},
      {"astm_e119",
       "standard fire of North America, linear between the tabulated points, thus a straight rise from 20 "
       "degC "
       "in the first 5 minutes",
       "ASTM E119 Table X1.1", "degC",
       table({{0, 20},    {5, 538},    {10, 704},   {15, 760},   {20, 795},   {25, 821},  {30, 843},
              {35, 862},  {40, 878},   {45, 892},   {50, 905},   {55, 916},   {60, 927},  {65, 937},
              {70, 946},  {75, 955},   {80, 963},   {85, 971},   {90, 978},   {95, 985},  {100, 991},
              {105, 996}, {110, 1001}, {115, 1006}, {120, 1010}, {240, 1093}, {480, 1260}})},
      {"astm_e119_formula",
       "smooth approximation of astm_e119, some 30 K above its points in the first minutes",
       "Lie 1992 (ASCE Manual 78)", "degC", formula(astm_e119_formula)},
      {"en1991_external", "fire outside a facade", "EN 1991-1-2:2002 3.2.2", "degC", formula(external)},
      {"en1991_hydrocarbon", "hydrocarbon fire", "EN 1991-1-2:2002 3.2.3", "degC",
       formula([](double minutes) { return hydrocarbon(minutes, 1080.0); })},
      {"hydrocarbon_modified", "modified hydrocarbon fire of tunnels (HCM), to 1300 degC",
       "French circular 2000-63", "degC",
       formula([](double minutes) { return hydrocarbon(minutes, 1280.0); })},
      {"rws", "tunnel fire of a fuel tanker, linear between the tabulated points", "Rijkswaterstaat", "degC",
       table({{0, 20},
              {3, 890},
              {5, 1140},
              {10, 1200},
              {30, 1300},
              {60, 1350},
              {90, 1300},
              {120, 1200},
              {180, 1200}})},
      {"rabt_car",
       "tunnel fire of road vehicles: 30 min with 25 min at 1200 degC, then 110 min of cooling; "
       "starts and ends at 15 degC",
       "RABT/ZTV, road", "degC", table({{0, 15}, {5, 1200}, {30, 1200}, {140, 15}})},
      {"rabt_train",
       "tunnel fire of trains: 60 min with 55 min at 1200 degC, then 110 min of cooling; "
       "starts and ends at 15 degC",
       "RABT/ZTV, rail", "degC", table({{0, 15}, {5, 1200}, {60, 1200}, {170, 15}})},
  };
}

}  // namespace

const CurveCatalogue& fire_curves() {
  static const CurveCatalogue catalogue("fire curve", all_fires());
  return catalogue;
}

}  // namespace pyroclast
