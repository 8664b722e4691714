#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/nearest.hpp"
#include "pyroclast/deck/deck.hpp"
#include "pyroclast/deck/reading.hpp"
#include "pyroclast/deck/survey_run.hpp"

namespace pyroclast {
namespace {

/// Value of the deck, its full path and the record that takes its errors.
struct Entry {
  DeckReading& deck;
  std::string path;
  const toml::node& node;

  void error(std::string message, std::string hint = {}) const {
    deck.report(path, node, std::move(message), std::move(hint));
  }
};

std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return node.is_array_of_tables() ? "an array of tables" : "a list";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a decimal number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

void wrong_type(const Entry& entry, std::string_view needed) {
  entry.error(fmt::format("{} is needed, not {}", needed, type_name(entry.node)));
}

std::string_view suffix(const Unit& unit) {
  return unit == unit::dimensionless ? "" : unit.si;
}

/// Describes how a quantity must be written, its range included.
std::string requirement(const Unit& unit, const Range& range) {
  const std::string words = range.describe(suffix(unit));
  return words.empty() ? requirement(unit) : fmt::format("{}; it must be {}", requirement(unit), words);
}

std::string unusual(double value, const Range& range, std::string_view unit) {
  return fmt::format("is {:.6g}{}{}, but usually it is {}", value, unit.empty() ? "" : " ", unit,
                     range.describe_usual(unit));
}

bool check_range(const Entry& entry, double value, const Range& range, std::string_view unit) {
  if (!range.contains(value)) {
    entry.error("must be " + range.describe(unit));
    return false;
  }
  if (!range.is_usual(value)) entry.deck.warn(entry.path, entry.node, unusual(value, range, unit));
  return true;
}

std::optional<double> read_written_quantity(const Entry& entry, const std::string& text, const Unit& unit) {
  try {
    return parse_quantity(text, unit);
  } catch (const QuantityError& error) {
    entry.error(error.reason());
    return std::nullopt;
  }
}

std::optional<double> read_plain_number(const Entry& entry, const Unit& unit) {
  if (unit != unit::dimensionless) {
    entry.error(fmt::format("no unit; {}", requirement(unit)), "the quotes are needed");
    return std::nullopt;
  }
  const double value = entry.node.value<double>().value_or(std::numeric_limits<double>::quiet_NaN());
  if (std::isfinite(value)) return value;
  entry.error("the number is not finite");
  return std::nullopt;
}

/// Tells whether a number is one of a run: numbers beyond, multiplied, would leave the range of doubles.
/// Records an error where it is not.
bool check_magnitude(const Entry& entry, double value, const Unit& unit) {
  constexpr double kSmallest = 1e-30, kLargest = 1e30;
  const double size = std::abs(value);
  if (size == 0.0 || (size >= kSmallest && size <= kLargest)) return true;
  const std::string in = suffix(unit).empty() ? "" : fmt::format(" {}", suffix(unit));
  entry.error(size > kLargest
                  ? fmt::format("is too large: no number of a run is beyond {:g}{}", kLargest, in)
                  : fmt::format("is too small: write 0, or a number of at least {:g}{}", kSmallest, in));
  return false;
}

std::optional<double> read_quantity(const Entry& entry, const Unit& unit, const Range& range) {
  std::optional<double> value;
  if (const auto* text = entry.node.as_string()) {
    value = read_written_quantity(entry, text->get(), unit);
  } else if (entry.node.is_number()) {
    value = read_plain_number(entry, unit);
  } else {
    wrong_type(entry, unit == unit::dimensionless ? "a number"
                                                  : fmt::format("a string such as \"{}\"", unit.example));
  }
  if (value && !check_magnitude(entry, *value, unit)) return std::nullopt;
  if (value) value = range.but_for_rounding(*value);
  if (value && !check_range(entry, *value, range, suffix(unit))) return std::nullopt;
  return value;
}

Entry element_of(const Entry& list, std::size_t index) {
  return {list.deck, fmt::format("{}[{}]", list.path, index), *list.node.as_array()->get(index)};
}

std::vector<double> read_quantities(const Entry& entry, const Unit& unit, const Range& range) {
  const toml::array* list = entry.node.as_array();
  if (!list || list->empty()) {
    const std::string needed =
        fmt::format("a list of at least one {}, e.g. [\"{}\"],", unit.name, unit.example);
    list ? entry.error(needed + " is needed") : wrong_type(entry, needed);
    return {};
  }
  std::vector<double> values;
  bool complete = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const auto value = read_quantity(element_of(entry, i), unit, range);
    complete = complete && value;
    values.push_back(value.value_or(0.0));
  }
  return complete ? values : std::vector<double>{};
}

using Point = std::pair<double, double>;

std::optional<Point> read_point(const Entry& entry, const Unit& x_unit, const Unit& y_unit) {
  const std::string needed =
      fmt::format("a point [\"{}\", \"{}\"] is needed", x_unit.example, y_unit.example);
  const toml::array* pair = entry.node.as_array();
  if (!pair) {
    entry.error(fmt::format("{}, not {}", needed, type_name(entry.node)));
    return std::nullopt;
  }
  if (pair->size() != 2) {
    entry.error(fmt::format("{}, not a list of {}", needed, pair->size()));
    return std::nullopt;
  }
  const auto x = read_quantity(element_of(entry, 0), x_unit, Range::any());
  const auto y = read_quantity(element_of(entry, 1), y_unit, Range::any());
  if (!x || !y) return std::nullopt;
  return Point{*x, *y};
}

std::vector<Point> read_points(const Entry& entry, const Unit& x_unit, const Unit& y_unit) {
  const toml::array* list = entry.node.as_array();
  if (!list || list->size() < 2) {
    const std::string needed =
        fmt::format("a list of two or more points, [[\"{}\", \"{}\"], ...],", x_unit.example, y_unit.example);
    list ? entry.error(needed + " is needed") : wrong_type(entry, needed);
    return {};
  }
  std::vector<Point> points;
  bool complete = true;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const Entry element = element_of(entry, i);
    const auto point = read_point(element, x_unit, y_unit);
    complete = complete && point;
    if (!point) continue;
    if (!points.empty() && !(points.back().first < point->first)) {
      element_of(element, 0)
          .error(
              fmt::format("must be above the {} before, {} {}", x_unit.name, points.back().first, x_unit.si));
      complete = false;
    }
    points.push_back(*point);
  }
  return complete ? points : std::vector<Point>{};
}

std::string list_of_places(std::size_t least, const Unit& unit, int coordinates = 2) {
  const std::vector<std::string> numbers(coordinates, fmt::format("\"{}\"", unit.example));
  return fmt::format("a list of {} or more places, [[{}], ...],", least, fmt::join(numbers, ", "));
}

/// Reads a list of at least `least` places; returns none after an error.
/// \param needed    words for such a list
/// \param read_one  function that reads a place of the list
template <class ReadOne>
auto read_places(const Entry& entry, const std::string& needed, std::size_t least, ReadOne read_one) {
  std::vector<typename std::invoke_result_t<ReadOne, Entry>::value_type> places;
  const toml::array* list = entry.node.as_array();
  if (!list || list->size() < least) {
    list ? entry.error(needed + " is needed") : wrong_type(entry, needed);
    return places;
  }
  for (std::size_t i = 0; i < list->size(); ++i)
    if (auto place = read_one(element_of(entry, i))) places.push_back(*std::move(place));
  if (places.size() < list->size()) places.clear();
  return places;
}

/// Reads a place; returns none after an error, which shows the line to write where a coordinate is missing.
/// \param key  key that states the place, or a list of places
std::optional<StatedPlace> read_stated_place(const Entry& entry, std::string_view key, const Unit& unit,
                                             const Coordinates& coordinates) {
  const toml::array* list = entry.node.as_array();
  const bool is_in_space = coordinates.count == 3;
  const std::string needed = fmt::format("a place [\"{0}\", \"{0}\"{1}] is needed", unit.example,
                                         is_in_space ? fmt::format(", \"{}\"", unit.example) : "");
  if (!list) {
    entry.error(fmt::format("{}, not {}", needed, type_name(entry.node)));
    return std::nullopt;
  }
  const bool is_pair = list->size() == 2, is_triple = list->size() == 3;
  if (is_triple && !is_in_space) {
    entry.error(needed + ": a body in the plane has no z; with [specimen] depth the body is a solid");
    return std::nullopt;
  }
  if (!is_pair && !is_triple) {
    entry.error(fmt::format("{}, not a list of {}", needed, list->size()));
    return std::nullopt;
  }
  std::array<std::optional<double>, 3> at;
  for (std::size_t i = 0; i < list->size(); ++i)
    at[i] = read_quantity(element_of(entry, i), unit, Range::any());
  if (!at[0] || !at[1] || (is_triple && !at[2])) return std::nullopt;
  if (is_pair && is_in_space && !coordinates.pair_is_along_z) {
    entry.error(
        fmt::format("a point of a solid needs its z too; in the middle it is {} = [\"{:g} {}\", \"{:g} "
                    "{}\", \"{:g} {}\"]",
                    key, *at[0], unit.si, *at[1], unit.si, coordinates.middle_z, unit.si));
    return std::nullopt;
  }
  return StatedPlace{*at[0], *at[1], at[2]};
}

std::optional<long long> read_integer(const Entry& entry, const Range& range) {
  const auto* integer = entry.node.as_integer();
  if (!integer) {
    wrong_type(entry, "a whole number, without decimal point, exponent or quotes,");
    return std::nullopt;
  }
  const long long value = integer->get();
  if (!check_range(entry, static_cast<double>(value), range, "")) return std::nullopt;
  return value;
}

std::optional<std::string> read_text(const Entry& entry) {
  const auto* text = entry.node.as_string();
  if (text && !text->get().empty()) return text->get();
  text ? entry.error("must not be empty") : wrong_type(entry, "a string");
  return std::nullopt;
}

std::optional<bool> read_flag(const Entry& entry) {
  if (const auto* flag = entry.node.as_boolean()) return flag->get();
  wrong_type(entry, "true or false, without quotes,");
  return std::nullopt;
}

std::string one_of(const std::vector<std::string>& words) {
  return "one of " + quoted_list(words);
}

/// Returns the word's index, or that of the nearest word after an error; none if no word is near.
std::optional<std::size_t> read_choice(const Entry& entry, const std::vector<std::string>& words) {
  const auto* text = entry.node.as_string();
  if (!text) {
    wrong_type(entry, one_of(words));
    return std::nullopt;
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (text->get() == words[i]) return i;
  }
  const auto near = nearest(text->get(), words);
  entry.error("must be " + one_of(words), did_you_mean(text->get(), words));
  return near;
}

/// Takes the value of a key of a table; returns none if the key or the whole table is absent.
std::optional<Entry> read(DeckReading& deck, TableReading* table, std::string_view key) {
  const toml::node* node = table ? table->read(key) : nullptr;
  if (!node) return std::nullopt;
  return Entry{deck, table->path_of(key), *node};
}

/// Takes the value of a key that must be there, and records an error if it is absent; `needed` says what is
/// missing.
std::optional<Entry> require(DeckReading& deck, TableReading* table, std::string_view key,
                             const std::string& needed) {
  auto entry = read(deck, table, key);
  if (!entry && table && !table->undecided) deck.report_missing(*table, key, needed);
  return entry;
}

/// Returns a number with its unit, as the deck reference has it.
std::string fallback_text(double value, const Unit& unit) {
  if (!std::isfinite(value)) return "none";
  return fmt::format("{}{}{}", value, unit == unit::dimensionless ? "" : " ", suffix(unit));
}

DeckKey key_of(std::string_view key, ValueForm form, std::string value) {
  DeckKey result;
  result.key = key;
  result.form = form;
  result.value = std::move(value);
  return result;
}

DeckKey quantity_key(std::string_view key, const Unit& unit, const Range& range) {
  DeckKey result = key_of(key, ValueForm::quantity, unit == unit::dimensionless ? "number" : unit.name);
  result.kinds = {unit.name};
  result.unit = suffix(unit);
  result.range = range;
  return result;
}

DeckKey quantities_key(std::string_view key, const Unit& unit, const Range& range) {
  DeckKey result = quantity_key(key, unit, range);
  result.is_list = true;
  result.value = fmt::format("list of {}", result.value);
  return result;
}

DeckKey integer_key(std::string_view key, const Range& range) {
  DeckKey result = key_of(key, ValueForm::integer, "whole number");
  result.range = range;
  return result;
}

DeckKey places_key(std::string_view key, ValueForm form, bool is_list, const Unit& unit) {
  DeckKey result =
      key_of(key, form,
             fmt::format("{} [x, y]{}, {}", is_list ? "list of places" : "place",
                         form == ValueForm::place_in_space ? ", in a solid [x, y, z]" : "", unit.name));
  result.is_list = is_list;
  result.kinds = {unit.name};
  return result;
}

DeckKey texts_key(std::string_view key) {
  DeckKey result = key_of(key, ValueForm::text, "list of texts");
  result.is_list = true;
  return result;
}

DeckKey with_fallback(DeckKey key, std::string fallback) {
  key.fallback = std::move(fallback);
  return key;
}

std::string header(const TableReading* table, std::string_view key, std::string_view form) {
  return table ? fmt::format(fmt::runtime(form), table->path_of(key)) : "";
}

TableReading* read_table(const Entry& entry) {
  if (const toml::table* table = entry.node.as_table()) return &entry.deck.table(*table, entry.path);
  wrong_type(entry, fmt::format("a table, [{}],", entry.path));
  return nullptr;
}

std::vector<TableReading*> read_tables(const Entry& entry) {
  if (!entry.node.is_array_of_tables()) {
    wrong_type(entry, fmt::format("an array of tables, [[{}]],", entry.path));
    return {};
  }
  std::vector<TableReading*> tables;
  const toml::array& list = *entry.node.as_array();
  for (std::size_t i = 0; i < list.size(); ++i) {
    tables.push_back(&entry.deck.table(*list.get_as<toml::table>(i), fmt::format("{}[{}]", entry.path, i)));
  }
  return tables;
}

}  // namespace

Section Section::section(std::string_view key, Meaning meaning) const {
  if (auto* survey = deck_->survey()) {
    survey->need_table(table_->path, key);
    return {*deck_, &survey->table(table_->path_of(key), false, meaning.text())};
  }
  const auto entry = require(*deck_, table_, key, header(table_, key, "the table [{}] is needed"));
  return {*deck_, entry ? read_table(*entry) : nullptr};
}

std::optional<Section> Section::optional_section(std::string_view key, Meaning meaning) const {
  if (auto* survey = deck_->survey()) {
    if (!survey->is_present(table_->path, key)) return std::nullopt;
    return Section(*deck_, &survey->table(table_->path_of(key), true, meaning.text()));
  }
  const auto entry = read(*deck_, table_, key);
  TableReading* table = entry ? read_table(*entry) : nullptr;
  if (!table) return std::nullopt;
  return Section(*deck_, table);
}

std::vector<Section> Section::sections(std::string_view key, Meaning meaning) const {
  if (auto* survey = deck_->survey()) {
    survey->need_table(table_->path, std::string(key) + "[]");
    return {Section(*deck_, &survey->table(table_->path_of(key) + "[]", false, meaning.text()))};
  }
  const std::string needed = header(table_, key, "at least one table [[{}]] is needed");
  if (!require(*deck_, table_, key, needed)) return {};
  return optional_sections(key);
}

Section Section::section_or_none(std::string_view key, Meaning meaning) const {
  if (auto* survey = deck_->survey())
    return {*deck_, &survey->table(table_->path_of(key), true, meaning.text())};
  const auto entry = read(*deck_, table_, key);
  return {*deck_, entry ? read_table(*entry) : nullptr};
}

std::vector<Section> Section::optional_sections(std::string_view key, Meaning meaning) const {
  if (auto* survey = deck_->survey()) {
    if (!survey->is_present(table_->path, key)) return {};
    return {Section(*deck_, &survey->table(table_->path_of(key) + "[]", true, meaning.text()))};
  }
  const auto entry = read(*deck_, table_, key);
  std::vector<Section> result;
  if (!entry) return result;
  for (TableReading* table : read_tables(*entry)) result.push_back(Section(*deck_, table));
  return result;
}

std::vector<std::pair<std::string, Section>> Section::named_sections(std::string_view placeholder,
                                                                     Meaning meaning) const {
  if (auto* survey = deck_->survey())
    return {{std::string(placeholder),
             Section(*deck_, &survey->table(table_->path_of(placeholder), false, meaning.text()))}};
  std::vector<std::pair<std::string, Section>> result;
  if (!table_) return result;
  for (const auto& [key, node] : table_->table)
    if (node.is_table()) result.emplace_back(key.str(), section(key.str()));
  return result;
}

Section Section::with_defaults_of(std::string_view table) const {
  Section same = *this;
  same.defaults_of_ = table;
  return same;
}

double Section::quantity(std::string_view key, const Unit& unit, const Range& range, Meaning meaning) const {
  note(quantity_key(key, unit, range), meaning);
  if (deck_->survey()) return range.any_value();
  const auto entry = require(*deck_, table_, key, requirement(unit, range));
  return (entry ? read_quantity(*entry, unit, range) : std::nullopt).value_or(range.any_value());
}

double Section::quantity(std::string_view key, const Unit& unit, const Range& range, double fallback,
                         Meaning meaning) const {
  note(with_fallback(quantity_key(key, unit, range), fallback_text(fallback, unit)), meaning);
  const auto entry = read(*deck_, table_, key);
  return (entry ? read_quantity(*entry, unit, range) : std::nullopt).value_or(fallback);
}

std::vector<double> Section::quantities(std::string_view key, const Unit& unit, const Range& range,
                                        Meaning meaning) const {
  note(quantities_key(key, unit, range), meaning);
  if (deck_->survey()) return {};
  const auto entry = require(*deck_, table_, key, requirement(unit, range));
  return entry ? read_quantities(*entry, unit, range) : std::vector<double>{};
}

std::vector<double> Section::optional_quantities(std::string_view key, const Unit& unit, const Range& range,
                                                 Meaning meaning) const {
  note(with_fallback(quantities_key(key, unit, range), "[]"), meaning);
  const auto entry = read(*deck_, table_, key);
  const toml::array* list = entry ? entry->node.as_array() : nullptr;
  if (!entry || (list && list->empty())) return {};
  return read_quantities(*entry, unit, range);
}

double Section::number(std::string_view key, const Range& range, Meaning meaning) const {
  return quantity(key, unit::dimensionless, range, meaning);
}

double Section::number(std::string_view key, const Range& range, double fallback, Meaning meaning) const {
  return quantity(key, unit::dimensionless, range, fallback, meaning);
}

std::vector<double> Section::numbers(std::string_view key, const Range& range, Meaning meaning) const {
  return quantities(key, unit::dimensionless, range, meaning);
}

std::vector<std::pair<double, double>> Section::points(std::string_view key, const Unit& x_unit,
                                                       const Unit& y_unit, Meaning meaning) const {
  DeckKey described =
      key_of(key, ValueForm::points, fmt::format("list of points, {} and {}", x_unit.name, y_unit.name));
  described.kinds = {x_unit.name, y_unit.name};
  note(std::move(described), meaning);
  if (deck_->survey()) return {};
  const auto entry = require(
      *deck_, table_, key,
      fmt::format("a list of points, [[\"{}\", \"{}\"], ...], is needed", x_unit.example, y_unit.example));
  return entry ? read_points(*entry, x_unit, y_unit) : std::vector<Point>{};
}

std::optional<std::pair<double, double>> Section::place(std::string_view key, const Unit& unit,
                                                        Meaning meaning) const {
  note(places_key(key, ValueForm::place, false, unit), meaning);
  if (deck_->survey()) return std::nullopt;
  const auto entry = require(*deck_, table_, key,
                             fmt::format("a place [\"{}\", \"{}\"] is needed", unit.example, unit.example));
  return entry ? read_point(*entry, unit, unit) : std::nullopt;
}

std::vector<std::pair<double, double>> Section::places(std::string_view key, const Unit& unit,
                                                       std::size_t least, Meaning meaning) const {
  note(places_key(key, ValueForm::place, true, unit), meaning);
  if (deck_->survey()) return {};
  const std::string needed = list_of_places(least, unit);
  const auto entry = require(*deck_, table_, key, needed + " is needed");
  if (!entry) return {};
  return read_places(*entry, needed, least, [&](const Entry& one) { return read_point(one, unit, unit); });
}

std::optional<StatedPlace> Section::place(std::string_view key, const Unit& unit,
                                          const Coordinates& coordinates, Meaning meaning) const {
  note(places_key(key, ValueForm::place_in_space, false, unit), meaning);
  if (deck_->survey()) return std::nullopt;
  const auto entry = require(*deck_, table_, key,
                             fmt::format("a place [\"{}\", \"{}\"] is needed", unit.example, unit.example));
  return entry ? read_stated_place(*entry, key, unit, coordinates) : std::nullopt;
}

std::vector<StatedPlace> Section::places(std::string_view key, const Unit& unit, std::size_t least,
                                         const Coordinates& coordinates, Meaning meaning) const {
  note(places_key(key, ValueForm::place_in_space, true, unit), meaning);
  if (deck_->survey()) return {};
  const std::string needed = list_of_places(least, unit, coordinates.pair_is_along_z ? 2 : coordinates.count);
  const auto entry = require(*deck_, table_, key, needed + " is needed");
  if (!entry) return {};
  return read_places(*entry, needed, least,
                     [&](const Entry& one) { return read_stated_place(one, key, unit, coordinates); });
}

long long Section::integer(std::string_view key, const Range& range, Meaning meaning) const {
  note(integer_key(key, range), meaning);
  const auto stand_in = static_cast<long long>(range.any_value());
  if (deck_->survey()) return stand_in;
  const std::string words = range.describe();
  const auto entry =
      require(*deck_, table_, key,
              words.empty() ? "a whole number is needed" : "a whole number is needed; it must be " + words);
  return (entry ? read_integer(*entry, range) : std::nullopt).value_or(stand_in);
}

long long Section::integer(std::string_view key, const Range& range, long long fallback,
                           Meaning meaning) const {
  note(with_fallback(integer_key(key, range), fmt::format("{}", fallback)), meaning);
  const auto entry = read(*deck_, table_, key);
  return (entry ? read_integer(*entry, range) : std::nullopt).value_or(fallback);
}

bool Section::flag(std::string_view key, Meaning meaning) const {
  note(key_of(key, ValueForm::flag, "true or false"), meaning);
  if (auto* survey = deck_->survey()) return survey->is_set(table_->path, key, false);
  const auto entry = require(*deck_, table_, key, "true or false is needed");
  return (entry ? read_flag(*entry) : std::nullopt).value_or(false);
}

bool Section::flag_or(std::string_view key, bool fallback, Meaning meaning) const {
  note(with_fallback(key_of(key, ValueForm::flag, "true or false"), fmt::format("{}", fallback)), meaning);
  if (auto* survey = deck_->survey()) return survey->is_set(table_->path, key, fallback);
  const auto entry = read(*deck_, table_, key);
  return (entry ? read_flag(*entry) : std::nullopt).value_or(fallback);
}

std::string Section::text(std::string_view key, Meaning meaning) const {
  note(key_of(key, ValueForm::text, "text"), meaning);
  const auto entry = require(*deck_, table_, key, "a string is needed");
  return (entry ? read_text(*entry) : std::nullopt).value_or("");
}

std::string Section::text(std::string_view key, std::string fallback, Meaning meaning) const {
  note(with_fallback(key_of(key, ValueForm::text, "text"), fmt::format("\"{}\"", fallback)), meaning);
  const auto entry = read(*deck_, table_, key);
  return (entry ? read_text(*entry) : std::nullopt).value_or(std::move(fallback));
}

std::size_t Section::choice_index(std::string_view key, const std::vector<Word>& options,
                                  std::optional<std::size_t> fallback, std::string_view fallback_word,
                                  Meaning meaning) const {
  std::vector<std::string> words;
  for (const Word& option : options) words.push_back(option.word);
  if (auto* survey = deck_->survey()) {
    DeckKey read = key_of(key, ValueForm::word, "word");
    for (const Word& option : options)
      read.words.push_back({fmt::format("\"{}\"", option.word), std::string(option.meaning.text())});
    if (fallback) read.fallback = fmt::format("\"{}\"", fallback_word);
    note(std::move(read), meaning);
    return survey->chosen(table_->path, key, words);
  }
  const auto entry =
      fallback ? read(*deck_, table_, key) : require(*deck_, table_, key, one_of(words) + " is needed");
  if (!entry && fallback) return *fallback;
  const auto index = entry ? read_choice(*entry, words) : std::nullopt;
  if (!index && table_) table_->undecided = true;
  return index.value_or(0);
}

std::string Section::word_or_text(std::string_view key, const std::vector<Choice<int>>& options,
                                  Meaning other, Meaning meaning, std::string_view needed) const {
  if (auto* survey = deck_->survey()) {
    DeckKey read = key_of(key, ValueForm::word_or_text, "word or text");
    std::vector<std::string> asked;
    for (const auto& option : options) {
      asked.emplace_back(option.word);
      read.words.push_back({fmt::format("\"{}\"", option.word), std::string(option.meaning.text())});
    }
    read.words.push_back({"other text", std::string(other.text())});
    if (needed.empty()) read.fallback = fmt::format("\"{}\"", options.front().word);
    note(std::move(read), meaning);
    return asked[survey->chosen(table_->path, key, asked)];
  }
  const auto entry =
      needed.empty() ? read(*deck_, table_, key) : require(*deck_, table_, key, std::string(needed));
  return (entry ? read_text(*entry) : std::nullopt).value_or(std::string(options.front().word));
}

namespace {

template <class Entry>
std::vector<std::string> texts_of(const Entry& entry) {
  std::vector<std::string> list;
  if (!entry) return list;
  const auto* array = entry->node.as_array();
  if (!array) {
    const auto text = entry->node.template value<std::string>();
    entry->error(text && entry->node.is_string() ? fmt::format("must be a list of texts: [\"{}\"]", *text)
                                                 : "must be a list of texts, each in quotation marks");
    return list;
  }
  for (const auto& element : *array) {
    const auto text = element.template value<std::string>();
    if (!text) {
      entry->error("must hold texts only, each in quotation marks");
      return {};
    }
    list.push_back(*text);
  }
  return list;
}

}  // namespace

std::vector<std::string> Section::texts(std::string_view key, Meaning meaning) const {
  note(texts_key(key), meaning);
  return texts_of(require(*deck_, table_, key, "a list of texts is needed"));
}

std::vector<std::string> Section::optional_texts(std::string_view key, Meaning meaning) const {
  note(with_fallback(texts_key(key), "[]"), meaning);
  return texts_of(read(*deck_, table_, key));
}

namespace {

std::string json_of(const toml::node& node) {
  std::ostringstream text;
  text << toml::json_formatter(node);
  return text.str();
}

}  // namespace

std::string Section::json(std::string_view key, std::string_view value, Meaning meaning) const {
  note(key_of(key, ValueForm::anything, std::string(value)), meaning);
  const auto entry = require(*deck_, table_, key, fmt::format("{} is needed", value));
  return entry ? json_of(entry->node) : "null";
}

std::string Section::json(std::string_view key, std::string_view value, const std::string& fallback,
                          Meaning meaning) const {
  note(with_fallback(key_of(key, ValueForm::anything, std::string(value)), fallback), meaning);
  const auto entry = read(*deck_, table_, key);
  return entry ? json_of(entry->node) : fallback;
}

std::vector<std::string> Section::keys() const {
  std::vector<std::string> all;
  if (auto* survey = deck_->survey()) {
    survey->described_table(table_->path).may_lack_all = true;
    return all;
  }
  if (!table_) return all;
  for (const auto& [key, node] : table_->table) all.emplace_back(key.str());
  return all;
}

bool Section::has(std::string_view key) const {
  if (auto* survey = deck_->survey()) {
    survey->know(table_->path, key);
    return survey->is_present(table_->path, key);
  }
  return table_ && table_->look(key);
}

void Section::know(std::initializer_list<std::string_view> keys) const {
  for (const auto key : keys)
    if (auto* survey = deck_->survey())
      survey->know(table_->path, key);
    else
      has(key);
}

bool Section::is_table(std::string_view key) const {
  if (auto* survey = deck_->survey()) {
    survey->know(table_->path, key);
    return survey->is_table(table_->path, key);
  }
  const toml::node* node = table_ ? table_->look(key) : nullptr;
  return node && node->is_table();
}

void Section::take_names_of_deck() const {
  if (auto* survey = deck_->survey()) survey->described_table(table_->path).has_names_of_deck = true;
}

void Section::take_any_keys() const {
  if (auto* survey = deck_->survey()) survey->described_table(table_->path).has_any_keys = true;
}

void Section::take_keys_of_code(std::string_view key) const {
  if (auto* survey = deck_->survey()) survey->described_table(table_->path).code_key = key;
}

void Section::leave_open() const {
  if (table_) table_->undecided = true;
}

void Section::describe(std::string_view key, const KeyForms& forms, Meaning meaning) const {
  auto* survey = deck_->survey();
  if (!survey) return;
  DeckKey read = key_of(key, forms.form, forms.value);
  if (forms.form == ValueForm::quantity) read.kinds = {forms.unit.name};
  read.forms = forms.name;
  read.optional = forms.optional;
  read.unit = suffix(forms.unit);
  read.range = forms.range;
  if (forms.fallback) read.fallback = fallback_text(*forms.fallback, forms.unit);
  read.meaning = meaning.text();
  survey->read_in_forms(table_->path, std::move(read), forms.name);
}

void Section::note(DeckKey key, Meaning meaning) const {
  auto* survey = deck_->survey();
  if (!survey) return;
  if (!defaults_of_.empty() && !key.fallback.empty()) key.fallback = fmt::format("as in [{}]", defaults_of_);
  key.meaning = meaning.text();
  survey->read(table_->path, std::move(key));
}

bool Section::ok() const {
  return table_ && deck_->is_clean(table_->path);
}

void Section::error(std::string_view key, std::string message) const {
  if (const auto entry = read(*deck_, table_, key)) {
    entry->error(std::move(message));
  } else if (table_) {
    deck_->report(*table_, table_->path_of(key), std::move(message));
  }
}

void Section::error(std::string message) const {
  if (table_) deck_->report(*table_, table_->path, std::move(message));
}

void Section::warn(std::string_view key, std::string message) const {
  if (table_ && !deck_->survey()) deck_->warn(*table_, key, std::move(message));
}

void Section::warn_if_unusual(std::string_view key, double value, const Unit& unit,
                              const Range& range) const {
  if (!range.is_usual(value)) warn(key, unusual(value, range, suffix(unit)));
}

void Section::names_file(std::string_view key, std::filesystem::path file, std::string rest) const {
  if (table_ && !deck_->survey()) deck_->add_file({table_->path_of(key), std::move(file), std::move(rest)});
}

void Section::needs_file(std::filesystem::path file) const {
  if (table_ && !deck_->survey()) deck_->add_file({{}, std::move(file), {}});
}

std::string Section::where(std::string_view key) const {
  if (!table_) return deck_->name();
  const toml::node* node = table_->table.get(key);
  return deck_->where(*table_, key, node ? *node : table_->table);
}

bool Section::is_changed(std::string_view key) const {
  return table_ && deck_->is_changed(table_->path_of(key));
}

std::string Section::path() const {
  return table_ ? table_->path : "";
}

}  // namespace pyroclast
