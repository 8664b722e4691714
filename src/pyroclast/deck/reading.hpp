#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "pyroclast/deck/deck.hpp"
#include "pyroclast/deck/diagnostic.hpp"
#include "pyroclast/deck/source_text.hpp"

namespace pyroclast {

class SurveyRun;

/// What is known about one table: its place in the deck, and what its reader asked for.
struct TableReading {
  struct Asked {
    std::string key;
    bool read = false;  ///< false while the reader has only looked whether it is there
  };

  const toml::table& table;
  std::string path;
  std::vector<Asked> asked;  ///< in the order of asking, each key once
  bool undecided = false;    ///< a choice could not be read, so which keys belong here is not known

  /// The node of a key that is now known, null if it is absent.
  const toml::node* look(std::string_view key);
  /// The same for a key whose value the reader takes.
  const toml::node* read(std::string_view key);
  std::vector<std::string> known_keys() const;
  std::string path_of(std::string_view key) const;

 private:
  Asked& ask(std::string_view key);
};

/// The files that a deck's text comes from, for messages.
struct DeckSource {
  std::string name = {};           ///< of the deck
  std::string appended_name = {};  ///< of the file whose text ends the deck's; empty where there is none
  int appended_lines = 0;
};

/// A deck while it is read: the text, its tree, and the errors so far. Private to this module.
class DeckReading {
 public:
  /// @throws DeckError
  /// \param changed  keys whose values come from the command line: what is said of them names --set
  DeckReading(std::string text, DeckSource from, std::vector<std::string> changed = {});
  /// A deck without text; `survey` answers what its reader asks, and no error is kept.
  explicit DeckReading(SurveyRun& survey);

  /// Null but for a survey.
  SurveyRun* survey() const { return survey_; }
  const std::string& name() const { return from_.name; }
  const DeckSource& from() const { return from_; }
  const std::string& text() const { return source_.text(); }

  TableReading& root();
  /// The record of a table, the same at each call.
  TableReading& table(const toml::table& table, const std::string& path);

  /// The text with another value at a path such as "stages[1].rate". A key that is missing is added in its
  /// table; a table that is missing, too. Throws Error where that cannot be done.
  std::string with_value(std::string_view path, const std::string& value) const;

  bool is_changed(const std::string& path) const {
    return std::ranges::find(changed_, path) != changed_.end();
  }
  void add_file(DeckFile file) { files_.push_back(std::move(file)); }
  const std::vector<DeckFile>& files() const { return files_; }

  /// An error at a value.
  void report(const std::string& path, const toml::node& node, std::string message, std::string hint = {});
  /// An error of a table, such as a missing key of the given path.
  /// A key that the table must have.
  void report_missing(const TableReading& table, std::string_view key, const std::string& needed);
  void report(const TableReading& table, const std::string& path, std::string message);
  /// Something that is allowed, but most likely not meant, at a value; a key that is absent stands for its
  /// table.
  void warn(const TableReading& table, std::string_view key, std::string message);
  void warn(const std::string& path, const toml::node& node, std::string message);
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  /// Whether nothing was reported at or below a path; false in a survey.
  bool is_clean(std::string_view path) const;

  /// "file:line" of a value, or "--set".
  std::string where(const TableReading& table, std::string_view key, const toml::node& node) const;

  /// What was reported, and a report of each key that nobody read.
  std::vector<Diagnostic> diagnostics() const;

 private:
  std::string with_new_key(std::string_view path, const std::string& value) const;
  Diagnostic at_value(const std::string& path, const toml::node& node, std::string message) const;
  Diagnostic locate(const std::string& path, const toml::source_region& region) const;
  std::string as_written(const toml::node& node) const;
  Diagnostic not_read(const TableReading& table, const toml::key& key, const toml::node& node) const;
  void append_unread(const TableReading& table, std::vector<Diagnostic>& result) const;
  /// The table that knows the key, as a hint; empty if none does.
  std::string misplaced_hint(const TableReading& table, std::string_view key) const;

  DeckSource from_;
  std::vector<std::string> changed_;
  SourceText source_;
  toml::table root_;
  std::map<const toml::table*, std::unique_ptr<TableReading>> tables_;
  std::vector<const TableReading*> tables_as_read_;
  std::vector<Diagnostic> diagnostics_;
  std::vector<Diagnostic> warnings_;
  std::vector<DeckFile> files_;
  SurveyRun* survey_ = nullptr;
};

}  // namespace pyroclast
