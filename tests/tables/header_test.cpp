#include "pyroclast/tables/header.hpp"

#include <gtest/gtest.h>

#include "layouts.hpp"
#include "messages.hpp"

namespace pyroclast {
namespace {

/// Values of a column of strain, from a table with a column of stress beside it.
std::vector<double> strains(const std::string& header, const std::vector<std::string>& units = {}) {
  const auto table = MeasuredTable::parse(header + ";stress [MPa]\n0;0\n0.5;9\n", "press.csv", 2);
  const std::array<AskedColumn, 2> asked{{{"strain", unit::dimensionless, {{&meaning::strain}}},
                                          {"stress", unit::stress, {{&meaning::stress}}}}};
  return table.values(table.choose({"press.csv", {}, units}, asked)[0], unit::dimensionless);
}

// Promise: a strain is read in the unit that its header writes, in each of the ways to write it.
TEST(Header, UnitsOfStrainAreReadAsWritten) {
  struct Unit {
    double factor;
    std::vector<const char*> texts;
  };
  const Unit units[] = {{1e-3,
                         {"‰", "permille", "per mille", "Promille", "o/oo", "0/00", "mm/m", "10⁻³", "10^-3",
                          "10-3", "×10⁻³", "1e-3", "E-3"}},
                        {1e-6,
                         {"microstrain", "µε", "\u03BCε", "με", "µstrain", "um/m", "µm/m", "\u03BCm/m", "ue",
                          "10⁻⁶", "1E-6", "x10^-6"}},
                        {1e-2,
                         {"%", "wt%", "wt.-%", "Vol.-%", "vol%", "vol.%", "mass-%", "Mass %", "M.-%",
                          "Gew.-%", "pct", "per cent"}},
                        {1.0, {"-", "1", "", "–", "m/m", "mm/mm"}}};
  for (const auto& [factor, texts] : units)
    for (const std::string text : texts) {
      for (const std::string& header :
           {"Strain [" + text + "]", "Strain (" + text + ")", "Strain [ " + text + " ]",
            "Strain [" + text + "] (LVDT 1)", "Strain (" + text + ") axial"})
        EXPECT_DOUBLE_EQ(strains(header).at(1), 0.5 * factor) << header;
      if (text.size() < 2) continue;
      EXPECT_DOUBLE_EQ(strains("Strain, " + text).at(1), 0.5 * factor) << text;
      EXPECT_DOUBLE_EQ(strains("Strain in " + text).at(1), 0.5 * factor) << text;
      EXPECT_DOUBLE_EQ(strains("Strain / " + text).at(1), 0.5 * factor) << text;
    }
  EXPECT_DOUBLE_EQ(strains("Strain ‰").at(1), 5e-4);
  EXPECT_DOUBLE_EQ(strains("Strain (in ‰)").at(1), 5e-4);
  EXPECT_DOUBLE_EQ(strains("Strain", {"‰", ""}).at(1), 5e-4);
  for (const std::string header : {"Strain permille", "Strain per mille", "Strain ‰ (LVDT 1)", "‰ strain",
                                   "strain 1e-3", "Dehnung Promille", "strain_permille (mean)"})
    EXPECT_DOUBLE_EQ(strains(header).at(1), 5e-4) << header;
  for (const std::string header :
       {"microstrain", "micro-strain", "µε", "DMS 1 microstrain", "strain µε (DMS 1)"})
    EXPECT_DOUBLE_EQ(strains(header).at(1), 5e-7) << header;
}

// Promise: a text in brackets that looks like a unit is never passed over.
TEST(Header, AnUnknownUnitInRoundBracketsIsRefusedAsInSquareOnes) {
  for (const std::string text : {"‰x", "mstrain", "kN/m2x", "permil.x", "per thousand", "millistrain",
                                 "10^-4x", "m²x", "me", "°", "x/y", "parts/million", "parts per million",
                                 "percent of strain", "x1000", "x 1000", "nanostrains", "1/1000"})
    for (const std::string& header :
         {"Strain [" + text + "]", "Strain (" + text + ")", "(" + text + ") strain"}) {
      if (header.starts_with("(") && text == "°") continue;
      SCOPED_TRACE(header);
      expect_in("press.csv:1: column \"", message([&] { strains(header); }));
      expect_in("unit \"" + text + "\"", message([&] { strains(header); }));
    }
  expect_in("if (‰x) is a remark, write it without brackets", message([] { strains("Strain (‰x)"); }));
  EXPECT_DOUBLE_EQ(strains("Strain (‰x)", {"‰", ""}).at(1), 5e-4);
}

// Promise: remarks in round brackets are no units.
TEST(Header, RemarksInRoundBracketsPass) {
  for (const std::string text :
       {"measured",   "mean of 3", "LVDT 1", "LVDT1",        "No. 3",      "axial",
        "at 20 °C",   "20 °C",     "28 d",   "28-day",       "DMS 2",      "corrected, 2nd run",
        "gauge no.4", "f_c/f_c20", "E/E0",   "Mitte",        "right side", "K1",
        "T2",         "processed", "steps",  "axial strain", "mean"})
    EXPECT_DOUBLE_EQ(strains("Strain (" + text + ")").at(1), 0.5) << text;
  EXPECT_DOUBLE_EQ(strains("Strain at 50 %").at(1), 0.5);
  EXPECT_DOUBLE_EQ(strains("Ratio f_c(T)/f_c(20)").at(1), 0.5);
}

}  // namespace
}  // namespace pyroclast
