#include "pyroclast/deck/survey.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "diagnostics_of.hpp"
#include "pyroclast/deck/reference.hpp"

// of its own, as tests of a module are one unit
namespace pyroclast::survey_test {
namespace {

enum class Mass { scaled, real };
enum class Kind { press, fire, wait };

/// All readings of a key in a table of the schema.
std::vector<DeckKey> keys(const DeckSchema& schema, const std::string& table, const std::string& key) {
  std::vector<DeckKey> found;
  for (const DeckTable& t : schema.tables)
    if (t.path == table)
      std::copy_if(t.keys.begin(), t.keys.end(), std::back_inserter(found),
                   [&](const DeckKey& k) { return k.key == key; });
  return found;
}

/// The one reading; a failed test if there are none or several.
DeckKey only_key(const DeckSchema& schema, const std::string& table, const std::string& key) {
  const std::vector<DeckKey> found = keys(schema, table, key);
  EXPECT_EQ(found.size(), 1U) << table << "." << key;
  return found.empty() ? DeckKey{} : found.front();
}

const DeckTable& table_of(const DeckSchema& schema, std::string_view path) {
  const auto found = std::find_if(schema.tables.begin(), schema.tables.end(),
                                  [&](const DeckTable& t) { return t.path == path; });
  EXPECT_NE(found, schema.tables.end()) << path;
  return found == schema.tables.end() ? schema.tables.front() : *found;
}

using Conditions = std::vector<KeyCondition>;

KeyCondition with(std::string table, std::string key, std::vector<std::string> values,
                  std::vector<std::string> others) {
  return {.table = std::move(table),
          .key = std::move(key),
          .with = std::move(values),
          .without = std::move(others)};
}
KeyCondition present(std::string table, std::string key) {
  return {std::move(table), std::move(key), KeyCondition::Kind::present, {}, {}};
}
KeyCondition absent(std::string table, std::string key) {
  return {std::move(table), std::move(key), KeyCondition::Kind::absent, {}, {}};
}

TEST(Survey, KeepsWhatTheReaderSaysOfAKey) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section s = deck.root().section("part", "something");
    s.quantity("width", unit::length, Range::positive(), "how wide");
    s.quantity("gravity", unit::acceleration, Range::any(), 9.81, "how heavy");
    s.quantity("change", unit::temperature_difference, Range::any(), INFINITY, "how often");
    s.quantities("sieves", unit::length, Range::positive(), "bounds");
    s.number("fraction", Range::fraction(), "share");
    s.number("safety", Range::fraction(), 0.9, "of the step");
    s.numbers("weights", Range::any(), "of each");
    s.points("curve", unit::time, unit::temperature, "over the time");
    s.integer("count", Range::between(4, 100), "blocks");
    s.integer("relaxation", Range::non_negative(), 0, "iterations");
    s.flag("predictor", "foretells");
    s.flag("coupled", true, "both");
    s.text("title", "name of the run");
    s.text("unit", "m", "of what follows");
    s.choice<Mass>("mass", {{"scaled", Mass::scaled, "by density"}, {"real", Mass::real, "as it is"}},
                   "that moves");
    s.choice<Mass>("other", {{"scaled", Mass::scaled, ""}, {"real", Mass::real, ""}}, Mass::real, "as well");
    s.choice("kind", std::vector<Choice<int>>{{"a", 1, "first"}, {"b", 2, "second"}}, "of two");
  });
  ASSERT_EQ(schema.tables.size(), 1U);
  EXPECT_EQ(schema.tables[0].path, "part");
  EXPECT_EQ(schema.tables[0].meaning, "something");
  struct Expected {
    const char *key, *value, *unit, *allowed, *fallback, *meaning;
  };
  const Expected expected[] = {
      {"width", "length", "m", "greater than 0", "", "how wide"},
      {"gravity", "acceleration", "m/s2", "", "9.81 m/s2", "how heavy"},
      {"change", "temperature difference", "K", "", "none", "how often"},
      {"sieves", "list of length", "m", "greater than 0", "", "bounds"},
      {"fraction", "number", "", "between 0 and 1", "", "share"},
      {"safety", "number", "", "between 0 and 1", "0.9", "of the step"},
      {"weights", "list of number", "", "", "", "of each"},
      {"curve", "list of points, time and temperature", "", "", "", "over the time"},
      {"count", "whole number", "", "between 4 and 100", "", "blocks"},
      {"relaxation", "whole number", "", "at least 0", "0", "iterations"},
      {"predictor", "true or false", "", "", "", "foretells"},
      {"coupled", "true or false", "", "", "true", "both"},
      {"title", "text", "", "", "", "name of the run"},
      {"unit", "text", "", "", "\"m\"", "of what follows"},
      {"mass", "word", "", "", "", "that moves"},
      {"other", "word", "", "", "\"real\"", "as well"},
      {"kind", "word", "", "", "", "of two"},
  };
  const auto& read = schema.tables[0].keys;
  ASSERT_EQ(read.size(), std::size(expected));
  for (std::size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].key, expected[i].key);
    EXPECT_EQ(read[i].value, expected[i].value) << read[i].key;
    EXPECT_EQ(read[i].unit, expected[i].unit) << read[i].key;
    EXPECT_EQ(read[i].range.describe(), expected[i].allowed) << read[i].key;
    EXPECT_EQ(read[i].fallback, expected[i].fallback) << read[i].key;
    EXPECT_EQ(read[i].meaning, expected[i].meaning) << read[i].key;
    EXPECT_FALSE(read[i].optional) << read[i].key;
    EXPECT_TRUE(read[i].conditions.empty()) << read[i].key;
  }
  const auto& mass = read[14].words;
  ASSERT_EQ(mass.size(), 2U);
  EXPECT_EQ(mass[0].word, "\"scaled\"");
  EXPECT_EQ(mass[0].meaning, "by density");
  EXPECT_EQ(mass[1].word, "\"real\"");
}

// Each key stands behind another kind of decision, the last behind five of them.
TEST(Survey, FindsKeysBehindEveryDecision) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section root = deck.root();
    if (root.choice<Mass>("mass", {{"scaled", Mass::scaled, ""}, {"real", Mass::real, ""}}, "") ==
        Mass::scaled)
      return;
    if (root.has("stress")) {
      root.number("stress", Range::any(), "");
      return;
    }
    root.number("level", Range::any(), "");
    if (!root.flag("coupled", false, "")) return;
    const auto table = root.optional_section("heat");
    if (table) {
      table->number("initial", Range::any(), "");
      return;
    }
    for (const Section& s : root.optional_sections("probes")) {
      s.number("x", Range::any(), "");
      return;
    }
    root.number("deepest", Range::any(), "");
  });
  const Conditions real{with("", "mass", {"\"real\""}, {"\"scaled\""})};
  EXPECT_EQ(only_key(schema, "", "stress").conditions, real);
  EXPECT_TRUE(only_key(schema, "", "stress").optional);
  const Conditions level{real[0], absent("", "stress")};
  EXPECT_EQ(only_key(schema, "", "level").conditions, level);
  EXPECT_FALSE(only_key(schema, "", "level").optional);
  const Conditions coupled{real[0], absent("", "stress"), with("", "coupled", {"true"}, {"false"})};
  EXPECT_EQ(only_key(schema, "heat", "initial").conditions, Conditions{});
  EXPECT_EQ(table_of(schema, "heat").conditions, coupled);
  EXPECT_TRUE(table_of(schema, "heat").optional);
  EXPECT_EQ(table_of(schema, "probes[]").conditions,
            (Conditions{coupled[0], coupled[1], coupled[2], absent("", "heat")}));
  EXPECT_EQ(only_key(schema, "", "deepest").conditions,
            (Conditions{coupled[0], coupled[1], coupled[2], absent("", "heat"), absent("", "probes")}));
}

TEST(Survey, AKeyDependsOnlyOnWhatDecidesOnIt) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section s = deck.root();
    s.flag("before", "");
    const auto kind = s.choice<Kind>(
        "kind", {{"press", Kind::press, ""}, {"fire", Kind::fire, ""}, {"wait", Kind::wait, ""}}, "");
    const bool fast = s.flag("fast", "");
    if (kind != Kind::wait) s.number("of_two", Range::any(), "");
    if (kind == Kind::fire && fast) s.number("of_both", Range::any(), "");
    if (kind == Kind::fire || fast) s.number("of_either", Range::any(), "");
    if (kind == Kind::press || (kind == Kind::fire && s.has("file")))
      s.number("of_one_or_two", Range::any(), "");
    s.number("of_none", Range::any(), "");
    s.flag("after", "");
  });
  EXPECT_EQ(only_key(schema, "", "of_two").conditions,
            (Conditions{with("", "kind", {"\"press\"", "\"fire\""}, {"\"wait\""})}));
  EXPECT_EQ(only_key(schema, "", "of_both").conditions,
            (Conditions{with("", "kind", {"\"fire\""}, {"\"press\"", "\"wait\""}),
                        with("", "fast", {"true"}, {"false"})}));
  const auto either = keys(schema, "", "of_either");
  ASSERT_EQ(either.size(), 2U);
  EXPECT_EQ(either[0].conditions, (Conditions{with("", "kind", {"\"fire\""}, {"\"press\"", "\"wait\""})}));
  EXPECT_EQ(either[1].conditions, (Conditions{with("", "kind", {"\"press\"", "\"wait\""}, {"\"fire\""}),
                                              with("", "fast", {"true"}, {"false"})}));
  const auto one_or_two = keys(schema, "", "of_one_or_two");
  ASSERT_EQ(one_or_two.size(), 2U);
  EXPECT_EQ(one_or_two[0].conditions,
            (Conditions{with("", "kind", {"\"press\""}, {"\"fire\"", "\"wait\""})}));
  EXPECT_EQ(one_or_two[1].conditions,
            (Conditions{with("", "kind", {"\"fire\""}, {"\"press\"", "\"wait\""}), present("", "file")}));
  EXPECT_TRUE(only_key(schema, "", "of_none").conditions.empty());
}

TEST(Survey, TheSameKeyMayMeanDifferentThings) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    for (const Section& s : deck.root().sections("stages"))
      if (s.choice<Kind>("kind", {{"press", Kind::press, ""}, {"fire", Kind::fire, ""}}, "") == Kind::press)
        s.quantity("rate", unit::velocity, Range::any(), "of the platen");
      else
        s.quantity("rate", unit::heating_rate, Range::any(), "of the temperature");
  });
  const auto rates = keys(schema, "stages[]", "rate");
  ASSERT_EQ(rates.size(), 2U);
  EXPECT_EQ(rates[0].unit, "m/s");
  EXPECT_EQ(rates[0].conditions, (Conditions{with("stages[]", "kind", {"\"press\""}, {"\"fire\""})}));
  EXPECT_EQ(rates[1].unit, "K/s");
  EXPECT_EQ(rates[1].conditions, (Conditions{with("stages[]", "kind", {"\"fire\""}, {"\"press\""})}));
}

TEST(Survey, FormsOfAValueAreDescribedOnceForAllKeys) {
  const auto read_curve = [](const Section& s, const char* key, const Unit& unit) {
    s.describe(key, {.value = "curve", .unit = unit, .range = Range::positive(), .name = "curve over T"},
               "property");
    if (!s.is_table(key)) {
      s.quantity(key, unit, Range::positive(), "");
      return;
    }
    const Section forms = *s.optional_section(key, "one of");
    if (forms.has("csv"))
      forms.text("csv", "file");
    else
      forms.text("formula", "in T");
  };
  const DeckSchema schema = survey_deck([&](const Deck& deck) {
    read_curve(deck.root().section("materials").section("mortar"), "E", unit::stress);
    read_curve(deck.root().section("materials").section("mortar"), "density", unit::density);
  });
  const DeckKey young = only_key(schema, "materials.mortar", "E");
  EXPECT_EQ(young.value, "curve");
  EXPECT_EQ(young.unit, "Pa");
  EXPECT_EQ(young.meaning, "property");
  EXPECT_FALSE(young.optional);
  const DeckTable& forms = table_of(schema, "curve over T");
  EXPECT_TRUE(forms.is_form);
  EXPECT_EQ(forms.meaning, "one of");
  ASSERT_EQ(forms.keys.size(), 2U);
  EXPECT_EQ(forms.keys[1].key, "formula");
  EXPECT_TRUE(forms.conditions.empty());
  EXPECT_EQ(schema.tables.size(), 2U);
}

TEST(Survey, NamesWhatHasNoMeaningAndWhatIsNeverRead) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section root = deck.root();
    root.text("title", "of the run");
    root.know({"title", "mechanics", "forgotten"});
    if (const auto mechanics = root.optional_section("mechanics"))
      mechanics->choice<Mass>("mass", {{"scaled", Mass::scaled, "by density"}, {"real", Mass::real, ""}},
                              "that moves");
    root.section("specimen", "its size").number("width", Range::any(), "");
  });
  EXPECT_EQ(schema.never_read, std::vector<std::string>{"forgotten"});
  EXPECT_EQ(schema.undocumented(), (std::vector<std::string>{"forgotten", "mechanics",
                                                             "mechanics.mass = \"real\"", "specimen.width"}));
}

// What a survey misses is told if the reader knows of it.
TEST(Survey, TellsOfAKeyThatOnlyTwoAnswersOpenTogether) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section s = deck.root();
    s.know({"of_both", "of_zero"});
    const bool first = s.flag("first", ""), second = s.flag("second", "");
    if (first && second) s.number("of_both", Range::any(), "");
    if (s.number("count", Range::positive(), "") == 0.0) s.number("of_zero", Range::any(), "");
  });
  EXPECT_EQ(schema.never_read, (std::vector<std::string>{"of_both", "of_zero"}));
}

TEST(Survey, StandsInForADeckInWhichNothingGoesTogether) {
  int calls = 0;
  survey_deck([&](const Deck& deck) {
    ++calls;
    const Section s = deck.root().section("part");
    EXPECT_GT(s.quantity("width", unit::length, Range::above(2.0), ""), 2.0);
    EXPECT_FALSE(s.ok());
    s.error("width", "contradicts the height");
    s.error("is wrong as a whole");
    EXPECT_NO_THROW(deck.finish());
  });
  EXPECT_EQ(calls, 1);
}

// A meaning must not be taken for a value: text converts to bool.
TEST(Meaning, IsNoFallback) {
  const Deck deck = Deck::parse("title = \"x\"\n", "case.toml");
  const Section root = deck.root();
  root.text("title", "of the run");
  EXPECT_FALSE(root.flag("coupled", "both at once"));
  root.choice<bool>("field", {{"uniform", true, ""}, {"conduction", false, ""}}, "how temperatures follow");
  const auto diagnostics = diagnostics_of(deck);
  ASSERT_EQ(diagnostics.size(), 2U);
  EXPECT_TRUE(mentions(diagnostics[0].message, "missing")) << diagnostics[0].message;
  EXPECT_TRUE(mentions(diagnostics[1].message, "missing")) << diagnostics[1].message;
}

TEST(Reference, HasARowForEachKey) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section root = deck.root();
    root.text("title", "name of the run");
    for (const Section& s : root.sections("stages", "what is done, one after the other")) {
      const auto kind = s.choice<Kind>(
          "kind", {{"press", Kind::press, "the platen moves"}, {"fire", Kind::fire, "heat flows"}},
          "kind of the stage");
      if (kind == Kind::press) {
        s.quantity("velocity", unit::velocity, Range::positive(), "of the platen");
        if (s.has("fastest")) {
          s.quantity("fastest", unit::velocity, Range::positive(), "highest velocity");
          s.number("ratio", Range::fraction(), "a|b");
        }
      } else {
        s.quantity("duration", unit::time, Range::positive(), 60.0, "how long");
      }
    }
    for (const char* name : {"aggregate", "mortar"}) {
      const Section s = root.section("materials").section(name, "a solid");
      s.quantity("density", unit::density, Range::positive(), "mass over volume");
    }
    if (const auto coupling = root.optional_section("coupling", "how fields act on each other"))
      coupling->flag("predictor", false, "foretells");
  });
  EXPECT_EQ(deck_reference(schema), R"(## At the top of the deck

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `title` | text |  |  | needed | Name of the run. |

## `[[stages]]`

What is done, one after the other.

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `kind` | one of `"press"`, `"fire"` |  |  | needed | Kind of the stage. |

### `kind = "press"`

The platen moves.

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `velocity` | velocity | m/s | greater than 0 | needed | Of the platen. |
| `fastest` | velocity | m/s | greater than 0 | – | Highest velocity. |
| `ratio` | number |  | between 0 and 1 | needed | With `fastest`. A\|b. |

### `kind = "fire"`

Heat flows.

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `duration` | time | s | greater than 0 | `60 s` | How long. |

## `[materials.aggregate]`, `[materials.mortar]`

A solid.

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `density` | density | kg/m3 | greater than 0 | needed | Mass over volume. |

## `[coupling]`

How fields act on each other. May be left out.

| key | value | unit | allowed | default | meaning |
|---|---|---|---|---|---|
| `predictor` | true or false |  |  | `false` | Foretells. |
)");
}

// Greek letters count once, whatever their bytes.
TEST(Reference, BreaksWhatStandsOutsideOfTablesAfter120Characters) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    deck.root()
        .section("heat",
                 "ααααααααα βββββββββ γγγγγγγγγ δδδδδδδδδ εεεεεεεεε ζζζζζζζζζ ηηηηηηηηη θθθθθθθθθ ιιιιιιιιι "
                 "κκκκκκκκκ λλλλλλλλλ μμμμμμμμμμ ννννννννν")
        .number("initial", Range::any(), "");
  });
  const std::string text = deck_reference(schema);
  EXPECT_TRUE(mentions(text, " λλλλλλλλλ μμμμμμμμμμ\nννννννννν.\n\n|")) << text;
}

TEST(Reference, TellsWhatAKeyDependsOn) {
  const DeckSchema schema = survey_deck([](const Deck& deck) {
    const Section root = deck.root();
    const auto kind = root.section("run").choice<Kind>(
        "kind", {{"press", Kind::press, ""}, {"fire", Kind::fire, ""}, {"wait", Kind::wait, ""}}, "");
    const Section s = root.section("output");
    if (kind != Kind::wait) s.number("often", Range::any(), "");
    if (kind == Kind::wait) s.number("seldom", Range::any(), "");
    if (!s.has("file")) s.number("count", Range::any(), "");
    if (s.flag("all", "")) root.section("fields").number("each", Range::any(), "");
  });
  const std::string text = deck_reference(schema);
  for (const char* row : {"| `often` | number |  |  | needed | Not with `run.kind = \"wait\"`. |",
                          "| `seldom` | number |  |  | needed | With `run.kind = \"wait\"`. |",
                          "| `count` | number |  |  | needed | Without `file`. |",
                          "## `[fields]`\n\nWith `output.all = true`.\n"})
    EXPECT_TRUE(mentions(text, row)) << row << "\n" << text;
}

}  // namespace
}  // namespace pyroclast::survey_test
