#include "pyroclast/stages/record_results.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "result_of.hpp"

/// Numbers that a stage makes of its records, of histories made by hand.
namespace pyroclast::record_results_test {
namespace {

using Kind = RecordResult::Kind;

const RecordParameters kLoad{.name = "load", .kind = RecordKind::force, .set = "right"};
const RecordParameters kStress{.name = "pull", .kind = RecordKind::stress, .set = "specimen"};
const RecordParameters kWay{.name = "way", .kind = RecordKind::displacement, .set = "right"};
const std::vector<RecordParameters> kRecords{kLoad, kStress, kWay};

struct Row {
  std::optional<double> load, pull, way;
};

History history_of(std::initializer_list<Row> rows) {
  History history;
  for (const char* name : {"load_N", "pull_MPa", "way_m"}) history.add_column({name, "1"});
  for (const Row& row : rows) history.add_row({row.load, row.pull, row.way});
  return history;
}

/// Records that a body gave while it was driven on: time, then load, pull in Pa, and way.
std::vector<RecordPeak> peaks_of(std::initializer_list<std::pair<double, std::vector<double>>> looks) {
  std::vector<RecordPeak> peaks(kRecords.size());
  for (const auto& [time, values] : looks)
    for (std::size_t i = 0; i < peaks.size(); ++i) peaks[i].take(i, time, true, time + 100.0, values);
  return peaks;
}

/// Load falls from -50 N at 1 s, pull from 3 MPa at 2 s; the way only grows.
std::vector<RecordPeak> known_peaks() {
  return peaks_of({{0.5, {-20.0, 1e6, 1e-3}},
                   {1.0, {-50.0, 2e6, 2e-3}},
                   {2.0, {-30.0, 3e6, 4e-3}},
                   {3.0, {-20.0, 1e6, 6e-3}}});
}

std::optional<double> one(const RecordResult& asked, const std::vector<RecordPeak>& peaks,
                          const History& history, RowRange rows) {
  const auto results = record_results(kRecords, peaks, {asked}, {}, history, rows);
  return is_none(results, asked.name) ? std::nullopt : std::optional(number(results, asked.name));
}

// Promise: a peak is told with its sign, in the unit of its column, and with its time; so is the largest.
TEST(RecordResults, PeakAndLargestOfEachRecord) {
  const auto results = record_results(kRecords, known_peaks(), {}, {}, history_of({}), {});
  EXPECT_EQ(number(results, "peak_load_N"), -50.0);
  EXPECT_EQ(number(results, "peak_load_time_s"), 101.0);
  EXPECT_EQ(number(results, "largest_load_N"), -50.0);
  EXPECT_EQ(number(results, "largest_load_time_s"), 101.0);
  EXPECT_DOUBLE_EQ(number(results, "peak_pull_MPa"), 3.0);
  EXPECT_EQ(number(results, "peak_pull_time_s"), 102.0);
  EXPECT_DOUBLE_EQ(number(results, "largest_pull_MPa"), 3.0);
  EXPECT_TRUE(is_none(results, "peak_way_m"));
  EXPECT_TRUE(is_none(results, "peak_way_time_s"));
  EXPECT_EQ(number(results, "largest_way_m"), 6e-3);
  EXPECT_EQ(number(results, "largest_way_time_s"), 103.0);
  const auto before = record_results(kRecords, {}, {}, {}, history_of({}), {});
  ASSERT_EQ(before.size(), results.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].name, results[i].name);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(before[i].value));
  }
}

// Promise: a larger size that comes while nothing drives the body is the largest, but no peak.
TEST(RecordResults, WhatDoesNotCountIsNoPeak) {
  RecordPeak peak;
  peak.take(0, 1.0, true, 1.0, {10.0});
  peak.take(0, 1.5, false, 1.5, {-90.0});
  peak.take(0, 2.0, true, 2.0, {5.0});
  peak.take(0, 3.0, true, 3.0, {4.0});
  EXPECT_TRUE(peak.peak().is_found());
  EXPECT_EQ(peak.peak().size(), 10.0);
  EXPECT_EQ(peak.values(), std::vector<double>{10.0});
  EXPECT_EQ(peak.time(), 1.0);
  EXPECT_EQ(peak.largest(), -90.0);
  EXPECT_EQ(peak.largest_time(), 1.5);
  peak.take(0, 4.0, false, 4.0, {90.0});  // as large, later
  EXPECT_EQ(peak.largest(), -90.0);
}

// Promise: a peak of a record lasts for a tenth of the time to it.
TEST(RecordResults, APeakLastsForATenthOfTheTimeToIt) {
  for (const auto& [until, found] : {std::pair{10.99, false}, std::pair{11.01, true}}) {
    RecordPeak peak;
    peak.take(0, 10.0, true, 10.0, {100.0});
    peak.take(0, 10.5, true, 10.5, {90.0});
    peak.take(0, until, true, until, {90.0});
    EXPECT_EQ(peak.peak().is_found(), found) << until;
  }
  Peak so_far;
  so_far.take(8.0, 1.0, {});
  EXPECT_DOUBLE_EQ(rule_of_records(so_far).lasting, 0.8);
  EXPECT_EQ(rule_of_records(so_far).fall, PeakRule().fall);
}

// Promise: each kind of result is what it says.
TEST(RecordResults, EachKindIsWhatItSays) {
  const History history = history_of({{1.0, 9.0, 9.0}, {2.0, 0.5, 1e-3}, {4.0, 1.5, 3e-3}, {5.0, 8.0, 8.0}});
  const RowRange rows{1, 3};
  const auto peaks = known_peaks();
  const auto result = [&](const RecordResult& asked) { return one(asked, peaks, history, rows); };
  EXPECT_EQ(result({.name = "a", .kind = Kind::given, .value = 7.5}), 7.5);
  EXPECT_EQ(result({.name = "a", .kind = Kind::peak, .record = kLoad}), -50.0);
  EXPECT_EQ(result({.name = "a", .kind = Kind::peak, .record = kWay}), std::nullopt);
  EXPECT_EQ(result({.name = "a", .kind = Kind::largest, .record = kWay}), 6e-3);
  EXPECT_EQ(result({.name = "a", .kind = Kind::last, .record = kLoad}), 4.0);
  EXPECT_DOUBLE_EQ(result({.name = "a", .kind = Kind::last, .record = kStress}).value(), 1.5e6);
  EXPECT_EQ(result({.name = "a", .kind = Kind::at_peak, .record = kWay, .other = kLoad}), 2e-3);
  EXPECT_EQ(result({.name = "a", .kind = Kind::at_peak, .record = kLoad, .other = kStress}), -30.0);
  EXPECT_EQ(result({.name = "a", .kind = Kind::at_peak, .record = kLoad, .other = kWay}), std::nullopt);
  EXPECT_DOUBLE_EQ(result({.name = "a", .kind = Kind::work, .record = kLoad, .other = kWay}).value(), 6e-3);
  // before the stage
  for (const Kind kind : {Kind::peak, Kind::largest, Kind::last, Kind::at_peak})
    EXPECT_EQ(one({.name = "a", .kind = kind, .record = kLoad, .other = kLoad}, {}, history, {1, 1}),
              std::nullopt);
}

// Promise: work is the area under the curve, of either sign; rows without a value leave a hole.
TEST(RecordResults, WorkIsTheAreaUnderTheCurve) {
  const RecordResult work{.name = "W", .kind = Kind::work, .record = kLoad, .other = kWay};
  const auto of = [&](std::initializer_list<Row> rows) {
    return one(work, known_peaks(), history_of(rows), {0, rows.size()}).value();
  };
  EXPECT_DOUBLE_EQ(of({{2.0, 0.0, 0.0}, {4.0, 0.0, 2.0}, {4.0, 0.0, 3.0}, {0.0, 0.0, 1.0}}), 6.0 + 4.0 - 4.0);
  const std::optional<double> none;
  EXPECT_DOUBLE_EQ(of({{2.0, 0.0, 0.0}, {none, 0.0, 2.0}, {4.0, 0.0, 3.0}, {4.0, 0.0, 5.0}}), 8.0);
  EXPECT_DOUBLE_EQ(of({{2.0, 0.0, 0.0}, {4.0, 0.0, none}, {4.0, 0.0, 3.0}, {4.0, 0.0, 5.0}}), 8.0);
  EXPECT_EQ(of({{2.0, 0.0, 7.0}}), 0.0);
}

// Promise: a formula knows the body and the results before it, in SI; it is told in its own unit; one that
// has no finite value, or needs a result that has none, has none.
TEST(RecordResults, AFormulaKnowsWhatCameBefore) {
  const std::vector<RecordResult> asked{
      {.name = "force", .kind = Kind::peak, .record = kLoad, .unit = "N"},
      {.name = "kilo",
       .kind = Kind::formula,
       .formula = "force / thickness",
       .unit = "kN/m",
       .unit_size = 1e3},
      {.name = "twice", .kind = Kind::formula, .formula = "2 * kilo + weight"},
      {.name = "none", .kind = Kind::peak, .record = kWay, .unit = "m"},
      {.name = "of_none", .kind = Kind::formula, .formula = "none + 1"},
      {.name = "infinite", .kind = Kind::formula, .formula = "1 / (force + 50)"}};
  const auto results =
      record_results(kRecords, known_peaks(), asked, {.thickness = 0.1, .weight = 30.0}, history_of({}), {});
  EXPECT_EQ(number(results, "force_N"), -50.0);
  EXPECT_DOUBLE_EQ(number(results, "kilo_kN_m"), -0.5);
  EXPECT_DOUBLE_EQ(number(results, "twice"), -970.0);
  EXPECT_TRUE(is_none(results, "none_m"));
  EXPECT_TRUE(is_none(results, "of_none"));
  EXPECT_TRUE(is_none(results, "infinite"));
  EXPECT_EQ(lines_of(asked, results),
            (std::vector<std::string>{"force -50 N", "kilo -0.5 kN/m", "twice -970", "none: none",
                                      "of_none: none", "infinite: none"}));
  EXPECT_TRUE(lines_of({{.name = "h", .kind = Kind::given, .value = 1.0}}, {{"h", 1.0}}).empty());
  EXPECT_TRUE(lines_of({{.name = "gone", .kind = Kind::last}}, {}).empty());
}

// Promise: who asks for a peak that is none is told so, once for each record, with what it would take.
TEST(RecordResults, AMissingPeakIsToldToWhoAsked) {
  const auto peaks = known_peaks();
  const auto told = [&](const RecordResult& asked) { return missing_peaks(kRecords, peaks, {asked}); };
  EXPECT_TRUE(told({.name = "a", .kind = Kind::peak, .record = kLoad}).empty());
  EXPECT_TRUE(told({.name = "a", .kind = Kind::largest, .record = kWay}).empty());
  EXPECT_TRUE(told({.name = "a", .kind = Kind::at_peak, .record = kWay, .other = kLoad}).empty());
  EXPECT_TRUE(missing_peaks(kRecords, {}, {{.name = "a", .kind = Kind::peak, .record = kWay}}).empty());
  for (const RecordResult& asked :
       {RecordResult{.name = "a", .kind = Kind::peak, .record = kWay},
        RecordResult{.name = "a", .kind = Kind::at_peak, .record = kLoad, .other = kWay}}) {
    ASSERT_EQ(told(asked).size(), 1u);
    EXPECT_EQ(told(asked)[0],
              "way has no peak: while the body was driven on, its size did not fall by 2 % from its largest, "
              "0.006 m, and stay below that for a tenth of the time to there; drive the body farther");
  }
  // a stress is told in MPa
  const auto rising = peaks_of({{1.0, {1.0, 2e6, 0.0}}, {2.0, {2.0, 4e6, 0.0}}});
  EXPECT_NE(missing_peaks(kRecords, rising, {{.name = "a", .kind = Kind::peak, .record = kStress}})
                .at(0)
                .find("its largest, 4 MPa,"),
            std::string::npos);
}

// Promise: the state of a record's peak is all of it.
TEST(RecordResults, TheStateOfAPeakIsAllOfIt) {
  auto first = known_peaks();
  RecordPeak second;
  StateCopy copy;
  copy.take([&](StateVisitor& visitor) { first[0].visit_state(visitor, 3); });
  copy.put([&](StateVisitor& visitor) { second.visit_state(visitor, 3); });
  EXPECT_TRUE(second.peak().is_found());
  EXPECT_EQ(second.peak().size(), 50.0);
  EXPECT_EQ(second.time(), 101.0);
  EXPECT_EQ(second.values(), (std::vector<double>{-50.0, 2e6, 2e-3}));
  EXPECT_EQ(second.largest(), -50.0);
  EXPECT_EQ(second.largest_time(), 101.0);
  BodyFigures body{.thickness = 0.25, .weight = 12.0}, other;
  copy = {};
  copy_state(body, other);
  EXPECT_EQ(other.thickness, 0.25);
  EXPECT_EQ(other.weight, 12.0);
}

}  // namespace
}  // namespace pyroclast::record_results_test
