#pragma once

#include <concepts>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pyroclast/base/range.hpp"
#include "pyroclast/deck/diagnostic.hpp"
#include "pyroclast/units/units.hpp"

namespace pyroclast {

class Deck;
class DeckReading;
struct DeckKey;
struct DeckSchema;
struct TableReading;

/// What a key, a word or a table means, for the deck reference; empty where another place says it. A literal,
/// so that no number is taken for one.
class Meaning {
 public:
  template <std::size_t N>
  constexpr Meaning(const char (&text)[N]) : text_(text, N - 1) {}  // NOLINT(google-explicit-constructor)
  explicit constexpr Meaning(std::string_view text) : text_(text) {}

  constexpr std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

/// One of the words that a key may hold, and what it stands for.
template <class E>
struct Choice {
  std::string_view word;
  E value;
  Meaning meaning;
};

/// How the deck reference describes a key that is read in several forms.
struct KeyForms {
  std::string value;                       ///< what is written, such as "curve over the temperature: stress"
  const Unit& unit = unit::dimensionless;  ///< of the range and the fallback
  Range range = Range::any();
  std::optional<double> fallback = {};
  /// Name under which the tables at and below the key are described, once for all keys; empty if there are
  /// none.
  std::string name = {};
};

/// A file that a deck names.
struct DeckFile {
  std::string key;  ///< full path of the key that names it; empty where it stands beside such a file
  std::filesystem::path file;  ///< where it was found
  std::string rest;            ///< of the value, behind the file's name
};

/// One table of a deck: a cheap handle, valid as long as its Deck.
///
/// Nothing in the deck makes reading throw. What cannot be read is recorded, and a value that is allowed is
/// returned in its place, so that the reader goes on and the user sees every error at once; `Deck::finish`
/// throws them. A table that is missing is one error: what is read from it records no more.
///
/// Every key that is read, or asked for with `has`, is a known key of its table. The reading functions with a
/// `fallback` return it if the key is absent. The `meaning` of a key goes into the deck reference (see
/// `survey_deck`); that of a table may be given at any one of the places that ask for it.
class Section {
 public:
  /// A table that must be there.
  Section section(std::string_view key, Meaning meaning = "") const;
  /// A table that may be there; empty also if the key is not a table, which is recorded.
  std::optional<Section> optional_section(std::string_view key, Meaning meaning = "") const;
  /// The same where what is read from a table that is absent is its fallbacks.
  Section section_or_none(std::string_view key, Meaning meaning = "") const;
  /// An array of tables ([[key]]) of at least one; empty also after an error.
  std::vector<Section> sections(std::string_view key, Meaning meaning = "") const;
  /// An array of tables that may be absent.
  std::vector<Section> optional_sections(std::string_view key, Meaning meaning = "") const;

  /// Every table in this one, with its name, in the order of the names.
  /// \param placeholder  stands for the names in the deck reference
  std::vector<std::pair<std::string, Section>> named_sections(std::string_view placeholder,
                                                              Meaning meaning = "") const;

  /// The same table, whose fallbacks are what another table says: the deck reference names it in their place.
  Section with_defaults_of(std::string_view table) const;

  /// A quantity, written as a string with its unit, in `unit.si`; `range` is in that unit.
  double quantity(std::string_view key, const Unit& unit, const Range& range, Meaning meaning) const;
  double quantity(std::string_view key, const Unit& unit, const Range& range, double fallback,
                  Meaning meaning) const;
  /// A list of at least one quantity; empty after an error.
  std::vector<double> quantities(std::string_view key, const Unit& unit, const Range& range,
                                 Meaning meaning) const;
  /// The same for a list that may be absent, or hold nothing.
  std::vector<double> optional_quantities(std::string_view key, const Unit& unit, const Range& range,
                                          Meaning meaning) const;

  /// A dimensionless number, written as a number or as a string such as "31 %".
  double number(std::string_view key, const Range& range, Meaning meaning) const;
  double number(std::string_view key, const Range& range, double fallback, Meaning meaning) const;
  /// A list of at least one dimensionless number; empty after an error.
  std::vector<double> numbers(std::string_view key, const Range& range, Meaning meaning) const;

  /// A list of two or more points, `[[x, y], ...]`, in `x_unit.si` and `y_unit.si`, x ascending strictly;
  /// empty after an error, which names the element.
  std::vector<std::pair<double, double>> points(std::string_view key, const Unit& x_unit, const Unit& y_unit,
                                                Meaning meaning) const;

  /// A place `[x, y]`, or a list of at least so many places; empty after an error, which names the element.
  std::optional<std::pair<double, double>> place(std::string_view key, const Unit& unit,
                                                 Meaning meaning) const;
  std::vector<std::pair<double, double>> places(std::string_view key, const Unit& unit, std::size_t least,
                                                Meaning meaning) const;

  long long integer(std::string_view key, const Range& range, Meaning meaning) const;
  long long integer(std::string_view key, const Range& range, long long fallback, Meaning meaning) const;
  bool flag(std::string_view key, Meaning meaning) const;
  /// \tparam Bool  bool itself, so that no text is taken for a fallback
  template <std::same_as<bool> Bool>
  bool flag(std::string_view key, Bool fallback, Meaning meaning) const {
    return flag_or(key, fallback, meaning);
  }
  /// A string that is not empty.
  std::string text(std::string_view key, Meaning meaning) const;
  std::string text(std::string_view key, std::string fallback, Meaning meaning) const;

  /// One of several words: `choice<Mass>("mass", {{"scaled", Mass::scaled}, {"real", Mass::real}})`. A
  /// misspelt word is read as the nearest one. If there is none, the first choice stands in, and keys of this
  /// table that are missing or unknown are not reported from then on, since which ones are needed depends on
  /// the choice.
  template <class E>
  E choice(std::string_view key, std::initializer_list<Choice<E>> options, Meaning meaning) const {
    return std::data(options)[choice_index(key, words(options), std::nullopt, {}, meaning)].value;
  }
  /// \tparam F  E itself, so that no text is taken for a fallback
  template <class E, std::same_as<E> F>
  E choice(std::string_view key, std::initializer_list<Choice<E>> options, F fallback,
           Meaning meaning) const {
    std::string_view word;
    for (const auto& option : options)
      if (option.value == fallback) word = option.word;
    const std::size_t index = choice_index(key, words(options), options.size(), word, meaning);
    return index < options.size() ? std::data(options)[index].value : fallback;
  }
  /// The same for words that are known only when the deck is read, at least one.
  template <class E>
  E choice(std::string_view key, const std::vector<Choice<E>>& options, Meaning meaning) const {
    return options[choice_index(key, words(options), std::nullopt, {}, meaning)].value;
  }
  /// The first of them stands where the deck says nothing.
  template <class E>
  E choice_or_first(std::string_view key, const std::vector<Choice<E>>& options, Meaning meaning) const {
    const std::size_t index =
        choice_index(key, words(options), options.size(), options.front().word, meaning);
    return options[index < options.size() ? index : 0].value;
  }

  /// One of several words, or any other text that `other` explains; the first word where the deck says
  /// nothing.
  std::string word_or_text(std::string_view key, const std::vector<Choice<int>>& words, Meaning other,
                           Meaning meaning) const;
  /// A list of strings that must be there; empty after an error.
  std::vector<std::string> texts(std::string_view key, Meaning meaning) const;
  /// A list of strings; empty if the key is absent.
  std::vector<std::string> optional_texts(std::string_view key, Meaning meaning) const;

  /// Whatever stands at a key that must be there, as JSON; a date is a text.
  /// \param value  what is written, for the deck reference
  std::string json(std::string_view key, std::string_view value, Meaning meaning) const;
  /// The same for a key that may be absent; `fallback`, itself JSON, is then what it says.
  std::string json(std::string_view key, std::string_view value, const std::string& fallback,
                   Meaning meaning) const;
  /// The keys that are written, in the order of their names. None of them counts as read.
  std::vector<std::string> keys() const;

  /// Whether the key is written. A key that is found here but never read, nor named in `error`, is reported
  /// as one that has no effect.
  bool has(std::string_view key) const;
  /// Makes keys known that are read with other settings only: a deck that holds one is told that it has no
  /// effect, and not that there is no such key.
  void know(std::initializer_list<std::string_view> keys) const;
  /// Whether the key is written and holds a table; otherwise like `has`.
  bool is_table(std::string_view key) const;
  /// Says for the deck reference what a key holds that is read in several forms, before it is read: then
  /// nothing that the reading functions are told of the key counts.
  void describe(std::string_view key, const KeyForms& forms, Meaning meaning) const;
  /// Which keys belong here depends on a value that could not be read: from now on those of this table that
  /// are missing or unknown are not reported.
  void leave_open() const;
  /// Whether no error was recorded so far in this table and the tables below: guards a check between values
  /// against reporting the stand-in of a value that could not be read.
  bool ok() const;

  /// Records a contradiction found by the caller, at the key (or at the table, if the key is absent).
  void error(std::string_view key, std::string message) const;
  /// Records a contradiction of the table as a whole.
  void error(std::string message) const;

  /// Records what is allowed at the key, but most likely not meant; the deck stays valid.
  void warn(std::string_view key, std::string message) const;
  /// The same where a value, in `unit.si`, is not what is usual in its range.
  void warn_if_unusual(std::string_view key, double value, const Unit& unit, const Range& range) const;

  /// Says that the key's value is the name of a file, followed by `rest`.
  void names_file(std::string_view key, std::filesystem::path file, std::string rest = {}) const;

  /// Says that a file belongs to one that a key names, and must stand beside it.
  void needs_file(std::filesystem::path file) const;

  /// Where the key stands (or its table, if the key is absent), as "file:line"; "--set" where that stated it.
  std::string where(std::string_view key) const;
  /// Whether the command line, or a script, states the key.
  bool is_changed(std::string_view key) const;
  /// Full path of the table, such as "contacts.mortar_mortar"; empty for the root.
  std::string path() const;

 private:
  friend class Deck;
  Section(DeckReading& deck, TableReading* table) : deck_(&deck), table_(table) {}

  struct Word {
    std::string word;
    Meaning meaning;
  };
  template <class Options>
  static std::vector<Word> words(const Options& options) {
    std::vector<Word> result;
    for (const auto& option : options) result.push_back({std::string(option.word), option.meaning});
    return result;
  }
  /// Index of the word chosen; `fallback` is returned if the key is absent, which is an error without one.
  std::size_t choice_index(std::string_view key, const std::vector<Word>& words,
                           std::optional<std::size_t> fallback, std::string_view fallback_word,
                           Meaning meaning) const;
  bool flag_or(std::string_view key, bool fallback, Meaning meaning) const;
  /// In a survey, keeps that the key was read.
  void note(DeckKey key, Meaning meaning) const;

  DeckReading* deck_;
  TableReading* table_;           ///< null for a table that is missing
  std::string_view defaults_of_;  ///< see with_defaults_of
};

/// Text that is appended to a deck, and the file that it comes from, for messages.
struct Appendix {
  std::string text, name;
};

/// A TOML file in which every dimensional value is a string with its unit. Its reader asks for the keys it
/// knows and calls `finish`, which reports every error at once, keys that nobody asked for among them.
class Deck {
 public:
  /// @throws DeckError if the file cannot be read, is empty or is not TOML.
  /// @param changes  as "key=value" with the full path of a key ("stages[1].rate=10 K/min"); one that the
  /// deck does
  ///                 not have is added. `text` and places in messages are then those of the changed deck.
  ///                 Throws Error for one that cannot be made.
  /// @param more  is appended before them
  static Deck open(const std::filesystem::path& file, const std::vector<std::string>& changes = {},
                   const Appendix& more = {});
  /// The same for a text; `name` takes the file's place in messages.
  static Deck parse(std::string text, std::string name, const std::vector<std::string>& changes = {},
                    const Appendix& more = {});

  Deck(Deck&&) noexcept;
  Deck& operator=(Deck&&) noexcept;
  ~Deck();

  /// The file's name as given to `open`.
  const std::string& name() const;
  /// The deck as it was read, byte by byte.
  const std::string& text() const;

  Section root() const;

  /// What was warned of, in the order of the file.
  std::vector<Diagnostic> warnings() const;
  /// Files that the deck names, in the order of reading.
  const std::vector<DeckFile>& files() const;
  /// The text with other values, by the full paths of their keys; a key that is missing is added.
  std::string with(const std::vector<std::pair<std::string, std::string>>& values) const;

  /// Call once everything is read.
  /// @throws DeckError with every error recorded, and every key that was not read.
  void finish() const;

 private:
  friend DeckSchema survey_deck(const std::function<void(const Deck&)>& read);
  explicit Deck(std::unique_ptr<DeckReading> reading);

  std::unique_ptr<DeckReading> reading_;
};

}  // namespace pyroclast
