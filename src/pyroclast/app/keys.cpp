#include <filesystem>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/deck/editor_schema.hpp"
#include "pyroclast/deck/reference.hpp"
#include "pyroclast/deck/schema_json.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast::app {

namespace {

struct KeysOptions {
  bool json = false;
  bool schema = false;
  bool survey = false;  ///< true to ask the readers of decks, false for what they left at the build
};

constexpr auto kKeysIntroduction = R"(# Deck reference

Every table and key that a deck may hold, printed by the code that reads decks (`pyroclast keys`).
[The deck](../understand/deck.md) and [Heat](../understand/heat.md) explain what needs more than a line.

A value with a dimension is written with its unit, such as `"150 mm"`. Any unit of that dimension will do. The columns
"allowed" and "default" hold for the column "unit". A default of "–" means: the key may be left out, and nothing takes
its place. `[[name]]` is a table of which there may be several.

Where something depends on `stages.kind`: "with" means that one stage at least is of this kind, "not with" that not all
stages are.

)";

/// Finds a file that the build leaves beside the program; empty where there is none.
std::filesystem::path file_of_build(std::string_view name) {
  for (const auto* folder : {PYROCLAST_DATA, "generated"})
    if (auto file = own_prefix() / folder / name; std::filesystem::exists(file)) return file;
  return {};
}

int print_keys(const KeysOptions& options) {
  const DeckSchema schema = options.survey ? deck_schema() : known_deck_schema();
  if (options.schema)
    fmt::print("{}", editor_schema(schema, "Deck of Pyroclast"));
  else if (options.json)
    fmt::print("{}", json_of(schema));
  else
    fmt::print("{}{}", kKeysIntroduction, deck_reference(schema));
  return 0;
}

}  // namespace

DeckSchema known_deck_schema() {
  const auto file = file_of_build("deck_keys.json");  // to find all keys takes some 15 s
  return file.empty() ? deck_schema() : schema_of(read_file(file));
}

Command add_keys(CLI::App& cli) {
  const auto options = std::make_shared<KeysOptions>();
  auto* keys = cli.add_subcommand("keys", "Print all keys of decks, as Markdown");
  keys->add_flag("--json", options->json, "Print JSON");
  keys->add_flag("--schema", options->schema,
                 "Print a JSON Schema (draft 4), with which editors complete and check decks");
  keys->add_flag("--survey", options->survey,
                 "Ask the readers of decks again, not the file of the build; takes a while")
      ->group("");
  return {keys, [options](const auto&) { return print_keys(*options); }};
}

}  // namespace pyroclast::app
