#include "pyroclast/deck/schema_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pyroclast/base/error.hpp"

namespace pyroclast {

NLOHMANN_JSON_SERIALIZE_ENUM(KeyCondition::Kind, {{KeyCondition::Kind::present, "present"},
                                                  {KeyCondition::Kind::absent, "absent"},
                                                  {KeyCondition::Kind::value, "value"}})
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckWord, word, meaning)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(KeyCondition, table, key, kind, with, without)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckKey, key, value, unit, allowed, fallback, optional, words, meaning,
                                   conditions)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(DeckTable, path, is_form, optional, meaning, keys, conditions)
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
