#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pyroclast/material/concrete.hpp"
#include "pyroclast/material/jump_path.hpp"
#include "pyroclast/plugin/find_law.hpp"
#include "pyroclast/simulation/history.hpp"

namespace pyroclast {

/// A contact law with all its properties, as "key=value" states them. Throws Error for one that is missing or
/// cannot be.
ContactMaterial stated_material(const LawTable& law, const std::vector<std::string>& values);

/// One contact point on its way along a path of jumps, with its energies added up. As in a run it has the
/// strengths of the highest temperature that it came to, and loses what the material loses on cooling.
class LawPoint {
 public:
  /// \param temperature  at which it begins, °C
  /// \param hottest      no less than which it was so far, °C
  ///
  /// Throws Error, here and in `go`, for a temperature at which the law cannot be, or that a curve does not
  /// hold.
  explicit LawPoint(ContactMaterial material, OnCooling on_cooling = OnCooling::irreversible,
                    double temperature = kReferenceTemperature, double hottest = absolute_zero);

  void go(const JumpPathPoint& to);
  /// In `steps` equal parts; after each of them `look` is called.
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

  /// What `values` are: names with their units at the end, all SI and degC.
  std::vector<Column> columns() const;
  std::vector<double> values() const;
  double temperature() const { return at_.temperature; }  ///< °C

 private:
  void warm_to(double temperature);
  void update(const JumpPathPoint& point);
  double dissipated() const;

  ContactMaterial material_;
  OnCooling on_cooling_;
  double hottest_;  ///< so far, °C
  const LawTable& law_;
  std::vector<std::byte> constants_;
  std::vector<double> internals_, losses_;
  PointResponse response_;
  JumpPathPoint at_;
  double property_change_ = 0.0;
};

}  // namespace pyroclast
