#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/tables/measured_table.hpp"

namespace pyroclast {
namespace {

const std::array<AskedColumn, 4> kStones{
    {{"x", unit::length, {{&meaning::x}}},
     {"y", unit::length, {{&meaning::y}}},
     {"diameter", unit::length, {{&meaning::diameter}, {&meaning::radius, 2.0}}},
     {"phase", unit::dimensionless, {{&meaning::phase}}, true}}};
const ColumnMeanings kOthersOfStones{&meaning::z, &meaning::diameter, &meaning::radius, &meaning::area,
                                     &meaning::grain};
const std::array<AskedColumn, 2> kCurve{
    {{"strain", unit::dimensionless, {{&meaning::strain}}}, {"stress", unit::stress, {{&meaning::stress}}}}};
const std::array<AskedColumn, 2> kSieves{
    {{"size", unit::length, {{&meaning::sieve}}}, {"passing", unit::dimensionless, {{&meaning::passing}}}}};

using Numbers = std::vector<double>;

/// Values of all rows, quantity by quantity.
template <std::size_t N>
std::vector<Numbers> read(const std::string& text, const std::array<AskedColumn, N>& asked,
                          const ColumnMeanings& others = {}, const ColumnChoice& choice = {"f.csv", {}, {}}) {
  const auto table = MeasuredTable::parse(text, "f.csv", 2);
  std::vector<Numbers> values;
  const auto columns = table.choose(choice, asked, others);
  for (std::size_t i = 0; i < columns.size(); ++i) values.push_back(table.values(columns[i], asked[i].unit));
  return values;
}

std::string refusal_of_stones(const std::string& text, const ColumnChoice& choice = {"f.csv", {}, {}}) {
  return message([&] { read(text, kStones, kOthersOfStones, choice); });
}

void expect_near(const std::vector<Numbers>& values, const std::vector<Numbers>& expected,
                 const std::string& text) {
  ASSERT_EQ(values.size(), expected.size()) << text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    ASSERT_EQ(values[i].size(), expected[i].size()) << text;
    for (std::size_t k = 0; k < values[i].size(); ++k) EXPECT_DOUBLE_EQ(values[i][k], expected[i][k]) << text;
  }
}

// Promise: columns of a packing are read by their names, whatever their order, and a radius is half a
// diameter.
TEST(ChooseColumns, StonesAreReadByName) {
  const std::vector<Numbers> stones{{0.03, 0.09}, {0.04, 0.05}, {0.02, 0.03}};
  for (const std::string text : {
           "x [mm],y [mm],d [mm]\n30,40,20\n90,50,30\n",
           "x [mm],y [mm],radius [mm]\n30,40,10\n90,50,15\n",
           "x [mm],y [mm],r [mm]\n30,40,10\n90,50,15\n",
           "x_mm,y_mm,R_mm\n30,40,10\n90,50,15\n",
           "Y [mm],X [mm],Diameter [mm]\n40,30,20\n50,90,30\n",
           "radius [mm],x [mm],y [mm]\n10,30,40\n15,90,50\n",
           "id,x [mm],y [mm],r [mm]\n7,30,40,10\n9,90,50,15\n",
           "x [mm],y [mm],Ø [mm],id\n30,40,20,7\n90,50,30,9\n",
           "No.;x [mm];y [mm];size [mm]\n4;30;40;20\n2;90;50;30\n",
           "name,x [mm],y [mm],r [mm]\nA,30,40,10\nB,90,50,15\n",
           "xCenter [mm],yCenter [mm],Durchmesser [mm]\n30,40,20\n90,50,30\n",
           "Centroid y [mm],Centroid x [mm],Feret diameter [mm]\n40,30,20\n50,90,30\n",
           "x [mm],y [mm],2R [mm]\n30,40,20\n90,50,30\n",
           "x [mm],y [mm],d/2 [mm]\n30,40,10\n90,50,15\n",
           "a [mm],b [mm],c [mm]\n30,40,20\n90,50,30\n",
       })
    expect_near(read(text, kStones, kOthersOfStones), stones, text);
  const std::string mixed = "phase,r [mm],y [mm],x [mm]\n0,10,40,30\n1,15,50,90\n";
  expect_near(read(mixed, kStones, kOthersOfStones), {stones[0], stones[1], stones[2], {0.0, 1.0}}, mixed);
  const std::string wide = "id,x [mm],y [mm],r [mm],area [mm2]\n7,30,40,10,1\n9,90,50,15,1\n";
  expect_near(read(wide, kStones, kOthersOfStones, {"f.csv", {{"x"}, {"y"}, {"r"}}, {}}), stones, wide);
  expect_near(read(wide, kStones, kOthersOfStones, {"f.csv", {{"", 2}, {"", 3}, {"", 4}}, {}}), stones, wide);
}

// Promise: a comment above the numbers that has a name for each column names them, as NumPy writes its
// header.
TEST(ChooseColumns, ACommentOfNamesIsAHeader) {
  const std::vector<Numbers> stones{{0.03, 0.09}, {0.04, 0.05}, {0.02, 0.03}};
  const ColumnChoice in_mm{"f.csv", {}, {"mm", "mm", "mm"}};
  for (const std::string text :
       {"# x y r\n30 40 10\n90 50 15\n", "# packing\n# y,x,d\n40,30,20\n50,90,30\n",
        "% x,y,radius,\n30,40,10\n90,50,15\n", "# three grains of sand, 7\n30 40 20\n90 50 30\n"})
    expect_near(read(text, kStones, kOthersOfStones, in_mm), stones, text);
  const std::string with_units = "# x [mm] y [mm] r [mm]\n30 40 10\n90 50 15\n";
  expect_near(read(with_units, kStones, kOthersOfStones), stones, with_units);
  const std::string remark = "# three [own] grains\n30 40 20\n90 50 30\n";
  expect_near(read(remark, kStones, kOthersOfStones, in_mm), stones, remark);
}

// Promise: where "%" begins the comment that names the columns, it may be the unit of the first one. A pure
// number there is refused unless its unit is told, as both readings differ by a hundred.
TEST(ChooseColumns, APercentSignBeforeTheNamesIsNeitherUnitNorCommentByGuess) {
  const std::string table = "strain,stress [MPa]\n0.1,20\n0.2,30\n";
  expect_in(
      "f.csv:1: the line begins with \"%\", which may be the unit of column \"strain\" or begin a comment; "
      "write \"strain [%]\" or \"strain [-]\"",
      message([&] { read("% " + table, kCurve); }));
  const std::vector<Numbers> curve{{0.001, 0.002}, {20e6, 30e6}};
  for (const std::string text :
       {"% strain [%],stress [MPa]\n0.1,20\n0.2,30\n", "% strain [-],stress [MPa]\n0.001,20\n0.002,30\n"})
    expect_near(read(text, kCurve), curve, text);
  expect_near(read("% " + table, kCurve, {}, {"f.csv", {}, {"%", ""}}), curve, table);
}

// Promise: a name that says another quantity than its place is refused, and the message says what to write.
TEST(ChooseColumns, NamesThatContradictTheirPlaceAreRefused) {
  expect_in("f.csv:1: column \"radius\" is the radius by its name, but stands in the place of the x",
            refusal_of_stones("radius [mm],y [mm],d [mm]\n1,2,3\n"));
  expect_in("column \"z\" is the z by its name, but stands in the place of the diameter",
            refusal_of_stones("x [mm],y [mm],z [mm]\n1,2,3\n"));
  const std::string in_space = refusal_of_stones("x [mm],y [mm],z [mm],r [mm]\n1,2,3,4\n");
  expect_in("write { csv = \"f.csv\", columns = [\"x\", \"y\", \"r\"] }", in_space);
  expect_in(
      "column \"id\" stands in the place of the x by its name",
      refusal_of_stones("id,x [m],y [m],d [m]\n1,2,3,4\n", {"f.csv", {{"id"}, {"x"}, {"y"}}, {"m", "", ""}}));
  expect_in("is the retained by its name",
            message([] { read("size [mm],retained [%]\n1,2\n4,100\n", kSieves, {&meaning::retained}); }));
}

// Promise: a message that proposes columns names those that are needed, each once, in the order of the key.
TEST(ChooseColumns, ProposedColumnsAreThoseThatAreNeeded) {
  expect_in("columns = [\"x\", \"y\", \"d\"], units = [\"m\", \"m\", \"m\"] }",
            refusal_of_stones("id,x,y,d\n7,1,2,3\n9,2,3,4\n"));
  expect_in(
      "columns = [\"x\", \"y\", \"diameter\"] }",
      refusal_of_stones("id,area [mm2],y [mm],x [mm],z [mm],diameter [mm],radius [mm]\n7,1,2,3,4,5,6\n"));
  expect_in("columns = [\"Opening\", \"Passing\"] }",
            message([] { read("Sieve,Opening [mm],Passing [%]\n4,4.75,50\n8,16,100\n", kSieves); }));
  expect_in("columns = [\"Opening\", \"Passing\"] }", message([] {
              read("Passing [%],Retained [g],Sieve,Opening [mm]\n50,1,8,4.75\n100,2,4,16\n", kSieves,
                   {&meaning::retained});
            }));
  expect_in("columns = [\"strain\", 2] }",
            message([] { read("id2,stress [MPa],strain [%],stress [MPa]\n5,1,2,3\n5,2,3,4\n", kCurve); }));
}

// Promise: a curve is read by the names of its two columns, and the end of a shorter pair is its end.
TEST(ChooseColumns, CurvesAreReadByNameUpToTheirEnd) {
  const std::vector<Numbers> curve{{0.0, 1e-3}, {0.0, 2e7}};
  for (const std::string text :
       {"stress [MPa],strain [‰]\n0,0\n20,1\n", "Spannung [MPa];Dehnung [‰]\n0;0\n20;1\n",
        "stress_MPa,eps\n0,0\n20,0.001\n", "nr,sigma [MPa],ε [‰]\n5,0,0\n8,20,1\n"})
    expect_near(read(text, kCurve), curve, text);
  const ColumnChoice first{"f.csv", {{"", 1}, {"", 2}}, {}}, second{"f.csv", {{"", 3}, {"", 4}}, {}};
  for (const char mark : {',', ';', '\t'}) {
    std::string text =
        "strain [‰],stress [MPa],strain [‰],stress [MPa]\n0,0,0,0\n1,20,2,30\n,,3,40\n,,4,35\n";
    std::ranges::replace(text, ',', mark);
    expect_near(read(text, kCurve, {}, first), curve, text);
    EXPECT_EQ(read(text, kCurve, {}, second)[0].size(), 4u) << text;
  }
  const std::string gap = "strain [‰],stress [MPa],c\n0,0,1\n,,2\n1,20,3\n2,,4\n,,5\n";
  expect_in("f.csv:3: column \"strain\" is empty", message([&] { read(gap, kCurve, {}, first); }));
}

// Promise: a unit that does not fit a known name takes the name's meaning from it.
TEST(ChooseColumns, UnitsGoBeforeNames) {
  const std::array<AskedColumn, 2> course{{{"time", unit::time, {{&meaning::time}}},
                                           {"temperature", unit::temperature, {{&meaning::temperature}}}}};
  const std::string odd = "T [min],t [degC]\n0,20\n1,30\n";
  expect_near(read(odd, course), {{0.0, 60.0}, {20.0, 30.0}}, odd);
  const std::string swapped = "gas temperature [degC],elapsed [min]\n20,0\n30,1\n";
  expect_near(read(swapped, course), {{0.0, 60.0}, {20.0, 30.0}}, swapped);
  for (const std::string name : {"Temperature rise [K]", "ΔT [K]", "dT [degC]", "temperature increase (K)"})
    expect_in("is the temperature rise by its name", message([&] {
                read("time [min]," + name + "\n0,0\n1,30\n", course, {&meaning::temperature_rise});
              }));
}

}  // namespace
}  // namespace pyroclast
