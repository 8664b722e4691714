#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pyroclast/deck/reading.hpp"
#include "pyroclast/deck/survey.hpp"

namespace pyroclast {

/// Question that a reader asks of a deck, and whose answer may decide the next questions.
struct SurveyQuestion {
  enum class Kind : std::uint8_t { present, is_table, word, flag };

  std::string table, key;
  Kind kind = Kind::present;

  auto operator<=>(const SurveyQuestion&) const = default;
};

/// Answers by question, as indices into the possible answers.
using SurveyAnswers = std::map<SurveyQuestion, std::size_t>;

/// One call of a reader with a deck that has no text: answers the reader's questions and keeps them. Private
/// to this module.
class SurveyRun {
 public:
  /// Question, its answer, and all possible answers as a deck has them.
  struct Answered {
    SurveyQuestion question;
    std::size_t answer = 0;
    std::vector<std::string> possible;
  };
  /// Key that was read, and the number of answers given before.
  struct Read {
    std::string table;
    DeckKey key;
    std::size_t after = 0;
  };

  explicit SurveyRun(SurveyAnswers given) : given_(std::move(given)) {}

  bool is_present(const std::string& table, std::string_view key);
  bool is_table(const std::string& table, std::string_view key);
  bool is_set(const std::string& table, std::string_view key, bool usual);
  std::size_t chosen(const std::string& table, std::string_view key, const std::vector<std::string>& words);

  void know(const std::string& table, std::string_view key);
  void read(const std::string& table, DeckKey key);
  /// Notes a key that is read in several forms, in place of the calls of `read` that follow.
  /// \param forms  name under which the tables at and below the key are described; may be empty
  void read_in_forms(const std::string& table, DeckKey key, const std::string& forms);
  /// Notes a table that must be there, by its table and its name, which ends with "[]" for an array.
  void need_table(const std::string& table, std::string_view name);
  /// Returns the description of a table that was asked for.
  DeckTable& described_table(const std::string& path);
  /// Returns the table at a path; array elements have the path of their array with "[]".
  TableReading& table(const std::string& path, bool optional, std::string_view meaning);

  const std::vector<Answered>& answered() const { return answered_; }
  const std::vector<Read>& keys_read() const { return read_; }
  const std::vector<DeckTable>& tables() const { return tables_; }
  const std::vector<std::pair<std::string, std::string>>& known() const { return known_; }

 private:
  /// \param usual  answer where none was given
  std::size_t answer(const std::string& table, std::string_view key, SurveyQuestion::Kind kind,
                     std::vector<std::string> possible, std::size_t usual);
  /// Returns the path under which a table is described.
  std::string described(const std::string& path) const;

  SurveyAnswers given_;
  std::vector<Answered> answered_;
  std::map<SurveyQuestion, std::size_t> place_;  ///< place of each question among those that are answered
  std::vector<Read> read_;
  std::vector<DeckTable> tables_;
  std::vector<std::pair<std::string, std::string>> known_;  ///< table and key of each known key
  std::map<std::string, std::string> forms_;                ///< name of the forms, by the path of the key
  std::map<std::string, std::unique_ptr<TableReading>> readings_;
};

}  // namespace pyroclast
