#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/deck/editor_schema.hpp"
#include "pyroclast/deck/reference.hpp"
#include "pyroclast/python/bindings.hpp"
#include "pyroclast/python/errors.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast::python {

namespace {

using Number = std::optional<double>;

/// Section that keeps its file.
struct Table {
  std::shared_ptr<const Deck> file;
  Section section;

  std::vector<Table> with(const std::vector<Section>& sections) const {
    std::vector<Table> tables;
    for (const Section& s : sections) tables.push_back({file, s});
    return tables;
  }
};

Meaning meant(const std::string& text) {
  return Meaning(std::string_view(text));
}

Range range_of(Number least, Number most) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  return Range::between(least.value_or(-infinite), most.value_or(infinite));
}

const Unit& unit_of(const std::string& si) {
  for (const Unit* kind : unit::all)
    if (si == kind->si) return *kind;
  throw Error(si + ": is no SI unit of a quantity that files hold");
}

std::string choice(const Table& table, const std::string& key,
                   const std::vector<std::pair<std::string, std::string>>& words, bool is_optional,
                   const std::string& meaning) {
  std::vector<Choice<std::size_t>> options;
  for (std::size_t i = 0; i < words.size(); ++i)
    options.push_back({words[i].first, i, meant(words[i].second)});
  const std::size_t chosen = is_optional ? table.section.choice_or_first(key, options, meant(meaning))
                                         : table.section.choice(key, options, meant(meaning));
  return words[chosen].first;
}

double quantity(const Table& t, const std::string& key, const std::string& unit, const std::string& meaning,
                Number least, Number most, Number fallback) {
  const Range range = range_of(least, most);
  return fallback ? t.section.quantity(key, unit_of(unit), range, *fallback, meant(meaning))
                  : t.section.quantity(key, unit_of(unit), range, meant(meaning));
}

double number(const Table& t, const std::string& key, const std::string& meaning, Number least, Number most,
              Number fallback) {
  return quantity(t, key, "1", meaning, least, most, fallback);
}

long long integer(const Table& t, const std::string& key, const std::string& meaning, Number least,
                  Number most, std::optional<long long> fallback) {
  const Range range = range_of(least, most);
  return fallback ? t.section.integer(key, range, *fallback, meant(meaning))
                  : t.section.integer(key, range, meant(meaning));
}

std::string text(const Table& t, const std::string& key, const std::string& meaning,
                 const std::optional<std::string>& fallback) {
  return fallback ? t.section.text(key, *fallback, meant(meaning)) : t.section.text(key, meant(meaning));
}

void bind_table(py::module_& m) {
  using py::arg;
  using Text = std::string;
  const auto none = py::none();
  py::class_<Table>(m, "Table", "One table of a TOML file.")
      .def(
          "table",
          [](const Table& t, const Text& key, const Text& meaning) {
            return Table{t.file, t.section.section(key, meant(meaning))};
          },
          arg("key"), arg("meaning"))
      .def(
          "optional_table",
          [](const Table& t, const Text& key, const Text& meaning) {
            const auto section = t.section.optional_section(key, meant(meaning));
            return section ? std::optional(Table{t.file, *section}) : std::nullopt;
          },
          arg("key"), arg("meaning"))
      .def(
          "optional_tables",
          [](const Table& t, const Text& key, const Text& meaning) {
            return t.with(t.section.optional_sections(key, meant(meaning)));
          },
          arg("key"), arg("meaning"))
      .def(
          "named_tables",
          [](const Table& t, const Text& placeholder, const Text& meaning) {
            std::vector<std::pair<std::string, Table>> named;
            for (const auto& [name, section] : t.section.named_sections(placeholder, meant(meaning)))
              named.emplace_back(name, Table{t.file, section});
            return named;
          },
          arg("placeholder"), arg("meaning"))
      .def("keys",
           [](const Table& t) {
             t.section.take_any_keys();
             return t.section.keys();
           })
      .def("quantity", &quantity, arg("key"), arg("unit"), arg("meaning"), arg("least") = none,
           arg("most") = none, arg("fallback") = none)
      .def("number", &number, arg("key"), arg("meaning"), arg("least") = none, arg("most") = none,
           arg("fallback") = none)
      .def("integer", &integer, arg("key"), arg("meaning"), arg("least") = none, arg("most") = none,
           arg("fallback") = none)
      .def(
          "flag",
          [](const Table& t, const Text& key, const Text& meaning, bool fallback) {
            return t.section.flag(key, fallback, meant(meaning));
          },
          arg("key"), arg("meaning"), arg("fallback"))
      .def("text", &text, arg("key"), arg("meaning"), arg("fallback") = none)
      .def(
          "texts",
          [](const Table& t, const Text& key, const Text& meaning, bool is_optional) {
            return is_optional ? t.section.optional_texts(key, meant(meaning))
                               : t.section.texts(key, meant(meaning));
          },
          arg("key"), arg("meaning"), arg("is_optional"))
      .def("choice", &choice, arg("key"), arg("words"), arg("is_optional"), arg("meaning"))
      .def(
          "json",
          [](const Table& t, const Text& key, const Text& value, const Text& meaning) {
            return t.section.json(key, value, meant(meaning));
          },
          arg("key"), arg("value"), arg("meaning"))
      .def(
          "has", [](const Table& t, const Text& key) { return t.section.has(key); }, arg("key"))
      .def(
          "know",
          [](const Table& t, const std::vector<Text>& keys) {
            for (const Text& key : keys) t.section.know({key});
          },
          arg("keys"))
      .def("ok", [](const Table& t) { return t.section.ok(); })
      .def(
          "error",
          [](const Table& t, const Text& key, const Text& message) {
            key.empty() ? t.section.error(message) : t.section.error(key, message);
          },
          arg("key"), arg("message"))
      .def(
          "where", [](const Table& t, const Text& key) { return t.section.where(key); }, arg("key"));
}

/// Reads a cell as Python's `float` reads it; returns false where `float` would read it otherwise, or the
/// number is not finite.
bool read_cell(const char* begin, const char* end, double largest, double& value) {
  if (begin == end) {
    value = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  const auto [stop, error] = std::from_chars(begin, end, value);
  return error == std::errc{} && stop == end && std::abs(value) <= largest;
}

/// Reads whole lines of a table of numbers: (columns, rows), NaN where a cell is empty. Returns None where a
/// line is anything else: then the caller reads it cell by cell, and says what is wrong.
py::object read_rows(const py::bytes& lines, py::ssize_t columns, double largest) {
  const std::string_view text = lines;
  const auto rows = static_cast<py::ssize_t>(std::ranges::count(text, '\n'));
  if (columns < 1 || text.empty() || text.back() != '\n') return py::none();
  py::array_t<double> table({columns, rows});
  double* const cells = table.mutable_data();
  const char* at = text.data();
  for (py::ssize_t row = 0; row < rows; ++row)
    for (py::ssize_t column = 0; column < columns; ++column) {
      const char* end = at;
      while (*end != ',' && *end != '\n') ++end;
      const bool is_last = column + 1 == columns;
      if ((*end == '\n') != is_last || (columns == 1 && end == at)) return py::none();
      if (!read_cell(at, end, largest, cells[column * rows + row])) return py::none();
      at = end + 1;
    }
  return table;
}

}  // namespace

void bind_tables(py::module_& m) {
  m.def("read_rows", &read_rows, py::arg("lines"), py::arg("columns"), py::arg("largest"),
        "Whole lines of numbers, (columns, rows); None where they are anything else.");
  bind_table(m);
  using File = std::shared_ptr<const Deck>;
  struct TomlFile {
    File deck;
  };
  py::class_<TomlFile>(m, "TomlFile", "A TOML file whose reader asks for the keys that it knows.")
      .def(py::init([](const std::string& file) {
             return TomlFile{std::make_shared<const Deck>(Deck::open(file))};
           }),
           py::arg("file"))
      .def("root",
           [](const TomlFile& file) {
             return Table{file.deck, file.deck->root()};
           })
      .def("finish", [](const TomlFile& file) { file.deck->finish(); });
  const auto survey = [](const py::function& read) {
    return survey_deck([&](const Deck& deck) {
      read(TomlFile{File(&deck, [](const Deck*) {})});  // lives as long as this call
    });
  };
  m.def(
      "reference_of", [survey](const py::function& read) { return deck_reference(survey(read)); },
      py::arg("read"), "All that a reader of a TomlFile asks for, as Markdown.");
  m.def(
      "schema_of",
      [survey](const py::function& read, const std::string& title) {
        return editor_schema(survey(read), title);
      },
      py::arg("read"), py::arg("title"), "The same as a JSON Schema (draft 4).");
  m.def(
      "did_you_mean",
      [](const std::string& text, const std::vector<std::string>& words) {
        return did_you_mean(text, words);
      },
      py::arg("text"), py::arg("words"), "Names the nearest word; empty if none is near.");
}

}  // namespace pyroclast::python
