#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pyroclast/deck/reference.hpp"
#include "pyroclast/deck/schema_json.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/stages/settle.hpp"

namespace pyroclast {
namespace {

// With a kind of stage that somebody else adds.
TEST(DeckReference, SaysWhatEveryKeyWordAndTableMeans) {
  StageRegistry kinds;
  kinds.add({"shake",
             "drives the platen up and down",
             {},
             [](const Section& s, const StageTables&) -> std::unique_ptr<Stage> {
               s.integer("turns", Range::at_least(1), "before the stage ends");
               return std::make_unique<Settle>(Settle::Keys{});
             }});
  const DeckSchema schema = deck_schema(kinds);
  EXPECT_GT(schema.tables.size(), 15U);
  EXPECT_EQ(schema.undocumented(), std::vector<std::string>{});
  const std::string page = deck_reference(schema);
  EXPECT_NE(page.find("### `kind = \"shake\"`\n\nDrives the platen up and down."), std::string::npos);
  EXPECT_NE(page.find("| `turns` | whole number |"), std::string::npos);
  EXPECT_EQ(schema_of(json_of(schema)), schema);
  EXPECT_THROW(schema_of("{}"), Error);
  EXPECT_THROW(schema_of("tables"), Error);
}

}  // namespace
}  // namespace pyroclast
