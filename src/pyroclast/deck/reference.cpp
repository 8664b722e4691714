#include "pyroclast/deck/reference.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/deck/key_path.hpp"

namespace pyroclast {
namespace {

constexpr auto kNoWord = "";

/// Longest line outside of tables, in characters.
constexpr int kLineLength = 120;

std::string code(std::string_view text) {
  return fmt::format("`{}`", text);
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string sentence(const std::string& text) {
  if (text.empty()) return text;
  return fmt::format("{}{}", capitalised(text), text.back() == '.' ? "" : ".");
}

/// Joins the sentences that are not empty.
std::string paragraph(const std::vector<std::string>& sentences) {
  std::vector<std::string> said;
  for (const std::string& s : sentences)
    if (!s.empty()) said.push_back(s);
  return fmt::format("{}", fmt::join(said, " "));
}

/// Breaks a text into lines.
std::string wrapped(const std::string& text) {
  std::string result;
  int length = 0;  // characters of the present line
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string word = text.substr(begin, end - begin);
    const auto characters = static_cast<int>(
        std::count_if(word.begin(), word.end(), [](char c) { return (c & 0xC0) != 0x80; }));  // UTF-8
    const bool fits = length + 1 + characters <= kLineLength;
    if (!result.empty()) result += fits ? ' ' : '\n';
    length = result.empty() || !fits ? characters : length + 1 + characters;
    result += word;
    begin = end + 1;
  }
  return result;
}

std::string header(const DeckTable& table) {
  if (table.is_form) return capitalised(table.path);
  if (table.path.empty()) return "At the top of the deck";
  return is_array_path(table.path) ? fmt::format("`[[{}]]`", without_brackets(table.path))
                                   : fmt::format("`[{}]`", table.path);
}

/// Returns a setting as it stands in a deck, with its table if that is another one.
std::string setting(const KeyCondition& condition, const std::string& table) {
  if (condition.table == table) return condition.key;
  std::string path = condition.table;
  for (auto at = path.find("[]"); at != std::string::npos; at = path.find("[]")) path.erase(at, 2);
  return path.empty() ? condition.key : fmt::format("{}.{}", path, condition.key);
}

/// Returns a condition in words, such as 'With `mass = "scaled"`', or 'Not with `kind = "conduct"`'.
std::string when(const KeyCondition& condition, const std::string& table) {
  const std::string key = setting(condition, table);
  if (condition.kind == KeyCondition::Kind::present) return fmt::format("With `{}`", key);
  if (condition.kind == KeyCondition::Kind::absent) return fmt::format("Without `{}`", key);
  const bool few = condition.with.size() <= condition.without.size();
  std::vector<std::string> settings;
  for (const std::string& value : few ? condition.with : condition.without)
    settings.push_back(fmt::format("`{} = {}`", key, value));
  return fmt::format("{} {}", few ? "With" : "Not with", fmt::join(settings, " or "));
}

std::string when(const std::vector<KeyCondition>& conditions, const std::string& table) {
  std::vector<std::string> all;
  for (const KeyCondition& condition : conditions) all.push_back(sentence(when(condition, table)));
  return paragraph(all);
}

/// Returns a text that ends no cell of a table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string row(const DeckTable& table, const DeckKey& key) {
  std::vector<std::string> words, meaning{when(key.conditions, table.path), sentence(key.meaning)};
  for (const DeckWord& word : key.words) {
    words.push_back(code(word.word));
    if (!word.meaning.empty()) meaning.push_back(fmt::format("`{}`: {}", word.word, sentence(word.meaning)));
  }
  const std::string fallback = key.is_needed() ? "needed" : key.fallback.empty() ? "–" : code(key.fallback);
  const std::string value = words.empty() ? key.value : fmt::format("one of {}", fmt::join(words, ", "));
  return fmt::format("| `{}` | {} | {} | {} | {} | {} |\n", key.key, cell(value), key.unit,
                     key.range.describe_all(), fallback, cell(paragraph(meaning)));
}

/// Returns the rows of keys that are read with one word of the key `decisive`.
/// \param word  word of `decisive`; kNoWord: the rows of keys that do not depend on `decisive`
std::string rows(const DeckTable& table, const std::string& decisive, const std::string& word) {
  std::string text;
  for (DeckKey key : table.keys) {
    const auto decides = [&](const KeyCondition& c) { return c.table == table.path && c.key == decisive; };
    const auto condition = std::find_if(key.conditions.begin(), key.conditions.end(), decides);
    const bool depends = !decisive.empty() && condition != key.conditions.end();
    if (depends != (word != kNoWord)) continue;
    if (depends) {
      const auto& with = condition->with;
      if (std::find(with.begin(), with.end(), word) == with.end()) continue;
      key.conditions.erase(condition);
    }
    if (key.key == decisive)  // a word with a part of its own is explained there
      for (DeckWord& w : key.words)
        if (!rows(table, decisive, w.word).empty()) w.meaning.clear();
    text += row(table, key);
  }
  if (text.empty()) return "";
  return "| key | value | unit | allowed | default | meaning |\n|---|---|---|---|---|---|\n" + text;
}

/// Finds the key whose words decide on the others: most of its words have keys of their own.
const DeckKey* decisive_key(const DeckTable& table) {
  for (const DeckKey& key : table.keys) {
    const auto has_keys = [&](const DeckWord& word) {
      return std::any_of(table.keys.begin(), table.keys.end(), [&](const DeckKey& other) {
        return std::any_of(other.conditions.begin(), other.conditions.end(), [&](const KeyCondition& c) {
          return c.table == table.path && c.key == key.key && !c.without.empty() &&
                 std::find(c.with.begin(), c.with.end(), word.word) != c.with.end();
        });
      });
    };
    const auto count = std::count_if(key.words.begin(), key.words.end(), has_keys);
    if (count > 1 && 2 * count > static_cast<std::ptrdiff_t>(key.words.size())) return &key;
  }
  return nullptr;
}

std::string body(const DeckTable& table) {
  const DeckKey* decisive = decisive_key(table);
  if (!decisive) return rows(table, "", kNoWord);
  std::string text = rows(table, decisive->key, kNoWord);
  for (const DeckWord& word : decisive->words) {
    const std::string part = rows(table, decisive->key, word.word);
    if (part.empty()) continue;
    text += fmt::format("\n### `{} = {}`\n\n", decisive->key, word.word);
    if (!word.meaning.empty()) text += fmt::format("{}\n\n", wrapped(sentence(word.meaning)));
    text += part;
  }
  return text;
}

std::string introduction(const DeckTable& table) {
  return paragraph({sentence(table.meaning), table.optional && !table.is_form ? "May be left out." : "",
                    when(table.conditions, table.path)});
}

}  // namespace

std::string deck_reference(const DeckSchema& schema) {
  std::vector<const DeckTable*> open;
  for (const DeckTable& table : schema.tables)
    if (!table.keys.empty()) open.push_back(&table);
  std::string text;
  while (!open.empty()) {
    const DeckTable& first = *open.front();
    const auto is_alike = [&](const DeckTable* t) {
      return t == &first || (introduction(*t) == introduction(first) && body(*t) == body(first));
    };
    std::vector<std::string> headers;
    for (const DeckTable* table : open)
      if (is_alike(table)) headers.push_back(header(*table));
    text += fmt::format("{}## {}\n\n", text.empty() ? "" : "\n", fmt::join(headers, ", "));
    if (const std::string words = introduction(first); !words.empty())
      text += fmt::format("{}\n\n", wrapped(words));
    text += body(first);
    std::erase_if(open, is_alike);
  }
  return text;
}

}  // namespace pyroclast
