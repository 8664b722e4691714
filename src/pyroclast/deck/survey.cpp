#include "pyroclast/deck/survey.hpp"

#include <algorithm>
#include <bitset>
#include <deque>
#include <iterator>
#include <set>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/deck/key_path.hpp"
#include "pyroclast/deck/survey_run.hpp"

namespace pyroclast {
namespace {

const toml::table& no_table() {
  static const toml::table none;
  return none;
}

/// Returns the parts in which two readings of a key must agree to be the same, one behind the other.
std::string content(const SurveyRun::Read& r) {
  std::string all;
  all.reserve(256);
  const auto add = [&](const std::string& part) { all.append(part).push_back('\0'); };
  for (const std::string* part :
       {&r.key.key, &r.table, &r.key.value, &r.key.unit, &r.key.fallback, &r.key.meaning})
    add(*part);
  const Range& range = r.key.range;
  for (const double end : {range.lower, range.upper, range.usual_lower, range.usual_upper})
    all.append(reinterpret_cast<const char*>(&end), sizeof end);
  all.push_back(static_cast<char>(r.key.form));
  for (const DeckWord& w : r.key.words) {
    add(w.word);
    add(w.meaning);
  }
  return all;
}

/// Numbers of things in the order of meeting them.
template <class Map>
class Numbers {
 public:
  /// Returns the number of a thing, and whether the thing is new.
  std::pair<int, bool> of(const typename Map::key_type& thing) {
    const auto [known, is_new] = numbers_.emplace(thing, static_cast<int>(numbers_.size()));
    return {known->second, is_new};
  }

 private:
  Map numbers_;
};

constexpr std::size_t kNotAsked = -1;

using AnswerSet = std::bitset<64>;  ///< answers to one question, by number
bool has(const AnswerSet& set, std::size_t answer) {
  return answer < set.size() && set[answer];
}

/// Record of one run, of thousands. Questions and keys have the numbers of the surveyor, which keeps their
/// texts once.
struct Told {
  struct Answered {
    int question = 0;
    std::size_t answer = 0;
    const std::vector<std::string>* possible = nullptr;
  };
  struct Read {
    int key = 0;
    std::size_t after = 0;  ///< number of answers before
  };

  std::vector<Answered> answered;
  std::vector<Read> read;
  std::vector<std::size_t> answers;  ///< answers by question; kNotAsked or beyond the end: it was not asked
  std::vector<bool> keys;            ///< true for each key that was read, by its number

  std::size_t answer(int question) const {
    return static_cast<std::size_t>(question) < answers.size() ? answers[question] : kNotAsked;
  }
  bool reads(int key) const { return static_cast<std::size_t>(key) < keys.size() && keys[key]; }
};

/// Finding: a key as one run read it, and the answers with which it is read.
struct Found {
  SurveyRun::Read what;
  int key = 0;
  SurveyAnswers given;  ///< answers given in that run
  const Told* run = nullptr;
  bool in_form = false;
  /// Answers with which the key is read, for each question before it; the other questions have the run's
  /// answers.
  std::vector<AnswerSet> with;
  std::vector<std::size_t> deciding;  ///< questions that count and have not all their answers in `with`
};

template <class Tables>
auto find_table(Tables& tables, const std::string& path) {
  return std::find_if(tables.begin(), tables.end(), [&](const DeckTable& t) { return t.path == path; });
}

class Surveyor {
 public:
  /// \param read  function that calls the reader, which asks the run
  explicit Surveyor(std::function<void(SurveyRun&)> read) : read_(std::move(read)) {
    plan({});
    visit_planned();
    while (correct()) visit_planned();
  }

  DeckSchema schema() const {
    DeckSchema schema{.tables = tables_, .never_read = {}};
    put_parts_together(schema.tables);
    for (const Found& f : found_) {
      DeckKey key = described(f);
      DeckTable& table = *find_table(schema.tables, f.what.table);
      std::vector<DeckKey>& keys = key.form == ValueForm::table ? table.needed_tables : table.keys;
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(std::move(key));
    }
    for (const auto& [table, key] : known_) {
      const std::string path = joined_path(table, key);
      if (!is_read(table, key) && !is_table(path) && !is_table(path + "[]"))
        schema.never_read.push_back(path);
    }
    std::erase_if(schema.tables, [](const DeckTable& t) { return t.keys.empty() && !t.has_any_keys; });
    for (DeckTable& table : schema.tables) {
      take_common_conditions(table);
      // Of a table that other answers let be left out, answers together may decide.
      std::erase_if(table.needed_tables, [&](const DeckKey& needed) {
        return once_optional_.contains(joined_path(table.path, needed.key));
      });
    }
    return schema;
  }

 private:
  bool is_read(const std::string& table, const std::string& key) const {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Found& f) { return f.what.table == table && f.what.key.key == key; });
  }
  bool is_table(const std::string& path) const { return find_table(tables_, path) != tables_.end(); }
  bool is_form(const std::string& path) const { return find_table(tables_, path)->is_form; }

  void plan(SurveyAnswers given) {
    if (planned_.insert(given).second) open_.push_back(std::move(given));
  }

  void visit_planned() {
    while (!open_.empty()) {
      const SurveyAnswers next = std::move(open_.front());
      open_.pop_front();
      visit(next);
    }
  }

  /// Returns the record of a run with these answers.
  const Told& told(const SurveyAnswers& given) {
    visit(given);
    return told_.at(given);
  }

  /// Calls the reader with these answers; where that brings something new, plans a run with each other
  /// answer.
  void visit(const SurveyAnswers& given) {
    if (told_.contains(given)) return;
    SurveyRun run(given);
    read_(run);
    Told& told = told_[given];
    visited_.push_back(given);
    for (const DeckTable& t : run.tables()) merge(t);
    for (const auto& k : run.known())
      if (is_known_.insert(k).second) known_.push_back(k);
    bool is_new = false;
    for (const auto& a : run.answered()) {
      const auto [question, is_new_question] = questions_.of(a.question);
      is_new = is_new || is_new_question;
      if (is_new_question) asked_.push_back(a.question);
      told.answered.push_back({question, a.answer, &*possible_.insert(a.possible).first});
      told.answers.resize(std::max<std::size_t>(told.answers.size(), question + 1), kNotAsked);
      told.answers[question] = a.answer;
    }
    for (const auto& r : run.keys_read()) {
      const auto [key, is_new_key] = keys_.of(content(r));
      is_new = is_new || is_new_key;
      if (is_new_key) key_texts_.push_back(r);
      told.read.push_back({key, r.after});
      told.keys.resize(std::max<std::size_t>(told.keys.size(), key + 1));
      told.keys[key] = true;
    }
    if (!is_new) return;
    for (const auto& a : run.answered())
      for (std::size_t other = 0; other < a.possible.size(); ++other)
        if (other != a.answer) plan(changed(given, a.question, other));
  }

  static SurveyAnswers changed(SurveyAnswers given, const SurveyQuestion& question, std::size_t answer) {
    given[question] = answer;
    return given;
  }

  void merge(const DeckTable& table) {
    if (table.optional) once_optional_.insert(table.path);
    const auto known = find_table(tables_, table.path);
    if (known == tables_.end()) {
      tables_.push_back(table);
      return;
    }
    known->optional = known->optional && table.optional;
    if (known->meaning.empty()) known->meaning = table.meaning;
    known->has_names_of_deck = known->has_names_of_deck || table.has_names_of_deck;
    known->has_any_keys = known->has_any_keys || table.has_any_keys;
    known->may_lack_all = known->may_lack_all || table.may_lack_all;
    if (known->code_key.empty()) known->code_key = table.code_key;
  }

  /// Compares the findings with all runs: narrows a finding that a run contradicts, and adds a finding for a
  /// key that none explains. Returns false if nothing was to be done.
  bool correct() {
    bool is_changed = false;
    const std::size_t runs = visited_.size();
    for (std::size_t run = 0; run < runs; ++run) {
      const SurveyAnswers given = visited_[run];
      const Told& told = told_.at(given);
      for (Found& f : found_)
        if (!f.in_form && !told.reads(f.key) && is_explained(f, told))
          is_changed = narrow(f, told) || is_changed;
      for (const auto& r : told.read) {
        if (is_explained(r.key, told)) continue;
        Found f = find(r, given);
        found_of_key_.resize(std::max<std::size_t>(found_of_key_.size(), r.key + 1));
        found_of_key_[r.key].push_back(found_.size());
        found_.push_back(std::move(f));
        is_changed = true;
      }
    }
    return is_changed;
  }

  /// Tells whether a question counts for a finding. A form is the same wherever it stands, so only questions
  /// of its own table count for it.
  static bool counts(const Found& f, const SurveyQuestion& question) {
    return !f.in_form || question.table == f.what.table;
  }

  /// Changes the answers before the key one by one. A run that another finding explains is left to that
  /// finding.
  Found find(const Told::Read& read, const SurveyAnswers& given) {
    const SurveyRun::Read& what = key_texts_[read.key];
    Found f{what, read.key, given, &told_.at(given), is_form(what.table), {}, {}};
    for (std::size_t i = 0; i < read.after; ++i) {
      const auto& a = f.run->answered[i];
      f.with.emplace_back().set(a.answer);
      const SurveyQuestion question = asked_[a.question];
      if (!counts(f, question)) continue;
      for (std::size_t answer = 0; answer < a.possible->size(); ++answer) {
        const Told& other = told(changed(given, question, answer));
        if (other.reads(read.key) && !is_explained(read.key, other)) f.with[i].set(answer);
      }
      if (f.with[i].count() < a.possible->size()) f.deciding.push_back(i);
    }
    return f;
  }

  /// Tells whether a finding says that a run reads a key; one finding says so for all readings of a form.
  bool is_explained(int key, const Told& run) const {
    if (static_cast<std::size_t>(key) >= found_of_key_.size()) return false;
    return std::ranges::any_of(found_of_key_[key], [&](std::size_t place) {
      return found_[place].in_form || is_explained(found_[place], run);
    });
  }

  /// Tells whether a run's answers are those with which the key is read.
  static bool is_explained(const Found& f, const Told& run) {
    return std::ranges::all_of(
        f.deciding, [&](std::size_t i) { return has(f.with[i], run.answer(f.run->answered[i].question)); });
  }

  /// Removes an answer from a finding: one with which the key is read only if questions that follow from it
  /// are answered otherwise than in a run that does not read the key. Returns false if there is none.
  bool narrow(Found& f, const Told& run) {
    SurveyAnswers as_in_run = f.given;
    for (const auto& a : run.answered)
      if (f.run->answer(a.question) == kNotAsked) as_in_run[asked_[a.question]] = a.answer;
    for (std::size_t i = 0; i < f.with.size(); ++i) {
      const auto& a = f.run->answered[i];
      const std::size_t answer = run.answer(a.question);
      if (answer == a.answer || !has(f.with[i], answer)) continue;
      if (told(changed(as_in_run, asked_[a.question], answer)).reads(f.key)) continue;
      f.with[i].reset(answer);
      if (std::ranges::find(f.deciding, i) == f.deciding.end()) f.deciding.push_back(i);
      return true;
    }
    return false;
  }

  DeckKey described(const Found& f) const {
    DeckKey key = f.what.key;
    for (std::size_t i = 0; i < f.with.size(); ++i) {
      const auto& a = f.run->answered[i];
      const SurveyQuestion& question = asked_[a.question];
      if (!counts(f, question) || f.with[i].count() == a.possible->size()) continue;
      std::vector<std::string> with, without;
      for (std::size_t answer = 0; answer < a.possible->size(); ++answer)
        (has(f.with[i], answer) ? with : without).push_back((*a.possible)[answer]);
      add_condition(key, f, question, with, without);
    }
    return key;
  }

  static void add_condition(DeckKey& key, const Found& f, const SurveyQuestion& question,
                            const std::vector<std::string>& with, const std::vector<std::string>& without) {
    using Kind = SurveyQuestion::Kind;
    KeyCondition condition{.table = question.table, .key = question.key, .with = {}, .without = {}};
    if (question.kind == Kind::word || question.kind == Kind::flag) {
      condition.with = with;
      condition.without = without;
    } else {
      const bool present = with.front() == "true";
      if (!present && f.in_form) return;  // forms exclude each other
      if (present && question.table == f.what.table && question.key == key.key) {
        key.optional = key.fallback.empty();
        return;
      }
      // That a key's own table is there goes without saying.
      const std::string path = joined_path(question.table, question.key);
      if (present && is_at_or_below(f.what.table, path)) return;
      condition.kind = present ? KeyCondition::Kind::present : KeyCondition::Kind::absent;
    }
    key.conditions.push_back(std::move(condition));
  }

  /// Puts tables below one table of the root together.
  static void put_parts_together(std::vector<DeckTable>& tables) {
    std::vector<std::string> order;
    const auto place = [&](const DeckTable& table) {
      const std::string top = table.path.substr(0, table.path.find_first_of(".["));
      const auto known = std::find(order.begin(), order.end(), top);
      const auto index = std::distance(order.begin(), known);
      if (known == order.end()) order.push_back(top);
      return index;
    };
    for (const DeckTable& table : tables) place(table);
    std::stable_sort(tables.begin(), tables.end(),
                     [&](const DeckTable& a, const DeckTable& b) { return place(a) < place(b); });
  }

  /// Moves conditions from outside that all keys share to the table.
  static void take_common_conditions(DeckTable& table) {
    if (table.keys.empty()) return;
    for (const KeyCondition& condition : std::vector(table.keys.front().conditions)) {
      if (condition.table == table.path) continue;
      const auto has_it = [&](const DeckKey& k) {
        return std::find(k.conditions.begin(), k.conditions.end(), condition) != k.conditions.end();
      };
      if (!std::all_of(table.keys.begin(), table.keys.end(), has_it)) continue;
      table.conditions.push_back(condition);
      for (DeckKey& key : table.keys) std::erase(key.conditions, condition);
    }
  }

  std::function<void(SurveyRun&)> read_;
  std::deque<SurveyAnswers> open_;
  std::set<SurveyAnswers> planned_;
  std::map<SurveyAnswers, Told> told_;
  std::vector<SurveyAnswers> visited_;  ///< answers of each run, about from the fewest changed to the most
  Numbers<std::map<SurveyQuestion, int>> questions_;
  std::vector<SurveyQuestion> asked_;  ///< questions, by number
  Numbers<std::unordered_map<std::string, int>> keys_;
  std::vector<SurveyRun::Read> key_texts_;       ///< keys, by number
  std::set<std::vector<std::string>> possible_;  ///< lists of answers
  std::vector<Found> found_;
  std::vector<std::vector<std::size_t>> found_of_key_;  ///< places of the findings of each key, by its number
  std::vector<DeckTable> tables_;
  std::vector<std::pair<std::string, std::string>> known_;
  std::set<std::pair<std::string, std::string>> is_known_;
  std::set<std::string> once_optional_;  ///< paths of tables that a run asked for as optional
};

}  // namespace

std::size_t SurveyRun::answer(const std::string& table, std::string_view key, SurveyQuestion::Kind kind,
                              std::vector<std::string> possible, std::size_t usual) {
  SurveyQuestion question{described(table), std::string(key), kind};
  const auto [place, is_new] = place_.try_emplace(question, answered_.size());
  if (!is_new) return answered_[place->second].answer;
  const auto given = given_.find(question);
  const std::size_t answer = given != given_.end() ? given->second : usual;
  answered_.push_back({std::move(question), answer, std::move(possible)});
  return answer;
}

bool SurveyRun::is_present(const std::string& table, std::string_view key) {
  const SurveyQuestion as_table{described(table), std::string(key), SurveyQuestion::Kind::is_table};
  if (const auto asked = place_.find(as_table); asked != place_.end() && answered_[asked->second].answer == 1)
    return true;
  return answer(table, key, SurveyQuestion::Kind::present, {"false", "true"}, 1) == 1;
}

bool SurveyRun::is_table(const std::string& table, std::string_view key) {
  return answer(table, key, SurveyQuestion::Kind::is_table, {"false", "true"}, 0) == 1;
}

bool SurveyRun::is_set(const std::string& table, std::string_view key, bool usual) {
  return answer(table, key, SurveyQuestion::Kind::flag, {"false", "true"}, usual ? 1 : 0) == 1;
}

std::size_t SurveyRun::chosen(const std::string& table, std::string_view key,
                              const std::vector<std::string>& words) {
  std::vector<std::string> possible;
  for (const std::string& word : words) possible.push_back('"' + word + '"');
  return answer(table, key, SurveyQuestion::Kind::word, std::move(possible), 0);
}

void SurveyRun::know(const std::string& table, std::string_view key) {
  known_.emplace_back(described(table), key);
}

void SurveyRun::need_table(const std::string& table, std::string_view name) {
  DeckKey needed;
  needed.key = name;
  needed.form = ValueForm::table;
  read(table, std::move(needed));
}

void SurveyRun::read(const std::string& table, DeckKey key) {
  if (!forms_.empty() && forms_.contains(joined_path(table, key.key))) return;
  read_.push_back({described(table), std::move(key), answered_.size()});
}

void SurveyRun::read_in_forms(const std::string& table, DeckKey key, const std::string& forms) {
  const std::string path = joined_path(table, key.key);
  read(table, std::move(key));
  forms_.emplace(path, forms.empty() ? path : forms);
}

TableReading& SurveyRun::table(const std::string& path, bool optional, std::string_view meaning) {
  DeckTable table{.path = described(path),
                  .optional = optional,
                  .meaning = std::string(meaning),
                  .keys = {},
                  .needed_tables = {},
                  .code_key = {},
                  .conditions = {}};
  table.is_form = table.path != path;
  tables_.push_back(std::move(table));
  auto& reading = readings_[path];
  if (!reading) reading.reset(new TableReading{.table = no_table(), .path = path, .asked = {}});
  return *reading;
}

DeckTable& SurveyRun::described_table(const std::string& path) {
  return *find_table(tables_, described(path));
}

std::string SurveyRun::described(const std::string& path) const {
  const auto known = std::find_if(forms_.rbegin(), forms_.rend(),  // the one with the longest path
                                  [&](const auto& f) { return is_at_or_below(path, f.first); });
  return known == forms_.rend() ? path : known->second + path.substr(known->first.size());
}

DeckSchema survey_deck(const DeckReader& read) {
  return Surveyor([&](SurveyRun& run) { read(Deck(std::make_unique<DeckReading>(run))); }).schema();
}

std::vector<std::string> DeckSchema::undocumented() const {
  std::vector<std::string> paths = never_read;
  for (const DeckTable& table : tables) {
    if (table.meaning.empty() && !table.path.empty()) paths.push_back(table.path);
    for (const DeckKey& key : table.keys) {
      const std::string path = joined_path(table.path, key.key);
      if (key.meaning.empty()) paths.push_back(path);
      for (const DeckWord& word : key.words)
        if (word.meaning.empty()) paths.push_back(fmt::format("{} = {}", path, word.word));
    }
  }
  return paths;
}

}  // namespace pyroclast
