// Promise: how far a curve is from a reference is what docs/understand/theory.md says, exactly for lines.
#include "pyroclast/results/reference_distances.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pyroclast/results/summary.hpp"
#include "stages/drives.hpp"

namespace pyroclast {
namespace {

constexpr double kRounding = 1e-14;  // of a handful of sums

TEST(Distances, TheSameLineByOtherPointsIsNotApart) {
  const CurveDistances d = distances({{0.0, 1.0, 2.0, 4.0}, {0.0, 10.0, 20.0, 0.0}},
                                     {{0.0, 2.0, 3.0, 4.0}, {0.0, 20.0, 10.0, 0.0}});
  EXPECT_EQ(d.rms, 0.0);
  EXPECT_EQ(d.area, 0.0);
  EXPECT_EQ(d.at_peak, 0.0);
  EXPECT_EQ(d.covered, 1.0);
}

TEST(Distances, AnEvenDifferenceIsThatOverTheGreatestValue) {
  const CurveDistances d = distances({{0.0, 2.0}, {3.0, 23.0}}, {{0.0, 1.0, 2.0}, {0.0, 10.0, 20.0}});
  EXPECT_NEAR(*d.rms, 3.0 / 20.0, kRounding);
  EXPECT_NEAR(*d.area, 6.0, kRounding);
  EXPECT_NEAR(*d.at_peak, 23.0 / 20.0 - 1.0, kRounding);
}

// y - r goes from -1 to 3 over a width of 4: it crosses zero at 1. Areas 0.5 and 4.5; the mean square is
// (1 - 3 + 9) / 3 by integration of a straight line.
TEST(Distances, WhereCurvesCrossBothAreasCount) {
  const CurveDistances d =
      distances({{0.0, 4.0}, {-1.0, 3.0}}, {{-1.0, 0.0, 4.0, 5.0}, {0.0, 0.0, 0.0, -2.0}});
  EXPECT_NEAR(*d.area, 5.0, kRounding);
  EXPECT_NEAR(*d.rms, std::sqrt(7.0 / 3.0) / 2.0, kRounding);
  EXPECT_NEAR(*d.covered, 4.0 / 6.0, kRounding);
}

// A reference whose greatest value is negative: the run's is the most negative.
TEST(Distances, ThePeakIsOfTheReferencesSignAndInItsRange) {
  const CurveDistances d =
      distances({{0.0, 1.0, 2.0, 3.0}, {0.0, -18.0, 5.0, -100.0}}, {{0.0, 1.0, 2.0}, {0.0, -20.0, -10.0}});
  EXPECT_NEAR(*d.at_peak, -0.1, kRounding);
}

TEST(Distances, ALoopOfUnloadingIsLeftOut) {
  const PlainCurve straight{{0.0, 4.0}, {0.0, 40.0}};
  const PlainCurve loop{{0.0, 2.0, 1.0, 2.0, 4.0}, {0.0, 20.0, 3.0, 19.0, 40.0}};
  const CurveDistances d = distances(loop, straight);
  EXPECT_EQ(d.area, 0.0);
  EXPECT_EQ(distances(straight, loop).area, 0.0);
}

TEST(Distances, WithoutACommonRangeThereIsNone) {
  const CurveDistances d = distances({{0.0, 1.0}, {0.0, 1.0}}, {{2.0, 3.0}, {0.0, 1.0}});
  EXPECT_FALSE(d.rms || d.area || d.at_peak);
  EXPECT_EQ(d.covered, 0.0);
  EXPECT_FALSE(distances({}, {{2.0, 3.0}, {0.0, 1.0}}).covered);
  EXPECT_FALSE(distances({{0.0, 1.0}, {0.0, 1.0}}, {{0.0, 1.0}, {0.0, 0.0}}).rms) << "relative to nothing";
}

Reference of_stress(std::vector<double> strain, std::vector<double> stress) {
  return {"mine",
          false,
          DrawnRows::compressed,
          {"stress", "stress_MPa", &unit::stress, 1e-6},
          {"strain", "strain"},
          std::move(strain),
          stress,
          stress};
}

// Promise: the summary has the distances of a run by the reference's name, a study knows their names before
// the first row, and the run's own curve is not apart from it.
TEST(Distances, ARunIsNotApartFromItsOwnCurve) {
  const Finished run(deck(kUniform + kSettle + kCompress));
  const PlainCurve own = curve_beside(of_stress({0.0, 1.0}, {0.0, 1.0}), run.run);
  ASSERT_GT(own.x.size(), 10u);
  EXPECT_EQ(own.x.front(), 0.0);
  const std::vector<Reference> held{of_stress(own.x, own.y)};
  const Summary summary = summarize(run.run, held);
  const auto told = nlohmann::json::parse(summary_text(summary, run.run))["references"]["mine"];
  EXPECT_EQ(told["rms_over_greatest"], 0.0);
  EXPECT_EQ(told["area_between_MPa"], 0.0);
  EXPECT_EQ(told["peak_difference"], 0.0);
  EXPECT_EQ(told["share_covered"], 1.0);
  Trial before(deck(kUniform + kSettle + kCompress));
  const auto names = summary_numbers(before.run, held);
  for (const char* name : {"rms_over_greatest", "peak_difference", "area_between_MPa", "share_covered"})
    EXPECT_NE(std::ranges::find(names, std::string("references.mine.") + name), names.end()) << name;
}

TEST(Distances, AReferenceOfAnotherUnitOrSignIsToldAtTheEnd) {
  const Finished run(deck(kUniform + kSettle + kCompress));
  const PlainCurve own = curve_beside(of_stress({0.0, 1.0}, {0.0, 1.0}), run.run);
  const auto warnings = [&](double factor) {
    std::vector<double> stress = own.y;
    for (double& value : stress) value *= factor;
    const std::vector<Reference> held{of_stress(own.x, stress)};
    return fmt::format("{}", fmt::join(summarize(run.run, held).warnings, "\n"));
  };
  EXPECT_NE(warnings(1e6).find("in another unit"), std::string::npos);
  EXPECT_NE(warnings(-1.0).find("state its sign"), std::string::npos);
  EXPECT_EQ(warnings(0.5).find("reference"), std::string::npos);
  const std::vector<Reference> elsewhere{of_stress({7.0, 8.0}, {0.0, 1.0})};
  const auto all = fmt::format("{}", fmt::join(summarize(run.run, elsewhere).warnings, "\n"));
  EXPECT_NE(all.find("the run has no strain in its range, 7 to 8"), std::string::npos) << all;
}

}  // namespace
}  // namespace pyroclast
