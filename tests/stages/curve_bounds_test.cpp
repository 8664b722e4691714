#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "copy_state.hpp"
#include "pyroclast/stages/compression_response.hpp"
#include "pyroclast/stages/peak.hpp"
#include "result_of.hpp"

/// The bounds at which a curve has a peak, a modulus, an inelastic strain, and counts as quasi-static: by
/// curves of a few straight stretches, whose answers are exact.
namespace pyroclast::curve_bounds_test {
namespace {

constexpr double kStrength = 40e6;  // Pa

/// Straight stretches through points (strain, stress), in steps of 1e-5 of strain.
CompressionCurve through(std::initializer_list<std::pair<double, double>> points) {
  CompressionCurve curve;
  const auto add = [&](double strain, double stress) {
    curve.strain.push_back(strain);
    curve.stress.push_back(stress);
    curve.platen_difference.push_back(0.0);
    curve.kinetic_over_strain.push_back(0.0);
    curve.time.push_back(10.0 * strain);
  };
  std::pair<double, double> last = *points.begin();
  add(last.first, last.second);
  for (const auto& next : std::vector(points.begin() + 1, points.end())) {
    const int count = static_cast<int>(std::lround((next.first - last.first) / 1e-5));
    for (int i = 1; i <= count; ++i) {
      const double share = static_cast<double>(i) / count;
      add(last.first + share * (next.first - last.first), last.second + share * (next.second - last.second));
    }
    last = next;
  }
  return curve;
}

/// To a peak of 40 MPa at 2e-3, and down to 20 MPa.
CompressionCurve roof() {
  return through({{0.0, 0.0}, {2e-3, kStrength}, {4e-3, 0.5 * kStrength}});
}

/// The point with a stress, on the way up.
std::size_t at(const CompressionCurve& curve, double stress) {
  const auto found =
      std::ranges::find_if(curve.stress, [&](double s) { return s >= stress * (1.0 - 1e-12); });
  return static_cast<std::size_t>(found - curve.stress.begin());
}

std::ptrdiff_t count_of(const std::vector<std::string>& texts, const std::string& words) {
  return std::ranges::count_if(texts, [&](const auto& t) { return t.find(words) != std::string::npos; });
}

// ---- Quasi-static ----------------------------------------------------------------------------------------

// Promise: kinetic over elastic energy of 1 % and a difference between the platens of 2 % of f_c are still
// quasi-static, on either side of the peak; what is beyond is not, and does not spoil the other side.
TEST(QuasiStaticBounds, OnePercentOfEnergyAndTwoOfStress) {
  struct Case {
    double kinetic, difference;
    bool is_static;
  };
  for (const Case& c : {Case{0.01, 0.0, true}, Case{0.0101, 0.0, false}, Case{0.0, 0.02, true},
                        Case{0.0, 0.0201, false}, Case{0.01, 0.02, true}, Case{0.0101, 0.0201, false}})
    for (const bool behind : {false, true}) {
      CompressionCurve curve = roof();
      const std::size_t peak = at(curve, kStrength);
      const std::size_t point = behind ? peak + 1 : peak;
      curve.kinetic_over_strain[point] = c.kinetic;
      curve.platen_difference[point] = c.difference * kStrength;
      const auto r = quasi_static_report(curve, peak);
      EXPECT_EQ(r.to_peak, behind || c.is_static) << c.kinetic << " " << c.difference;
      EXPECT_EQ(r.after_peak, !behind || c.is_static) << c.kinetic << " " << c.difference;
      EXPECT_DOUBLE_EQ(behind ? r.kinetic_after_peak : r.kinetic_to_peak, c.kinetic);
      EXPECT_DOUBLE_EQ(behind ? r.difference_after_peak : r.difference_to_peak, c.difference);
      EXPECT_EQ(behind ? r.kinetic_to_peak : r.kinetic_after_peak, 0.0);
      EXPECT_EQ(behind ? r.difference_to_peak : r.difference_after_peak, 0.0);
      const StageReport report = compression_report(curve);
      EXPECT_EQ(std::get<bool>(value_of(report, "quasi_static")), r.to_peak);
      EXPECT_EQ(std::get<bool>(value_of(report, "quasi_static_after_peak")), r.after_peak);
      EXPECT_EQ(number(report, "kinetic_over_elastic_to_peak"), r.kinetic_to_peak);
      EXPECT_EQ(number(report, "kinetic_over_elastic_after_peak"), r.kinetic_after_peak);
      EXPECT_EQ(number(report, "platen_difference_over_f_c_to_peak"), r.difference_to_peak);
      EXPECT_EQ(number(report, "platen_difference_over_f_c_after_peak"), r.difference_after_peak);
      EXPECT_EQ(count_of(report.warnings, "not quasi-static up to the peak"), r.to_peak ? 0 : 1);
      EXPECT_EQ(report.lines.back(),
                r.to_peak ? "quasi-static up to the peak" : "NOT quasi-static up to the peak");
    }
}

// Promise: the worst point counts, and a warning tells both measures.
TEST(QuasiStaticBounds, TheWorstPointCounts) {
  CompressionCurve curve = roof();
  for (const auto& [share, kinetic, difference] :
       {std::tuple{0.3, 0.03, 0.01}, std::tuple{0.5, 0.07, 0.05}, std::tuple{0.7, 0.05, 0.03}}) {
    curve.kinetic_over_strain[at(curve, share * kStrength)] = kinetic;
    curve.platen_difference[at(curve, share * kStrength)] = difference * kStrength;
  }
  const auto report = compression_report(curve);
  EXPECT_EQ(count_of(report.warnings,
                     "kinetic over elastic energy up to 7.0e-02, platen stresses differ by "
                     "up to 5.0 % of f_c; load more slowly"),
            1);
}

// Promise: below a tenth of f_c the motion says nothing yet.
TEST(QuasiStaticBounds, InertiaCountsFromATenthOfTheStrength) {
  for (const double share : {0.099, 0.1}) {
    CompressionCurve curve = roof();
    const std::size_t point = at(curve, share * kStrength) - (share < 0.1 ? 1 : 0);
    ASSERT_EQ(curve.stress[point] < 0.1 * kStrength, share < 0.1);
    curve.kinetic_over_strain[point] = 5.0;
    curve.platen_difference[point] = kStrength;
    const auto r = quasi_static_report(curve, at(curve, kStrength));
    EXPECT_EQ(r.to_peak, share < 0.1);
    EXPECT_EQ(r.in_modulus, share < 0.1);
  }
}

// Promise: E needs platens that agree within 2 % of f_c up to a third of it; energy of the motion does not
// matter there, nor what comes later.
TEST(QuasiStaticBounds, AModulusNeedsPlatensThatAgreeUpToAThird) {
  const auto has_modulus = [](double share, double kinetic, double difference) {
    CompressionCurve curve = roof();
    const std::size_t point = at(curve, share * kStrength);
    curve.kinetic_over_strain[point] = kinetic;
    curve.platen_difference[point] = difference * kStrength;
    const auto r = compression_response(curve);
    EXPECT_EQ(quasi_static_report(curve, r.peak).in_modulus, static_cast<bool>(r.modulus));
    if (!r.modulus) {
      EXPECT_EQ(r.modulus.none_because,
                "the platens' stresses differ by more than 2 % of f_c up to 1/3 of it");
    }
    return static_cast<bool>(r.modulus);
  };
  EXPECT_TRUE(has_modulus(0.2, 1.0, 0.02));
  EXPECT_FALSE(has_modulus(0.2, 0.0, 0.021));
  EXPECT_FALSE(has_modulus(0.33, 0.0, 0.021));
  EXPECT_TRUE(has_modulus(0.34, 0.0, 0.021));
  EXPECT_TRUE(has_modulus(0.9, 0.0, 0.5));
}

// Promise: nothing was opened, so nothing is quasi-static.
TEST(QuasiStaticBounds, NothingIsNotQuasiStatic) {
  const auto r = quasi_static_report({}, 0);
  EXPECT_FALSE(r.to_peak || r.after_peak || r.in_modulus);
  const StageReport report = compression_report({});
  EXPECT_FALSE(std::get<bool>(value_of(report, "quasi_static")));
  EXPECT_TRUE(is_none(report, "stress_max_MPa"));
  EXPECT_TRUE(is_none(report, "strain_at_stress_max"));
  EXPECT_EQ(report.warnings,
            std::vector<std::string>{"no f_c and no E: the stage ended before it loaded the specimen"});
}

// ---- Peaks -----------------------------------------------------------------------------------------------

/// The size of a peak of a record of (driven, size), if it is one.
std::optional<double> peak_of(std::initializer_list<std::pair<double, double>> record,
                              const PeakRule& rule = {}) {
  Peak peak;
  for (const auto& [driven, size] : record) peak.take(driven, size, rule);
  return peak.is_found() ? std::optional(peak.size()) : std::nullopt;
}

// Promise: a fall of 2 % that lasts for 3e-4 is a peak; one that is less deep or shorter is none.
TEST(PeakBounds, AFallIsDeepAndLasting) {
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 97.9}, {1.31e-3, 99.0}}), 100.0);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 98.1}, {2e-3, 98.1}}), std::nullopt);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 97.9}, {1.29e-3, 97.0}}), std::nullopt);
  EXPECT_EQ(peak_of({{0.0, 100.0}, {1e-4, 97.9}, {3e-4, 97.0}}), 100.0);  // for as long as that, at least
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 97.9}, {1.2e-3, 100.0}, {1.31e-3, 99.5}}), 100.0);
}

// Promise: a larger size before the fall has lasted is what may become the peak, and counts anew.
TEST(PeakBounds, WhatComesBackWasNone) {
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 97.0}, {1.2e-3, 101.0}, {1.5e-3, 100.0}}), std::nullopt);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.1e-3, 97.0}, {1.2e-3, 101.0}, {1.3e-3, 98.0}, {1.55e-3, 98.0}}),
            101.0);
}

// Promise: a fall to below half is a peak at once; and a size after a peak is none.
TEST(PeakBounds, ACollapseIsAPeakAtOnce) {
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.01e-3, 49.9}}), 100.0);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.01e-3, 50.1}}), std::nullopt);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.01e-3, 40.0}, {2e-3, 500.0}}), 100.0);
  EXPECT_EQ(peak_of({{1e-3, 100.0}, {1.01e-3, 79.0}}, {.collapse = 0.2}), 100.0);
}

// Promise: a peak tells where it stood, and what its state keeps is all of it.
TEST(PeakBounds, ItsStateIsAllOfIt) {
  Peak first;
  first.take(1e-3, 100.0, {});
  EXPECT_FALSE(first.has_fallen());
  first.take(1.1e-3, 97.0, {});
  EXPECT_TRUE(first.has_fallen());
  EXPECT_EQ(first.driven(), 1e-3);
  Peak second;
  second.take(5e-3, 7.0, {});
  copy_state(first, second);
  EXPECT_EQ(second.driven(), 1e-3);
  EXPECT_EQ(second.size(), 100.0);
  EXPECT_TRUE(second.has_fallen());
  second.take(1.31e-3, 99.0, {});  // lasting by now, though it comes back to above 98
  EXPECT_TRUE(second.is_found());
  copy_state(second, first);
  EXPECT_TRUE(first.is_found());
}

// Promise: of a curve, f_c is where such a peak is; the falls of 2 % and of 10 % tell theirs without lasting.
TEST(PeakBounds, ACurveHasItsPeakByEachRule) {
  // a dip that makes itself good within 3e-4, by a share of 40 MPa
  const auto dipped = [](double dip) {
    return compression_report(through({{0.0, 0.0},
                                       {2e-3, kStrength},
                                       {2.1e-3, (1.0 - dip) * kStrength},
                                       {2.3e-3, 1.03 * kStrength},
                                       {4.3e-3, 0.4 * kStrength}}));
  };
  EXPECT_NEAR(number(dipped(0.019), "f_c_by_fall_of_2_percent_MPa"), 41.2, 1e-9);
  EXPECT_NEAR(number(dipped(0.021), "f_c_by_fall_of_2_percent_MPa"), 40.0, 1e-9);
  EXPECT_NEAR(number(dipped(0.098), "f_c_by_fall_of_10_percent_MPa"), 41.2, 1e-9);
  EXPECT_NEAR(number(dipped(0.102), "f_c_by_fall_of_10_percent_MPa"), 40.0, 1e-9);
  for (const double dip : {0.019, 0.021, 0.098, 0.102}) {
    EXPECT_NEAR(number(dipped(dip), "f_c_MPa"), 41.2, 1e-9);
    EXPECT_NEAR(number(dipped(dip), "strain_at_peak"), 2.3e-3, 1e-12);
    EXPECT_EQ(dipped(dip).lines.front(), "f_c 41.2 MPa at strain 0.0023");
  }
}

// Promise: two falls that tell strengths more than 5 % apart are worth a warning; a curve that rises above
// f_c by more than 0.5 % of it is worth a line.
TEST(PeakBounds, DoubtsAreTold) {
  const auto again = [](double rise, double end) {
    return compression_report(through({{0.0, 0.0},
                                       {2e-3, kStrength},
                                       {2.5e-3, 0.95 * kStrength},
                                       {4e-3, rise * kStrength},
                                       {6e-3, end * kStrength}}));
  };
  // f_c is 40 MPa by a fall of 2 %; that of 10 % comes behind the second rise
  EXPECT_EQ(count_of(again(1.049, 0.5).warnings, "f_c depends on how a peak is told"), 0);
  EXPECT_EQ(count_of(again(1.051, 0.5).warnings,
                     "f_c depends on how a peak is told: 40.00 MPa by the first "
                     "fall of 2 %, 42.04 MPa by one of 10 %; the stress falls"),
            1);
  EXPECT_EQ(count_of(again(1.051, 1.0).warnings, "42.04 MPa at the end without a fall of 10 %;"), 1);
  EXPECT_EQ(count_of(again(1.0049, 0.5).lines, "rises again"), 0);
  EXPECT_EQ(
      count_of(again(1.0051, 0.5).lines, "rises again behind f_c, to 40.20 MPa (+1 %) at strain 0.00400"), 1);
  EXPECT_EQ(count_of(again(0.97, 0.5).lines, "rises again"), 0);
}

// Promise: a peak while the first wave runs is none; the time counts from the first point.
TEST(PeakBounds, TheFirstWaveIsOver) {
  CompressionCurve curve = roof();
  for (double& time : curve.time) time += 5.0;
  // the peak comes after 0.02 s
  EXPECT_TRUE(compression_response(curve, 0.0199).strength);
  const auto during = compression_response(curve, 0.0201);
  EXPECT_FALSE(during.strength || during.bore);
  EXPECT_NE(
      during.strength.none_because.find(
          "the largest stress, 40.00 MPa, came after 20 ms, while the first stress wave still ran through "
          "the specimen (20.1 ms)"),
      std::string::npos)
      << during.strength.none_because;
  EXPECT_EQ(compression_report(curve, {.waves_until = 0.0201}).warnings.size(), 1u);
  // a first peak in the wave, and a larger one behind it: that is the strength
  const auto two =
      through({{0.0, 0.0}, {1e-3, 30e6}, {1.5e-3, 10e6}, {3e-3, kStrength}, {4e-3, 0.5 * kStrength}});
  EXPECT_DOUBLE_EQ(*compression_response(two, 0.0).strength, 30e6);
  EXPECT_DOUBLE_EQ(*compression_response(two, 0.016).strength, kStrength);
}

// Promise: who looks for a peak that is not there is told how far the stress fell, and by how much it must.
TEST(PeakBounds, SaysWhyThereIsNoPeak) {
  const auto fallen = [](double share) {
    return compression_response(through({{0.0, 0.0}, {2e-3, kStrength}, {2.2e-3, share * kStrength}}))
        .strength.none_because;
  };
  EXPECT_EQ(
      fallen(0.981).find("the stage ended before a peak: the stress did not fall by 2 % from the largest, "
                         "40.00 MPa at strain 0.00200; drive the platen farther"),
      0u);
  EXPECT_EQ(
      fallen(0.979).find("the stage ended too soon behind the largest stress, 40.00 MPa at strain 0.00200:"),
      0u);
}

// ---- Modulus and inelastic strain ------------------------------------------------------------------------

/// E of a curve that is straight from 5 % to 1/3 of its strength, and elsewhere of another slope.
CompressionResponse bent(double slope, double below, double above) {
  // strains are whole steps of 1e-5: 2 MPa is 5 % of 40 MPa, 13.33 a third
  const double a = std::round(2e6 / below / 1e-5) * 1e-5, b = a + std::round(11.5e6 / slope / 1e-5) * 1e-5,
               c = b + std::round(26.5e6 / above / 1e-5) * 1e-5;
  return compression_response(through(
      {{0.0, 0.0}, {a, a * below}, {b, a * below + (b - a) * slope}, {c, kStrength}, {c + 2e-3, 10e6}}));
}

// Promise: E is the slope from 5 % to a third of f_c, whatever the curve does below and above.
TEST(ModulusBounds, IsTheSlopeFromFivePercentToAThird) {
  const auto r = bent(20e9, 10e9, 15e9);
  ASSERT_TRUE(r.modulus);
  EXPECT_NEAR(*r.modulus, 20e9, 1e-3 * 20e9);
  EXPECT_EQ(r.toe, 0.0);
}

// Promise: a curve that is steeper above by more than a tenth begins with a toe; up to there it does not.
TEST(ModulusBounds, AToeIsSteeperAboveByMoreThanATenth) {
  const auto slight = bent(20e9, 20e9, 21.5e9), toe = bent(20e9, 20e9, 24e9);
  EXPECT_NEAR(*slight.modulus, 20e9, 0.01 * 20e9);
  EXPECT_EQ(slight.toe, 0.0);
  EXPECT_NEAR(*toe.modulus, 24e9, 0.01 * 24e9);
  // the steep line through the peak meets zero stress at
  const double peak = 13.5e6 / 20e9 + 26.5e6 / 24e9;
  EXPECT_NEAR(toe.toe, peak - kStrength / 24e9, 2e-5);
  // its inelastic strain counts from there: nothing is left
  ASSERT_TRUE(toe.strength);
  if (toe.inelastic_strain) {
    EXPECT_NEAR(*toe.inelastic_strain, 0.0, 2e-5);
  }
}

// Promise: the steepest stretch is sought up to 88 % of f_c, and no farther.
TEST(ModulusBounds, TheSteepestStretchEndsAt88Percent) {
  // twice as steep from 60 to 88 % alone; a fall behind the peak
  const auto steep = [](double from, double to) {
    const double slope = 20e9, a = from * kStrength / slope, b = a + (to - from) * kStrength / (2.0 * slope),
                 c = b + (1.0 - to) * kStrength / slope;
    return *compression_response(through({{0.0, 0.0},
                                          {a, from * kStrength},
                                          {b, to * kStrength},
                                          {c, kStrength},
                                          {c + 2e-3, 1e7}}))
                .modulus;
  };
  EXPECT_NEAR(steep(0.60, 0.885), 40e9, 0.01 * 40e9);
  EXPECT_LT(steep(0.70, 0.985), 37e9);
  EXPECT_NEAR(steep(0.35, 0.635), 40e9, 0.01 * 40e9);
}

// Promise: three points make a line, two do not; and one that falls has no modulus.
TEST(ModulusBounds, ThreePointsMakeALine) {
  const auto with_points = [](std::vector<double> stresses) {
    CompressionCurve curve;
    double strain = 0.0;
    stresses.insert(stresses.end(), {kStrength, 0.3 * kStrength});
    for (const double stress : stresses) {
      curve.strain.push_back(strain += 5e-4);
      curve.stress.push_back(stress);
      curve.platen_difference.push_back(0.0);
      curve.kinetic_over_strain.push_back(0.0);
      curve.time.push_back(strain);
    }
    return compression_response(curve).modulus;
  };
  const auto three = with_points({4e6, 8e6, 12e6});
  ASSERT_TRUE(three);
  EXPECT_NEAR(*three, 8e9, 1.0);
  EXPECT_EQ(with_points({4e6, 12e6}).none_because,
            "fewer than three points of the curve lie between 5 % and 1/3 of f_c");
  EXPECT_EQ(with_points({12e6, 11.9e6, 11.8e6}).none_because,
            "the stress does not rise with the strain between 5 % and 1/3 of f_c");
  // those at the ends of the range count
  EXPECT_TRUE(with_points({2e6, 8e6, kStrength * (1.0 / 3.0)}));
  EXPECT_FALSE(with_points({1.99e6, 8e6, 13.3e6}));
  EXPECT_FALSE(with_points({2e6, 8e6, 13.4e6}));
}

// Promise: eps_ic is the strain at the peak less the elastic one; there is none of a stage that began above
// 5 % of f_c, nor where the curve is steeper than its own line.
TEST(ModulusBounds, InelasticStrainIsWhatIsNotElastic) {
  const auto from = [](double first) {
    return compression_response(
        through({{0.0, first}, {1e-3, 0.5 * kStrength}, {2e-3, kStrength}, {2.6e-3, 0.5 * kStrength}}));
  };
  EXPECT_EQ(from(0.051 * kStrength).inelastic_strain.none_because, "the stage began under load");
  EXPECT_NE(from(0.049 * kStrength).inelastic_strain.none_because, "the stage began under load");
  // bends at half of the strength: 2e-3 of strain where 20 GPa would take 1e-3 and 10 GPa a further 2e-3
  const auto bends = compression_response(
      through({{0.0, 0.0}, {1e-3, 0.5 * kStrength}, {3e-3, kStrength}, {4e-3, 0.5 * kStrength}}));
  EXPECT_NEAR(*bends.inelastic_strain, 3e-3 - 2e-3, 1e-9);
  // a little steeper above, by less than a toe
  const auto steeper = bent(20e9, 20e9, 21.5e9);
  EXPECT_EQ(steeper.inelastic_strain.none_because,
            "the curve is steeper on its way to the peak than the line that gave E");
}

// Promise: a report tells each number in its unit, and in words.
TEST(ModulusBounds, AReportTellsThem) {
  const auto report = compression_report(
      through({{0.0, 0.0}, {1e-3, 0.5 * kStrength}, {3e-3, kStrength}, {4e-3, 0.5 * kStrength}}));
  EXPECT_NEAR(number(report, "E_GPa"), 20.0, 1e-9);
  EXPECT_NEAR(number(report, "f_c_MPa"), 40.0, 1e-12);
  EXPECT_NEAR(number(report, "strain_ic"), 1e-3, 1e-9);
  EXPECT_EQ(number(report, "toe_strain"), 0.0);
  EXPECT_EQ(report.lines, (std::vector<std::string>{"f_c 40 MPa at strain 0.003", "E 20 GPa",
                                                    "inelastic strain at the peak (eps_ic) 0.001",
                                                    "quasi-static up to the peak"}));
  const auto toe =
      compression_report(through({{0.0, 0.0}, {1e-3, 10e6}, {2e-3, kStrength}, {3e-3, 0.5 * kStrength}}));
  EXPECT_NEAR(number(toe, "E_GPa"), 30.0, 0.01);
  EXPECT_NEAR(number(toe, "toe_strain"), 2e-3 - kStrength / 30e9, 1e-6);
  EXPECT_EQ(toe.lines[1],
            "E 30 GPa, where the curve is steepest: it begins with a toe, up to strain 0.00067");
}

// ---- Unloading -------------------------------------------------------------------------------------------

// Promise: E in unloading is the slope from 90 to 10 % of the stress at the start; what comes before and
// after does not count.
TEST(UnloadingBounds, IsTheSlopeFrom90To10Percent) {
  // 20 GPa between, else 10 GPa; 30 MPa at the start
  const double a = 3e6 / 10e9, b = a + 24e6 / 20e9, c = b + 2e6 / 10e9;
  const auto report =
      compression_report(through({{0.0, 30e6}, {a, 27e6}, {b, 3e6}, {c, 1e6}}), {.is_upwards = true});
  // strains fall as the platen goes up
  EXPECT_TRUE(is_none(report, "E_unloading_GPa"));
  CompressionCurve curve = through({{0.0, 30e6}, {a, 27e6}, {b, 3e6}, {c, 1e6}});
  for (double& strain : curve.strain) strain = -strain;
  const auto down = compression_report(curve, {.is_upwards = true});
  EXPECT_NEAR(number(down, "E_unloading_GPa"), 20.0, 1e-6);
  EXPECT_NEAR(number(down, "stress_at_end_MPa"), 1.0, 1e-9);
  EXPECT_EQ(down.lines,
            (std::vector<std::string>{"unloaded from 30.00 to 1.00 MPa", "E in unloading 20 GPa"}));
  const auto nothing = compression_report({}, {.is_upwards = true});
  EXPECT_TRUE(is_none(nothing, "E_unloading_GPa") && is_none(nothing, "stress_at_end_MPa"));
  EXPECT_TRUE(nothing.lines.empty());
  EXPECT_EQ(nothing.results.size(), down.results.size());
  CompressionCurve few;
  for (const double stress : {30e6, 20e6, 10e6, 1e6}) {
    few.strain.push_back(-few.stress.size() * 1e-4);
    few.stress.push_back(stress);
  }
  EXPECT_EQ(
      compression_report(few, {.is_upwards = true}).lines[1],
      "E in unloading: none, because fewer than three points lie between 90 % and 10 % of the stress at "
      "the start");
}

// ---- State -----------------------------------------------------------------------------------------------

// Promise: a curve goes on from its state with all of its columns.
TEST(CurveState, HoldsAllColumns) {
  CompressionCurve first = through({{0.0, 0.0}, {5e-5, 1e6}}), second;
  for (std::size_t i = 0; i < first.count(); ++i) {
    first.platen_difference[i] = 3.0 * static_cast<double>(i);
    first.kinetic_over_strain[i] = 5.0 * static_cast<double>(i);
  }
  copy_state(first, second);
  EXPECT_EQ(second.strain, first.strain);
  EXPECT_EQ(second.stress, first.stress);
  EXPECT_EQ(second.platen_difference, first.platen_difference);
  EXPECT_EQ(second.kinetic_over_strain, first.kinetic_over_strain);
  EXPECT_EQ(second.time, first.time);
}

}  // namespace
}  // namespace pyroclast::curve_bounds_test
