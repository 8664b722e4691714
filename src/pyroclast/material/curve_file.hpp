#pragma once

#include "pyroclast/base/unit.hpp"
#include "pyroclast/material/curve.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Columns of a curve in a file: the abscissa and the value.
inline constexpr std::size_t kCurveColumns = 2;

/// Makes a curve from two columns of a table, in the units of the axis and of the value. Throws Error naming
/// file and line when a unit does not convert, or the points do not make a curve.
Curve curve_of_table(const MeasuredTable& table, const ColumnChoice& choice, const CurveAxis& axis,
                     const Unit& value);

}  // namespace pyroclast
