#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pyroclast/deck/deck.hpp"

namespace pyroclast {

/// One of the words that a key may hold.
struct DeckWord {
  std::string word;
  std::string meaning;

  bool operator==(const DeckWord&) const = default;
};

/// A setting elsewhere in the deck that decides whether a key is read.
struct KeyCondition {
  enum class Kind : std::uint8_t { present, absent, value };

  std::string table, key;  ///< of the setting
  Kind kind = Kind::value;
  std::vector<std::string> with;     ///< Kind::value: as written in a deck; the key is read with these ...
  std::vector<std::string> without;  ///< ... and not with these

  bool operator==(const KeyCondition&) const = default;
};

/// What a deck may say under one key.
struct DeckKey {
  std::string key;
  std::string value;      ///< what is written, such as "length"
  std::string unit;       ///< unit of `allowed` and `fallback`; may be empty
  std::string allowed;    ///< range in words; empty if everything is allowed
  std::string fallback;   ///< what holds if the key is left out; empty if it has to be there, or is optional
  bool optional = false;  ///< may be left out, and nothing takes its place
  std::vector<DeckWord> words;
  std::string meaning;
  std::vector<KeyCondition> conditions;  ///< all of which must hold

  bool operator==(const DeckKey&) const = default;
};

/// What a deck may say in one table, or in each of an array of tables.
struct DeckTable {
  std::string path;       ///< such as "materials.mortar", or "stages[]" for an array; empty for the root
  bool is_form = false;   ///< forms of a value that keys of several tables take; `path` is then a name
  bool optional = false;  ///< may be left out
  std::string meaning;
  /// In the order of reading; a key that is read in two ways, or under either of two conditions, stands
  /// twice.
  std::vector<DeckKey> keys;
  std::vector<KeyCondition> conditions;  ///< of all its keys
};

/// Everything that a reader asks of a deck.
struct DeckSchema {
  std::vector<DeckTable> tables;  ///< in the order of reading, without tables that hold tables only

  /// Full paths of keys, words and tables that no meaning was given for, and of keys that are known
  /// (`Section::know`, `has`) but read with no settings.
  std::vector<std::string> undocumented() const;

  std::vector<std::string> never_read;  ///< full paths of the latter
};

/// Reads a deck; what it makes of it is its own affair.
using DeckReader = std::function<void(const Deck&)>;

/// What `read` asks of a deck under any settings.
///
/// It is called many times, each time with a deck that has no text and answers otherwise: which word a choice
/// holds, whether a flag is set, whether an optional key or table is there. Where an answer leads to a key or
/// a question not met before, every other answer of that call is changed in turn. So keys are found that
/// depend on words, flags and the presence of keys, one behind the other, and for each what it depends on.
/// Two sorts are missed: keys that depend on the value of a number or a text, and keys that two answers open
/// only together, neither of which changes alone what is asked. A reader asks for such keys always, or makes
/// them known (`Section::know`), and `never_read` tells.
///
/// Values are stand-ins that their ranges allow, and `Section::ok` is false, as after an error: a reader asks
/// for all keys before it looks whether their values go together. `Deck::finish` does not throw.
DeckSchema survey_deck(const DeckReader& read);

}  // namespace pyroclast
