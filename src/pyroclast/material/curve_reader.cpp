#include "pyroclast/material/curve_reader.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shown.hpp"
#include "pyroclast/material/curve_file.hpp"
#include "pyroclast/tables/read_choice.hpp"

namespace pyroclast {
namespace {

/// End of a ramp's range, s: 30 years, later than any run.
constexpr double kRampEnd = 1e9;

/// Words of the deck reference for a value that is of its key's kind.
constexpr auto kQuantity = "quantity of the key's kind";

std::string suffix(const Unit& unit) {
  return unit == unit::dimensionless ? "" : unit.si;
}

std::string with_unit(double value, const Unit& unit) {
  return fmt::format("{:.6g}{}{}", value, suffix(unit).empty() ? "" : " ", suffix(unit));
}

Curve converted(const Curve& curve, const UnitFactors& to, const std::string& description) {
  if (to.is_none()) return curve;
  if (to.shift == 0.0) return (curve * (to.factor / to.divisor)).described_as(description);
  return Curve::function(
      description, [curve, to](double x) { return to(curve(x)); }, curve.range(), curve.axis());
}

/// Returns the result of `make`; none after an error, which is recorded at the key.
template <class Make>
std::optional<Curve> try_at(const Section& section, std::string_view key, const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    section.error(key, error.what());
    return std::nullopt;
  }
}

std::string path_of(const Section& section, std::string_view key) {
  return section.path().empty() ? std::string(key) : fmt::format("{}.{}", section.path(), key);
}

/// Returns a ratio that has only a share of the loss of `ratio`.
Curve lost_in_part(const Curve& ratio, double share) {
  return Curve::function(
      fmt::format("1 - {} (1 - r), r {}", share, ratio.description()),
      [ratio, share](double x) { return 1.0 - share * (1.0 - ratio(x)); }, ratio.range(), ratio.axis());
}

}  // namespace

std::string describe_farther(std::string_view property, const Interval& range,
                             const CurveCatalogue& builtins) {
  std::vector<std::string> names;
  for (const NamedCurve* entry : builtins.of_property(property, range)) names.push_back(entry->name);
  if (names.empty())
    return property.empty()
               ? "give it there too"
               : fmt::format("no built-in curve of a {} reaches as far; give it there too by a table",
                             property);
  return fmt::format("{} {} as far", fmt::join(names, ", "), names.size() == 1 ? "reaches" : "reach");
}

CurveReader::CurveReader(std::filesystem::path folder, CurveAxis axis, Interval needed,
                         const CurveCatalogue& builtins)
    : folder_(std::move(folder)), axis_(std::move(axis)), needed_(needed), builtins_(builtins) {}

Curve CurveReader::read(const Section& section, std::string_view key, const Unit& unit, const Range& range,
                        Meaning meaning) {
  section.describe(key, {or_curve(unit), ValueForm::quantity, unit, range, std::nullopt, forms_name()},
                   meaning);
  return read_described(section, key, unit, range);
}

Curve CurveReader::read(const Section& section, std::string_view key, const Unit& unit, const Range& range,
                        double fallback, Meaning meaning) {
  section.describe(key, {or_curve(unit), ValueForm::quantity, unit, range, fallback, forms_name()}, meaning);
  return section.has(key) ? read_described(section, key, unit, range) : Curve::constant(fallback);
}

Curve CurveReader::read_described(const Section& section, std::string_view key, const Unit& unit,
                                  const Range& range) {
  std::optional<Curve> curve;
  if (!section.is_table(key)) {
    curve = Curve::constant(section.quantity(key, unit, range, ""));
  } else {
    const Section forms =
        *section.optional_section(key, "a key that depends on it may hold one of these forms");
    curve = varied(forms, read_forms(forms, unit, true));
    if (!curve || !forms.ok() || !covers(section, key, *curve) || !within(section, key, *curve, unit, range))
      curve = Curve::constant(range.any_value());
    else
      warn_if_unusual(section, key, *curve, unit, range);
  }
  const std::string path = path_of(section, key);
  curves_.push_back({path, unit.si, curve->named(path), property_of(section, key)});
  return curves_.back().curve;
}

/// Returns the curve over temperature times a factor, and moved along the temperature: studies vary both.
std::optional<Curve> CurveReader::varied(const Section& forms, std::optional<Curve> curve) const {
  if (axis_ != temperature_axis()) return curve;
  const double scale = forms.number("scale", Range::non_negative(), 1.0, "factor of the whole curve");
  const double shift = forms.quantity(
      "shift", unit::temperature_difference, Range::any(), 0.0,
      "by which the curve stands at higher temperatures; beyond its own range it keeps the value at the end");
  if (curve && shift != 0.0) curve = curve->shifted(shift);
  return curve && scale != 1.0 ? scale * *curve : curve;
}

/// Reads a curve in the one form that the deck gives; returns none after an error.
/// \param has_value  true where "value times curve" is among the forms
std::optional<Curve> CurveReader::read_forms(const Section& forms, const Unit& unit, bool has_value) const {
  std::vector<std::string> allowed = {"table", "csv", "builtin", "expression"};
  if (has_value) allowed.insert(allowed.begin(), "value");
  if (axis_ == time_axis() && unit == unit::temperature) allowed.emplace_back("from");
  std::vector<std::string> given;
  for (const std::string& form : allowed)
    if (forms.has(form)) given.push_back(form);
  if (given.empty()) {
    forms.error(fmt::format("a curve needs one of the keys {}", fmt::join(allowed, ", ")));
    return std::nullopt;
  }
  for (std::size_t i = 1; i < given.size(); ++i)
    forms.error(given[i], fmt::format("has no meaning beside \"{}\": a curve has one of {}", given[0],
                                      fmt::join(allowed, ", ")));
  return read_form(forms, given[0], unit);
}

std::optional<Curve> CurveReader::read_form(const Section& forms, const std::string& form,
                                            const Unit& unit) const {
  if (form == "value") return read_product(forms, unit);
  if (form == "table") return read_table(forms, unit);
  if (form == "csv") return read_csv(forms, unit);
  if (form == "builtin") return read_builtin(forms, "builtin", unit);
  if (form == "expression") return read_expression(forms, unit);
  return read_ramp(forms, unit);
}

std::optional<Curve> CurveReader::read_product(const Section& forms, const Unit& unit) const {
  forms.describe("value", {.value = kQuantity}, "value that the ratio `times` multiplies");
  forms.describe("times",
                 {.value = fmt::format("name of a built-in ratio, or {}", forms_name()),
                  .form = ValueForm::text,
                  .name = forms_name()},
                 "ratio; over the temperature it is 1 at 20 °C");
  const double value = forms.quantity("value", unit, Range::any(), "");
  const std::optional<Curve> ratio =
      forms.is_table("times") ? read_forms(*forms.optional_section("times"), unit::dimensionless, false)
                              : read_builtin(forms, "times", unit::dimensionless);
  double share = 1.0;
  if (axis_ == temperature_axis())
    share = forms.number("share", Range::between(0.0, 1.0), 1.0,
                         "share of the loss by the ratio `times` that counts: the value is multiplied by 1 - "
                         "share (1 - ratio)");
  if (!ratio || !forms.ok()) return std::nullopt;
  return try_at(forms, "times", [&] {
    if (axis_ == temperature_axis() && ratio->holds(kReferenceTemperature)) {
      const double at_reference = (*ratio)(kReferenceTemperature);
      if (!(std::abs(at_reference - 1.0) <= kRatioTolerance))
        throw Error(fmt::format("must be 1 at {} degC, where the value holds, but is {:.6g} there",
                                kReferenceTemperature, at_reference));
    }
    return value * (share == 1.0 ? *ratio : lost_in_part(*ratio, share));
  });
}

std::optional<Curve> CurveReader::read_table(const Section& forms, const Unit& unit) const {
  forms.describe("table", {.value = fmt::format("list of points, [[{}, value], ...]", abscissa().name)},
                 "two points or more, ascending; the curve is linear between them");
  const auto points = forms.points("table", abscissa(), unit, "");
  if (points.empty()) return std::nullopt;
  std::vector<double> abscissae, values;
  for (const auto& [x, y] : points) {
    abscissae.push_back(x);
    values.push_back(y);
  }
  return Curve::table(std::move(abscissae), std::move(values), axis_);
}

std::optional<Curve> CurveReader::read_csv(const Section& forms, const Unit& unit) const {
  const std::string file =
      forms.text("csv", "file beside the deck with a [measured table](measured-tables.md)");
  ColumnChoice choice = read_column_choice(forms, file, kCurveColumns, kCurveColumns);
  if (axis_ == time_axis()) choice.start = read_start(forms);
  if (file.empty() || !forms.ok()) return std::nullopt;
  forms.names_file("csv", folder_ / file);
  return try_at(forms, "csv", [&] {
    return curve_of_table(MeasuredTable::open(folder_ / file, kCurveColumns), choice, axis_, unit);
  });
}

/// Reads a curve of the catalogue by its name at the key.
std::optional<Curve> CurveReader::read_builtin(const Section& section, std::string_view key,
                                               const Unit& unit) const {
  const std::string name = section.text(key, "name of a built-in curve");
  if (name.empty()) return std::nullopt;
  return try_at(section, key, [&] {
    const NamedCurve& entry = builtins_.at(name);
    try {
      return converted(entry.curve, unit_factors(entry.unit, unit),
                       fmt::format("{} ({}) in {}", entry.name, entry.source, unit.si));
    } catch (const QuantityError&) {
      throw Error(entry.unit == "1"
                      ? fmt::format("\"{0}\" is a ratio; write {{ value = \"{1}\", times = \"{0}\" }}", name,
                                    unit.example)
                      : fmt::format("\"{}\" is in {}; a curve in {} ({}) is needed", name, entry.unit,
                                    unit.si, unit.name));
    }
  });
}

std::optional<Curve> CurveReader::read_expression(const Section& forms, const Unit& unit) const {
  const std::string formula = forms.text(
      "expression", axis_ == time_axis() ? Meaning("formula in t, in s") : Meaning("formula in T, in °C"));
  forms.describe("unit", {.value = "text", .form = ValueForm::text, .optional = true},
                 "unit of the formula's value; a ratio needs none");
  const std::string given =
      unit == unit::dimensionless ? forms.text("unit", unit.si, "") : forms.text("unit", "");
  const auto range = forms.quantities("range", abscissa(), Range::any(),
                                      "where the formula holds: the lower end, the upper end");
  if (!range.empty() && (range.size() != 2 || !(range[0] < range[1])))
    forms.error("range", "must be two values, the first below the second");
  if (!forms.ok()) return std::nullopt;
  return try_at(forms, "expression", [&]() -> std::optional<Curve> {
    const Curve curve = Curve::expression(formula, {range[0], range[1]}, axis_);
    return try_at(forms, "unit", [&] {
      return converted(curve, unit_factors(given, unit),
                       fmt::format("formula \"{}\" in {}", shown_in_short(formula), given));
    });
  });
}

std::optional<Curve> CurveReader::read_ramp(const Section& forms, const Unit& unit) const {
  const double from = forms.quantity("from", unit, Range::any(), "temperature at which a ramp begins");
  const double rate = forms.quantity("rate", unit::heating_rate, Range::positive(),
                                     "change of the temperature over the time");
  const double to =
      forms.quantity("to", unit, Range::any(), "temperature at which the ramp ends; constant from then on");
  if (!forms.ok()) return std::nullopt;
  const double duration = std::abs(to - from) / rate;
  if (!(0.0 < duration && duration < kRampEnd)) {
    forms.error(
        "to", fmt::format("must be another {} than \"from\", and reached within {} s", unit.name, kRampEnd));
    return std::nullopt;
  }
  return Curve::table({0.0, duration, kRampEnd}, {from, to, to}, axis_)
      .described_as(fmt::format("ramp from {} to {} at {:.6g} K/s, then constant", with_unit(from, unit),
                                with_unit(to, unit), rate));
}

/// Returns the property of the built-in curve that the key names; empty where it names none.
std::string CurveReader::property_of(const Section& section, std::string_view key) const {
  if (!section.is_table(key)) return {};
  const Section forms = section.section(key);
  for (const char* const form : {"builtin", "times"}) {
    if (!forms.ok() || !forms.has(form) || forms.is_table(form)) continue;
    if (const NamedCurve* const entry = builtins_.find(forms.text(form, ""))) return entry->property;
  }
  return {};
}

bool CurveReader::covers(const Section& section, std::string_view key, const Curve& curve) const {
  const Interval given = curve.range();
  if (curve.holds(needed_)) return true;
  const bool is_of_time = axis_ == time_axis();
  std::string cure;
  if (axis_ == temperature_axis())
    cure =
        fmt::format(": {}{}", describe_farther(property_of(section, key), needed_, builtins_), cure_(given));
  else if (is_of_time && given.lower > needed_.lower)
    cure =
        "; times count from the start of heating: where a record begins there, write start = \"first row\" "
        "beside csv";
  section.error(
      key, fmt::format("is given from {:.6g} to {:.6g} {}{}, but the run needs it from {:.6g} to {:.6g} {}; "
                       "curves are not extrapolated{}",
                       given.lower, given.upper, axis_.unit,
                       is_of_time ? fmt::format(" ({})", curve.description()) : "", needed_.lower,
                       needed_.upper, axis_.unit, cure));
  return false;
}

/// Tells whether the values are allowed wherever the run needs them, and records an error where they are not.
bool CurveReader::within(const Section& section, std::string_view key, const Curve& curve, const Unit& unit,
                         const Range& range) const {
  try {
    for (const double extreme :
         {curve.minimum(needed_.lower, needed_.upper), curve.maximum(needed_.lower, needed_.upper)}) {
      if (range.contains(range.but_for_rounding(extreme))) continue;
      section.error(key, fmt::format("comes to {} between {} and {} {}; must be {}", with_unit(extreme, unit),
                                     needed_.lower, needed_.upper, axis_.unit, range.describe(suffix(unit))));
      return false;
    }
  } catch (const Error& error) {
    section.error(key, error.what());
    return false;
  }
  return true;
}

/// Warns of a value beyond the usual ones: at 20 degC of a property, at all times of a course.
void CurveReader::warn_if_unusual(const Section& section, std::string_view key, const Curve& curve,
                                  const Unit& unit, const Range& range) const {
  if (axis_ == temperature_axis()) {
    if (curve.holds(kReferenceTemperature))
      section.warn_if_unusual(key, curve(kReferenceTemperature), unit, range);
    return;
  }
  const double least = curve.minimum(needed_.lower, needed_.upper);
  const double greatest = curve.maximum(needed_.lower, needed_.upper);
  section.warn_if_unusual(key, range.is_usual(least) ? greatest : least, unit, range);
}

std::string CurveReader::forms_name() const {
  return axis_ == time_axis() ? "curve over the time" : "curve over the temperature";
}

std::string CurveReader::or_curve(const Unit& unit) const {
  return fmt::format("{}, or {}", unit == unit::dimensionless ? "number" : unit.name, forms_name());
}

const Unit& CurveReader::abscissa() const {
  return axis_ == time_axis() ? unit::time : unit::temperature;
}

}  // namespace pyroclast
