#include <filesystem>

#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/base/own_program.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/deck/reference.hpp"
#include "pyroclast/deck/schema_json.hpp"
#include "pyroclast/setup/setup.hpp"

namespace pyroclast::app {

namespace {

constexpr auto kKeysIntroduction = R"(# Deck reference

Every table and key that a deck may hold. `pyroclast keys` prints this page from the code that reads decks.
[deck.md](deck.md) and [heat.md](heat.md) explain what needs more than a line.

A value with a dimension is written with its unit, such as `"150 mm"`. Any unit of that dimension will do. The columns
"allowed" and "default" hold for the column "unit". A default of "–" means: the key may be left out, and nothing takes
its place. `[[name]]` is a table of which there may be several.

Where something depends on `stages.kind`: "with" means that one stage at least is of this kind, "not with" that not all
stages are.

)";

/// File that the build leaves beside the program: to find all keys takes some 15 s.
constexpr auto kFile = "deck_keys.json";

}  // namespace

DeckSchema known_deck_schema() {
  for (const auto* folder : {PYROCLAST_DATA, "generated"}) {
    const auto file = own_prefix() / folder / kFile;
    if (std::filesystem::exists(file)) return schema_of(read_file(file));
  }
  return deck_schema();
}

int print_keys(const KeysOptions& options) {
  const DeckSchema schema = options.survey ? deck_schema() : known_deck_schema();
  if (options.json)
    fmt::print("{}", json_of(schema));
  else
    fmt::print("{}{}", kKeysIntroduction, deck_reference(schema));
  return 0;
}

}  // namespace pyroclast::app
