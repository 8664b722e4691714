#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/tables/measured_table.hpp"

/// One record in the ways that loggers, spreadsheets and programs write it.
namespace pyroclast::layouts {

/// Temperatures of a furnace, °C, over the time, s.
using Record = std::vector<std::pair<double, double>>;

enum class Units { brackets, parentheses, slash, row_below, row_above, suffix };
enum class Time { seconds, minutes, clock, minutes_seconds };
enum class Names { plain, quoted, none };

struct Layout {
  std::string_view delimiter;
  char decimal = '.';
  Units units = Units::brackets;
  Time time = Time::seconds;
  Names names = Names::plain;
  std::string_view begin = "";  ///< byte order mark, line "sep=", comments
  std::string_view line_end = "\n";
  bool has_index = false, has_end_delimiter = false, has_plus = false, has_gaps = false, quotes_cells = false;
};

inline constexpr std::string_view kMark = "\xEF\xBB\xBF";

inline const std::array<Layout, 30>& all() {
  using enum Units;
  using enum Time;
  using enum Names;
  static const std::array<Layout, 30> layouts{{
      {","},
      {", ", '.', parentheses, minutes},
      {";", ',', brackets, clock},
      {";", ',', slash, seconds, plain, kMark},
      {"\t", ',', brackets, minutes, quoted},
      {"\t", '.', row_below, clock, plain, "", "\r\n"},
      {"  ", '.', brackets, seconds},
      {" ", ',', slash, minutes},
      {" ", '.', parentheses, clock, plain, "# furnace\n"},
      {",", '.', brackets, minutes, plain, "", "\n", true},
      {";", '.', parentheses, seconds, plain, "", "\r\n", true},
      {"\t", ',', brackets, seconds, plain, "", "\r", true},
      {",", '.', brackets, seconds, plain, "", "\n", false, true},
      {";", ',', brackets, minutes, plain, "", "\r\n", false, true},
      {",", '.', brackets, seconds, plain, "", "\n", false, false, true},
      {";", ',', parentheses, minutes, plain, "sep=;\n", "\n", false, false, true},
      {",", '.', brackets, clock, plain, "sep=,\r\n", "\r\n"},
      {",", ',', brackets, seconds, quoted, "", "\n", false, false, false, false, true},
      {",", '.', brackets, minutes, quoted, "", "\n", true, false, false, false, true},
      {",", '.', row_above, seconds},
      {";", ',', row_below, minutes, plain, kMark, "\r\n"},
      {";", '.', row_above, clock, quoted},
      {",", '.', suffix, seconds, plain, kMark},
      {";", ',', suffix, minutes, plain, "% furnace\n// 1\n! 2\n"},
      {"\t", '.', slash, minutes_seconds},
      {",", '.', brackets, minutes_seconds, quoted, kMark, "\r\n", true, true},
      {",", '.', brackets, seconds, none},
      {";", ',', brackets, minutes, none, kMark, "\r\n"},
      {" ", ',', brackets, seconds, none, "", "\r"},
      {"; ", ',', brackets, clock, plain, "", "\r\n", true, true, true, true, true},
  }};
  return layouts;
}

/// The unit of the times and that of the temperatures.
inline std::pair<std::string, std::string> units_of(const Layout& layout) {
  static constexpr std::array kTimes{"s", "min", "hh:mm:ss", "mm:ss"};
  return {kTimes[static_cast<std::size_t>(layout.time)], "degC"};
}

/// A number is never of the form 1,234, which a comma between thousands has too.
inline std::string number(double value, const Layout& layout) {
  constexpr std::size_t kThousands = 3;
  std::string text = fmt::format("{}", value);
  const auto point = text.find('.');
  if (point != text.npos && text.size() == point + 1 + kThousands) text += '0';
  if (point != text.npos) text[point] = layout.decimal;
  if (layout.has_plus && value >= 0.0) text.insert(0, 1, '+');
  return text;
}

/// \param seconds  whole where the layout writes times of a clock, and of half minutes where it writes
/// minutes
inline std::string time(double seconds, const Layout& layout) {
  constexpr long long kSixty = 60;
  if (layout.time == Time::seconds) return number(seconds, layout);
  if (layout.time == Time::minutes) return number(seconds / kSixty, layout);
  const auto whole = static_cast<long long>(seconds);
  const long long s = whole % kSixty, minutes = whole / kSixty;
  return layout.time == Time::clock ? fmt::format("{:02}:{:02}:{:02}", minutes / kSixty, minutes % kSixty, s)
                                    : fmt::format("{:02}:{:02}", minutes, s);
}

/// Of a record, s: its minutes have few digits enough for a time.
inline constexpr double kLongest = 5e7;

/// Whether a layout can write a record to the bit. A clock that shows an hour or more in the first row is
/// that of the day, and one that falls may have passed midnight.
inline bool can_write(const Layout& layout, const Record& record) {
  constexpr double kHour = 3600.0;
  if (layout.time == Time::clock && !record.empty() &&
      (record.front().first >= kHour ||
       !std::ranges::is_sorted(record, {}, [](const auto& row) { return row.first; })))
    return false;
  for (const auto& [t, T] : record) {
    if (layout.time == Time::seconds) continue;
    if (!(t >= 0.0 && t < kLongest)) return false;
    if (layout.time == Time::minutes ? std::fmod(t, 30.0) != 0.0 : t != std::floor(t)) return false;
  }
  return true;
}

inline std::string written(const Layout& layout, const Record& record) {
  std::string text(layout.begin);
  const auto add_row = [&](std::vector<std::string> cells, bool is_quoted) {
    std::string row;
    for (std::string& cell : cells) {
      if (is_quoted) cell = '"' + cell + '"';
      row += row.empty() && &cell == cells.data() ? cell : std::string(layout.delimiter) + cell;
    }
    if (layout.has_end_delimiter) row += layout.delimiter;
    text += row + std::string(layout.line_end);
    if (layout.has_gaps) text += std::string(layout.line_end);
  };
  const auto with_index = [&](std::string index, std::vector<std::string> cells) {
    if (layout.has_index) cells.insert(cells.begin(), std::move(index));
    return cells;
  };
  const auto [time_unit, temperature_unit] = units_of(layout);
  const auto name = [&](const std::string& word, const std::string& unit) {
    switch (layout.units) {
      case Units::brackets:
        return fmt::format("{} [{}]", word, unit);
      case Units::parentheses:
        return fmt::format("{} ({})", word, unit);
      case Units::slash:
        return fmt::format("{} / {}", word, unit);
      case Units::suffix:
        return fmt::format("{}_{}", word, unit);
      case Units::row_below:
      case Units::row_above:
        break;
    }
    return word;
  };
  if (layout.names != Names::none) {
    const bool is_quoted = layout.names == Names::quoted;
    const auto units = with_index("", {time_unit, temperature_unit});
    if (layout.units == Units::row_above) add_row(units, is_quoted);
    add_row(with_index("", {name("time", time_unit), name("gas", temperature_unit)}), is_quoted);
    if (layout.units == Units::row_below) add_row(units, is_quoted);
  }
  for (std::size_t i = 0; i < record.size(); ++i)
    add_row(
        with_index(fmt::format("{}", i), {time(record[i].first, layout), number(record[i].second, layout)}),
        layout.quotes_cells);
  return text;
}

/// What a layout cannot say itself.
inline ColumnChoice choice_of(const Layout& layout) {
  if (layout.names != Names::none) return {};
  return {"furnace.csv", {}, {units_of(layout).first, units_of(layout).second}};
}

inline Record read(std::string_view text, const ColumnChoice& choice = {}) {
  const auto table = MeasuredTable::parse(text, "furnace.csv", 2);
  const std::array<AskedColumn, 2> asked{{{"time", unit::time, {{&meaning::time}}},
                                          {"temperature", unit::temperature, {{&meaning::temperature}}}}};
  const auto columns = table.choose(choice, asked);
  const auto times = table.values(columns[0], unit::time);
  const auto temperatures = table.values(columns[1], unit::temperature);
  require_ascending(table, columns[0], times, "time", unit::time);
  Record record;
  for (std::size_t i = 0; i < times.size(); ++i) record.emplace_back(times[i], temperatures[i]);
  return record;
}

}  // namespace pyroclast::layouts
