#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace pyroclast {

/// Nanoseconds of a second.
inline constexpr std::int64_t kSecondInNs = 1'000'000'000;

/// Meaning of the two parts of a time such as 01:30; three parts are hours, minutes and seconds.
enum class ClockForm { unknown, minutes_seconds, hours_minutes };
enum class DateOrder { year_month_day, day_month_year, month_day_year };

/// Form of times that a unit such as "hh:mm:ss", "mm:ss" or "dd.mm.yyyy hh:mm" states.
struct TimeForm {
  ClockForm clock = ClockForm::unknown;
  std::optional<DateOrder> date;
};
/// Returns the form that a unit states; empty where it is no form of a time.
std::optional<TimeForm> time_form(std::string_view unit);

/// Time as a cell tells it: "10:14:05", "02.03.2026 10:14", "2026-03-02T10:14:05.25+01:00".
struct Moment {
  std::array<int, 3> date{};   ///< parts of the date in the order in which they stand
  char sign = '\0';            ///< sign between the parts of the date; 0 without a date
  bool is_year_first = false;  ///< true where four digits come first, or nothing stands between the parts
  int parts = 0;               ///< parts of the clock time, two or three
  bool is_of_day = false;      ///< true where the clock time cannot be a time since a start: AM, PM, Z
  bool has_offset = false;     ///< true where the difference from UTC is told
  int offset = 0;              ///< difference from UTC, s
  std::int64_t count = 0;      ///< clock time in whole units of its last part
  std::int64_t fraction = 0;   ///< rest of it, ns

  bool has_date() const { return sign != '\0'; }
  /// Tells whether another cell is written in the same way, so that both can be of one column.
  bool is_like(const Moment& other) const;
  /// Returns the time since 0 o'clock, ns.
  std::int64_t nanoseconds(ClockForm form) const;
  /// Returns the number of the day; empty where the calendar has no such day.
  std::optional<std::int64_t> day(DateOrder order) const;
};

/// Reads the time that a cell tells; empty where it tells none.
std::optional<Moment> moment_of(std::string_view cell);

/// Tells whether a cell begins with a date, in any order of day, month and year.
bool begins_with_date(std::string_view cell);

}  // namespace pyroclast
