#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/jump_path.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/simulation/watching/history.hpp"

namespace pyroclast {

/// Returns a contact law with all its properties, as "key=value" states them. Throws Error for a property
/// that is missing or not allowed.
ContactMaterial stated_material(const LawTable& law, const std::vector<std::string>& values);

/// Contact point that is taken along a path of jumps, with its energies added up. As in a run it has the
/// strengths of the highest temperature so far, and loses what the material loses on cooling.
class LawPoint {
 public:
  /// \param temperature  temperature at the beginning, °C
  /// \param hottest      least value of the highest temperature so far, °C
  ///
  /// Throws Error, here and in `go`, for a temperature at which the law's properties are not allowed or a
  /// curve is not defined.
  explicit LawPoint(ContactMaterial material, OnCooling on_cooling = OnCooling::irreversible,
                    double temperature = kReferenceTemperature, double hottest = absolute_zero);

  void go(const JumpPathPoint& to);
  /// Goes to a point in `steps` equal parts and calls `look` after each of them.
  template <class Look>
  void go(const JumpPathPoint& to, int steps, Look look) {
    const JumpPathPoint from = at_;
    for (int i = 1; i <= steps; ++i) {
      const double share = static_cast<double>(i) / steps;
      const auto between = [&](double a, double b) { return i == steps ? b : a + share * (b - a); };
      go({between(from.opening, to.opening), between(from.slip, to.slip),
          between(from.temperature, to.temperature)});
      look();
    }
  }

  /// Returns the columns of `values`: names with their units at the end, all SI and degC.
  std::vector<Column> columns() const;
  std::vector<double> values() const;
  double temperature() const { return at_.temperature; }  ///< °C

 private:
  void warm_to(double temperature);
  void update(const JumpPathPoint& point);
  double dissipated() const;

  ContactMaterial material_;
  OnCooling on_cooling_;
  double hottest_;  ///< highest temperature so far, °C
  const LawTable& law_;
  std::vector<std::byte> constants_;
  std::vector<double> internals_, losses_;
  PointResponse response_;
  JumpPathPoint at_;
  double property_change_ = 0.0;
};

}  // namespace pyroclast
