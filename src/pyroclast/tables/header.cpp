#include "pyroclast/tables/header.hpp"

#include <algorithm>
#include <cstddef>

#include "pyroclast/tables/cell.hpp"
#include "pyroclast/tables/table_lines.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {
namespace {

bool says_unit(std::string_view text) {
  return clock_form(text) || is_unit(text);
}

/// Returns a unit, "1" for "" and "-", which are written for no unit.
std::string unit_or_none(std::string_view text) {
  return text.empty() || text == "-" ? "1" : std::string(text);
}

/// Returns the place of the bracket that opens what the text ends with; `npos` without such a bracket.
std::size_t last_open(std::string_view text, char open, char close) {
  if (!text.ends_with(close)) return text.npos;
  int depth = 0;
  for (std::size_t i = text.size(); i-- > 0;) {
    if (text[i] == close) ++depth;
    if (text[i] == open && --depth == 0) return i;
  }
  return text.npos;
}

std::optional<ColumnHeader> with_bracket(std::string_view cell, char open, char close) {
  const std::size_t at = last_open(cell, open, close);
  if (at == cell.npos) return std::nullopt;
  const std::string_view unit = without_blanks(cell.substr(at + 1, cell.size() - at - 2));
  // round brackets hold other words too
  if (open == '(' && unit != "-" && !says_unit(unit)) return std::nullopt;
  return ColumnHeader{std::string(without_blanks(cell.substr(0, at))), unit_or_none(unit), {}};
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
  return ColumnHeader{std::string(name), std::string(unit), {}};
}

using Words = std::vector<std::string>;

/// Splits a line into words; text in brackets or quotes is one word.
Words words_of(std::string_view line) {
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
  if (const auto header = with_bracket(cell, '[', ']')) return *header;
  if (const auto header = with_bracket(cell, '(', ')')) return *header;
  if (const auto header = with_slash(cell)) return *header;
  ColumnHeader header{std::string(cell), {}, {}};
  const std::size_t underscore = cell.rfind('_');
  if (underscore != cell.npos && underscore > 0 && is_unit(cell.substr(underscore + 1)))
    header.likely_unit = cell.substr(underscore + 1);
  return header;
}

std::optional<std::string> unit_cell(std::string_view cell) {
  if (cell == "-") return "1";
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')})
    if (last_open(cell, open, close) == 0) cell = without_blanks(cell.substr(1, cell.size() - 2));
  if (cell.empty() || cell == "-") return "1";
  return says_unit(cell) ? std::optional(std::string(cell)) : std::nullopt;
}

std::vector<std::string> cells_between_blanks(std::string_view line, std::size_t count) {
  const Words words = words_of(line);
  for (const Words& cells : {with_their_units(words), up_to_brackets(words)})
    if (cells.size() == count) return cells;
  return {};
}

}  // namespace pyroclast
