#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
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

/// Meaning of a key, a word or a table, for the deck reference; empty where another place gives it. The type
/// takes only a literal, so that no number is taken for a meaning.
class Meaning {
 public:
  template <std::size_t N>
  constexpr Meaning(const char (&text)[N]) : text_(text, N - 1) {}  // NOLINT(google-explicit-constructor)
  explicit constexpr Meaning(std::string_view text) : text_(text) {}

  constexpr std::string_view text() const { return text_; }

 private:
  std::string_view text_;
};

/// Word that a key may hold, and its value.
template <class E>
struct Choice {
  std::string_view word;
  E value;
  Meaning meaning;
};

/// Form of the value of a key, of which a list may have any number.
enum class ValueForm : std::uint8_t {
  anything,
  text,
  word,          ///< one of several words
  word_or_text,  ///< one of several words, or any other text
  flag,
  integer,
  quantity,        ///< number with its unit; without unit where it is dimensionless
  place,           ///< [x, y], of one kind of quantity
  place_in_space,  ///< [x, y] or [x, y, z]
  points,          ///< [[x, y], ...], of two kinds of quantity
  table
};

/// Description, for the deck reference, of a key that is read in several forms.
struct KeyForms {
  /// Written form of the value, such as "curve over the temperature: stress".
  std::string value;
  ValueForm form = ValueForm::anything;    ///< form of a value that is no table
  const Unit& unit = unit::dimensionless;  ///< unit of the range and the fallback
  Range range = Range::any();
  std::optional<double> fallback = {};
  /// Name under which the tables at and below the key are described, once for all keys; empty if there are no
  /// such tables.
  std::string name = {};
  bool optional = false;  ///< true for a key that may be left out where it has no fallback
};

/// Place as a deck states it, in the unit of its reader.
struct StatedPlace {
  double x = 0.0, y = 0.0;
  std::optional<double> z = std::nullopt;  ///< none for a pair
};

/// Coordinates that a place has in the body of a deck.
struct Coordinates {
  int count = 2;                 ///< 2: [x, y]; 3: [x, y, z]
  bool pair_is_along_z = false;  ///< true where a pair stands for all z of a solid
  double middle_z = 0.0;         ///< z that a message proposes where it is missing, m
};

/// File that a deck names.
struct DeckFile {
  /// Full path of the key that names the file; empty for a file that must stand beside such a file.
  std::string key;
  std::filesystem::path file;  ///< place where the file was found
  std::string rest;            ///< rest of the value, behind the file's name
};

/// Table of a deck: a cheap handle, valid as long as its Deck.
///
/// The content of the deck never makes reading throw. A value that cannot be read is recorded as an error,
/// and an allowed value is returned in its place. So the reader goes on and the user sees every error at
/// once; `Deck::finish` throws them. A table that is missing is one error: reading from it records no more.
///
/// Every key that is read, or asked for with `has`, is a known key of its table. The reading functions with a
/// `fallback` return it if the key is absent. The `meaning` of a key goes into the deck reference (see
/// `survey_deck`); the meaning of a table may be given at any one of the places that ask for the table.
class Section {
 public:
  /// Returns a table that must be there.
  Section section(std::string_view key, Meaning meaning = "") const;
  /// Returns a table that may be there; empty also if the key is not a table, which is recorded as an error.
  std::optional<Section> optional_section(std::string_view key, Meaning meaning = "") const;
  /// Returns a table that may be there; reading from an absent table returns the fallbacks.
  Section section_or_none(std::string_view key, Meaning meaning = "") const;
  /// Returns an array of tables ([[key]]) with at least one element; empty also after an error.
  std::vector<Section> sections(std::string_view key, Meaning meaning = "") const;
  /// Returns an array of tables that may be absent.
  std::vector<Section> optional_sections(std::string_view key, Meaning meaning = "") const;

  /// Returns every table in this one, with its name, in the order of the names.
  /// \param placeholder  word that stands for the names in the deck reference
  std::vector<std::pair<std::string, Section>> named_sections(std::string_view placeholder,
                                                              Meaning meaning = "") const;

  /// Returns the same table with fallbacks that another table states: the deck reference names that table in
  /// their place.
  Section with_defaults_of(std::string_view table) const;

  /// Reads a quantity, written as a string with its unit, and returns it in `unit.si`; `range` is in that
  /// unit.
  double quantity(std::string_view key, const Unit& unit, const Range& range, Meaning meaning) const;
  double quantity(std::string_view key, const Unit& unit, const Range& range, double fallback,
                  Meaning meaning) const;
  /// Reads a list of at least one quantity; empty after an error.
  std::vector<double> quantities(std::string_view key, const Unit& unit, const Range& range,
                                 Meaning meaning) const;
  /// Reads a list of quantities that may be absent or empty.
  std::vector<double> optional_quantities(std::string_view key, const Unit& unit, const Range& range,
                                          Meaning meaning) const;

  /// Reads a dimensionless number, written as a number or as a string such as "31 %".
  double number(std::string_view key, const Range& range, Meaning meaning) const;
  double number(std::string_view key, const Range& range, double fallback, Meaning meaning) const;
  /// Reads a list of at least one dimensionless number; empty after an error.
  std::vector<double> numbers(std::string_view key, const Range& range, Meaning meaning) const;

  /// Reads a list of two or more points, `[[x, y], ...]`, in `x_unit.si` and `y_unit.si`, with x strictly
  /// ascending; empty after an error, which names the element.
  std::vector<std::pair<double, double>> points(std::string_view key, const Unit& x_unit, const Unit& y_unit,
                                                Meaning meaning) const;

  /// Reads a place `[x, y]`, or a list of at least `least` places; empty after an error, which names the
  /// element. With `coordinates` a place may have a third number, as the body of the deck asks for.
  std::optional<std::pair<double, double>> place(std::string_view key, const Unit& unit,
                                                 Meaning meaning) const;
  std::vector<std::pair<double, double>> places(std::string_view key, const Unit& unit, std::size_t least,
                                                Meaning meaning) const;

  std::optional<StatedPlace> place(std::string_view key, const Unit& unit, const Coordinates& coordinates,
                                   Meaning meaning) const;
  std::vector<StatedPlace> places(std::string_view key, const Unit& unit, std::size_t least,
                                  const Coordinates& coordinates, Meaning meaning) const;

  long long integer(std::string_view key, const Range& range, Meaning meaning) const;
  long long integer(std::string_view key, const Range& range, long long fallback, Meaning meaning) const;
  bool flag(std::string_view key, Meaning meaning) const;
  /// \tparam Bool  bool itself, so that no text is taken for a fallback
  template <std::same_as<bool> Bool>
  bool flag(std::string_view key, Bool fallback, Meaning meaning) const {
    return flag_or(key, fallback, meaning);
  }
  /// Reads a string that is not empty.
  std::string text(std::string_view key, Meaning meaning) const;
  std::string text(std::string_view key, std::string fallback, Meaning meaning) const;

  /// Reads one of several words: `choice<Mass>("mass", {{"scaled", Mass::scaled}, {"real", Mass::real}})`. A
  /// misspelt word is read as the nearest word. If no word is near, the first choice stands in. From then on
  /// missing or unknown keys of this table are not reported, since the choice decides which keys are needed.
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
  /// Reads one of several words, at least one, that are known only when the deck is read.
  template <class E>
  E choice(std::string_view key, const std::vector<Choice<E>>& options, Meaning meaning) const {
    return options[choice_index(key, words(options), std::nullopt, {}, meaning)].value;
  }
  /// Reads one of several words; where the key is absent, returns the value of the first word.
  template <class E>
  E choice_or_first(std::string_view key, const std::vector<Choice<E>>& options, Meaning meaning) const {
    const std::size_t index =
        choice_index(key, words(options), options.size(), options.front().word, meaning);
    return options[index < options.size() ? index : 0].value;
  }

  /// Reads one of several words, or any other text, which `other` explains; returns the first word where the
  /// key is absent.
  /// \param needed  what a message asks for where the key must be there; empty where it may be absent
  std::string word_or_text(std::string_view key, const std::vector<Choice<int>>& words, Meaning other,
                           Meaning meaning, std::string_view needed = {}) const;
  /// Reads a list of strings that must be there; empty after an error.
  std::vector<std::string> texts(std::string_view key, Meaning meaning) const;
  /// Reads a list of strings; empty if the key is absent.
  std::vector<std::string> optional_texts(std::string_view key, Meaning meaning) const;

  /// Returns the value of a key that must be there, whatever it is, as JSON; a date is a text.
  /// \param value  written form of the value, for the deck reference
  std::string json(std::string_view key, std::string_view value, Meaning meaning) const;
  /// Returns the value as JSON; for an absent key returns `fallback`, which is itself JSON.
  std::string json(std::string_view key, std::string_view value, const std::string& fallback,
                   Meaning meaning) const;
  /// Returns the keys that are written, in the order of their names. None of them counts as read.
  std::vector<std::string> keys() const;

  /// Tells whether the key is written. A key that is found here, but is never read nor named in `error`, is
  /// reported as a key without effect.
  bool has(std::string_view key) const;
  /// Makes keys known that are read with other settings only: a deck that holds one is told that the key has
  /// no effect, and not that there is no such key.
  void know(std::initializer_list<std::string_view> keys) const;
  /// Says that the deck itself names tables in this one, for which the reader asks as texts of the deck say.
  void take_names_of_deck() const;
  /// Says that the deck itself names the keys of this table.
  void take_any_keys() const;
  /// Says that this table has further keys where a key holds none of its words but the name of code.
  void take_keys_of_code(std::string_view key) const;
  /// Tells whether the key is written and holds a table; otherwise works like `has`.
  bool is_table(std::string_view key) const;
  /// Describes, for the deck reference, a key that is read in several forms. The call comes before the key is
  /// read; the reading functions then add nothing to the description.
  void describe(std::string_view key, const KeyForms& forms, Meaning meaning) const;
  /// Stops reports of missing or unknown keys in this table, from now on. Call it where a value that could
  /// not be read decides which keys belong here.
  void leave_open() const;
  /// Tells whether no error was recorded so far in this table and the tables below. The answer guards a check
  /// between values against the stand-in of a value that could not be read.
  bool ok() const;

  /// Records a contradiction found by the caller, at the key (or at the table, if the key is absent).
  void error(std::string_view key, std::string message) const;
  /// Records a contradiction of the table as a whole.
  void error(std::string message) const;

  /// Records a warning of a value that is allowed but most likely not meant; the deck stays valid.
  void warn(std::string_view key, std::string message) const;
  /// Records such a warning where a value, in `unit.si`, is not among the usual values of its range.
  void warn_if_unusual(std::string_view key, double value, const Unit& unit, const Range& range) const;

  /// Records that the key's value is the name of a file, followed by `rest`.
  void names_file(std::string_view key, std::filesystem::path file, std::string rest = {}) const;

  /// Records a file that belongs to a file that a key names, and must stand beside it.
  void needs_file(std::filesystem::path file) const;

  /// Returns the place of the key (of its table, if the key is absent) as "file:line", or "--set" where the
  /// key was stated there.
  std::string where(std::string_view key) const;
  /// Tells whether the command line, or a script, states the key.
  bool is_changed(std::string_view key) const;
  /// Returns the full path of the table, such as "contacts.mortar_mortar"; empty for the root.
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
  /// Returns the index of the word chosen, or `fallback` if the key is absent. Without a fallback an absent
  /// key is an error.
  std::size_t choice_index(std::string_view key, const std::vector<Word>& words,
                           std::optional<std::size_t> fallback, std::string_view fallback_word,
                           Meaning meaning) const;
  bool flag_or(std::string_view key, bool fallback, Meaning meaning) const;
  /// Notes, in a survey, that the key was read.
  void note(DeckKey key, Meaning meaning) const;

  DeckReading* deck_;
  TableReading* table_;           ///< null for a table that is missing
  std::string_view defaults_of_;  ///< name of the table that states the fallbacks, see with_defaults_of
};

/// Text that is appended to a deck, and the name of its file, for messages.
struct Appendix {
  std::string text, name;
};

/// TOML file in which every dimensional value is a string with its unit. Its reader asks for the keys it
/// knows and calls `finish`, which reports every error at once, also each key that nobody asked for.
class Deck {
 public:
  /// Opens a deck and applies changes to it.
  /// @throws DeckError if the file cannot be read, is empty or is not TOML.
  /// @throws Error for a change that cannot be made.
  /// @param changes  as "key=value" with the full path of a key ("stages[1].rate=10 K/min"). A key that the
  ///                 deck does not have is added. `text` and the places in messages are those of the changed
  ///                 deck.
  /// @param more     text that is appended before the changes are made
  static Deck open(const std::filesystem::path& file, const std::vector<std::string>& changes = {},
                   const Appendix& more = {});
  /// Parses a deck from a text; `name` takes the file's place in messages.
  static Deck parse(std::string text, std::string name, const std::vector<std::string>& changes = {},
                    const Appendix& more = {});

  Deck(Deck&&) noexcept;
  Deck& operator=(Deck&&) noexcept;
  ~Deck();

  /// Returns the file's name as given to `open`.
  const std::string& name() const;
  /// Returns the text of the deck as it was read, byte by byte.
  const std::string& text() const;

  Section root() const;

  /// Returns the warnings, in the order of the file.
  std::vector<Diagnostic> warnings() const;
  /// Returns the files that the deck names, in the order of reading.
  const std::vector<DeckFile>& files() const;
  /// Returns the text with other values, given by the full paths of their keys; a key that is missing is
  /// added.
  std::string with(const std::vector<std::pair<std::string, std::string>>& values) const;

  /// Ends the reading before its end where an error was recorded: of a value on which all others depend.
  /// @throws DeckError with every error recorded.
  void finish_early() const;
  /// Ends the reading; call it once everything is read.
  /// @throws DeckError with every error recorded, and every key that was not read.
  void finish() const;

 private:
  friend DeckSchema survey_deck(const std::function<void(const Deck&)>& read);
  explicit Deck(std::unique_ptr<DeckReading> reading);

  std::unique_ptr<DeckReading> reading_;
};

}  // namespace pyroclast
