#include "pyroclast/deck/reading.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/nearest.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/deck/key_path.hpp"
#include "pyroclast/deck/survey_run.hpp"
#include "pyroclast/deck/toml_characters.hpp"

namespace pyroclast {
namespace {

SourcePosition position(const toml::source_position& place) {
  return {static_cast<int>(place.line), static_cast<int>(place.column)};
}

std::string_view without_leading_spaces(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
  return text;
}

/// Tells whether a line's value, or the first of a list, is a number and a unit that should stand in quotes.
bool has_unquoted_quantity(std::string_view line) {
  line.remove_prefix(std::min(line.find('=') + 1, line.size()));
  line.remove_prefix(std::min(line.find_first_not_of(" \t["), line.size()));
  double number = 0.0;
  const auto [end, status] = std::from_chars(line.data(), line.data() + line.size(), number);
  if (status != std::errc{}) return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  line = without_leading_spaces(line);
  return !line.empty() && std::string_view("#,]\"'0123456789_=").find(line[0]) == std::string_view::npos;
}

/// Line of one of the files that a deck's text comes from.
struct FileLine {
  const std::string& file;
  int line;
};

FileLine in_file(const DeckSource& from, const SourceText& source, int line) {
  const int own = source.line_count() - from.appended_lines;
  if (from.appended_name.empty() || line <= own) return {from.name, line};
  return {from.appended_name, line - own};
}

toml::table parse_toml(const SourceText& source, const DeckSource& from) {
  const auto fail = [&](SourcePosition at, std::string message, std::string hint) {
    const auto [file, line] = in_file(from, source, at.line);
    throw DeckError({Diagnostic{.file = file,
                                .line = line,
                                .column = at.column,
                                .message = std::move(message),
                                .hint = std::move(hint)}});
  };
  const auto fail_to_parse = [&](SourcePosition at, std::string_view what) {
    const bool unquoted = has_unquoted_quantity(source.line(at.line));
    const bool escapes = what.find("escape sequence") != std::string_view::npos;
    fail(at, fmt::format("not valid TOML: {}", what),
         unquoted  ? "a value with a unit stands in quotes, e.g. \"150 mm\""
         : escapes ? std::string(kPathsInToml)
                   : "");
  };
  if (const auto fault = character_fault(source.text())) fail_to_parse(fault->at, fault->what);
  toml::table root;
  try {
    root = toml::parse(source.text());
  } catch (const toml::parse_error& error) {
    fail_to_parse(position(error.source().begin), error.description());
  }
  if (root.empty()) fail({1, 1}, "the file is empty", "");
  return root;
}

/// Reads a text as TOML; returns none if it is not TOML.
std::optional<toml::table> try_toml(const std::string& text) {
  if (character_fault(text)) return std::nullopt;
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

/// Returns a value as TOML. A value that is not TOML as it stands, such as 5 us, becomes a string.
std::string as_toml(const std::string& value) {
  const auto table = try_toml("value = " + value);
  if (table && table->size() == 1) return value;
  return fmt::format("\"{}\"", value);
}

bool is_table_like(const toml::node& node) {
  return node.is_table() || node.is_array_of_tables();
}

std::string in_brackets(const std::string& path) {
  return path.empty() ? "at the top of the deck" : fmt::format("in [{}]", path);
}

}  // namespace

TableReading::Asked& TableReading::ask(std::string_view key) {
  const auto found = std::find_if(asked.begin(), asked.end(), [&](const Asked& a) { return a.key == key; });
  return found != asked.end() ? *found : asked.emplace_back(Asked{std::string(key)});
}

const toml::node* TableReading::look(std::string_view key) {
  ask(key);
  return table.get(key);
}

const toml::node* TableReading::read(std::string_view key) {
  ask(key).read = true;
  return table.get(key);
}

std::vector<std::string> TableReading::known_keys() const {
  std::vector<std::string> keys;
  for (const Asked& a : asked) keys.push_back(a.key);
  return keys;
}

std::string TableReading::path_of(std::string_view key) const {
  return joined_path(path, key);
}

DeckReading::DeckReading(std::string text, DeckSource from, std::vector<std::string> changed)
    : from_(std::move(from)),
      changed_(std::move(changed)),
      source_(std::move(text)),
      root_(parse_toml(source_, from_)) {}

DeckReading::DeckReading(SurveyRun& survey) : from_{"survey"}, source_(""), survey_(&survey) {}

TableReading& DeckReading::root() {
  return survey_ ? survey_->table("", false, "") : table(root_, "");
}

TableReading& DeckReading::table(const toml::table& table, const std::string& path) {
  auto& reading = tables_[&table];
  if (!reading) {
    reading.reset(new TableReading{.table = table, .path = path, .asked = {}});
    tables_as_read_.push_back(reading.get());
  }
  return *reading;
}

void DeckReading::report(const std::string& path, const toml::node& node, std::string message,
                         std::string hint) {
  if (survey_) return;
  Diagnostic diagnostic = at_value(path, node, std::move(message));
  diagnostic.hint = std::move(hint);
  diagnostics_.push_back(std::move(diagnostic));
}

void DeckReading::warn(const std::string& path, const toml::node& node, std::string message) {
  if (!survey_) warnings_.push_back(at_value(path, node, std::move(message)));
}

void DeckReading::warn(const TableReading& table, std::string_view key, std::string message) {
  const toml::node* node = table.table.get(key);
  warn(table.path_of(key), node ? *node : table.table, std::move(message));
}

void DeckReading::report(const TableReading& table, const std::string& path, std::string message) {
  if (survey_) return;
  Diagnostic diagnostic = locate(path, table.table.source());
  diagnostic.message = std::move(message);
  diagnostics_.push_back(std::move(diagnostic));
}

void DeckReading::report_missing(const TableReading& table, std::string_view key, const std::string& needed) {
  if (survey_) return;
  report(table, table.path_of(key), "missing; " + needed);
  diagnostics_.back().is_missing = true;
}

std::string DeckReading::with_value(std::string_view path, const std::string& value) const {
  const std::string written = as_toml(value);
  const auto node = root_.at_path(path);
  if (!node) return with_new_key(path, written);
  const auto* table = node.as_table();
  if (node.is_array_of_tables() || (table && !table->is_inline()))
    throw Error(
        fmt::format("--set {}={}: {} is a table of {}; name one of its keys", path, value, path, name()));
  const auto& region = node.node()->source();
  return source_.replaced(position(region.begin), position(region.end), written);
}

/// Returns the text with a new key in the nearest table that there is: within its braces, below its header,
/// or below a new header at the end. Where none of these fits, the key stands with its full path above all.
std::string DeckReading::with_new_key(std::string_view path, const std::string& value) const {
  const auto fits = [&](const std::string& text) {
    const auto table = try_toml(text);
    return table && table->at_path(path);
  };
  for (std::string_view above = path; above.find('.') != std::string_view::npos;) {
    above = above.substr(0, above.rfind('.'));
    const auto table = root_.at_path(above);
    if (!table.is_table()) continue;
    const std::string_view key = path.substr(above.size() + 1);
    const SourcePosition begin = position(table.node()->source().begin);
    const int line = begin.line;
    if (table.as_table()->is_inline()) {
      const SourcePosition within{line, begin.column + 1};  // behind the brace
      const auto* comma = table.as_table()->empty() ? "" : ",";
      const std::string text = source_.replaced(within, within, fmt::format(" {} = {}{}", key, value, comma));
      if (fits(text)) return text;
    }
    const SourcePosition end{line, static_cast<int>(source_.line(line).size()) + 1};
    for (const std::string& text : {source_.replaced(end, end, fmt::format("\n{} = {}", key, value)),
                                    fmt::format("{}\n[{}]\n{} = {}\n", source_.text(), above, key, value)})
      if (fits(text)) return text;
  }
  if (const auto text = fmt::format("{} = {}\n{}", path, value, source_.text()); fits(text)) return text;
  throw Error(fmt::format("--set {}={}: there is no place for this key in {}", path, value, name()));
}

bool DeckReading::is_clean(std::string_view path) const {
  return !survey_ && std::none_of(diagnostics_.begin(), diagnostics_.end(),
                                  [&](const Diagnostic& d) { return is_at_or_below(d.key, path); });
}

std::vector<Diagnostic> DeckReading::diagnostics() const {
  std::vector<Diagnostic> result = diagnostics_;
  for (const TableReading* table : tables_as_read_) append_unread(*table, result);
  std::set<std::string> meant;
  for (const Diagnostic& d : result)
    if (!d.meant.empty()) meant.insert(d.meant);
  std::erase_if(result, [&](const Diagnostic& d) { return d.is_missing && meant.contains(d.key); });
  // A key that several readers miss is one error.
  std::set<std::string> said;
  std::erase_if(result, [&](const Diagnostic& d) { return !said.insert(to_string(d)).second; });
  return result;
}

void DeckReading::append_unread(const TableReading& table, std::vector<Diagnostic>& result) const {
  for (auto&& [key, node] : table.table) {
    const std::string_view name = key.str();
    const bool read = std::any_of(table.asked.begin(), table.asked.end(),
                                  [&](const TableReading::Asked& a) { return a.read && a.key == name; });
    if (read) continue;
    Diagnostic diagnostic = not_read(table, key, node);
    if (table.undecided && diagnostic.hint.empty()) continue;
    result.push_back(std::move(diagnostic));
  }
}

Diagnostic DeckReading::not_read(const TableReading& table, const toml::key& key,
                                 const toml::node& node) const {
  const std::string name(key.str());
  Diagnostic diagnostic = locate(table.path_of(name), key.source());
  diagnostic.value = as_written(node);
  const std::vector<std::string> known = table.known_keys();
  if (std::find(known.begin(), known.end(), name) != known.end()) {
    diagnostic.message = "has no effect with the other settings of this deck";
    return diagnostic;
  }
  diagnostic.message = is_table_like(node) ? "unknown table" : "unknown key";
  if (const auto near = nearest(name, known)) {
    diagnostic.hint = did_you_mean(name, known);
    diagnostic.meant = table.path_of(known[*near]);
    return diagnostic;
  }
  diagnostic.message += known.empty()
                            ? fmt::format("; no keys are allowed {}", in_brackets(table.path))
                            : fmt::format("; allowed {}: {}", in_brackets(table.path), quoted_list(known));
  diagnostic.hint = misplaced_hint(table, name);
  return diagnostic;
}

std::string DeckReading::misplaced_hint(const TableReading& table, std::string_view key) const {
  for (const TableReading* other : tables_as_read_) {
    if (other == &table) continue;
    const std::vector<std::string> known = other->known_keys();
    if (std::find(known.begin(), known.end(), key) == known.end()) continue;
    return fmt::format("\"{}\" belongs {}", key, in_brackets(other->path));
  }
  return {};
}

Diagnostic DeckReading::at_value(const std::string& path, const toml::node& node, std::string message) const {
  Diagnostic diagnostic = locate(path, node.source());
  diagnostic.value = as_written(node);
  diagnostic.message = std::move(message);
  return diagnostic;
}

Diagnostic DeckReading::locate(const std::string& path, const toml::source_region& region) const {
  const SourcePosition at = position(region.begin);
  const auto [file, line] = in_file(from_, source_, at.line);
  return {.file = is_changed(path) ? "--set" : file,
          .line = line,
          .column = at.column,
          .is_changed = is_changed(path),
          .key = path};
}

std::string DeckReading::where(const TableReading& table, std::string_view key,
                               const toml::node& node) const {
  const Diagnostic place = locate(table.path_of(key), node.source());
  return place.is_changed ? place.file : fmt::format("{}:{}", place.file, place.line);
}

std::string DeckReading::as_written(const toml::node& node) const {
  if (is_table_like(node)) return {};
  return source_.excerpt(position(node.source().begin), position(node.source().end));
}

}  // namespace pyroclast
