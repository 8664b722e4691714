#include <algorithm>
#include <cstddef>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/nearest.hpp"
#include "pyroclast/tables/measured_table.hpp"
#include "pyroclast/units/units.hpp"

// Choice of the columns of a table: by the deck, by known names, by places.

namespace pyroclast {
namespace {

std::string in_quotes(std::string_view text) {
  return fmt::format("\"{}\"", text);
}

bool holds(const ColumnMeanings& meanings, const ColumnMeaning* one) {
  return std::ranges::find(meanings, one) != meanings.end();
}

/// Returns all quantities that names of columns may say.
ColumnMeanings vocabulary_of(std::span<const AskedColumn> asked, const ColumnMeanings& others) {
  ColumnMeanings all{&meaning::index};
  const auto add = [&](const ColumnMeaning* one) {
    if (!holds(all, one)) all.push_back(one);
  };
  for (const AskedColumn& column : asked)
    for (const KnownName& known : column.names) add(known.meaning);
  for (const ColumnMeaning* one : others) add(one);
  return all;
}

/// Returns the first of the names of a quantity that a column says; null where it says none.
const KnownName* said(const AskedColumn& asked, const ColumnMeanings& meanings) {
  const auto found =
      std::ranges::find_if(asked.names, [&](const KnownName& one) { return holds(meanings, one.meaning); });
  return found == asked.names.end() ? nullptr : &*found;
}

std::size_t count_needed(std::span<const AskedColumn> asked) {
  return static_cast<std::size_t>(std::ranges::count(asked, false, &AskedColumn::is_optional));
}

std::string stated_unit(const ColumnChoice& choice, std::size_t i) {
  return i < choice.units.size() ? choice.units[i] : "";
}

std::string names_of(std::span<const AskedColumn> asked) {
  std::string list;
  for (const AskedColumn& column : asked)
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", column.name,
                        column.is_optional ? " (where there is one)" : "");
  return list;
}

}  // namespace

std::size_t MeasuredTable::find(const ColumnChoice::TableColumn& wanted) const {
  if (wanted.number > 0) {
    if (wanted.number > columns_.size())
      refuse(path_, header_line_,
             fmt::format("has no column {}; it has {}", wanted.number, list_of_columns()));
    return wanted.number - 1;
  }
  std::vector<std::string> names;
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (columns_[i].name == wanted.name || columns_[i].written == wanted.name) found.push_back(i);
    if (!columns_[i].name.empty()) names.push_back(columns_[i].name);
  }
  if (found.empty())
    refuse(path_, header_line_,
           fmt::format("has no column \"{}\"{}; it has {}", wanted.name,
                       did_you_mean(wanted.name, names, "; "), list_of_columns()));
  if (found.size() > 1)
    refuse(path_, header_line_,
           fmt::format("has more than one column \"{}\"; write one of their numbers, {} or {}", wanted.name,
                       found[0] + 1, found[1] + 1));
  return found[0];
}

ColumnMeanings MeasuredTable::meanings(std::size_t column, const ColumnMeanings& vocabulary,
                                       const std::string& stated) const {
  const ColumnHeader& header = columns_[column];
  std::string_view name = header.name;
  if (!header.likely_unit.empty() && name.ends_with(header.likely_unit))
    name.remove_suffix(header.likely_unit.size());
  while (name.ends_with('_') || name.ends_with(',') || name.ends_with(' ')) name.remove_suffix(1);
  ColumnMeanings result = meanings_of_name(name, vocabulary);
  std::erase_if(result, [&](const ColumnMeaning* one) {
    if (!header.unit.empty()) return !fits(column, header.unit, one->unit);
    return !stated.empty() && one != &meaning::index && !fits(column, stated, one->unit);
  });
  return result;
}

std::vector<std::size_t> MeasuredTable::columns_of_values(std::span<const AskedColumn> asked,
                                                          const ColumnMeanings& vocabulary) const {
  const ColumnMeanings number{&meaning::index};
  const auto is_number = [&](std::size_t i) {
    const std::string& unit = columns_[i].unit;
    return (unit.empty() || unit == "1") && meanings(i, vocabulary) == number;
  };
  const auto has = [&](const ColumnMeaning* one) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      if (holds(meanings(i, vocabulary), one)) return true;
    return false;
  };
  // A number of the row can be a quantity that is asked for, such as the grain, where no column has its own
  // name.
  const bool may_be_asked = std::ranges::any_of(asked, [&](const AskedColumn& one) {
    return said(one, number) != nullptr && !has(one.names[0].meaning);
  });
  // Dates in a column of their own say no more than the clock beside them, which passes midnight.
  const auto is_date = [&](std::size_t i) { return kind_of_cell(grid_.rows[0].cells[i]) == CellKind::date; };
  const bool has_clock = std::ranges::any_of(
      grid_.rows[0].cells, [](const std::string& cell) { return moment_of(cell).has_value(); });
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < columns_.size(); ++i)
    if ((may_be_asked || !is_number(i)) && !(has_clock && is_date(i))) result.push_back(i);
  return result;
}

bool MeasuredTable::contradicts(std::size_t column, const AskedColumn& asked,
                                const ColumnMeanings& vocabulary, const std::string& stated) const {
  if (asked.names.empty()) return false;
  const ColumnMeanings says = meanings(column, vocabulary, stated);
  return !says.empty() && said(asked, says) == nullptr;
}

/// Matches columns with as many quantities: by a name that one column alone says, and says of one quantity
/// alone, the others by their places.
MeasuredTable::Match MeasuredTable::match(std::vector<std::size_t> columns,
                                          std::span<const AskedColumn> asked,
                                          const ColumnMeanings& vocabulary) const {
  std::vector<std::optional<std::size_t>> found(asked.size());
  std::size_t most_names = 0;
  for (const AskedColumn& one : asked) most_names = std::max(most_names, one.names.size());
  for (std::size_t rank = 0; rank < most_names; ++rank) {
    const auto says = [&](std::size_t column, std::size_t i) {
      return !found[i] && rank < asked[i].names.size() &&
             holds(meanings(column, vocabulary), asked[i].names[rank].meaning);
    };
    for (std::size_t i = 0; i < asked.size(); ++i) {
      std::vector<std::size_t> with_name;
      for (const std::size_t column : columns)
        if (says(column, i)) with_name.push_back(column);
      if (with_name.size() != 1) continue;
      bool is_of_others = false;
      for (std::size_t k = 0; k < asked.size(); ++k)
        is_of_others = is_of_others || (k != i && says(with_name[0], k));
      if (is_of_others) continue;
      found[i] = with_name[0];
      std::erase(columns, with_name[0]);
    }
  }
  Match result;
  auto next = columns.begin();
  for (std::size_t i = 0; i < asked.size(); ++i) {
    result.columns.push_back(found[i] ? *found[i] : *next++);
    if (!result.contradicted && contradicts(result.columns[i], asked[i], vocabulary, ""))
      result.contradicted = i;
  }
  return result;
}

bool MeasuredTable::fit(const Match& match, const ColumnChoice& choice,
                        std::span<const AskedColumn> asked) const {
  if (match.contradicted) return false;
  for (std::size_t i = 0; i < match.columns.size(); ++i)
    if (!fits(match.columns[i], stated_unit(choice, i), asked[i].unit)) return false;
  return true;
}

/// Matches all columns but those that number the rows; empty where their count is wrong. The first column may
/// number the rows without a name if the others fit then.
std::optional<MeasuredTable::Match> MeasuredTable::match_all(const ColumnChoice& choice,
                                                             std::span<const AskedColumn> asked,
                                                             const ColumnMeanings& vocabulary) const {
  const auto matched = [&](const std::vector<std::size_t>& columns) -> std::optional<Match> {
    const std::size_t count = columns.size();
    if (count < count_needed(asked) || count > asked.size()) return std::nullopt;
    if (!choice.units.empty() && choice.units.size() != count) return std::nullopt;
    return match(columns, asked.first(count), vocabulary);
  };
  std::vector<std::size_t> columns = columns_of_values(asked, vocabulary);
  const auto all = matched(columns);
  if (all && fit(*all, choice, asked)) return all;
  if (!columns.empty() && is_index(columns[0])) {
    columns.erase(columns.begin());
    const auto others = matched(columns);
    if (others && fit(*others, choice, asked)) return others;
  }
  return all;
}

bool MeasuredTable::names_suit(std::span<const AskedColumn> asked, const ColumnMeanings& others) const {
  const auto found = match_all({}, asked, vocabulary_of(asked, others));
  return found && !found->contradicted;
}

bool MeasuredTable::suits(std::span<const AskedColumn> asked, const ColumnMeanings& others) const {
  const auto found = match_all({}, asked, vocabulary_of(asked, others));
  return found && fit(*found, {}, asked);
}

/// Returns the columns that the deck states. A name that says another quantity is refused; a number is not,
/// so that a deck can take any column for anything.
std::vector<std::size_t> MeasuredTable::stated_columns(const ColumnChoice& choice,
                                                       std::span<const AskedColumn> asked,
                                                       const ColumnMeanings& vocabulary) const {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < choice.columns.size(); ++i) {
    const std::size_t index = find(choice.columns[i]);
    if (std::ranges::find(result, index) != result.end())
      refuse(path_, header_line_, fmt::format("{} is chosen twice", column_name(index)));
    if (choice.columns[i].number == 0 && contradicts(index, asked[i], vocabulary, stated_unit(choice, i)))
      refuse(path_, header_line_,
             fmt::format("{} stands in the place of the {} by its name; `columns` are the {}, in this order. "
                         "Write {} for the name where it is meant so",
                         column_name(index), asked[i].name, names_of(asked), index + 1));
    result.push_back(index);
  }
  return result;
}

void MeasuredTable::refuse_contradiction(std::size_t column, const AskedColumn& asked,
                                         const ColumnChoice& choice, std::span<const AskedColumn> all,
                                         const ColumnMeanings& vocabulary) const {
  const ColumnMeanings says = meanings(column, vocabulary);
  const std::string place = fmt::format("{} is the {} by its name, but stands in the place of the {}",
                                        column_name(column), says[0]->name, asked.name);
  if (says[0] == &meaning::temperature_rise)
    refuse(
        path_, header_line_,
        fmt::format("{}; add the temperature at the start to its numbers, and name it temperature", place));
  if (says[0] == &meaning::retained)
    refuse(
        path_, header_line_,
        fmt::format("{}; write the shares that pass: 100 % less all that larger sieves and this one retain",
                    place));
  const std::vector<std::size_t> likely = likely_columns(all, vocabulary);
  bool has_all = true;
  for (std::size_t i = 0; i < likely.size(); ++i)
    has_all = has_all && !contradicts(likely[i], all[i], vocabulary, "");
  refuse(
      path_, header_line_,
      fmt::format("{}; the columns are the {}. The file has {}; {}", place, names_of(all), list_of_columns(),
                  has_all ? "write " + line_to_write(choice, likely, all)
                          : "where the column is meant all the same, choose it by its number in `columns`"));
}

std::vector<std::size_t> MeasuredTable::found_columns(const ColumnChoice& choice,
                                                      std::span<const AskedColumn> asked,
                                                      const ColumnMeanings& vocabulary) const {
  if (const auto found = match_all(choice, asked, vocabulary)) {
    if (found->contradicted) {
      const std::size_t i = *found->contradicted;
      if (contradicts(found->columns[i], asked[i], vocabulary, stated_unit(choice, i)))
        refuse_contradiction(found->columns[i], asked[i], choice, asked, vocabulary);
    }
    return found->columns;
  }
  const std::size_t needed = count_needed(asked);
  if (columns_of_values(asked, vocabulary).size() < needed)
    refuse(path_, header_line_,
           fmt::format("has {} column{} (delimiter: {}), but {} are needed: {}", columns_.size(),
                       columns_.size() == 1 ? "" : "s", grid_.delimiter, needed, names_of(asked)));
  refuse(path_, header_line_,
         fmt::format("has {} columns, of which {} are needed ({}): {}; write {}", columns_.size(), needed,
                     names_of(asked), list_of_columns(),
                     line_to_write(choice, likely_columns(asked, vocabulary), asked)));
}

std::string MeasuredTable::chosen_unit(std::size_t column, const std::string& stated,
                                       const AskedColumn& asked) const {
  const std::string said = unit_of(column, asked.unit);
  if (stated.empty() || !columns_[column].unit.empty()) {
    if (!stated.empty() && meant_unit(stated, asked.unit) != meant_unit(said, asked.unit))
      refuse(path_, header_line_,
             fmt::format("{} is in \"{}\" by the file and in \"{}\" by the deck; write \"\" in its place in "
                         "`units`, or change the file",
                         column_name(column), said, stated));
    if (column == 0 && grid_.may_begin_with_unit && columns_[0].unit.empty() && said == "1" &&
        !asked.is_known_by_size)
      refuse(path_, header_line_,
             fmt::format("the line begins with \"%\", which may be the unit of {} or begin a comment; write "
                         "\"{} [%]\" or \"{} [-]\"",
                         column_name(0), columns_[0].name, columns_[0].name));
    return said;
  }
  return stated;
}

/// Returns the number of rows up to the last one in which a cell of these columns is not empty: columns of a
/// shorter curve beside a longer one end with empty cells.
std::size_t MeasuredTable::end_of(const std::vector<std::size_t>& columns) const {
  std::size_t end = rows();
  const auto is_empty = [&](std::size_t column) { return grid_.rows[end - 1].cells[column].empty(); };
  while (end > 0 && std::ranges::all_of(columns, is_empty)) --end;
  if (end == 0) refuse(path_, header_line_, fmt::format("{} holds no number", column_name(columns[0])));
  return end;
}

std::vector<ChosenColumn> MeasuredTable::choose(const ColumnChoice& choice,
                                                std::span<const AskedColumn> asked,
                                                const ColumnMeanings& others) const {
  const ColumnMeanings vocabulary = vocabulary_of(asked, others);
  const std::vector<std::size_t> indices = choice.columns.empty() ? found_columns(choice, asked, vocabulary)
                                                                  : stated_columns(choice, asked, vocabulary);
  const std::size_t rows = end_of(indices);
  std::vector<ChosenColumn> result;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const std::string stated = stated_unit(choice, i);
    const KnownName* name = said(asked[i], meanings(indices[i], vocabulary, stated));
    result.push_back({indices[i], chosen_unit(indices[i], stated, asked[i]),
                      name == nullptr ? 1.0 : name->factor, rows,
                      asked[i].unit == unit::time ? choice.start : ""});
    if (result.back().unit.empty())
      refuse(path_, header_line_,
             fmt::format("{} has no unit; write \"{} [{}]\" above it, or {}", column_name(indices[i]),
                         columns_[indices[i]].name.empty() ? asked[i].name : columns_[indices[i]].name,
                         asked[i].unit.si, line_to_write(choice, indices, asked)));
  }
  return result;
}

std::string MeasuredTable::list_of_columns() const {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const ColumnHeader& column = columns_[i];
    list.push_back(fmt::format("{}{}{}", i + 1,
                               column.name.empty() ? "" : fmt::format(" \"{}\"", column.name),
                               column.unit.empty() ? "" : fmt::format(" [{}]", column.unit)));
  }
  return fmt::format("{}", fmt::join(list, ", "));
}

/// Guesses which columns a deck wants: by name and unit, by unit, by place.
std::vector<std::size_t> MeasuredTable::likely_columns(std::span<const AskedColumn> asked,
                                                       const ColumnMeanings& vocabulary) const {
  constexpr int kNamed = 40, kFits = 20, kSaysUnit = 10, kContradicts = -100, kNumbersRows = -50;
  std::vector<std::optional<std::size_t>> found(asked.size());
  const std::vector<std::size_t> of_values = columns_of_values(asked, vocabulary);
  const auto fitness = [&](std::size_t column, const AskedColumn& one) {
    const KnownName* name = said(one, meanings(column, vocabulary));
    int sum = name == nullptr ? 0 : kNamed - static_cast<int>(name - one.names.data());
    if (fits(column, "", one.unit)) sum += kFits + (columns_[column].unit.empty() ? 0 : kSaysUnit);
    if (contradicts(column, one, vocabulary, "")) sum += kContradicts;
    const bool is_of_values = std::ranges::find(of_values, column) != of_values.end();
    if (!is_of_values || (name == nullptr && is_index(column))) sum += kNumbersRows;
    return sum;
  };
  // The best pair of a column and a quantity goes first.
  for (std::size_t turn = 0; turn < asked.size(); ++turn) {
    std::optional<std::pair<std::size_t, std::size_t>> best;
    int best_fitness = 0;
    for (std::size_t i = 0; i < asked.size(); ++i)
      for (std::size_t column = 0; column < columns_.size() && !found[i]; ++column) {
        if (std::ranges::find(found, std::optional(column)) != found.end()) continue;
        const int its = fitness(column, asked[i]);
        if ((best && its <= best_fitness) || (asked[i].is_optional && its < kNamed)) continue;
        best = {i, column};
        best_fitness = its;
      }
    if (best) found[best->first] = best->second;
  }
  std::vector<std::size_t> result;
  for (const auto& column : found)
    if (column) result.push_back(*column);
  return result;
}

std::string MeasuredTable::line_to_write(const ColumnChoice& choice, const std::vector<std::size_t>& columns,
                                         std::span<const AskedColumn> asked) const {
  std::vector<std::string> names, units;
  bool all_say_units = true;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns_[columns[i]].name;
    const auto same = std::ranges::count(columns_, name, &ColumnHeader::name);
    names.push_back(name.empty() || same > 1 ? fmt::format("{}", columns[i] + 1) : in_quotes(name));
    const std::string unit = unit_of(columns[i], asked[i].unit);
    all_say_units = all_say_units && !unit.empty();
    units.push_back(in_quotes(unit.empty() ? asked[i].unit.si : unit));
  }
  std::string line =
      fmt::format("{{ {} = \"{}\", columns = [{}]", choice.key, choice.file, fmt::join(names, ", "));
  if (!all_say_units) line += fmt::format(", units = [{}]", fmt::join(units, ", "));
  return line + " }";
}

}  // namespace pyroclast
