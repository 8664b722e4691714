#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/base/read_file.hpp"
#include "pyroclast/deck/reference.hpp"
#include "pyroclast/deck/schema_json.hpp"
#include "pyroclast/setup/read_stages.hpp"
#include "pyroclast/stages/settle.hpp"

namespace pyroclast {
namespace {

// The build leaves the keys of all decks in a file, which takes a while.
TEST(DeckReference, SaysWhatEveryKeyWordAndTableMeans) {
  const DeckSchema schema = schema_of(read_file(DECK_KEYS));
  EXPECT_GT(schema.tables.size(), 15U);
  EXPECT_EQ(schema.undocumented(), std::vector<std::string>{});
  EXPECT_EQ(schema_of(json_of(schema)), schema);
  EXPECT_THROW(schema_of("{}"), Error);
  EXPECT_THROW(schema_of("tables"), Error);
}

TEST(DeckReference, HasAKindOfStageThatSomebodyElseAdds) {
  StageRegistry kinds;
  kinds.add({"shake",
             "drives the platen up and down",
             {},
             [](const Section& s, const StageTables&) -> std::unique_ptr<Stage> {
               s.integer("turns", Range::at_least(1), "before the stage ends");
               return std::make_unique<Settle>(Settle::Keys{});
             }});
  const std::string page = deck_reference(
      survey_deck([&](const Deck& deck) { read_stages(deck.root(), kinds, {}, DeckSpace{}, {}); }));
  EXPECT_NE(page.find("### `kind = \"shake\"`\n\nDrives the platen up and down."), std::string::npos);
  EXPECT_NE(page.find("| `turns` | whole number |"), std::string::npos);
}

}  // namespace
}  // namespace pyroclast
