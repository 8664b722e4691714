#pragma once

#include <filesystem>
#include <functional>
#include <istream>
#include <string>

#include "pyroclast/material/curve.hpp"

namespace pyroclast {

/// Turns a number in the given unit into the unit that the curve is to have. Throws Error for a unit that
/// does not fit.
using UnitConversion = std::function<double(double value, const std::string& unit)>;

/// Table from a CSV file of two columns with a header of the form "temperature [degC], conductivity [W/(m
/// K)]". The first column is the abscissa. Lines that are blank or begin with # are skipped. Throws Error
/// naming file and line when the file cannot be read, a line is not two numbers, a unit does not convert, or
/// the points do not make a table.
Curve read_curve_csv(const std::filesystem::path& path, const CurveAxis& axis,
                     const UnitConversion& convert_abscissa, const UnitConversion& convert_value);
/// The same from a stream; `path` names it in messages.
Curve read_curve_csv(std::istream& file, const std::filesystem::path& path, const CurveAxis& axis,
                     const UnitConversion& convert_abscissa, const UnitConversion& convert_value);

}  // namespace pyroclast
