#include <fmt/format.h>

#include "pyroclast/app/commands.hpp"
#include "pyroclast/deck/reference.hpp"
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

}  // namespace

int print_keys() {
  fmt::print("{}{}", kKeysIntroduction, deck_reference(deck_schema()));
  return 0;
}

}  // namespace pyroclast::app
