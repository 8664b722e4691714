#include "pyroclast/deck/editor_schema.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"
#include "pyroclast/deck/key_path.hpp"
#include "pyroclast/units/quantity_pattern.hpp"

namespace pyroclast {
namespace {

using Json = nlohmann::ordered_json;

const Unit& unit_of_kind(const std::string& kind) {
  for (const Unit* unit : unit::all)
    if (unit->name == kind) return *unit;
  throw Error(fmt::format("there is no kind of quantity \"{}\"", kind));
}

Json reference_to(const std::string& definition) {
  return {{"$ref", fmt::format("#/definitions/{}", definition)}};
}

Json any_of(std::vector<Json> ways) {
  if (ways.size() == 1) return ways.front();
  return {{"anyOf", std::move(ways)}};
}

/// Returns a word, flag or number as JSON from its text in a deck; a quantity is a text there.
Json value_in_deck(const std::string& written) {
  const Json value = Json::parse(written, nullptr, false);
  return value.is_discarded() ? Json(written) : value;
}

void add_range(Json& number, const Range& range) {
  if (std::isfinite(range.lower)) {
    number["minimum"] = range.lower;
    if (!range.lower_inclusive) number["exclusiveMinimum"] = true;
  }
  if (std::isfinite(range.upper)) {
    number["maximum"] = range.upper;
    if (!range.upper_inclusive) number["exclusiveMaximum"] = true;
  }
}

Json quantity(const std::string& kind, const Range& range) {
  const Unit& unit = unit_of_kind(kind);
  Json text = reference_to(kind);
  if (const std::string beyond = out_of_range_pattern(unit, range); !beyond.empty())
    text = {{"allOf", {text, {{"not", {{"type", "string"}, {"pattern", beyond}}}}}}};
  if (unit != unit::dimensionless) return text;
  Json number{{"type", "number"}};
  add_range(number, range);
  return any_of({number, text});
}

Json list_of(const Json& items, std::size_t least, std::optional<std::size_t> most = {}) {
  Json list{{"type", "array"}, {"items", items}};
  if (least > 0) list["minItems"] = least;
  if (most) list["maxItems"] = *most;
  return list;
}

Json one_value(const DeckKey& key) {
  switch (key.form) {
    case ValueForm::text:
    case ValueForm::word_or_text:
      return {{"type", "string"}, {"minLength", 1}};
    case ValueForm::word: {
      Json words = Json::array();
      for (const DeckWord& word : key.words) words.push_back(value_in_deck(word.word));
      return {{"enum", words}};
    }
    case ValueForm::flag:
      return {{"type", "boolean"}};
    case ValueForm::integer: {
      Json number{{"type", "integer"}};
      add_range(number, key.range);
      return number;
    }
    case ValueForm::quantity:
      return quantity(key.kinds[0], key.range);
    case ValueForm::place:
      return list_of(quantity(key.kinds[0], Range::any()), 2, 2);
    case ValueForm::place_in_space:
      return list_of(quantity(key.kinds[0], Range::any()), 2, 3);
    case ValueForm::points: {
      const Json point{
          {"type", "array"},
          {"items", {quantity(key.kinds[0], Range::any()), quantity(key.kinds[1], Range::any())}},
          {"minItems", 2},
          {"maxItems", 2}};
      return list_of(point, 2);
    }
    case ValueForm::anything:
    case ValueForm::table:
      break;
  }
  return Json::object();
}

Json value_of(const DeckKey& key) {
  Json value = key.is_list ? list_of(one_value(key), key.fallback == "[]" ? 0 : 1) : one_value(key);
  if (!key.forms.empty() && key.form != ValueForm::anything)
    value = any_of({std::move(value), reference_to(key.forms)});
  return value;
}

/// Returns the meaning of a key, its range and its words, for the window that an editor shows.
std::string description(const DeckKey& key) {
  std::string text = key.meaning;
  if (const std::string range = key.range.describe_all(key.unit); !range.empty())
    text += (text.empty() ? "" : "; ") + range;
  for (const DeckWord& word : key.words)
    if (!word.meaning.empty()) text += fmt::format("\n{}: {}", word.word, word.meaning);
  return text;
}

/// Returns what may stand under a key that is read in several ways.
Json property(const std::vector<DeckKey>& ways) {
  std::vector<Json> values;
  std::string meaning;
  for (const DeckKey& key : ways) {
    Json value = value_of(key);
    if (std::ranges::find(values, value) == values.end()) values.push_back(std::move(value));
    if (const std::string text = description(key); meaning.find(text) == std::string::npos)
      meaning += (meaning.empty() ? "" : "\n") + text;
  }
  Json result = any_of(std::move(values));
  if (result.contains("$ref")) result = {{"allOf", {result}}};  // whose neighbours draft 4 ignores
  if (!meaning.empty()) result["description"] = meaning;
  const std::string& fallback = ways.front().fallback;
  const bool is_no_value = fallback.empty() || fallback.starts_with("as in [") || fallback == "none";
  if (!is_no_value && std::ranges::all_of(ways, [&](const DeckKey& k) { return k.fallback == fallback; }))
    result["default"] = value_in_deck(fallback);
  return result;
}

std::vector<std::string> steps_of(std::string_view path) {
  std::vector<std::string> steps;
  while (!path.empty()) {
    const auto end = std::min(path.find('.'), path.size());
    steps.emplace_back(path.substr(0, end));
    path.remove_prefix(std::min(end + 1, path.size()));
  }
  return steps;
}

/// Tells whether a step, such as "NAME", stands for tables of any name.
bool is_placeholder(std::string_view step) {
  return std::ranges::all_of(step, [](char c) { return c >= 'A' && c <= 'Z'; });
}

/// Returns a condition that holds where a table below is there and meets another: of an array, one element.
Json somewhere(const std::vector<std::string>& steps, std::size_t from, Json inner) {
  for (std::size_t i = steps.size(); i-- > from;) {
    const std::string name = without_brackets(steps[i]);
    if (is_array_path(steps[i])) inner = {{"not", {{"items", {{"not", std::move(inner)}}}}}};
    inner = {{"required", {name}}, {"properties", {{name, std::move(inner)}}}};
  }
  return inner;
}

/// Writer of the schema of all tables.
class EditorSchema {
 public:
  explicit EditorSchema(const DeckSchema& schema) : schema_(schema) {
    for (const DeckTable& table : schema.tables) add(table);
    for (const DeckTable& table : schema.tables) require_all(table);
  }

  Json written(const std::string& title) const {
    Json result{{"$schema", "http://json-schema.org/draft-04/schema#"}, {"title", title}};
    result.update(object_of(root_));
    Json& definitions = result["definitions"] = Json::object();
    for (const auto& [name, node] : forms_) {
      definitions[name] = object_of(node);
      definitions[name]["minProperties"] = 1;
    }
    for (const std::string& kind : kinds_)
      definitions[kind] = {{"type", "string"}, {"pattern", quantity_pattern(unit_of_kind(kind))}};
    return result;
  }

 private:
  /// Entry of a list that is searched by name. Clang 14 cannot hold a pair with a type that holds such a
  /// list.
  template <class T>
  struct Named {
    std::string name;
    T value;
  };

  /// Table with its keys, and the tables in it by their steps.
  struct Node {
    const DeckTable* table = nullptr;
    std::vector<Named<std::vector<DeckKey>>> keys;
    std::vector<Named<Node>> tables;
    std::vector<Json> rules;

    template <class T>
    static T& in(std::vector<Named<T>>& list, const std::string& name) {
      const auto known = std::ranges::find(list, name, &Named<T>::name);
      if (known != list.end()) return known->value;
      list.push_back({name, T{}});
      return list.back().value;
    }
  };

  /// Returns the steps to a table from the object that holds it: the deck, or a form itself.
  static std::vector<std::string> steps_to(const DeckTable& table) {
    return table.is_form ? std::vector<std::string>{} : steps_of(table.path);
  }

  /// Returns the node some steps along the way to a table.
  Node& node_at(const DeckTable& table, const std::vector<std::string>& steps, std::size_t count) {
    Node* node = table.is_form ? &forms_[table.path] : &root_;
    for (std::size_t i = 0; i < count; ++i) node = &Node::in(node->tables, steps[i]);
    return *node;
  }

  void add(const DeckTable& table) {
    const std::vector<std::string> steps = steps_to(table);
    Node& node = node_at(table, steps, steps.size());
    node.table = &table;
    for (const DeckKey& key : table.keys) {
      Node::in(node.keys, key.key).push_back(key);
      kinds_.insert(key.kinds.begin(), key.kinds.end());
    }
  }

  void require_all(const DeckTable& table) {
    for (const DeckKey& key : table.keys) {
      if (!key.is_needed()) continue;
      std::vector<KeyCondition> conditions = table.conditions;
      conditions.insert(conditions.end(), key.conditions.begin(), key.conditions.end());
      require(table, key.key, conditions);
    }
    if (table.has_names_of_deck) return;  // which it needs only where the deck says so
    for (const DeckKey& needed : table.needed_tables)
      if (!needed.optional) require(table, without_brackets(needed.key), needed.conditions);
  }

  /// Returns a condition for a table that has a key, or, where it may, none of those that it needs.
  static Json needed(const DeckTable& table, const std::string& key) {
    const Json has{{"required", {key}}};
    if (!table.may_lack_all) return has;
    std::vector<Json> has_one;
    for (const DeckKey& other : table.keys)
      if (other.is_needed()) has_one.push_back({{"required", {other.key}}});
    return any_of({has, {{"not", any_of(std::move(has_one))}}});
  }

  /// Adds a rule that a table has a key under conditions, to the least table that holds all of them.
  void require(const DeckTable& table, const std::string& key, const std::vector<KeyCondition>& conditions) {
    const std::vector<std::string> steps = steps_to(table);
    // by the number of steps to the table that holds the key and the condition
    std::map<std::size_t, std::vector<Json>> failing;
    failing[steps.size()];
    for (const KeyCondition& condition : conditions) {
      if (table.is_form && condition.table != table.path) return;  // which a form cannot see
      const std::vector<std::string> others = table.is_form ? steps : steps_of(condition.table);
      const auto common = static_cast<std::size_t>(std::ranges::mismatch(steps, others).in1 - steps.begin());
      if (std::ranges::any_of(others.begin() + static_cast<std::ptrdiff_t>(common), others.end(),
                              is_placeholder))
        return;  // of tables of any name none is meant
      failing[common].push_back({{"not", somewhere(others, common, condition_on(condition))}});
    }
    Json rule = needed(table, key);
    std::size_t level = steps.size();
    for (auto at = failing.rbegin(); at != failing.rend(); ++at) {
      rule = wherever(steps, at->first, level, std::move(rule));
      level = at->first;
      at->second.push_back(std::move(rule));
      rule = any_of(std::move(at->second));
    }
    std::vector<Json>& rules = node_at(table, steps, level).rules;
    if (std::ranges::find(rules, rule) == rules.end()) rules.push_back(std::move(rule));
  }

  /// Returns a condition on a table some steps below, where there is one: on each element of an array, on
  /// each table of any name but those that have names of their own.
  Json wherever(const std::vector<std::string>& steps, std::size_t from, std::size_t to, Json inner) const {
    for (std::size_t i = to; i-- > from;) {
      if (is_array_path(steps[i])) inner = {{"items", std::move(inner)}};
      if (!is_placeholder(steps[i])) {
        inner = {{"properties", {{without_brackets(steps[i]), std::move(inner)}}}};
        continue;
      }
      Json own = Json::object();
      for (const DeckTable& table : schema_.tables) {
        const auto at = steps_of(table.path);
        if (at.size() == i + 1 && std::equal(at.begin(), at.end() - 1, steps.begin()) &&
            !is_placeholder(at[i]))
          own[without_brackets(at[i])] = Json::object();
      }
      inner = {{"additionalProperties", std::move(inner)}};
      if (!own.empty()) inner["properties"] = std::move(own);
    }
    return inner;
  }

  /// Returns a condition for the table that holds its key.
  Json condition_on(const KeyCondition& condition) const {
    const Json present{{"required", {condition.key}}};
    if (condition.kind == KeyCondition::Kind::present) return present;
    if (condition.kind == KeyCondition::Kind::absent) return {{"not", present}};
    Json values = Json::array();
    for (const std::string& value : condition.with) values.push_back(value_in_deck(value));
    Json result{{"properties", {{condition.key, {{"enum", values}}}}}};
    if (!is_fallback(condition)) result.update(present);
    return result;
  }

  /// Tells whether a condition holds where its key is left out.
  bool is_fallback(const KeyCondition& condition) const {
    const auto table = std::ranges::find(schema_.tables, condition.table, &DeckTable::path);
    if (table == schema_.tables.end()) return false;
    const auto key = std::ranges::find(table->keys, condition.key, &DeckKey::key);
    return key != table->keys.end() &&
           std::ranges::find(condition.with, key->fallback) != condition.with.end();
  }

  static Json object_of(const Node& node) {
    Json result{{"type", "object"}};
    if (node.table && !node.table->meaning.empty()) result["description"] = node.table->meaning;
    Json& properties = result["properties"] = Json::object();
    for (const auto& [key, ways] : node.keys) properties[key] = property(ways);
    std::vector<Json> of_any_name;
    const bool takes_names = node.table && node.table->has_names_of_deck;
    for (const auto& [step, table] : node.tables) {
      Json object = object_of(table);
      if (is_array_path(step)) object = list_of(object, 1);
      const std::string name = without_brackets(step);
      if (takes_names || is_placeholder(name)) of_any_name.push_back(object);
      if (is_placeholder(name)) continue;
      properties[name] = properties.contains(name) ? any_of({properties[name], object}) : object;
    }
    result["additionalProperties"] = of_any_name.empty() ? Json(false) : any_of(std::move(of_any_name));
    if (node.table && node.table->has_any_keys) result.erase("additionalProperties");
    for (const Json& rule : node.rules) result["allOf"].push_back(rule);
    if (!node.table || node.table->code_key.empty()) return result;
    // code of one's own has keys of its own
    const auto code = std::ranges::find(node.keys, node.table->code_key, &Named<std::vector<DeckKey>>::name);
    return any_of({result, holds_other_text(code->name, code->value.front())});
  }

  static Json holds_other_text(const std::string& key, const DeckKey& words) {
    Json known = Json::array();
    for (const DeckWord& word : words.words) known.push_back(value_in_deck(word.word));
    return {{"type", "object"}, {"required", {key}}, {"properties", {{key, {{"not", {{"enum", known}}}}}}}};
  }

  const DeckSchema& schema_;
  Node root_;
  std::map<std::string, Node> forms_;
  std::set<std::string> kinds_;
};

}  // namespace

std::string editor_schema(const DeckSchema& schema, const std::string& title) {
  return EditorSchema(schema).written(title).dump(1) + '\n';
}

}  // namespace pyroclast
