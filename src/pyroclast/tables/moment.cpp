#include "pyroclast/tables/moment.hpp"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstddef>
#include <string>

#include "pyroclast/base/characters.hpp"

namespace pyroclast {
namespace {

constexpr std::string_view kMinusSign = "\xE2\x88\x92";  // U+2212
constexpr std::int64_t kSixty = 60;
constexpr std::size_t kFractionDigits = 9;
constexpr std::size_t kMostHourDigits = 6;

/// Reader of a text from its beginning.
class Cursor {
 public:
  explicit Cursor(std::string_view text) : rest_(text) {}

  bool is_at_end() const { return rest_.empty(); }
  char next() const { return rest_.empty() ? '\0' : rest_.front(); }

  /// Returns digits, so many of them; nothing is taken where there are fewer or more.
  std::optional<std::string_view> digits(std::size_t least, std::size_t most) {
    std::size_t count = 0;
    while (count < rest_.size() && is_digit(rest_[count])) ++count;
    if (count < least || count > most) return std::nullopt;
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  bool take(std::string_view text) {
    if (!rest_.starts_with(text)) return false;
    rest_.remove_prefix(text.size());
    return true;
  }
  bool take_any_case(std::string_view small) {
    for (std::size_t i = 0; i < small.size(); ++i)
      if (i >= rest_.size() || (rest_[i] | ' ') != small[i]) return false;
    rest_.remove_prefix(small.size());
    return true;
  }
  bool take_blanks() {
    const std::size_t before = rest_.size();
    while (take(" ") || take("\u00A0")) {
    }
    return rest_.size() != before;
  }

 private:
  std::string_view rest_;
};

int number_of(std::string_view digits) {
  int value = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return value;
}

/// Reads "2026-03-02", "02.03.2026", "3/2/26" or "20260302" before a T.
bool read_date(Cursor& text, Moment& moment) {
  constexpr std::size_t kYear = 4, kCompact = 8;
  Cursor ahead = text;
  if (const auto all = ahead.digits(kCompact, kCompact); all && ahead.next() == 'T') {
    moment.date = {number_of(all->substr(0, 4)), number_of(all->substr(4, 2)), number_of(all->substr(6))};
    moment.sign = 'T';
    moment.is_year_first = true;
    text = ahead;
    return true;
  }
  ahead = text;
  const auto first = ahead.digits(1, kYear);
  const char sign = ahead.next();
  const std::string_view between(&sign, 1);
  if (!first || first->size() == 3 || std::string_view("-/.").find(sign) == std::string_view::npos)
    return false;
  ahead.take(between);
  const auto second = ahead.digits(1, 2);
  if (!second || !ahead.take(between)) return false;
  const auto third = ahead.digits(1, first->size() == kYear ? 2 : kYear);
  if (!third || third->size() == 3) return false;
  moment.date = {number_of(*first), number_of(*second), number_of(*third)};
  moment.sign = sign;
  moment.is_year_first = first->size() == kYear;
  text = ahead;
  return true;
}

/// Reads two or three parts with colons between them, or four or six digits where the date has none either.
bool read_clock(Cursor& text, Moment& moment) {
  std::array<std::int64_t, 3> parts{};
  if (moment.sign == 'T') {
    const auto all = text.digits(4, 6);
    if (!all || all->size() == 5) return false;
    moment.parts = static_cast<int>(all->size() / 2);
    for (std::size_t i = 0; i < all->size() / 2; ++i) parts[i] = number_of(all->substr(2 * i, 2));
  } else {
    const auto hours = text.digits(1, moment.has_date() ? 2 : kMostHourDigits);
    if (!hours) return false;
    parts[0] = number_of(*hours);
    for (moment.parts = 1; moment.parts < 3 && text.take(":"); ++moment.parts) {
      const auto part = text.digits(2, 2);
      if (!part) return false;
      parts[static_cast<std::size_t>(moment.parts)] = number_of(*part);
    }
    if (moment.parts < 2) return false;
  }
  if (parts[1] >= kSixty || parts[2] >= kSixty) return false;
  const bool is_midnight = parts[0] == 24 && parts[1] == 0 && parts[2] == 0;
  if (moment.has_date() && parts[0] > 23 && !is_midnight) return false;
  moment.count = kSixty * parts[0] + parts[1];
  if (moment.parts == 3) moment.count = kSixty * moment.count + parts[2];
  if (text.take(".") || text.take(",")) {
    const auto behind = text.digits(1, 40);
    if (!behind) return false;
    std::string digits(behind->substr(0, kFractionDigits));
    digits.resize(kFractionDigits, '0');
    moment.fraction = number_of(digits);
  }
  return true;
}

/// Reads AM or PM, where it stands. Returns false for an hour that does not go with it.
bool read_half_of_day(Cursor& text, Moment& moment) {
  Cursor ahead = text;
  ahead.take_blanks();
  const bool is_am = ahead.take_any_case("am") || ahead.take_any_case("a.m.");
  const bool is_pm = !is_am && (ahead.take_any_case("pm") || ahead.take_any_case("p.m."));
  if (!is_am && !is_pm) return true;
  text = ahead;
  const std::int64_t hour = moment.parts == 3 ? kSixty * kSixty : kSixty;
  const std::int64_t hours = moment.count / hour;
  if (hours < 1 || hours > 12) return false;
  if (hours == 12) moment.count -= 12 * hour;
  if (is_pm) moment.count += 12 * hour;
  moment.is_of_day = true;
  return true;
}

/// Reads Z, UTC or a difference such as +01:00, where it stands.
bool read_offset(Cursor& text, Moment& moment) {
  Cursor ahead = text;
  ahead.take_blanks();
  if (ahead.take_any_case("z") || ahead.take_any_case("utc") || ahead.take_any_case("gmt")) {
    moment.has_offset = moment.is_of_day = true;
    text = ahead;
    return true;
  }
  const bool is_east = ahead.take("+");
  if (!is_east && !ahead.take("-") && !ahead.take(kMinusSign)) return true;
  Cursor compact = ahead;
  int hours = 0, minutes = 0;
  if (const auto four = compact.digits(4, 4)) {
    hours = number_of(four->substr(0, 2));
    minutes = number_of(four->substr(2));
    ahead = compact;
  } else {
    const auto two = ahead.digits(2, 2);
    if (!two) return false;
    hours = number_of(*two);
    if (ahead.take(":")) {
      const auto behind = ahead.digits(2, 2);
      if (!behind) return false;
      minutes = number_of(*behind);
    }
  }
  if (hours > 23 || minutes > 59) return false;
  moment.has_offset = moment.is_of_day = true;
  moment.offset = static_cast<int>((is_east ? 1 : -1) * (hours * kSixty + minutes) * kSixty);
  text = ahead;
  return true;
}

std::optional<ClockForm> clock_of_letters(std::string_view text) {
  constexpr std::array<std::string_view, 4> kHours{"h", "hh", "H", "HH"};
  constexpr std::array<std::string_view, 5> kMinutes{"m", "mm", "M", "MM", "min"};
  constexpr std::array<std::string_view, 5> kSeconds{"s", "ss", "S", "SS", "sec"};
  text = text.substr(0, text.find_first_of(".,"));  // "ss.fff"
  std::string letters;
  for (bool goes_on = true; goes_on;) {
    const std::size_t end = text.find(':');
    const std::string_view part = text.substr(0, end);
    const auto is_of = [&](const auto& words) { return std::ranges::find(words, part) != words.end(); };
    letters += is_of(kHours) ? 'h' : is_of(kMinutes) ? 'm' : is_of(kSeconds) ? 's' : '?';
    goes_on = end != text.npos;
    if (goes_on) text.remove_prefix(end + 1);
  }
  if (letters == "hms") return ClockForm::unknown;
  if (letters == "ms") return ClockForm::minutes_seconds;
  return letters == "hm" ? std::optional(ClockForm::hours_minutes) : std::nullopt;
}

std::optional<DateOrder> order_of_letters(std::string_view text) {
  if (text.find_first_of("-/.") == text.npos) return std::nullopt;
  std::string letters;
  char before = '\0';
  for (const char c : text) {
    const char small = lower_case(c);
    const char part = small == 'j' ? 'y' : small == 't' ? 'd' : small;  // Jahr, Tag
    if (part != before && std::string_view("-/.").find(part) == std::string_view::npos) letters += part;
    before = part;
  }
  if (letters == "ymd") return DateOrder::year_month_day;
  if (letters == "dmy") return DateOrder::day_month_year;
  return letters == "mdy" ? std::optional(DateOrder::month_day_year) : std::nullopt;
}

}  // namespace

std::optional<TimeForm> time_form(std::string_view unit) {
  if (const auto clock = clock_of_letters(unit)) return TimeForm{*clock, {}};
  if (unit.starts_with("ISO 8601") || unit.starts_with("ISO8601"))
    return TimeForm{ClockForm::hours_minutes, DateOrder::year_month_day};
  constexpr std::size_t kShortest = 8;  // "dd.mm.yy"
  const std::size_t end = std::min(unit.find_first_of(" T,", 1), unit.size());
  const auto date = end < kShortest ? std::nullopt : order_of_letters(unit.substr(0, end));
  if (!date) return std::nullopt;
  unit.remove_prefix(end);
  while (!unit.empty() && std::string_view(" T,").find(unit.front()) != std::string_view::npos)
    unit.remove_prefix(1);
  if (unit.empty()) return TimeForm{ClockForm::hours_minutes, date};
  unit = unit.substr(0, unit.find_first_of(" Zz+"));
  if (!clock_of_letters(unit)) return std::nullopt;
  return TimeForm{ClockForm::hours_minutes, date};
}

bool Moment::is_like(const Moment& other) const {
  return sign == other.sign && is_year_first == other.is_year_first && has_offset == other.has_offset &&
         is_of_day == other.is_of_day;
}

std::int64_t Moment::nanoseconds(ClockForm form) const {
  const bool is_of_minutes = parts == 2 && (has_date() || is_of_day || form == ClockForm::hours_minutes);
  return (is_of_minutes ? kSixty : 1) * count * kSecondInNs + fraction - offset * kSecondInNs;
}

std::optional<std::int64_t> Moment::day(DateOrder order) const {
  using namespace std::chrono;
  constexpr int kCentury = 2000, kTwoDigits = 100;
  const auto [a, b, c] = date;
  int y = a, m = b, d = c;
  if (order == DateOrder::day_month_year) y = c, m = b, d = a;
  if (order == DateOrder::month_day_year) y = c, m = a, d = b;
  if (y < kTwoDigits) y += kCentury;
  const year_month_day of{year(y), month(static_cast<unsigned>(m)),
                          std::chrono::day(static_cast<unsigned>(d))};
  if (!of.ok()) return std::nullopt;
  return sys_days(of).time_since_epoch().count();
}

std::optional<Moment> moment_of(std::string_view cell) {
  Cursor text(cell);
  Moment moment;
  if (read_date(text, moment)) {
    const bool has_comma = moment.sign != 'T' && text.take(",");
    if (!text.take_any_case("t") && !text.take_blanks() && !has_comma) return std::nullopt;
    text.take_blanks();
  }
  if (!read_clock(text, moment) || !read_half_of_day(text, moment) || !read_offset(text, moment) ||
      !text.is_at_end())
    return std::nullopt;
  return moment;
}

bool begins_with_date(std::string_view cell) {
  Cursor text(cell);
  Moment moment;
  return read_date(text, moment);
}

}  // namespace pyroclast
