#pragma once

#include "pyroclast/specimen/grading_curve.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {

/// Columns of a sieve analysis: the size, and the share that passes or is retained in all.
inline constexpr std::size_t kSieveColumns = 2;

/// Returns a curve by ascending size that ends with the first sieve which lets all pass. Throws Error unless
/// its sizes ascend or descend, and its shares go with them up to 100 %.
specimen::GradingCurve checked_curve(specimen::GradingCurve curve);

/// Reads a sieve analysis. Shares that a name calls cumulative and retained are taken from 100 %. Without a
/// choice a table may have further columns where names tell the two that are needed. Throws Error, naming the
/// file.
specimen::GradingCurve sieve_curve(const MeasuredTable& table, ColumnChoice choice);

}  // namespace pyroclast
