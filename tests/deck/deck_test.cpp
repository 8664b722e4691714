#include "pyroclast/deck/deck.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "diagnostics_of.hpp"

namespace pyroclast {
namespace {

Deck parse(const std::string& text) {
  return Deck::parse(text, "case.toml");
}

TEST(UnknownKey, IsReportedAtTheKeyWithTheNearestMatch) {
  const Deck deck = parse("\n[specimen]\n  heihgt = \"300 mm\"\n");
  deck.root().section("specimen").quantity("height", unit::length, Range::positive(), 0.3, "");
  EXPECT_EQ(to_string(only_diagnostic_of(deck)),
            "case.toml:3:3: specimen.heihgt = \"300 mm\": unknown key; did you mean \"height\"?");
}

TEST(UnknownKey, WithoutANearMatchListsWhatIsAllowed) {
  const Deck deck = parse("[specimen]\ncolour = \"grey\"\n");
  const Section specimen = deck.root().section("specimen");
  specimen.quantity("width", unit::length, Range::positive(), 0.1, "");
  specimen.has("height");
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.message, "unknown key; allowed in [specimen]: \"width\", \"height\"");
  EXPECT_EQ(diagnostic.hint, "");
}

TEST(UnknownKey, OfAnotherTableIsSentThere) {
  const Deck deck = parse("[specimen]\nseed = 1\n[blocks]\ncount = 5000\n");
  const Section specimen = deck.root().section("specimen");
  specimen.quantity("width", unit::length, Range::positive(), 0.1, "");
  const Section blocks = deck.root().section("blocks");
  blocks.integer("count", Range::positive(), "");
  blocks.integer("seed", Range::non_negative(), 0, "");
  EXPECT_EQ(only_diagnostic_of(deck).hint, "\"seed\" belongs in [blocks]");
}

TEST(UnknownTable, IsReportedOnceWithTheNearestMatch) {
  const Deck deck = parse("[contact.mortar_mortar]\nf_t = \"2.5 MPa\"\nc = \"3.8 MPa\"\n");
  deck.root().optional_section("contacts");
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.line, 1);
  EXPECT_EQ(diagnostic.key, "contact");
  EXPECT_EQ(diagnostic.message, "unknown table");
  EXPECT_EQ(diagnostic.hint, "did you mean \"contacts\"?");
}

TEST(UnknownKey, IsFoundInEveryElementOfAnArrayOfTables) {
  const Deck deck = parse("[[stages]]\nrate = 1\n[[stages]]\nrat = 2\n");
  for (const Section& stage : deck.root().sections("stages")) stage.number("rate", Range::any(), 0.0, "");
  EXPECT_EQ(only_diagnostic_of(deck).key, "stages[1].rat");
}

TEST(UnknownKey, IsEveryKeyOfADeckThatNobodyReads) {
  const Deck deck = parse("a = 1\n[b]\nc = 2\n");
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_TRUE(mentions(errors[0].message, "no keys are allowed at the top of the deck"));
}

TEST(KeyThatIsOnlyLookedFor, IsReportedAsWithoutEffect) {
  const Deck deck = parse("rate = 1\n");
  EXPECT_TRUE(deck.root().has("rate"));
  EXPECT_TRUE(mentions(only_diagnostic_of(deck).message, "has no effect"));
}

TEST(KeyThatIsAskedForTwice, IsFine) {
  const Deck deck = parse("rate = 1\n");
  EXPECT_EQ(deck.root().number("rate", Range::any(), ""), deck.root().number("rate", Range::any(), ""));
  EXPECT_NO_THROW(deck.finish());
}

TEST(Contradiction, IsLocatedAtTheKeyOrItsTable) {
  const Deck deck = parse("\n[sieves]\nlargest = \"4 mm\"\n");
  const Section sieves = deck.root().section("sieves");
  EXPECT_EQ(sieves.where("largest"), "case.toml:3");
  EXPECT_EQ(sieves.where("smallest"), "case.toml:2");
  sieves.error("largest", "must be above the smallest");
  sieves.error("smallest", "needed beside the largest");
  sieves.error("no aggregate fits");
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 3U);
  EXPECT_EQ(to_string(errors[0]), "case.toml:2:1: sieves.smallest: needed beside the largest");
  EXPECT_EQ(to_string(errors[1]), "case.toml:2:1: sieves: no aggregate fits");
  EXPECT_EQ(to_string(errors[2]), "case.toml:3:11: sieves.largest = \"4 mm\": must be above the smallest");
}

TEST(Section, IsOkUntilAnErrorInItOrBelow) {
  const Deck deck = parse("[a]\n[a.b]\nx = 1\n[ab]\ny = 1\n");
  const Section root = deck.root();
  const Section a = root.section("a");
  const Section ab = root.section("ab");
  ab.error("y", "wrong");
  EXPECT_FALSE(ab.ok());
  EXPECT_TRUE(a.ok());
  a.section("b").error("x", "wrong");
  EXPECT_FALSE(a.ok());
  EXPECT_FALSE(root.ok());
}

TEST(Errors, AreAllListedAtOnceInTheOrderOfTheFile) {
  const Deck deck = parse(R"(seed = 1.5
[specimen]
width = 150
height = "300 mmm"
thicknes = "1 m"
[solver]
mass = "scald"
damping = 1.5
[contact]
)");
  const Section root = deck.root();
  const Section solver = root.section("solver");
  solver.choice<int>("mass", {{"scaled", 0, ""}, {"real", 1, ""}}, "");
  solver.number("damping", Range::fraction(), "");
  const Section specimen = root.section("specimen");
  specimen.quantity("thickness", unit::length, Range::positive(), "");
  specimen.quantity("height", unit::length, Range::positive(), "");
  specimen.quantity("width", unit::length, Range::positive(), "");
  root.integer("seed", Range::any(), "");
  root.section("contacts");
  root.section("stages");

  // what is missing comes last, but for a key that another one means
  const std::vector<std::string> expected{
      "seed",        "specimen.width", "specimen.height", "specimen.thicknes",
      "solver.mass", "solver.damping", "contact",         "stages"};
  std::vector<std::string> keys;
  try {
    deck.finish();
  } catch (const DeckError& error) {
    for (const Diagnostic& diagnostic : error.diagnostics()) keys.push_back(diagnostic.key);
    const std::string all = error.what();
    EXPECT_EQ(std::count(all.begin(), all.end(), '\n') + 1, static_cast<std::ptrdiff_t>(expected.size()))
        << all;
  }
  EXPECT_EQ(keys, expected);
}

TEST(Finish, SaysTheSameEachTime) {
  const Deck deck = parse("a = 1\nb = 2\n");
  EXPECT_EQ(diagnostics_of(deck).size(), 2U);
  EXPECT_EQ(diagnostics_of(deck).size(), 2U);
}

TEST(Deck, CanBeMovedWhileSectionsAreHeld) {
  Deck deck = parse("a = 1\n");
  const Section root = deck.root();
  const Deck moved = std::move(deck);
  EXPECT_EQ(root.integer("a", Range::any(), ""), 1);
  EXPECT_NO_THROW(moved.finish());
}

}  // namespace
}  // namespace pyroclast
