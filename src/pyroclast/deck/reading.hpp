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

/// Knowledge about one table: its place in the deck, and the keys for which its reader asked.
struct TableReading {
  struct Asked {
    std::string key;
    bool read = false;  ///< false while the reader has only looked whether the key is there
  };

  const toml::table& table;
  std::string path;
  std::vector<Asked> asked;  ///< keys in the order of asking, each once
  /// True where a choice could not be read, so that the keys that belong here are not known.
  bool undecided = false;

  /// Makes a key known and returns its node, null if the key is absent.
  const toml::node* look(std::string_view key);
  /// Makes a key known whose value the reader takes, and returns its node.
  const toml::node* read(std::string_view key);
  std::vector<std::string> known_keys() const;
  std::string path_of(std::string_view key) const;

 private:
  Asked& ask(std::string_view key);
};

/// Files from which a deck's text comes, for messages.
struct DeckSource {
  std::string name = {};           ///< name of the deck
  std::string appended_name = {};  ///< name of the file whose text ends the deck; empty where there is none
  int appended_lines = 0;
};

/// Deck while it is read: the text, its tree, and the errors so far. Private to this module.
class DeckReading {
 public:
  /// @throws DeckError
  /// \param changed  keys whose values come from the command line; messages about them name --set
  DeckReading(std::string text, DeckSource from, std::vector<std::string> changed = {});
  /// Makes a deck without text; `survey` answers the questions of the reader, and no error is kept.
  explicit DeckReading(SurveyRun& survey);

  /// Returns the survey; null outside a survey.
  SurveyRun* survey() const { return survey_; }
  const std::string& name() const { return from_.name; }
  const DeckSource& from() const { return from_; }
  const std::string& text() const { return source_.text(); }

  TableReading& root();
  /// Returns what is known about a table; the same object at each call.
  TableReading& table(const toml::table& table, const std::string& path);

  /// Returns the text with another value at a path such as "stages[1].rate". A key that is missing is added
  /// in its table; a table that is missing is added too. Throws Error where that cannot be done.
  std::string with_value(std::string_view path, const std::string& value) const;

  bool is_changed(const std::string& path) const {
    return std::ranges::find(changed_, path) != changed_.end();
  }
  void add_file(DeckFile file) { files_.push_back(std::move(file)); }
  const std::vector<DeckFile>& files() const { return files_; }

  /// Reports an error at a value.
  void report(const std::string& path, const toml::node& node, std::string message, std::string hint = {});
  /// Reports that a table lacks a key that it must have.
  void report_missing(const TableReading& table, std::string_view key, const std::string& needed);
  /// Reports an error of a table, or of a path in it.
  void report(const TableReading& table, const std::string& path, std::string message);
  /// Warns of a value that is allowed but most likely not meant; for an absent key the warning stands at its
  /// table.
  void warn(const TableReading& table, std::string_view key, std::string message);
  void warn(const std::string& path, const toml::node& node, std::string message);
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  /// Tells whether nothing was reported at or below a path; false in a survey.
  bool is_clean(std::string_view path) const;

  /// Returns the place of a value as "file:line", or "--set".
  std::string where(const TableReading& table, std::string_view key, const toml::node& node) const;

  const std::vector<Diagnostic>& reported() const { return diagnostics_; }
  /// Returns everything that was reported, and a report of each key that nobody read.
  std::vector<Diagnostic> diagnostics() const;

 private:
  std::string with_new_key(std::string_view path, const std::string& value) const;
  Diagnostic at_value(const std::string& path, const toml::node& node, std::string message) const;
  Diagnostic locate(const std::string& path, const toml::source_region& region) const;
  std::string as_written(const toml::node& node) const;
  Diagnostic not_read(const TableReading& table, const toml::key& key, const toml::node& node) const;
  void append_unread(const TableReading& table, std::vector<Diagnostic>& result) const;
  /// Returns a hint that names the table that knows the key; empty if no table does.
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
