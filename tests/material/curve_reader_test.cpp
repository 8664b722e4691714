#include "pyroclast/material/curve_reader.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "deck/diagnostics_of.hpp"
#include "own_folder.hpp"
#include "pyroclast/material/builtin_curves.hpp"

namespace pyroclast {
namespace {

namespace fs = std::filesystem;

constexpr Interval kFire{20.0, 800.0};

/// A folder for the files of one test.
class Folder {
 public:
  Folder() : path_(own_folder() / test_name()) { fs::create_directories(path_); }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  void write(const std::string& name, const std::string& text) const { std::ofstream(path_ / name) << text; }
  const fs::path& path() const { return path_; }

 private:
  static std::string test_name() { return ::testing::UnitTest::GetInstance()->current_test_info()->name(); }
  fs::path path_;
};

Deck deck_of(const std::string& value) {
  return Deck::parse("\n[materials.mortar]\nkey = " + value + "\n", "case.toml");
}

Curve read(const Deck& deck, const Unit& unit, const Range& range = Range::any(), Interval needed = kFire,
           const fs::path& folder = ".") {
  CurveReader reader(folder, temperature_axis(), needed, builtin_curves());
  return reader.read(deck.root().section("materials").section("mortar"), "key", unit, range, "");
}

Curve read_good(const std::string& value, const Unit& unit, const fs::path& folder = ".") {
  const Deck deck = deck_of(value);
  const Curve curve = read(deck, unit, Range::any(), kFire, folder);
  EXPECT_NO_THROW(deck.finish()) << value;
  return curve;
}

// ---- The forms

TEST(CurveReader, TakesAQuantityAsTheSameValueEverywhere) {
  const Curve curve = read_good("\"70 GPa\"", unit::stress);
  EXPECT_TRUE(curve.is_constant());
  EXPECT_EQ(curve(1234.0), 70e9);
  EXPECT_EQ(read_good("0.5", unit::dimensionless)(20.0), 0.5);
}

TEST(CurveReader, InterpolatesATableInTheUnitsOfEachElement) {
  const Curve curve =
      read_good("{ table = [[\"20 degC\", \"70 GPa\"], [\"1073.15 K\", \"10000 MPa\"]] }", unit::stress);
  // 1e-6: the kelvin of the deck are converted to 800 degC with rounding.
  EXPECT_NEAR(curve(410.0), 40e9, 1.0);
  EXPECT_DOUBLE_EQ(curve(20.0), 70e9);
}

TEST(CurveReader, MultipliesAValueWithACurveOfAnyForm) {
  EXPECT_DOUBLE_EQ(read_good("{ value = \"70 GPa\", times = \"glasgow_modulus\" }", unit::stress)(520.0),
                   70e9 * 0.25);
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"70 GPa\", times = { builtin = \"glasgow_modulus\" } }", unit::stress)(520.0),
      70e9 * 0.25);
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"70 GPa\", times = { table = [[\"20 degC\", 1], [\"800 degC\", 0]] } }",
                unit::stress)(410.0),
      35e9);
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"70 GPa\", times = { expression = \"1 - (T - 20) / 1000\", range = [\"20 "
                "degC\", \"800 degC\"] } }",
                unit::stress)(520.0),
      35e9);
}

TEST(CurveReader, TakesAShareOfWhatARatioLoses) {
  const Curve curve =
      read_good("{ value = \"70 GPa\", times = \"glasgow_modulus\", share = 0.5 }", unit::stress);
  EXPECT_DOUBLE_EQ(curve(20.0), 70e9);
  EXPECT_DOUBLE_EQ(curve(520.0), 70e9 * (1.0 - 0.5 * 0.75));
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"70 GPa\", times = \"glasgow_modulus\", share = 0 }", unit::stress)(520.0), 70e9);
}

TEST(CurveReader, ScalesAndShiftsACurveAsAWhole) {
  const std::string table =
      "table = [[\"20 degC\", \"70 GPa\"], [\"420 degC\", \"30 GPa\"], [\"800 degC\", \"11 GPa\"]]";
  const Curve curve = read_good("{ " + table + ", scale = 1.1, shift = \"50 K\" }", unit::stress);
  EXPECT_DOUBLE_EQ(curve(20.0), 1.1 * 70e9);  // the end's value, before the range
  EXPECT_DOUBLE_EQ(curve(70.0), 1.1 * 70e9);
  EXPECT_DOUBLE_EQ(curve(270.0), 1.1 * 50e9);
  EXPECT_DOUBLE_EQ(curve(470.0), 1.1 * 30e9);
  EXPECT_DOUBLE_EQ(curve.minimum(20.0, 800.0), curve(800.0));
  EXPECT_DOUBLE_EQ(read_good("{ " + table + ", shift = \"-50 K\" }", unit::stress)(790.0), 11e9);
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"70 GPa\", times = \"glasgow_modulus\", scale = 0.5, shift = \"-20 K\" }",
                unit::stress)(500.0),
      35e9 * 0.25);
}

TEST(CurveReader, TakesTheNamedCurveInItsOwnUnit) {
  const double T = 400.0;
  const Curve conductivity = read_good("{ builtin = \"en1992_conductivity_upper\" }", unit::conductivity);
  EXPECT_DOUBLE_EQ(conductivity(T), 2.0 - 0.2451 * 4.0 + 0.0107 * 16.0);
  EXPECT_TRUE(mentions(conductivity.describe(), "EN 1992-1-2:2004 3.3.3(2)")) << conductivity.describe();
}

TEST(CurveReader, ConvertsANamedCurveToTheUnitOfTheKey) {
  const CurveCatalogue catalogue("furnace programme",
                                 {{"slow", "", "", "degF", Curve::table({0, 60}, {32, 212}, time_axis())},
                                  {"modulus", "", "", "GPa", Curve::table({0, 60}, {70, 10}, time_axis())}});
  const Deck deck = Deck::parse("gas = { builtin = \"slow\" }\nE = { builtin = \"modulus\" }\n", "case.toml");
  CurveReader reader(".", time_axis(), {0.0, 60.0}, catalogue);
  const Curve gas = reader.read(deck.root(), "gas", unit::temperature, Range::any(), "");
  const Curve modulus = reader.read(deck.root(), "E", unit::stress, Range::any(), "");
  EXPECT_NO_THROW(deck.finish());
  // The offset of the scales differs in the 13th digit.
  EXPECT_NEAR(gas(0.0), 0.0, 1e-9);
  EXPECT_NEAR(gas(60.0), 100.0, 1e-9);
  EXPECT_DOUBLE_EQ(modulus(30.0), 40e9);
}

TEST(CurveReader, ReadsACsvFileBesideTheDeck) {
  const Folder folder;
  folder.write("modulus.csv", "temperature [K], modulus [GPa]\n293.15, 70\n1073.15, 10\n");
  const Curve curve = read_good("{ csv = \"modulus.csv\" }", unit::stress, folder.path());
  EXPECT_NEAR(curve(410.0), 40e9, 1.0);
  folder.write("ratio.csv", "T [degC], ratio [1]\n20, 1\n800, 0.5\n");
  EXPECT_DOUBLE_EQ(
      read_good("{ value = \"2 MPa\", times = { csv = \"ratio.csv\" } }", unit::stress, folder.path())(800.0),
      1e6);
}

TEST(CurveReader, TakesColumnsOfAFileByNameOrNumber) {
  const Folder folder;
  folder.write("many.csv", "run;T [degC];E1 [GPa];E2\n1;20;1,5;70\n2;800;0,5;10\n");
  for (const std::string choice : {"columns = [\"T\", \"E2\"], units = [\"\", \"GPa\"]",
                                   "columns = [2, 4], units = [\"degC\", \"GPa\"]"})
    EXPECT_DOUBLE_EQ(read_good("{ csv = \"many.csv\", " + choice + " }", unit::stress, folder.path())(410.0),
                     40e9)
        << choice;
}

TEST(CurveReader, EvaluatesAnExpressionInItsUnitAndRange) {
  const Curve curve = read_good(
      "{ expression = \"70 * (1 - 0.001 * (T - 20))\", unit = \"GPa\", range = [\"20 degC\", \"800 degC\"] }",
      unit::stress);
  EXPECT_DOUBLE_EQ(curve(520.0), 35e9);
  EXPECT_EQ(curve.range(), kFire);
  EXPECT_TRUE(mentions(curve.describe(), "70 * (1 - 0.001 * (T - 20))")) << curve.describe();
}

TEST(CurveReader, MakesARampOverTheTimeAndHoldsItsEnd) {
  const Deck deck =
      Deck::parse("gas = { from = \"20 degC\", rate = \"5 K/min\", to = \"800 degC\" }\n", "case.toml");
  CurveReader reader(".", time_axis(), {0.0, 1e6}, builtin_curves());
  const Curve gas = reader.read(deck.root(), "gas", unit::temperature, Range::any(), "");
  EXPECT_NO_THROW(deck.finish());
  EXPECT_DOUBLE_EQ(gas(0.0), 20.0);
  EXPECT_NEAR(gas(60.0), 25.0, 1e-9);
  EXPECT_DOUBLE_EQ(gas(780.0 / 5.0 * 60.0 + 1.0), 800.0);
  EXPECT_DOUBLE_EQ(gas(1e6), 800.0);
}

TEST(CurveReader, CoolsAlongARampToALowerTemperature) {
  const Deck deck =
      Deck::parse("gas = { from = \"800 degC\", rate = \"1 K/s\", to = \"20 degC\" }\n", "case.toml");
  CurveReader reader(".", time_axis(), {0.0, 1000.0}, builtin_curves());
  EXPECT_DOUBLE_EQ(reader.read(deck.root(), "gas", unit::temperature, Range::any(), "")(100.0), 700.0);
}

TEST(CurveReader, FallsBackOnlyIfTheKeyIsAbsent) {
  const Deck deck = Deck::parse("there = \"3 1/K\"\n", "case.toml");
  CurveReader reader(".", temperature_axis(), kFire, builtin_curves());
  EXPECT_EQ(reader.read(deck.root(), "there", unit::expansion, Range::any(), 0.0, "")(20.0), 3.0);
  EXPECT_EQ(reader.read(deck.root(), "absent", unit::expansion, Range::any(), 7.0, "")(20.0), 7.0);
  EXPECT_NO_THROW(deck.finish());
  ASSERT_EQ(reader.curves().size(), 1U);
}

TEST(CurveReader, KeepsWhatItReadWithPathAndUnit) {
  const Deck deck = Deck::parse(
      "width = \"3 Pa\"\n[materials.mortar]\nE = { value = \"2 GPa\", times = \"glasgow_modulus\" }\n",
      "case.toml");
  CurveReader reader(".", temperature_axis(), kFire, builtin_curves());
  reader.read(deck.root(), "width", unit::stress, Range::any(), "");
  reader.read(deck.root().section("materials").section("mortar"), "E", unit::stress, Range::positive(), "");
  ASSERT_EQ(reader.curves().size(), 2U);
  EXPECT_EQ(reader.curves()[0].path, "width");
  EXPECT_EQ(reader.curves()[1].path, "materials.mortar.E");
  EXPECT_EQ(reader.curves()[1].unit, "Pa");
  EXPECT_EQ(reader.curves()[1].curve(20.0), 2e9);
}

// ---- The errors

struct BadCurve {
  const char* value;
  const char* key;      // where the error is
  const char* message;  // part of what is said
};

TEST(BadCurve, IsExplainedWhereItStands) {
  for (const BadCurve& bad : {
           BadCurve{"\"70 m\"", "key", "wrong dimension"},
           BadCurve{"{ builtin = \"en1992_conductivity_uper\" }", "key.builtin",
                    "the nearest is \"en1992_conductivity_upper\""},
           BadCurve{"{ builtin = \"en1992_conductivity_upper\" }", "key.builtin",
                    "is in W/(m K); a curve in Pa (stress)"},
           BadCurve{"{ builtin = \"glasgow_modulus\" }", "key.builtin", "times = \"glasgow_modulus\""},
           BadCurve{"{ value = \"70 GPa\", times = \"glasgow_modlus\" }", "key.times",
                    "the nearest is \"glasgow_modulus\""},
           BadCurve{"{ value = \"70 GPa\", times = \"en1992_conductivity_upper\" }", "key.times",
                    "is in W/(m K)"},
           BadCurve{"{ value = \"70 GPa\", times = \"en1992_peak_strain\" }", "key.times",
                    "must be 1 at 20 degC"},
           BadCurve{"{ value = \"70 m\", times = \"glasgow_modulus\" }", "key.value", "wrong dimension"},
           BadCurve{"{ value = \"70 GPa\" }", "key.times", "missing"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"], [\"800 degC\", \"4 m\"]] }", "key.table[1][1]",
                    "wrong dimension"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"], [\"800 K/s\", \"4 GPa\"]] }", "key.table[1][0]",
                    "temperature (degC)"},
           BadCurve{
               "{ table = [[\"20 degC\", \"70 GPa\"], [\"10 degC\", \"4 GPa\"], [\"900 degC\", \"4 GPa\"]] }",
               "key.table[1][0]", "must be above the temperature before, 20 degC"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"]] }", "key.table", "two or more points"},
           BadCurve{"{ csv = \"none.csv\" }", "key.csv", "none.csv"},
           BadCurve{"{ expression = \"70 * (1 -\", unit = \"GPa\", range = [\"20 degC\", \"800 degC\"] }",
                    "key.expression", "70 * (1 -"},
           BadCurve{"{ expression = \"70 * t\", unit = \"GPa\", range = [\"20 degC\", \"800 degC\"] }",
                    "key.expression", "t"},
           BadCurve{"{ expression = \"T\", unit = \"m\", range = [\"20 degC\", \"800 degC\"] }", "key.unit",
                    "wrong dimension"},
           BadCurve{"{ expression = \"T\", range = [\"20 degC\", \"800 degC\"] }", "key.unit", "missing"},
           BadCurve{"{ expression = \"T\", unit = \"GPa\" }", "key.range", "missing"},
           BadCurve{"{ expression = \"T\", unit = \"GPa\", range = [\"800 degC\", \"20 degC\"] }",
                    "key.range", "the first below the second"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"], [\"800 degC\", \"4 GPa\"]], csv = \"none.csv\" }",
                    "key.csv", "no meaning beside \"table\""},
           BadCurve{"{}", "key", "needs one of the keys value, table, csv, builtin, expression"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"], [\"600 degC\", \"4 GPa\"]] }", "key",
                    "given from 20 to 600 degC, but the run needs it from 20 to 800 degC"},
           BadCurve{"{ table = [[\"20 degC\", \"70 GPa\"], [\"400 degC\", \"-4 GPa\"], [\"800 degC\", \"4 "
                    "GPa\"]] }",
                    "key", "comes to -4e+09 Pa between 20 and 800 degC; must be greater than 0 Pa"},
           BadCurve{"{ value = \"70 GPa\", times = \"en1992_tensile_strength\" }", "key", "20 to 600 degC"},
           BadCurve{
               "{ expression = \"1 / (T - 800)^2\", unit = \"GPa\", range = [\"20 degC\", \"800 degC\"] }",
               "key", "no finite value at T = 800"},
       }) {
    const Deck deck = deck_of(bad.value);
    const Curve stand_in = read(deck, unit::stress, Range::positive());
    EXPECT_TRUE(stand_in.is_constant()) << bad.value;
    EXPECT_GT(stand_in(20.0), 0.0) << bad.value;
    const Diagnostic diagnostic = only_diagnostic_of(deck);
    EXPECT_EQ(diagnostic.file, "case.toml");
    EXPECT_EQ(diagnostic.line, 3) << bad.value;
    EXPECT_EQ(diagnostic.key, std::string("materials.mortar.") + bad.key) << bad.value;
    EXPECT_TRUE(mentions(diagnostic.message, bad.message)) << bad.value << ": " << diagnostic.message;
  }
}

TEST(BadCurve, ShowsTheValueAsWritten) {
  const Deck deck = deck_of("{ builtin = \"glasgow\" }");
  read(deck, unit::stress);
  EXPECT_EQ(only_diagnostic_of(deck).value, "\"glasgow\"");
}

TEST(BadCurve, WithAMisspeltKeyIsToldTheRightOne) {
  const Deck deck = deck_of("{ tabel = [[\"20 degC\", \"70 GPa\"], [\"800 degC\", \"4 GPa\"]] }");
  read(deck, unit::stress);
  const auto errors = diagnostics_of(deck);
  ASSERT_EQ(errors.size(), 2U);
  EXPECT_EQ(errors[1].hint, "did you mean \"table\"?");
}

TEST(BadCurve, RatioIsNoProductItself) {
  const Deck deck = deck_of("{ value = \"2 Pa\", times = { value = 1, times = \"glasgow_modulus\" } }");
  read(deck, unit::stress);
  EXPECT_EQ(diagnostics_of(deck).front().message,
            "a curve needs one of the keys table, csv, builtin, expression");
}

TEST(BadCurve, InACsvFileIsNamedByFileAndLine) {
  const Folder folder;
  folder.write("modulus.csv", "temperature [degC], modulus [m]\n20, 70\n800, 10\n");
  const Deck deck = deck_of("{ csv = \"modulus.csv\" }");
  read(deck, unit::stress, Range::any(), kFire, folder.path());
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.key, "materials.mortar.key.csv");
  EXPECT_TRUE(mentions(diagnostic.message, "modulus.csv:1")) << diagnostic.message;
}

TEST(BadCurve, OfAFileWithMoreColumnsIsToldWhichToWrite) {
  const Folder folder;
  folder.write("many.csv", "T [degC],E1 [GPa],E2 [GPa]\n20,1,70\n800,1,10\n");
  for (const auto& [value, key, message] : {
           std::tuple{"{ csv = \"many.csv\" }", "csv",
                      "write { csv = \"many.csv\", columns = [\"T\", \"E1\"] }"},
           std::tuple{"{ csv = \"many.csv\", columns = [\"T\", \"E11\"] }", "csv", "did you mean \"E1\"?"},
           std::tuple{"{ csv = \"many.csv\", columns = [\"T\"] }", "columns", "must be a list of 2 columns"},
           std::tuple{"{ csv = \"many.csv\", columns = [1, 0] }", "columns", "its number from 1"},
           std::tuple{"{ csv = \"many.csv\", columns = [1, 2], units = [\"K\"] }", "units",
                      "must be a list of 2 units"},
           std::tuple{"{ csv = \"many.csv\", columns = [1, 2], units = [\"K\", \"GPa\"] }", "csv",
                      "is in \"degC\" by the file and in \"K\" by the deck"},
       }) {
    const Deck deck = deck_of(value);
    read(deck, unit::stress, Range::any(), kFire, folder.path());
    const Diagnostic diagnostic = only_diagnostic_of(deck);
    EXPECT_EQ(diagnostic.key, std::string("materials.mortar.key.") + key) << value;
    EXPECT_TRUE(mentions(diagnostic.message, message)) << diagnostic.message;
  }
}

// What a run does not read needs no allowed value.
TEST(BadCurve, IsOnlyWhatTheRunNeeds) {
  const Deck deck =
      deck_of("{ value = \"30 MPa\", times = \"en1992_siliceous_strength\" }");  // 0 at 1200 degC
  EXPECT_DOUBLE_EQ(read(deck, unit::stress, Range::positive())(800.0), 0.15 * 30e6);
  EXPECT_NO_THROW(deck.finish());
  const Deck hotter = deck_of("{ value = \"30 MPa\", times = \"en1992_siliceous_strength\" }");
  read(hotter, unit::stress, Range::positive(), {20.0, 1200.0});
  EXPECT_TRUE(mentions(only_diagnostic_of(hotter).message, "must be greater than 0 Pa"));
}

TEST(BadCurve, RampOverTheTemperatureIsNone) {
  const Deck deck = deck_of("{ from = \"20 degC\", rate = \"5 K/min\", to = \"800 degC\" }");
  read(deck, unit::temperature);
  EXPECT_FALSE(diagnostics_of(deck).empty());
}

TEST(BadCurve, RampThatGoesNowhereIsRefused) {
  const Deck deck =
      Deck::parse("gas = { from = \"20 degC\", rate = \"5 K/min\", to = \"20 degC\" }\n", "case.toml");
  CurveReader reader(".", time_axis(), {0.0, 1.0}, builtin_curves());
  reader.read(deck.root(), "gas", unit::temperature, Range::any(), "");
  EXPECT_EQ(only_diagnostic_of(deck).key, "gas.to");
}

TEST(BadCurve, MissingKeyIsReportedAtItsTable) {
  const Deck deck = Deck::parse("[materials.mortar]\n", "case.toml");
  read(deck, unit::stress, Range::positive());
  EXPECT_EQ(only_diagnostic_of(deck).key, "materials.mortar.key");
}

}  // namespace
}  // namespace pyroclast
