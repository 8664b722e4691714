#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "diagnostics_of.hpp"

// of its own, as tests of a module are one unit
namespace pyroclast::section_test {
namespace {

enum class Mass { real, scaled };

Deck parse(const std::string& text) {
  return Deck::parse(text, "case.toml");
}

// Promise: what is allowed but not usual is read, and warned of with its place; it is no error.
TEST(Section, WarnsOfWhatIsNotUsual) {
  const Deck deck = parse("a = \"70 MPa\"\nb = \"70 GPa\"\nc = 3\nd = [\"1 m\", \"1 km\"]\n");
  const Section root = deck.root();
  const Range usual = Range::positive().usually(1e9, 500e9);
  EXPECT_DOUBLE_EQ(root.quantity("a", unit::stress, usual, ""), 70e6);
  root.quantity("b", unit::stress, usual, "");
  root.integer("c", Range::any().usually(0, 2), "");
  root.quantities("d", unit::length, Range::positive().usually(0.1, 10.0), "");
  root.warn("b", "is mine");
  deck.finish();
  std::vector<std::string> lines;
  for (const Diagnostic& warning : deck.warnings()) lines.push_back(to_string(warning));
  EXPECT_EQ(lines,
            (std::vector<std::string>{
                "case.toml:1:5: a = \"70 MPa\": is 7e+07 Pa, but usually it is between 1000000000 and "
                "500000000000 Pa",
                "case.toml:2:5: b = \"70 GPa\": is mine",
                "case.toml:3:5: c = 3: is 3, but usually it is between 0 and 2",
                "case.toml:4:13: d[1] = \"1 km\": is 1000 m, but usually it is between 0.1 and 10 m"}));
}

TEST(Section, ReadsEveryKindOfValue) {
  const Deck deck = parse(R"(
    width = "150 mm"
    sieves = ["4.75 mm", "0.8 cm"]
    fraction = "34 %"
    exponent = 0.45
    whole = 2
    weights = [1, 0.5, "20 %"]
    seed = 9007199254740993
    report = false
    name = "reference"
    mass = "real"
  )");
  const Section root = deck.root();
  EXPECT_DOUBLE_EQ(root.quantity("width", unit::length, Range::positive(), ""), 0.15);
  EXPECT_EQ(root.quantities("sieves", unit::length, Range::positive(), ""),
            (std::vector<double>{0.00475, 0.008}));
  EXPECT_DOUBLE_EQ(root.number("fraction", Range::fraction(), ""), 0.34);
  EXPECT_EQ(root.number("exponent", Range::fraction(), ""), 0.45);
  EXPECT_EQ(root.number("whole", Range::any(), ""), 2.0);
  EXPECT_EQ(root.numbers("weights", Range::fraction(), ""), (std::vector<double>{1.0, 0.5, 0.2}));
  EXPECT_EQ(root.integer("seed", Range::non_negative(), ""), 9007199254740993);
  EXPECT_FALSE(root.flag("report", ""));
  EXPECT_EQ(root.text("name", ""), "reference");
  EXPECT_EQ(root.choice<Mass>("mass", {{"scaled", Mass::scaled, ""}, {"real", Mass::real, ""}}, ""),
            Mass::real);
  EXPECT_TRUE(root.ok());
  EXPECT_NO_THROW(deck.finish());
}

TEST(Section, FallsBackOnlyIfTheKeyIsAbsent) {
  const Deck deck = parse("gap = \"2 mm\"\n");
  const Section root = deck.root();
  EXPECT_EQ(root.quantity("gap", unit::length, Range::non_negative(), 7.0, ""), 0.002);
  EXPECT_EQ(root.quantity("thickness", unit::length, Range::positive(), 7.0, ""), 7.0);
  EXPECT_EQ(root.number("damping", Range::fraction(), 0.8, ""), 0.8);
  EXPECT_EQ(root.integer("seed", Range::any(), 5, ""), 5);
  EXPECT_TRUE(root.flag("report", true, ""));
  EXPECT_EQ(root.text("name", "unnamed", ""), "unnamed");
  EXPECT_EQ(
      root.choice<Mass>("mass", {{"real", Mass::real, ""}, {"scaled", Mass::scaled, ""}}, Mass::scaled, ""),
      Mass::scaled);
  EXPECT_FALSE(root.optional_section("heating"));
  EXPECT_TRUE(root.optional_sections("stages").empty());
  EXPECT_NO_THROW(deck.finish());
}

TEST(Section, IsReachedByHeadersDotsAndInlineTables) {
  for (const std::string text :
       {"[contacts.mortar_mortar]\nf_t = \"2.5 MPa\"\n", "contacts.mortar_mortar.f_t = \"2.5 MPa\"\n",
        "[contacts]\nmortar_mortar = {f_t = \"2.5 MPa\"}\n"}) {
    const Deck deck = parse(text);
    const Section section = deck.root().section("contacts").section("mortar_mortar");
    EXPECT_EQ(section.path(), "contacts.mortar_mortar");
    EXPECT_EQ(section.quantity("f_t", unit::stress, Range::positive(), ""), 2.5e6);
    EXPECT_NO_THROW(deck.finish());
  }
}

TEST(Section, ArraysOfTablesKeepTheirOrder) {
  const Deck deck = parse("[[stages]]\nn = 1\n[[stages]]\nn = 2\n");
  std::vector<long long> read;
  for (const Section& stage : deck.root().sections("stages"))
    read.push_back(stage.integer("n", Range::any(), ""));
  EXPECT_EQ(read, (std::vector<long long>{1, 2}));
  EXPECT_NO_THROW(deck.finish());
}

struct BadValue {
  const char* value;    // as written in the deck
  const char* message;  // part of what is said about it
};

void expect_error(const Deck& deck, const BadValue& bad) {
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.file, "case.toml");
  EXPECT_EQ(diagnostic.line, 3);
  EXPECT_EQ(diagnostic.column, 7);
  EXPECT_EQ(diagnostic.key, "part.key");
  EXPECT_EQ(diagnostic.value, bad.value);
  EXPECT_TRUE(mentions(diagnostic.message, bad.message)) << diagnostic.message;
}

Deck with_value(const std::string& value) {
  return parse("\n[part]\nkey = " + value + "\n");
}

TEST(BadValue, OfAQuantityIsExplained) {
  for (const BadValue& bad :
       {BadValue{"150", "e.g. \"150 mm\""}, BadValue{"1.5", "no unit"}, BadValue{"\"150\"", "no unit"},
        BadValue{"\"mm\"", "no number"}, BadValue{"\"nan mm\"", "not finite"},
        BadValue{"\"5 mmm\"", "unknown unit \"mmm\""}, BadValue{"\"5 MPa\"", "length (m)"},
        BadValue{"\"-5 mm\"", "must be greater than 0 m"}, BadValue{"true", "not true or false"},
        BadValue{"[\"1 m\"]", "not a list"}, BadValue{"2000-01-01", "not a date or time"}}) {
    const Deck deck = with_value(bad.value);
    const double stand_in = deck.root().section("part").quantity("key", unit::length, Range::positive(), "");
    EXPECT_GT(stand_in, 0.0) << bad.value;
    expect_error(deck, bad);
  }
}

TEST(BadValue, OfANumberIsExplained) {
  for (const BadValue& bad :
       {BadValue{"1.5", "must be between 0 and 1"}, BadValue{"\"120 %\"", "must be between 0 and 1"},
        BadValue{"\"5 mm\"", "wrong dimension"}, BadValue{"nan", "not finite"},
        BadValue{"-inf", "not finite"}, BadValue{"false", "a number is needed"}}) {
    const Deck deck = with_value(bad.value);
    deck.root().section("part").number("key", Range::fraction(), "");
    expect_error(deck, bad);
  }
}

TEST(BadValue, OfAnIntegerIsExplained) {
  for (const BadValue& bad : {BadValue{"0", "must be between 1 and 10"}, BadValue{"3.0", "a whole number"},
                              BadValue{"1e1", "a whole number"}, BadValue{"\"3\"", "not a string"}}) {
    const Deck deck = with_value(bad.value);
    deck.root().section("part").integer("key", Range::between(1, 10), "");
    expect_error(deck, bad);
  }
}

TEST(BadValue, OfAFlagOrATextIsExplained) {
  const Deck flag = with_value("\"true\"");
  flag.root().section("part").flag("key", "");
  expect_error(flag, {"\"true\"", "without quotes"});
  const Deck text = with_value("3");
  text.root().section("part").text("key", "");
  expect_error(text, {"3", "a string is needed, not an integer"});
  const Deck empty = with_value("\"\"");
  empty.root().section("part").text("key", "");
  expect_error(empty, {"\"\"", "must not be empty"});
}

TEST(BadValue, IsReportedAlsoWhereThereIsAFallback) {
  const Deck deck = with_value("\"-5 mm\"");
  deck.root().section("part").quantity("key", unit::length, Range::non_negative(), 0.001, "");
  expect_error(deck, {"\"-5 mm\"", "must be at least 0 m"});
}

TEST(BadValue, OfAListIsLocatedAtItsElement) {
  const Deck deck = parse("sieves = [\"4 mm\", 8,\n  \"16 MPa\"]\n");
  EXPECT_TRUE(deck.root().quantities("sieves", unit::length, Range::positive(), "").empty());
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(to_string(errors[0]).find("case.toml:1:19: sieves[1] = 8: no unit"), 0U) << to_string(errors[0]);
  EXPECT_EQ(to_string(errors[1]).find("case.toml:2:3: sieves[2] = \"16 MPa\": unit \"MPa\""), 0U)
      << to_string(errors[1]);
}

TEST(BadValue, OfAListThatIsEmptyOrNoneIsExplained) {
  for (const BadValue& bad : {BadValue{"[]", "at least one length"}, BadValue{"\"4 mm\"", "a list of"}}) {
    const Deck deck = with_value(bad.value);
    EXPECT_TRUE(deck.root().section("part").quantities("key", unit::length, Range::positive(), "").empty());
    expect_error(deck, bad);
  }
}

TEST(Section, ReadsPointsInSiUnits) {
  const Deck deck = parse("modulus = [[\"20 degC\", \"70 GPa\"], [\"800 degC\", \"4000 MPa\"]]\n");
  const auto points = deck.root().points("modulus", unit::temperature, unit::stress, "");
  EXPECT_EQ(points, (std::vector<std::pair<double, double>>{{20.0, 70e9}, {800.0, 4e9}}));
  EXPECT_NO_THROW(deck.finish());
}

TEST(Section, TellsATableFromAValueWithoutReadingIt) {
  const Deck deck = parse("E = \"70 GPa\"\nf = { value = 1 }\n");
  EXPECT_FALSE(deck.root().is_table("E"));
  EXPECT_TRUE(deck.root().is_table("f"));
  EXPECT_FALSE(deck.root().is_table("absent"));
  EXPECT_EQ(diagnostics_of(deck).size(), 2U);  // neither was read
}

TEST(BadValue, OfAPointIsLocatedAtItsElement) {
  for (const auto& [list, path, message] :
       {std::tuple{"[[\"20 degC\", \"4 m\"], [\"30 degC\", \"4 Pa\"]]", "key[0][1]", "wrong dimension"},
        std::tuple{"[[\"20 degC\", \"4 Pa\"], [\"20 degC\", \"5 Pa\"]]", "key[1][0]",
                   "must be above the temperature before, 20 degC"},
        std::tuple{"[[\"20 degC\", \"4 Pa\"], [\"30 degC\"]]", "key[1]",
                   "a point [\"20 degC\", \"30 MPa\"] is needed, not a list of 1"},
        std::tuple{"[[\"20 degC\", \"4 Pa\"], 3]", "key[1]", "not an integer"},
        std::tuple{"[[\"20 degC\", \"4 Pa\"]]", "key", "two or more points"},
        std::tuple{"\"4 Pa\"", "key", "two or more points"}}) {
    const Deck deck = with_value(list);
    EXPECT_TRUE(deck.root().section("part").points("key", unit::temperature, unit::stress, "").empty());
    const Diagnostic diagnostic = only_diagnostic_of(deck);
    EXPECT_EQ(diagnostic.key, std::string("part.") + path);
    EXPECT_TRUE(mentions(diagnostic.message, message)) << diagnostic.message;
  }
}

TEST(Choice, ThatIsMisspeltIsReadAsTheNearest) {
  const Deck deck = with_value("\"scald\"");
  const Mass mass = deck.root().section("part").choice<Mass>(
      "key", {{"real", Mass::real, ""}, {"scaled", Mass::scaled, ""}}, "");
  EXPECT_EQ(mass, Mass::scaled);
  expect_error(deck, {"\"scald\"", "must be one of \"real\", \"scaled\""});
  EXPECT_EQ(only_diagnostic_of(deck).hint, "did you mean \"scaled\"?");
}

TEST(Choice, OfTheWrongTypeOrMissingListsTheWords) {
  const Deck wrong = with_value("3");
  wrong.root().section("part").choice<Mass>("key", {{"real", Mass::real, ""}, {"scaled", Mass::scaled, ""}},
                                            "");
  expect_error(wrong, {"3", "one of \"real\", \"scaled\" is needed, not an integer"});
  const Deck missing = parse("[part]\n");
  missing.root().section("part").choice<Mass>("key", {{"real", Mass::real, ""}, {"scaled", Mass::scaled, ""}},
                                              "");
  EXPECT_TRUE(mentions(only_diagnostic_of(missing).message, "missing; one of \"real\", \"scaled\""));
}

// Which keys belong to the table depends on the choice, so only what looks like a misspelling is reported.
TEST(Choice, ThatCannotBeReadDoesNotBlameTheKeysThatHangOnIt) {
  const Deck deck = parse("heating = \"furnace\"\nrate = \"5 K/min\"\nsed = 3\n");
  const Section root = deck.root();
  root.choice<int>("heating", {{"ramp", 0, ""}, {"uniform", 1, ""}}, "");
  root.integer("seed", Range::any(), "");
  root.quantity("duration", unit::time, Range::positive(), "");
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[0].key, "heating");
  EXPECT_EQ(errors[1].key, "sed");
  EXPECT_EQ(errors[1].hint, "did you mean \"seed\"?");
}

TEST(MissingKey, IsReportedAtItsTableWithWhatIsAllowed) {
  const Deck deck = parse("\n[specimen]\n");
  deck.root().section("specimen").quantity("width", unit::length, Range::positive(), "");
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.line, 2);
  EXPECT_EQ(diagnostic.key, "specimen.width");
  EXPECT_EQ(diagnostic.value, "");
  for (const std::string part : {"missing", "length", "150 mm", "greater than 0 m"}) {
    EXPECT_TRUE(mentions(diagnostic.message, part)) << diagnostic.message;
  }
}

TEST(MissingKey, OfEveryKindIsReported) {
  const Deck deck = parse("[part]\n");
  const Section part = deck.root().section("part");
  part.number("a", Range::fraction(), "");
  part.integer("b", Range::positive(), "");
  part.flag("c", "");
  part.text("d", "");
  part.numbers("e", Range::any(), "");
  part.section("f");
  part.sections("g");
  part.points("h", unit::temperature, unit::stress, "");
  std::string keys;
  for (const Diagnostic& diagnostic : diagnostics_of(deck)) {
    EXPECT_EQ(diagnostic.message.find("missing; "), 0U);
    keys += diagnostic.key + " ";
  }
  EXPECT_EQ(keys, "part.a part.b part.c part.d part.e part.f part.g part.h ");
}

TEST(MissingTable, IsOneErrorWhateverIsReadFromIt) {
  const Deck deck = parse("seed = 1\n");
  deck.root().integer("seed", Range::any(), "");
  const Section contacts = deck.root().section("contacts");
  EXPECT_GT(contacts.section("mortar_mortar").quantity("f_t", unit::stress, Range::positive(), ""), 0.0);
  EXPECT_TRUE(contacts.sections("stages").empty());
  EXPECT_FALSE(contacts.has("f_t"));
  EXPECT_FALSE(contacts.ok());
  contacts.error("f_t", "contradiction");
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.key, "contacts");
  EXPECT_TRUE(mentions(diagnostic.message, "[contacts]"));
}

TEST(WrongTable, IsExplained) {
  const Deck deck = parse("contacts = 3\nheating = true\n[stages]\n[[specimen]]\n");
  const Section root = deck.root();
  root.section("contacts");
  EXPECT_FALSE(root.optional_section("heating"));
  EXPECT_TRUE(root.sections("stages").empty());
  root.section("specimen");
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 4U);
  EXPECT_EQ(errors[0].message, "a table, [contacts], is needed, not an integer");
  EXPECT_EQ(errors[1].message, "a table, [heating], is needed, not true or false");
  EXPECT_EQ(errors[2].message, "an array of tables, [[stages]], is needed, not a table");
  EXPECT_EQ(errors[3].message, "a table, [specimen], is needed, not an array of tables");
}

}  // namespace
}  // namespace pyroclast::section_test
