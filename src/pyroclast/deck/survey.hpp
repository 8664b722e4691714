#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pyroclast/base/range.hpp"
#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// One of the words that a key may hold.
struct DeckWord {
  std::string word;
  std::string meaning;

  bool operator==(const DeckWord&) const = default;
};

/// Setting elsewhere in the deck that decides whether a key is read.
struct KeyCondition {
  enum class Kind : std::uint8_t { present, absent, value };

  std::string table, key;  ///< table and key of the setting
  Kind kind = Kind::value;
  /// Values, as written in a deck, with which the key is read; for Kind::value.
  std::vector<std::string> with;
  std::vector<std::string> without;  ///< values with which the key is not read; for Kind::value

  bool operator==(const KeyCondition&) const = default;
};

/// Contents that a deck may have under one key.
struct DeckKey {
  std::string key;
  std::string value;  ///< written form of the value in words, such as "length"
  ValueForm form = ValueForm::anything;
  bool is_list = false;
  /// Names of the kinds of quantity that the value holds, as Unit has them; two for points.
  std::vector<std::string> kinds;
  std::string forms;  ///< name of the forms of a table that the value may be; empty if it may be none
  std::string unit;   ///< unit of `range` and `fallback`; may be empty
  Range range;        ///< allowed and usual values
  /// Value of a key that is left out; empty if the key has to be there, or is optional.
  std::string fallback;
  bool optional = false;  ///< true for a key that may be left out and has no fallback
  std::vector<DeckWord> words;
  std::string meaning;
  std::vector<KeyCondition> conditions;  ///< conditions, all of which must hold

  /// Tells whether the key has to be there where its conditions hold.
  bool is_needed() const { return !optional && fallback.empty(); }

  bool operator==(const DeckKey&) const = default;
};

/// Contents that a deck may have in one table, or in each table of an array.
struct DeckTable {
  std::string path;  ///< path such as "materials.mortar", or "stages[]" for an array; empty for the root
  /// True for forms of a value that keys of several tables take; `path` is then a name.
  bool is_form = false;
  bool optional = false;  ///< true for a table that may be left out
  std::string meaning;
  /// Keys in the order of reading; a key that is read in two ways, or under either of two conditions, stands
  /// twice.
  std::vector<DeckKey> keys;
  /// Tables in this one that must be there, with the conditions of each; an array's name ends with "[]".
  std::vector<DeckKey> needed_tables;
  /// True where further tables like those below may stand, whose names the deck chooses.
  bool has_names_of_deck = false;
  bool has_any_keys = false;  ///< true where the deck chooses the names of keys
  /// True where the reader asks which keys there are, and may need none where there is no other.
  bool may_lack_all = false;
  /// Key whose other texts stand for code, which has further keys of its own; empty if there is none.
  std::string code_key;
  std::vector<KeyCondition> conditions;  ///< conditions of all keys of the table

  bool operator==(const DeckTable&) const = default;
};

/// Everything that a reader asks of a deck.
struct DeckSchema {
  std::vector<DeckTable> tables;  ///< tables in the order of reading, without tables that hold tables only

  /// Returns the full paths of keys, words and tables without a meaning, and of keys that are known
  /// (`Section::know`, `has`) but read with no settings.
  std::vector<std::string> undocumented() const;

  std::vector<std::string> never_read;  ///< full paths of keys that are known but read with no settings

  bool operator==(const DeckSchema&) const = default;
};

/// Function that reads a deck.
using DeckReader = std::function<void(const Deck&)>;

/// Finds all keys that `read` asks of a deck under any settings.
///
/// The survey calls `read` many times, each time with a deck that has no text. The deck answers otherwise
/// each time: which word a choice holds, whether a flag is set, whether an optional key or table is there.
/// Where an answer leads to a key or a question not met before, every other answer of that call is changed in
/// turn. So the survey finds keys that depend on words, flags and the presence of keys, one behind the other,
/// and the conditions of each key. Two sorts of keys are missed: keys that depend on the value of a number or
/// a text, and keys that two answers open only together, where neither answer alone changes the questions. A
/// reader asks for such keys always, or makes them known (`Section::know`); `never_read` lists them.
///
/// Values are stand-ins that their ranges allow, and `Section::ok` is false, as after an error: a reader asks
/// for all keys before it checks whether their values go together. `Deck::finish` does not throw.
DeckSchema survey_deck(const DeckReader& read);

}  // namespace pyroclast
