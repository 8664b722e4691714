// Promise: how far a curve is from a reference is what docs/understand/theory.md says, exactly for lines.
#include "pyroclast/results/reference_distances.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
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

// Of points one above the other the first counts, in the curve and in the reference.
TEST(Distances, AStepUpwardsIsLeftOut) {
  const PlainCurve step{{0.0, 1.0, 1.0, 2.0}, {0.0, 0.0, 10.0, 0.0}}, even{{0.0, 2.0}, {1.0, 1.0}};
  EXPECT_EQ(distances(step, even).area, 2.0);
  EXPECT_EQ(distances(even, step).area, 2.0);
}

// Promise: the peak is looked for among the points in the reference's range, both of its ends among them; one
// point is enough.
TEST(Distances, PointsAtTheEndsOfTheRangeHaveAPeak) {
  const PlainCurve falling{{1.0, 3.0}, {10.0, 1.0}};
  EXPECT_DOUBLE_EQ(*distances({{0.5, 1.0, 2.0}, {12.0, 9.0, 7.0}}, falling).at_peak, -0.1);
  EXPECT_DOUBLE_EQ(*distances({{2.0, 3.0, 3.5}, {5.0, 8.0, 12.0}}, falling).at_peak, -0.2);
  const CurveDistances of_one = distances({{2.0}, {8.0}}, falling);
  EXPECT_DOUBLE_EQ(*of_one.at_peak, -0.2);
  EXPECT_FALSE(of_one.covered || of_one.rms || of_one.area);
  EXPECT_FALSE(distances({{0.0, 4.0}, {8.0, 8.0}}, falling).at_peak) << "no point within";
}

// Promise: of a reference of zeros, nothing is relative to it, and the area is told.
TEST(Distances, OfAReferenceOfZerosTheAreaIsTold) {
  const CurveDistances d = distances({{0.0, 2.0}, {3.0, 3.0}}, {{0.0, 1.0}, {0.0, 0.0}});
  EXPECT_EQ(d.area, 3.0);
  EXPECT_EQ(d.covered, 1.0);
  EXPECT_FALSE(d.rms || d.at_peak);
}

// Promise: curves that meet at one place have no distance, but perhaps a peak there.
TEST(Distances, RangesThatTouchHaveNoDistance) {
  const CurveDistances d = distances({{0.0, 1.0}, {4.0, 6.0}}, {{1.0, 2.0}, {0.0, 5.0}});
  EXPECT_EQ(d.covered, 0.0);
  EXPECT_FALSE(d.rms || d.area);
  EXPECT_DOUBLE_EQ(*d.at_peak, 0.2);
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

/// Row of a history that is made by hand.
struct Row {
  std::optional<double> strain, stress, exchange = {};
};

/// Run with a history of the test's own making: its stages are those of the deck.
struct Written : Trial {
  using Trial::Trial;

  /// \param of_stages  rows of each stage; before them stands the row at the start, strain 0 and stress 0.5
  void write(const std::vector<std::vector<Row>>& of_stages) {
    History made;
    for (const char* column : {"strain", "stress_MPa", "exchange"}) made.add_column({column, "1"});
    made.add_row({0.0, 0.5, std::nullopt});
    for (std::size_t i = 0; i < of_stages.size(); ++i) {
      course(i) = {of_stages[i].empty() ? Outcome::not_begun : Outcome::completed,
                   {made.row_count(), made.row_count() + of_stages[i].size()}};
      for (const Row& row : of_stages[i]) made.add_row({row.strain, row.stress, row.exchange});
    }
    const_cast<History&>(run.history()) = std::move(made);
  }
  StageCourse& course(std::size_t stage) { return const_cast<StageCourse&>(run.courses().at(stage)); }
  PlainCurve beside(DrawnRows rows) const {
    Reference reference = of_stress({0.0, 1.0}, {0.0, 1.0});
    reference.rows = rows;
    return curve_beside(reference, run);
  }
};

void expect_points(const PlainCurve& curve, const std::vector<double>& x, const std::vector<double>& y) {
  EXPECT_EQ(curve.x, x);
  EXPECT_EQ(curve.y, y);
}

constexpr std::nullopt_t kGap = std::nullopt;

// Promise: without heat the curve begins at rest, and has the compressions before the test; a row without
// both values is left out.
TEST(CurveBeside, ACompressionBeginsAtRestAndHasThoseBeforeIt) {
  Written r(deck(kUniform + kSettle + kCompress + load("stress = \"1 MPa\"") + kCompress + kCompress));
  const auto compressed = [&] { return r.beside(DrawnRows::compressed); };
  expect_points(compressed(), {}, {});
  r.write({{{0.5, 2}}, {{1, 10}, {2, 20}}, {{2, 18}}, {{3, 15}, {kGap, 7}, {4, 12}, {5, kGap}, {6, 9}}, {}});
  expect_points(compressed(), {0, 1, 2, 3, 4, 6}, {0, 10, 20, 15, 12, 9});
  r.write({{{0.5, 2}}, {{1, 10}}, {}, {{2, kGap}}, {}});
  expect_points(compressed(), {0, 1}, {0, 10});
}

// Promise: after heat the curve begins with the first compression since, and its strain is that since the row
// before the test.
TEST(CurveBeside, ACompressionAfterHeatBeginsWhereHeatLeftTheBody) {
  Written r(deck(kUniform + kSettle + kCompress + heat("30 degC") + kCompress + kCompress));
  const auto compressed = [&] { return r.beside(DrawnRows::compressed); };
  r.write({{{0, 0}}, {{1, 10}}, {{2, 5, 1}, {3, 6, 2}}, {{4, 30}}, {{6, 40}, {7, 50}}});
  expect_points(compressed(), {0, 2, 3}, {30, 40, 50});
  r.write({{{0, 0}}, {{1, 10}}, {{2, 5, 1}, {3, 6, 2}}, {}, {{6, 40}, {7, 50}}});
  expect_points(compressed(), {3, 4}, {40, 50});
  r.write({{{0, 0}}, {{1, 10}}, {{2, 5, 1}, {kGap, 6, 2}}, {}, {{6, 40}, {7, 50}}});
  expect_points(compressed(), {6, 7}, {40, 50});
  // heat within the test comes after its beginning
  r.write({{{0, 0}}, {{1, 10}}, {}, {}, {{6, 40, 1}, {7, 50}}});
  expect_points(compressed(), {0, 1, 6, 7}, {0, 10, 40, 50});
}

// Promise: beside a heating stand the rows of its exchanges and the one row before the first; the exchange at
// which the body failed is left out.
TEST(CurveBeside, AHeatingHasItsExchangesAndTheRowBefore) {
  Written r(deck(kUniform + kSettle + heat("30 degC") + kCompress + heat("40 degC")));
  r.write({{{1, 1}, {2, 2}}, {{3, 3, 1}, {4, 4, 0}, {5, 5, 2}}, {{6, 6}}, {{7, 7, 3}, {8, 8, 4}}});
  expect_points(r.beside(DrawnRows::heated), {2, 3, 5, 7, 8}, {2, 3, 5, 7, 8});
  r.course(3).outcome = Outcome::ran_away;
  expect_points(r.beside(DrawnRows::heated), {2, 3, 5, 7}, {2, 3, 5, 7});
  r.write({{}, {{3, 3, 1}}, {}, {}});
  expect_points(r.beside(DrawnRows::heated), {0, 3}, {0.5, 3});
}

// Promise: displacements count from the last settle that came to rest and was followed by something.
TEST(CurveBeside, DisplacementsCountFromTheLastRest) {
  Written r(deck(kUniform + kSettle + kCompress + kSettle + kCompress + kSettle));
  const auto from_zero = [&] { return r.beside(DrawnRows::from_zero).x; };
  r.write({{{1, 1}}, {{2, 2}}, {{3, 3}}, {{4, 4}, {5, 5}}, {}});
  EXPECT_EQ(from_zero(), (std::vector<double>{4, 5}));
  r.course(2).outcome = Outcome::stopped;
  EXPECT_EQ(from_zero(), (std::vector<double>{2, 3, 4, 5}));
  r.course(0).outcome = Outcome::not_settled;
  EXPECT_EQ(from_zero(), (std::vector<double>{0, 1, 2, 3, 4, 5}));
  r.write({{{1, 1}}, {{2, 2}}, {}, {}, {{6, 6}}});
  EXPECT_EQ(from_zero(), (std::vector<double>{2, 6}));
}

// Promise: drawn values have the signs of the figure, and a reference that is a range stands for its middle.
TEST(CurveBeside, ValuesHaveTheirSignsAndRangesTheirMiddle) {
  Written r(deck(kUniform + kSettle + kCompress));
  r.write({{{1, 10}, {kGap, 11}}, {{2, 20}, {3, kGap}}});
  Reference reference = of_stress({5.0, 6.0}, {1.0, 2.0});
  reference.rows = DrawnRows::all;
  expect_points(curve_beside(reference, r.run), {0, 1, 2}, {0.5, 10, 20});
  reference.of.sign = -1.0;
  expect_points(curve_beside(reference, r.run), {0, 1, 2}, {-0.5, -10, -20});
  reference.over.sign = -1.0;
  expect_points(curve_beside(reference, r.run), {0, -1, -2}, {-0.5, -10, -20});
  reference.high = {4.0, 8.0};
  expect_points(curve_of(reference), {5.0, 6.0}, {2.5, 5.0});
}

// Promise: an area has the units of both axes, of which numbers have none and degrees are kelvins.
TEST(ReferenceDistances, AnAreaHasTheUnitsOfBothAxes) {
  const Trial trial(deck(kUniform + kSettle + kCompress));
  const auto unit_of = [&](const DrawnQuantity& of, const DrawnQuantity& over) {
    Reference reference = of_stress({0.0, 1.0}, {0.0, 1.0});
    reference.of = of;
    reference.over = over;
    return reference_distances(std::vector{reference}, trial.run).at(0).area_unit;
  };
  const DrawnQuantity number{"strain", "strain"}, force{"grip", "grip_N", &unit::force},
      opening{"gap", "gap_m", &unit::length}, other{"u", "u_m", &unit::length},
      temperature{"temperature", "temperature_degC", &unit::temperature},
      time{"heating_time", "heating_time_s", &unit::time};
  EXPECT_EQ(unit_of(force, opening), "N_m");
  EXPECT_EQ(unit_of(opening, other), "m2");
  EXPECT_EQ(unit_of(force, number), "N");
  EXPECT_EQ(unit_of(number, time), "s");
  EXPECT_EQ(unit_of(number, number), "");
  EXPECT_EQ(unit_of(temperature, time), "K_s");
}

/// What is said of references whose stresses are some numbers, at strains 0 and 1, of a run that came to -2
/// MPa.
struct SaidAtTheEnd {
  explicit SaidAtTheEnd(double of_run = -2.0) : run(deck(kUniform + kSettle + kCompress)) {
    run.run.run();
    run.write({{{0.0, 0.5 * of_run}}, {{1.0, of_run}}});
    run.course(0).rows = {0, 2};
  }
  std::string of(const std::vector<Reference>& references) const {
    std::string all;
    for (const ReferenceDistances& each : reference_distances(references, run.run))
      all += fmt::format("{}", fmt::join(each.warnings, "\n"));
    return all;
  }
  std::string of(double greatest) const {
    Reference reference = of_stress({0.0, 1.0}, {0.0, greatest});
    reference.rows = DrawnRows::all;
    return of({reference});
  }
  Written run;
};

// Promise: another unit is told from a factor of 100 on, up and down, whatever the sign; another sign below
// it.
TEST(ReferenceDistances, AFactorOfAHundredIsAnotherUnit) {
  const SaidAtTheEnd said;
  for (const double greatest : {-2.0 * 101, 2.0 * 101, -2.0 / 101, 2.0 / 101})
    EXPECT_NE(said.of(greatest).find("most likely in another unit"), std::string::npos) << greatest;
  for (const double greatest : {-2.0 * 99, -2.0 / 99}) EXPECT_EQ(said.of(greatest), "") << greatest;
  for (const double greatest : {2.0 * 99, 2.0 / 99})
    EXPECT_NE(said.of(greatest).find("state its sign"), std::string::npos) << greatest;
}

// Promise: zeros tell no unit and no sign; neither does a run without values, of which its range is told.
TEST(ReferenceDistances, ZerosTellNoUnitAndNoSign) {
  EXPECT_EQ(SaidAtTheEnd().of(0.0), "");
  EXPECT_EQ(SaidAtTheEnd(0.0).of(3.0), "");
  EXPECT_EQ(SaidAtTheEnd(0.0).of(0.0), "");
  SaidAtTheEnd said;
  said.run.write({{}, {{kGap, 1.0}}});
  EXPECT_EQ(
      said.of({of_stress({3.0, 1.0, 2.0}, {1.0, 2.0, 3.0})}),
      "reference \"mine\": the run has no strain in its range, 1 to 3, so that nothing tells how far they "
      "are apart");
}

// Promise: references of the program have no distances, and before the end nothing is said.
TEST(ReferenceDistances, AreOfOwnReferencesAndSaidAtTheEnd) {
  const SaidAtTheEnd said;
  Reference builtin = of_stress({0.0, 1.0}, {0.0, 500.0});
  builtin.is_builtin = true;
  EXPECT_TRUE(reference_distances(std::vector{builtin}, said.run.run).empty());
  Written under_way(deck(kUniform + kSettle + kCompress));
  const auto all = reference_distances(std::vector{of_stress({7.0, 8.0}, {0.0, 1.0})}, under_way.run);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].warnings.empty());
}

}  // namespace
}  // namespace pyroclast
