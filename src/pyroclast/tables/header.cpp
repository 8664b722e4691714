#include "pyroclast/tables/header.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "pyroclast/base/characters.hpp"
#include "pyroclast/tables/moment.hpp"
#include "pyroclast/tables/table_lines.hpp"
#include "pyroclast/units/spellings.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

bool says_unit(std::string_view text) {
  return time_form(text) || is_unit(text);
}

bool is_no_unit(std::string_view text) {
  constexpr std::array<std::string_view, 6> kNone{"", "-", "--", "–", "—", "−"};
  return std::ranges::find(kNone, text) != kNone.end();
}

/// Returns a unit, "1" for signs that are written for no unit.
std::string unit_or_none(std::string_view text) {
  return is_no_unit(text) ? "1" : std::string(text);
}

/// Tells whether a text is a capital letter with digits, as specimens are labelled: K2 is no square of a
/// kelvin.
bool is_label(std::string_view text) {
  return text.size() > 1 && text[0] >= 'A' && text[0] <= 'Z' &&
         text.find_first_not_of("0123456789", 1) == text.npos;
}

/// Text in brackets of a cell.
struct Bracket {
  std::size_t begin, end;  ///< places of the opening bracket and behind the closing one
  bool is_square;
  std::string_view text;
};

/// Returns a text without blanks around it and "in" before it, as in "(in mm)".
std::string_view without_in(std::string_view text) {
  text = without_blanks(text);
  return text.starts_with("in ") ? without_blanks(text.substr(3)) : text;
}

/// Returns the brackets of a cell that stand in no others, the last first. A bracket ends where one of its
/// own kind closes it: the unit of "u_n [m(]" is no unit.
std::vector<Bracket> brackets_of(std::string_view cell) {
  std::vector<Bracket> all;
  std::size_t begin = 0;
  int depth = 0;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (depth == 0 && (cell[i] == '[' || cell[i] == '(')) {
      begin = i;
      depth = 1;
    } else if (depth > 0 && cell[i] == cell[begin]) {
      ++depth;
    } else if (depth > 0 && cell[i] == (cell[begin] == '[' ? ']' : ')') && --depth == 0) {
      all.push_back({begin, i + 1, cell[begin] == '[', without_in(cell.substr(begin + 1, i - begin - 1))});
    }
  }
  std::ranges::reverse(all);
  return all;
}

/// Tells whether a bracket holds the unit of its cell. Within the cell it stands between blanks: the bracket
/// of "f_c(T)/f_c(20)" holds no tesla.
bool holds_unit(std::string_view cell, const Bracket& bracket) {
  const bool is_last = bracket.end == cell.size();
  const bool is_apart = bracket.begin == 0 || cell[bracket.begin - 1] == ' ';
  const bool ends_word =
      is_last || std::string_view(" ,;([").find(cell[bracket.end]) != std::string_view::npos;
  if (is_last && bracket.is_square) return true;
  if (!bracket.is_square && is_label(bracket.text)) return false;
  return (is_no_unit(bracket.text) || says_unit(bracket.text)) && (is_last || (is_apart && ends_word));
}

/// Reads a unit in brackets. A cell that ends with square brackets has its unit there, whatever it is.
std::optional<ColumnHeader> with_bracket(std::string_view cell) {
  const std::vector<Bracket> brackets = brackets_of(cell);
  const auto unit = std::ranges::find_if(brackets, [&](const Bracket& one) { return holds_unit(cell, one); });
  if (unit == brackets.end()) {
    const auto odd = std::ranges::find_if(
        brackets, [](const Bracket& one) { return !one.is_square && !is_remark(one.text); });
    return odd == brackets.end()
               ? std::nullopt
               : std::optional(ColumnHeader{std::string(cell), {}, {}, std::string(odd->text), {}});
  }
  std::string name(without_blanks(cell.substr(0, unit->begin)));
  if (const auto behind = without_blanks(cell.substr(unit->end)); !behind.empty()) {
    if (!name.empty()) name += ' ';
    name += behind;
  }
  return ColumnHeader{std::move(name), unit_or_none(unit->text), {}, {}, {}};
}

/// Reads "T / degC", and "T/degC" where the name is one word: "gas velocity m/s" is no such cell.
std::optional<ColumnHeader> with_slash(std::string_view cell) {
  const std::size_t apart = cell.find(" / ");
  const std::size_t slash = apart == cell.npos ? cell.find('/') : apart + 1;
  if (slash == cell.npos || slash == 0) return std::nullopt;
  const std::string_view name = without_blanks(cell.substr(0, slash));
  const std::string_view unit = without_blanks(cell.substr(slash + 1));
  if (apart == cell.npos && name.find(' ') != name.npos) return std::nullopt;
  if (name.empty() || !says_unit(unit)) return std::nullopt;
  return ColumnHeader{std::string(name), std::string(unit), {}, {}, {}};
}

/// Returns the unit that a name seems to end with: behind an underscore, a comma or "in", and behind a blank
/// where it has a sign that names have not, as in "strain ‰", or means a share, as in "strain permille". A
/// share may also begin a name, as in "% passing", or be all of it.
std::string likely_unit(std::string_view cell) {
  if (const auto bracket = brackets_of(cell);
      !bracket.empty() && bracket[0].end == cell.size() && bracket[0].begin > 0 && is_remark(bracket[0].text))
    cell = without_blanks(cell.substr(0, bracket[0].begin));
  if (const std::string_view share = share_unit(cell); !share.empty() && !is_digit(cell.front()))
    return std::string(share);
  for (const std::string_view mark : {"_", ",", " in "}) {
    const std::size_t at = cell.rfind(mark);
    if (at == cell.npos || at == 0) continue;
    const std::string_view unit = without_blanks(cell.substr(at + mark.size()));
    if (is_unit(unit) && unit != "1") return std::string(unit);
  }
  for (std::size_t at = cell.find(' '); at != cell.npos; at = cell.find(' ', at + 1)) {
    const std::string_view unit = without_blanks(cell.substr(at));
    const bool has_sign =
        std::ranges::any_of(std::array{"%", "‰", "°", "µ", "μ", "ε"},
                            [&](std::string_view sign) { return unit.find(sign) != unit.npos; });
    const bool is_condition = at > 0 && is_digit(cell[at - 1]);  // "strain at 50 %"
    if (at > 0 && !is_condition && has_sign && is_unit(unit)) return std::string(unit);
    if (at > 0 && !(is_condition && has_sign) && !share_unit(unit).empty()) return std::string(unit);
  }
  for (const std::string_view begin : {"% ", "‰ ", "percent ", "Percent ", "permille "})
    if (cell.starts_with(begin)) return std::string(share_unit(begin));
  return "";
}

using Words = std::vector<std::string>;

/// Splits a text at blanks, commas, semicolons and colons.
Words words_between(std::string_view text) {
  Words words(1);
  for (const char c : text) {
    if (std::string_view(" \t,;:").find(c) == std::string_view::npos)
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool is_number(std::string_view word) {
  return is_digit(word.front()) && word.find_first_not_of("0123456789.") == word.npos;
}

/// Tells whether a text has letters, with hyphens, points and digits among them, and no sign that units have:
/// "LVDT1", "No.", "28-day", not "m2x", "kN/m" and "‰".
bool is_word(std::string_view word) {
  for (const std::string_view sign :
       {"‰", "‱", "°", "µ", "μ", "ε", "ϵ", "ɛ", "²", "³", "¹", "⁻", "·", "⋅", "×", "−"})
    if (word.find(sign) != word.npos) return false;
  const bool begins_small = word.front() >= 'a' && word.front() <= 'z';
  bool has_letter = false, is_behind_digit = false;
  for (const char c : word) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0;
    if (!is_letter && !is_digit(c) && std::string_view("-_.'&").find(c) == std::string_view::npos)
      return false;
    if (is_letter && is_behind_digit && begins_small) return false;
    is_behind_digit = is_digit(c);
    has_letter = has_letter || is_letter;
  }
  return has_letter;
}

/// Tells whether a text is a quotient of a quantity by itself elsewhere, such as "f_c/f_c20" or "E/E0".
bool is_ratio(std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == text.npos || slash == 0 || slash + 1 == text.size()) return false;
  const auto stem = [](std::string_view name) {
    return is_word(name) ? name.substr(0, name.find_last_not_of("0123456789_") + 1) : std::string_view();
  };
  const std::string_view above = stem(text.substr(0, slash)), below = stem(text.substr(slash + 1));
  return !above.empty() && !below.empty() && (above.starts_with(below) || below.starts_with(above));
}

/// Tells whether a word means a share or may mean one: "percent", "mstrain", "permil", "ppt", "x1000".
bool may_be_share(std::string_view word) {
  if (!share_unit(word).empty()) return true;
  const std::string text = lower_case(word);
  for (const std::string_view begin :
       {"permil", "promil", "percen", "procen", "prozen", "milli", "micro", "pp"})
    if (text.starts_with(begin)) return true;
  for (const std::string_view end : {"strain", "strains"})
    if (text.ends_with(end) && text != end) return true;
  return text.size() > 1 && (text[0] == 'x' || text.starts_with("e-")) && is_digit(text.back());
}

/// Tells whether a text is two letters, of which the first may be a prefix of a unit: "me", "ns".
bool may_have_prefix(std::string_view text) {
  return text.size() == 2 && (text[0] == 'm' || text[0] == 'u' || text[0] == 'n');
}

/// Splits a line into words; text in brackets or quotes is one word.
Words words_of_line(std::string_view line) {
  Words words(1);
  int depth = 0;
  bool is_quoted = false;
  for (const char c : line) {
    if (c == '"') is_quoted = !is_quoted;
    if (c == '[' || c == '(') ++depth;
    if (c == ']' || c == ')') depth = std::max(depth - 1, 0);
    const bool is_blank = c == ' ' || c == '\t';
    if (is_blank && depth == 0 && !is_quoted) {
      if (!words.back().empty()) words.emplace_back();
    } else if (c != '"') {
      words.back() += c;
    }
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

/// Joins words with the units that belong to them.
Words with_their_units(const Words& words) {
  Words cells;
  bool is_behind_slash = false;
  for (const std::string& word : words) {
    const bool belongs = word == "/" || is_behind_slash || word.starts_with('[') || word.starts_with('(');
    if (belongs && !cells.empty())
      cells.back() += " " + word;
    else
      cells.push_back(word);
    is_behind_slash = word == "/";
  }
  return cells;
}

/// Joins words into cells that each end with the unit in brackets.
Words up_to_brackets(const Words& words) {
  Words cells;
  bool is_new = true;
  for (const std::string& word : words) {
    if (is_new)
      cells.push_back(word);
    else
      cells.back() += " " + word;
    is_new = word.ends_with(']') || word.ends_with(')');
  }
  return cells;
}

}  // namespace

ColumnHeader column_header(std::string_view cell) {
  ColumnHeader header{std::string(cell), {}, {}, {}, {}};
  if (const auto in_brackets = with_bracket(cell))
    header = *in_brackets;
  else if (const auto behind_slash = with_slash(cell))
    header = *behind_slash;
  if (header.unit.empty()) header.likely_unit = likely_unit(cell);
  header.written = cell;
  return header;
}

bool is_remark(std::string_view text) {
  const Words words = words_between(text);
  bool is_behind_number = false, is_behind_x = false;
  for (const std::string& word : words) {
    if (is_behind_x && is_number(word)) return false;  // "x 1000" is a factor
    if (!is_number(word) && !is_word(word) && !is_ratio(word) && !(is_behind_number && is_unit(word)))
      return false;
    is_behind_number = is_number(word);
    is_behind_x = word == "x";
  }
  return !words.empty() && !may_have_prefix(text) && std::ranges::find(words, "per") == words.end() &&
         std::ranges::none_of(words, may_be_share);
}

std::optional<std::string> unit_cell(std::string_view cell) {
  const std::vector<Bracket> brackets = brackets_of(cell);
  if (!brackets.empty() && brackets[0].begin == 0 && brackets[0].end == cell.size()) cell = brackets[0].text;
  if (is_no_unit(cell)) return "1";
  return says_unit(cell) ? std::optional(std::string(cell)) : std::nullopt;
}

std::vector<std::string> cells_between_blanks(std::string_view line, std::size_t count) {
  const Words words = words_of_line(line);
  for (const Words& cells : {with_their_units(words), up_to_brackets(words)})
    if (cells.size() == count) return cells;
  return {};
}

}  // namespace pyroclast
