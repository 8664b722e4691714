#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/material/curve_catalogue.hpp"

namespace pyroclast {

/// Largest deviation from 1 of a ratio at the reference temperature, to whose value it refers: published fits
/// are off a little.
inline constexpr double kRatioTolerance = 0.01;

/// Curve as a deck gave it, for plots and the manifest.
struct ReadCurve {
  std::string path;  ///< path such as "materials.mortar.E"
  std::string unit;  ///< SI unit of the values
  Curve curve;
  std::string property{};  ///< property of the built-in curve that it has, see NamedCurve; else empty
};

/// Names the built-in curves that may stand in the place of a curve and that hold everywhere in a range,
/// "en1992_apparent_modulus reaches as far"; where there is none, says what to do.
/// \param property  property of the curve, see NamedCurve; may be empty
std::string describe_farther(std::string_view property, const Interval& range,
                             const CurveCatalogue& builtins);

/// Reader of curves in a deck: properties over the temperature, or boundary values over the time. A key holds
/// one of
///
///     E = "70 GPa"
///     E = { value = "70 GPa", times = "glasgow_modulus" }
///     E = { value = "70 GPa", times = { table = [["20 degC", 1], ["800 degC", 0.05]] } }
///     E = { table = [["20 degC", "70 GPa"], ["800 degC", "4 GPa"]] }
///     E = { csv = "modulus.csv" }
///     k = { builtin = "en1992_conductivity_upper" }
///     E = { expression = "70 * (1 - 0.001 * (T - 20))", unit = "GPa", range = ["20 degC", "800 degC"] }
///
/// and a temperature over the time also `{ from = "20 degC", rate = "5 K/min", to = "800 degC" }`, constant
/// once `to` is reached. `times` is a name of the catalogue or any form that is a table, without dimension;
/// over the temperature it must be 1 at 20 °C (to 1 %), where the value holds. `scale` and `shift` beside any
/// form of a curve over the temperature change the curve as a whole.
///
/// An error is recorded in the deck, never thrown, and a constant that is allowed stands in for the curve.
class CurveReader {
 public:
  /// \param folder    folder of the deck, to which names of CSV files are relative
  /// \param axis      temperature_axis() or time_axis()
  /// \param needed    finite interval that the run will read; a curve that does not cover it is an error
  /// \param builtins  curves for `builtin` and `times`; must outlive the reader
  CurveReader(std::filesystem::path folder, CurveAxis axis, Interval needed, const CurveCatalogue& builtins);

  /// Returns the curve in `unit.si`, named by its path in the deck. `range` holds over the needed interval.
  Curve read(const Section& section, std::string_view key, const Unit& unit, const Range& range,
             Meaning meaning);
  /// Returns the curve of a key that may be absent; without the key the value is `fallback`.
  Curve read(const Section& section, std::string_view key, const Unit& unit, const Range& range,
             double fallback, Meaning meaning);

  /// Sets what an error of a curve that does not cover the needed range says in the end, by the curve's
  /// range.
  void set_cure(std::function<std::string(const Interval& given)> cure) { cure_ = std::move(cure); }

  Interval needed() const { return needed_; }
  /// Returns all curves that were read from keys that are there, in order of reading.
  const std::vector<ReadCurve>& curves() const { return curves_; }

 private:
  Curve read_described(const Section& section, std::string_view key, const Unit& unit, const Range& range);
  std::optional<Curve> varied(const Section& forms, std::optional<Curve> curve) const;
  std::optional<Curve> read_forms(const Section& forms, const Unit& unit, bool has_value) const;
  std::optional<Curve> read_form(const Section& forms, const std::string& form, const Unit& unit) const;
  std::optional<Curve> read_product(const Section& forms, const Unit& unit) const;
  std::optional<Curve> read_table(const Section& forms, const Unit& unit) const;
  std::optional<Curve> read_csv(const Section& forms, const Unit& unit) const;
  std::optional<Curve> read_builtin(const Section& section, std::string_view key, const Unit& unit) const;
  std::optional<Curve> read_expression(const Section& forms, const Unit& unit) const;
  std::optional<Curve> read_ramp(const Section& forms, const Unit& unit) const;
  std::string property_of(const Section& section, std::string_view key) const;
  bool covers(const Section& section, std::string_view key, const Curve& curve) const;
  bool within(const Section& section, std::string_view key, const Curve& curve, const Unit& unit,
              const Range& range) const;
  void warn_if_unusual(const Section& section, std::string_view key, const Curve& curve, const Unit& unit,
                       const Range& range) const;
  const Unit& abscissa() const;
  /// Returns the name of the forms of a curve in the deck reference.
  std::string forms_name() const;
  /// Describes in words the content of a key that may hold a curve.
  std::string or_curve(const Unit& unit) const;

  std::filesystem::path folder_;
  CurveAxis axis_;
  Interval needed_;
  const CurveCatalogue& builtins_;
  std::vector<ReadCurve> curves_;
  std::function<std::string(const Interval&)> cure_ = [](const Interval&) { return std::string(); };
};

}  // namespace pyroclast
