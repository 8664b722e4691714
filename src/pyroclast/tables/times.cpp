#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/tables/measured_table.hpp"
#include "pyroclast/tables/moment.hpp"
#include "pyroclast/units/units.hpp"

// Times of a record that a clock tells, with dates or without.

namespace pyroclast {
namespace {

constexpr std::int64_t kHourInNs = 3600 * kSecondInNs, kDayInNs = 24 * kHourInNs;  // ns
constexpr std::int64_t kMostDays = 36525;  ///< days that a record may last

std::string_view letters_of(DateOrder order) {
  if (order == DateOrder::year_month_day) return "yyyy-mm-dd hh:mm:ss";
  return order == DateOrder::day_month_year ? "dd/mm/yyyy hh:mm:ss" : "mm/dd/yyyy hh:mm:ss";
}

/// Adds a day from each row on at which a clock passes midnight: with the day added the times go on within
/// two of their longest steps, or within an hour. Other falls stay.
void pass_midnights(std::vector<std::int64_t>& times) {
  std::int64_t longest = kHourInNs / 2, added = 0;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const std::int64_t step = times[i] + added - times[i - 1];
    if (step < 0 && step + kDayInNs <= 2 * longest) added += kDayInNs;
    times[i] += added;
    longest = std::max(longest, times[i] - times[i - 1]);
  }
}

/// Returns the time of a clock on the day on which it lies in a record or, if on none, next to it. Without a
/// midnight in the record it may lie long before: times that count from a start have the start 0:00:00.
std::int64_t on_its_day(std::int64_t time, std::int64_t first, std::int64_t last) {
  const bool passes_midnight = last >= kDayInNs;
  if (time < first && passes_midnight && time + kDayInNs - last < first - time) return time + kDayInNs;
  return time > last && first + kDayInNs - time < time - last ? time - kDayInNs : time;
}

}  // namespace

bool MeasuredTable::tells_time(std::size_t column) const {
  return std::ranges::any_of(grid_.rows,
                             [&](const TableRow& row) { return moment_of(row.cells[column]).has_value(); });
}

bool MeasuredTable::tells_date(std::size_t column) const {
  return kind_of_cell(grid_.rows[0].cells[column]) == CellKind::stamp;
}

/// Finds the form of the times in a column: where one of them has three parts, times of two parts are minutes
/// and seconds.
ClockForm MeasuredTable::clock_form_of(const ChosenColumn& column, const std::vector<Moment>& moments) const {
  constexpr int kHoursMinutesSeconds = 3;
  const ClockForm form = time_form(column.unit).value_or(TimeForm{}).clock;
  if (form != ClockForm::unknown || moments[0].has_date() || moments[0].is_of_day) return form;
  if (std::ranges::any_of(moments, [](const Moment& one) { return one.parts == kHoursMinutesSeconds; }))
    return ClockForm::minutes_seconds;
  const std::string& cell = grid_.rows[0].cells[column.index];
  refuse(path_, line(0),
         fmt::format("{} may be minutes and seconds or hours and minutes; write \"time [mm:ss]\" or \"time "
                     "[hh:mm]\" above the column, or 00:{} or {}:00",
                     cell_place(0, column.index), cell, cell));
}

/// Returns the days on which moments lie, counted from the first. The order of day and month matters only
/// where the dates differ.
std::vector<std::int64_t> MeasuredTable::days_of(const ChosenColumn& column,
                                                 const std::vector<Moment>& moments) const {
  const Moment& first = moments[0];
  const auto differs =
      std::ranges::find_if(moments, [&](const Moment& one) { return one.date != first.date; });
  std::vector<DateOrder> orders;
  if (const auto stated = time_form(column.unit).value_or(TimeForm{}).date; stated && !first.is_year_first)
    orders = {*stated};
  else if (first.is_year_first)
    orders = {DateOrder::year_month_day};
  else if (first.sign == '.')
    orders = {DateOrder::day_month_year};  // nobody sets points behind a month that comes first
  else
    orders = {DateOrder::day_month_year, DateOrder::month_day_year, DateOrder::year_month_day};
  std::vector<std::vector<std::int64_t>> readings;
  std::vector<DateOrder> allowed;
  for (const DateOrder order : orders) {
    std::vector<std::int64_t> days;
    for (const Moment& one : moments)
      if (const auto day = one.day(order)) days.push_back(*day);
    if (days.size() != moments.size()) continue;
    for (std::size_t i = days.size(); i-- > 0;) days[i] -= days[0];
    if (std::ranges::find(readings, days) != readings.end()) continue;
    readings.push_back(std::move(days));
    allowed.push_back(order);
  }
  if (readings.empty()) {
    std::size_t row = 0;
    while (row + 1 < rows() && moments[row].day(orders[0])) ++row;
    refuse(path_, line(row), fmt::format("{} is no day of the calendar", cell_place(row, column.index)));
  }
  if (readings.size() > 1) {
    const auto row = std::min(static_cast<std::size_t>(differs - moments.begin()), rows() - 1);
    refuse(
        path_, line(row),
        fmt::format(
            "{} is a date, of which the order of day and month is not certain: it is {} or {} days "
            "after {}; state the order by the column's unit, \"{}\" or \"{}\", above it or in `units`",
            cell_place(row, column.index), readings[0][row], readings[1][row],
            as_written(grid_.rows[0].cells[column.index]), letters_of(allowed[0]), letters_of(allowed[1])));
  }
  if (std::ranges::any_of(readings[0], [](std::int64_t day) { return day > kMostDays || day < -kMostDays; }))
    refuse(path_, line(0), fmt::format("{} holds dates that are a century apart", column_name(column.index)));
  return readings[0];
}

std::vector<Moment> MeasuredTable::moments_of(const ChosenColumn& column) const {
  std::vector<Moment> moments;
  for (std::size_t row = 0; row < std::min(rows(), column.rows); ++row) {
    const std::string& cell = grid_.rows[row].cells[column.index];
    if (cell.empty())
      refuse(path_, line(row),
             fmt::format("{} is empty; delete the line or write a time", column_name(column.index)));
    const auto moment = moment_of(cell);
    if (!moment && kind_of_cell(cell) == CellKind::date)
      refuse(path_, line(row),
             fmt::format("{} is a date, and no time of the day can be read behind it; write it as "
                         "2026-03-02T10:14:05, or write times since the start in s, min, h or hh:mm:ss",
                         cell_place(row, column.index)));
    if (!moment) refuse(path_, line(row), fmt::format("{} is no time", cell_place(row, column.index)));
    if (!moments.empty() && !moment->is_like(moments[0]))
      refuse(
          path_, line(row),
          fmt::format("{} is written otherwise than {} in line {}; write all times of a column in one way",
                      cell_place(row, column.index), as_written(grid_.rows[0].cells[column.index]), line(0)));
    moments.push_back(*moment);
  }
  return moments;
}

/// Reads the start that a deck states, as one more moment of the column.
Moment MeasuredTable::stated_start(const ChosenColumn& column, const std::vector<Moment>& moments) const {
  const auto start = moment_of(column.start);
  const Moment& first = moments[0];
  const bool is_alike = start && start->sign == first.sign && start->is_year_first == first.is_year_first &&
                        start->has_offset == first.has_offset;
  const auto has_its_parts = [&](const Moment& one) { return one.has_date() || one.parts == start->parts; };
  if (!is_alike || std::ranges::none_of(moments, has_its_parts))
    refuse(path_, line(0),
           fmt::format("start = {} is not written as the times of {}; write it like {}, or \"{}\"",
                       as_written(column.start), column_name(column.index),
                       as_written(grid_.rows[0].cells[column.index]), kFirstRow));
  return *start;
}

MeasuredTable::Times MeasuredTable::times(const ChosenColumn& column) const {
  std::vector<Moment> moments = moments_of(column);
  const std::size_t count = moments.size();
  const bool is_stated = !column.start.empty() && column.start != kFirstRow;
  if (is_stated) moments.push_back(stated_start(column, moments));
  const ClockForm form = clock_form_of(column, moments);
  std::vector<std::int64_t> at;
  for (const Moment& one : moments) at.push_back(one.nanoseconds(form));
  std::optional<std::int64_t> start;
  if (is_stated) {
    start = at.back();
    at.pop_back();
  }
  const std::string& first = grid_.rows[0].cells[column.index];
  bool is_of_day = column.start == kFirstRow;
  if (moments[0].has_date()) {
    const auto days = days_of(column, moments);
    for (std::size_t i = 0; i < count; ++i) at[i] += days[i] * kDayInNs;
    if (start) *start += days[count] * kDayInNs;
    is_of_day = true;
  } else if (form != ClockForm::minutes_seconds || moments[0].parts == 3 || moments[0].is_of_day) {
    const bool is_of_clock = std::ranges::all_of(at, [](std::int64_t time) { return time < kDayInNs; });
    if (is_of_clock) pass_midnights(at);
    // A clock that began within an hour before is rather that of the record.
    is_of_day = is_of_day || moments[0].is_of_day ||
                (is_of_clock && (at.front() >= kHourInNs || at.back() >= kDayInNs));
    if (start) start = on_its_day(*start, at.front(), at.back());
  }
  if (start && *start > at.back())
    refuse(path_, line(count - 1),
           fmt::format("start = {} comes after the last time, {}", as_written(column.start),
                       cell_place(count - 1, column.index)));
  Times result;
  if (!start && is_of_day) start = at.front();
  result.start = is_stated ? column.start : is_of_day ? first : "";
  for (const std::int64_t time : at)
    result.values.push_back(static_cast<double>(time - start.value_or(0)) / kSecondInNs);
  return result;
}

std::string MeasuredTable::start_of(const ChosenColumn& column) const {
  if (tells_time(column.index)) return times(column).start;
  return column.start == kFirstRow ? fmt::format("{} {}", grid_.rows[0].cells[column.index], column.unit)
                                   : column.start;
}

}  // namespace pyroclast
