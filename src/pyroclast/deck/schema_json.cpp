#include "pyroclast/deck/schema_json.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

NLOHMANN_JSON_SERIALIZE_ENUM(KeyCondition::Kind, {{KeyCondition::Kind::present, "present"},
                                                  {KeyCondition::Kind::absent, "absent"},
                                                  {KeyCondition::Kind::value, "value"}})
NLOHMANN_JSON_SERIALIZE_ENUM(ValueForm, {{ValueForm::anything, "anything"},
                                         {ValueForm::text, "text"},
                                         {ValueForm::word, "word"},
                                         {ValueForm::word_or_text, "word or text"},
                                         {ValueForm::flag, "flag"},
                                         {ValueForm::integer, "integer"},
                                         {ValueForm::quantity, "quantity"},
                                         {ValueForm::place, "place"},
                                         {ValueForm::place_in_space, "place in space"},
                                         {ValueForm::points, "points"},
                                         {ValueForm::table, "table"}})

namespace {

/// An end that is not finite is null.
nlohmann::json json_of_end(double end) {
  return std::isfinite(end) ? nlohmann::json(end) : nlohmann::json();
}
double end_of(const nlohmann::json& end, double infinite) {
  return end.is_null() ? infinite : end.get<double>();
}

}  // namespace

void to_json(nlohmann::json& json, const Range& range) {
  json = {{"lower", json_of_end(range.lower)},
          {"upper", json_of_end(range.upper)},
          {"lower_inclusive", range.lower_inclusive},
          {"upper_inclusive", range.upper_inclusive},
          {"usual_lower", json_of_end(range.usual_lower)},
          {"usual_upper", json_of_end(range.usual_upper)}};
}

void from_json(const nlohmann::json& json, Range& range) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  range = {.lower = end_of(json.at("lower"), -kInfinite),
           .upper = end_of(json.at("upper"), kInfinite),
           .lower_inclusive = json.at("lower_inclusive"),
           .upper_inclusive = json.at("upper_inclusive"),
           .usual_lower = end_of(json.at("usual_lower"), -kInfinite),
           .usual_upper = end_of(json.at("usual_upper"), kInfinite)};
}

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckWord, word, meaning)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KeyCondition, table, key, kind, with, without)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckKey, key, value, form, is_list, kinds, forms, unit, range, fallback,
                                   optional, words, meaning, conditions)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckTable, path, is_form, optional, meaning, keys, needed_tables,
                                   has_names_of_deck, has_any_keys, may_lack_all, code_key, conditions)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckSchema, tables, never_read)

std::string json_of(const DeckSchema& schema) {
  return nlohmann::json(schema).dump(1) + '\n';
}

DeckSchema schema_of(const std::string& json) {
  try {
    return nlohmann::json::parse(json).get<DeckSchema>();
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("no schema of decks: {}", error.what()));
  }
}

}  // namespace pyroclast
