#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "result_of.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr double kLength = 1.0, kDepth = 0.05;  // m, thickness 1 m
constexpr double kYoung = 29.4e9, kStrength = 2.5e6, kEnergy = 60.0;

/// Columns and rows of blocks, the left half of one phase and the right half of another. Rows grow thinner
/// upwards: the point about which the halves of a beam turn is the last, and its face parts only in part.
specimen::Specimen<2> grid(double length, double depth, int columns, int rows) {
  specimen::Cells<2> t;
  std::vector<int> phase;
  for (int i = 0; i <= columns; ++i)
    for (int j = 0; j <= rows; ++j) {
      const double left = 1.0 - static_cast<double>(j) / rows;
      t.vertices.push_back({{length * i / columns, depth * (1.0 - left * left)}});
    }
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      const int corner = i * (rows + 1) + j;
      t.cells.push_back({corner, corner + rows + 1, corner + rows + 2, corner + 1});
      phase.push_back(2 * i < columns ? 0 : 1);
    }
  return specimen::specimen_from(
      specimen::completed({std::move(t), {"aggregate", "mortar"}, std::move(phase)}));
}

specimen::Specimen<2> bar_of_blocks() {
  return grid(kLength, kDepth, 20, 1);
}

/// A body of two halves that can crack where they meet, and nowhere else. The specimen of the deck is
/// another.
std::string halves_deck(const std::string& rest) {
  return R"DECK(title = "bar"
[specimen]
width = "1 m"
height = "50 mm"
seed = 1
[aggregates]
fraction = 0
d_min = "8 mm"
d_max = "16 mm"
fuller_exponent = 0.45
sieves = ["12 mm"]
minimum_gap = "0.5 mm"
[blocks]
count = 20
shortest_edge = 0.2
[superposition]
rule = "centroid"
[materials.aggregate]
E = "29.4 GPa"
nu = 0
density = "2200 kg/m3"
[materials.mortar]
E = "29.4 GPa"
nu = 0
density = "2200 kg/m3"
[contacts]
t_b = "1.6 mm"
t_b_scaling = "fixed"
[contacts.aggregate_aggregate]
law = "elastic"
K_n = "1e4 GPa/m"
K_s = "1e4 GPa/m"
[contacts.mortar_mortar]
law = "elastic"
K_n = "1e4 GPa/m"
K_s = "1e4 GPa/m"
[contacts.aggregate_mortar]
K_n = "1e4 GPa/m"
K_s = "1e4 GPa/m"
)DECK" + kMortarBond +
         R"DECK([mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
[output]
[heat]
field = "uniform"
)DECK" + rest;
}

/// A bar of two halves that is pulled apart, its opening controlled.
std::string bar(const std::string& rate) {
  return with(halves_deck(R"DECK(
[[sets]]
name = "before"
line = [["400 mm", "0 mm"], ["400 mm", "50 mm"]]
[[sets]]
name = "behind"
line = [["600 mm", "0 mm"], ["600 mm", "50 mm"]]
[[record]]
name = "stretch"
kind = "opening"
set = "before"
other = "behind"
direction = "x"
[[record]]
name = "load"
kind = "force"
set = "right"
direction = "x"
[[record]]
name = "grip"
kind = "displacement"
set = "right"
direction = "x"
[[stages]]
kind = "drive"
duration = "1.5 s"
look_interval = "1 ms"
[stages.control]
record = "stretch"
rate = "0.04 mm/s"
stiffness = "16 GN/m"
response_time = "20 ms"
[[stages.drives]]
set = "left"
hold = ["x"]
[[stages.drives]]            # else it would open askew, and bend about what is left
set = "specimen"
hold = ["y"]
[[stages.drives]]
set = "right"
force = "100 kN"
direction = [1, 0]
[[stages.until]]
record = "stretch"
above = "50 um"
)DECK"),
              "0.04 mm/s", rate);
}

/// Bar of one crack, which its own shortening would tear: f_t l / E is more than the crack opens by.
TEST(ControlVerification, ABarSnapsBackAlongItsClosedForm) {
  constexpr double kLastOpening = 2.0 * kEnergy / kStrength;
  ASSERT_GT(kStrength * kLength / kYoung, kLastOpening);
  const Finished r(bar("0.04 mm/s"), bar_of_blocks());
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const History& history = r.run.history();
  const RowRange rows = r.run.courses()[0].rows;
  const auto load = history.values("load_N", rows), grip = history.values("grip_m", rows),
             work = history.values("energy_loading_J", rows), stretch = history.values("stretch_m", rows);
  const auto peak = std::ranges::max_element(load) - load.begin();
  expect_known({"largest load of a bar of 1 m with one crack", "f_t A", "N"}, load[peak], kStrength * kDepth,
               0.05 * kStrength * kDepth);
  expect_known({"work that parts it, through a snap-back", "G_f A", "J"}, work.back(), kEnergy * kDepth,
               0.02 * kEnergy * kDepth);
  const double grip_at_peak = kStrength * kLength / kYoung + kStrength / 1e13 * 19;
  expect_known({"displacement of its grip at the largest load", "f_t l / E, and the contacts", "m"},
               grip[peak], grip_at_peak, 0.03 * grip_at_peak);
  expect_known({"the same when it is parted", "2 G_f / f_t", "m"}, grip.back(), kLastOpening,
               0.06 * kLastOpening);
  // all the way: load and grip go back together, on the line from peak to end
  for (std::size_t i = peak; i < load.size(); ++i) {
    const double left = load[i] / (kStrength * kDepth);
    EXPECT_NEAR(grip[i], kLastOpening * (1.0 - left) + grip_at_peak * left, 0.03 * grip_at_peak)
        << stretch[i];
  }
  const StageReport report = r.report(0);
  EXPECT_TRUE(report.warnings.empty()) << report.lines.back();
}

// Promise: where the pair takes the place of the loads, the run says so.
TEST(Control, WarnsWhereThePairBearsTheTest) {
  const Finished r(bar("2 mm/s"), bar_of_blocks());
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const StageReport report = r.report(0);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("control of stretch: the largest load is"), std::string::npos);
}

// Promise: where the loads close the opening that they are to open, the run ends before numbers run away.
TEST(Control, OfTheWrongSenseEndsTheRun) {
  const Finished r(with(bar("0.04 mm/s"), "direction = [1, 0]", "direction = [-1, 0]"), bar_of_blocks());
  EXPECT_EQ(r.run.outcome(), Outcome::control_lost);
  const StageReport report = r.report(0);
  EXPECT_TRUE(std::ranges::any_of(report.warnings, [](const std::string& warning) {
    return warning.find("the control of stretch ran away") != std::string::npos;
  }));
  // the opening that ends it is that of the whole stage, 60 um
  const auto stretch = r.run.history().values("stretch_m", r.run.courses()[0].rows);
  EXPECT_LT(std::abs(stretch.back()), 1e-3);

  // an opening that ran away fulfils no condition, though it passes its value
  const std::string until =
      fmt::format("direction = [-1, 0]\n\n[[stages.until]]\nrecord = \"stretch\"\nbelow = \"{} m\"",
                  0.999 * stretch.back());
  const Finished again(with(bar("0.04 mm/s"), "direction = [1, 0]", until.c_str()), bar_of_blocks());
  EXPECT_EQ(again.run.outcome(), Outcome::control_lost);
}

// Promise: however fast the opening grows, the strength lies between the largest load and that with the pair.
TEST(Control, TheStrengthLiesBetweenTheLoadAndTheLoadWithThePair) {
  for (const char* rate : {"0.1 mm/s", "0.4 mm/s"}) {
    const StageReport report = Finished(bar(rate), bar_of_blocks()).report(0);
    const double exact = kStrength * kDepth, with_pair = number(report, "largest_load_with_control_N");
    EXPECT_GT(with_pair, 0.998 * exact) << rate;
    EXPECT_LT(with_pair / (1.0 + number(report, "control_error_of_largest_load")), 1.002 * exact) << rate;
  }
}

// Promise: a pair of any stiffness either holds its opening, the stiffer the closer, or is refused before the
// run with the largest that would.
TEST(Control, ThePairMayBeAsStiffAsTheErrorSays) {
  const auto stiffened = [](double stiffness) {
    return with(bar("0.04 mm/s"), "\"16 GN/m\"", fmt::format("\"{:.17g} N/m\"", stiffness));
  };
  double most = 0.0;
  try {
    Trial(stiffened(1e16), bar_of_blocks());
  } catch (const Error& error) {
    const std::string text = error.what();
    const auto number = text.find("at most ");
    ASSERT_NE(number, std::string::npos) << text;
    EXPECT_NE(text.find("stages[0].control"), std::string::npos) << text;
    most = 1e9 * std::stod(text.substr(number + 8));
  }
  ASSERT_GT(most, 16e9);
  for (const double share : {0.05, 0.2, 0.5, 0.95}) {
    const Finished r(stiffened(share * most), bar_of_blocks());
    EXPECT_EQ(r.run.outcome(), Outcome::completed) << share;
    const auto load = r.run.history().values("load_N", r.run.courses()[0].rows);
    EXPECT_NEAR(*std::ranges::max_element(load), kStrength * kDepth, 0.05 * kStrength * kDepth) << share;
  }
}

// Promise: the report tells how much of the test was the pair's, by its own columns, and warns from 5 % on.
TEST(Control, TheReportTellsThePairsPart) {
  constexpr double kForces = 100e3;  // of the stage, at a factor of 1
  for (const char* rate : {"0.04 mm/s", "0.15 mm/s", "0.4 mm/s", "2 mm/s"}) {
    const Finished r(bar(rate), bar_of_blocks());
    const History& history = r.run.history();
    const RowRange rows = r.run.courses()[0].rows;
    const StageReport report = r.report(0);
    const auto factor = history.values("load_factor", rows), pair = history.values("control_force_N", rows),
               stretch = history.values("stretch_m", rows);
    double largest_factor = 0.0, largest_pair = 0.0, work = 0.0;
    for (std::size_t i = 0; i < factor.size(); ++i) {
      largest_factor = std::max(largest_factor, std::abs(factor[i]));
      largest_pair = std::max(largest_pair, std::abs(pair[i]));
      if (i > 0) work += 0.5 * (pair[i] + pair[i - 1]) * (stretch[i] - stretch[i - 1]);
    }
    const double peak = number(report, "largest_load_factor") * kForces,
                 with_pair = number(report, "largest_load_with_control_N");
    EXPECT_GE(number(report, "largest_load_factor"), largest_factor);
    EXPECT_NEAR(number(report, "largest_load_factor"), largest_factor, 0.01 * largest_factor);
    EXPECT_NEAR(number(report, "control_force_over_peak") * peak, largest_pair, 1e-9 * largest_pair);
    EXPECT_GE(with_pair, peak);
    EXPECT_NEAR(number(report, "control_error_of_largest_load"), with_pair / peak - 1.0, 1e-12);
    const double of_work = number(report, "control_work_over_loading_work");
    EXPECT_NEAR(of_work * number(report, "loading_work_J"), std::abs(work), 0.1 * std::abs(work) + 1e-3);
    ASSERT_EQ(report.lines.size(), 1U);
    EXPECT_EQ(report.lines[0],
              fmt::format("control of stretch: the largest load is {:.4g} N, and {:.4g} N "
                          "with the force of the pair beside this ({:+.2g} %); the pair "
                          "bore up to {:.2g} % of that load, and did {:.2g} % of the work",
                          peak, with_pair, 100.0 * number(report, "control_error_of_largest_load"),
                          100.0 * number(report, "control_force_over_peak"), 100.0 * of_work));
    const bool is_much = std::max(number(report, "control_error_of_largest_load"), of_work) > 0.05;
    EXPECT_EQ(report.warnings.size(), is_much ? 1U : 0U) << rate;
  }
}

/// Bent until almost nothing of its crack is left: the mouth opens by a hundred times what parts a face.
TEST(ControlVerification, TheWorkThatBreaksABeamIsTheFractureEnergyOfItsSection) {
  constexpr double kSpan = 0.4, kHeight = 0.1;
  const Finished r(halves_deck(R"DECK(
[[sets]]
name = "left_foot"
nearest = ["0 mm", "0 mm"]
[[sets]]
name = "right_foot"
nearest = ["400 mm", "0 mm"]
[[sets]]
name = "middle"
nearest = ["200 mm", "100 mm"]
[[sets]]
name = "left_lip"
within = "aggregate"
nearest = ["200 mm", "0 mm"]
[[sets]]
name = "right_lip"
within = "mortar"
nearest = ["200 mm", "0 mm"]
[[record]]
name = "mouth"
kind = "opening"
set = "left_lip"
other = "right_lip"
direction = "x"
[[record]]
name = "load"
kind = "force"
set = "middle"
direction = "-y"
[[record]]
name = "deflection"
kind = "displacement"
set = "middle"
direction = "-y"
[[stages]]
kind = "drive"
duration = "12 s"
look_interval = "4 ms"
[[stages.drives]]
set = "left_foot"
hold = ["x", "y"]
[[stages.drives]]
set = "right_foot"
hold = ["y"]
[[stages.drives]]
set = "middle"
velocity = "-1 mm/s"
direction = "y"
factor = { table = [["0 s", 0.05], ["3 s", 0.05], ["6 s", 1], ["12 s", 1]] }
[[stages.until]]
record = "mouth"
above = "4.8 mm"
)DECK"),
                   grid(kSpan, kHeight, 8, 10));
  EXPECT_EQ(r.run.outcome(), Outcome::completed);
  const History& history = r.run.history();
  const RowRange rows = r.run.courses()[0].rows;
  const auto load = history.values("load_N", rows), deflection = history.values("deflection_m", rows),
             ledger = history.values("energy_loading_J", rows);
  double work = 0.0;
  for (std::size_t i = 1; i < load.size(); ++i)
    work += 0.5 * (load[i] + load[i - 1]) * (deflection[i] - deflection[i - 1]);
  expect_known({"work of the load that breaks a beam through a straight column of faces", "G_f A", "J"}, work,
               kEnergy * kHeight, 0.01 * kEnergy * kHeight);
  expect_known({"the same by the ledger", "G_f A", "J"}, ledger.back(), kEnergy * kHeight,
               0.01 * kEnergy * kHeight);
}

}  // namespace
}  // namespace pyroclast
