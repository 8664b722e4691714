#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "known.hpp"
#include "pyroclast/specimen/from_cells.hpp"
#include "stages/small_runs.hpp"

namespace pyroclast {
namespace {

constexpr double kLength = 1.0, kDepth = 0.05;  // m, thickness 1 m
constexpr double kYoung = 29.4e9, kStrength = 2.5e6, kEnergy = 60.0;

/// A row of blocks, the left half of one phase and the right half of another.
specimen::Specimen bar() {
  constexpr int kBlocks = 20;
  specimen::Tessellation t;
  std::vector<int> phase;
  for (int i = 0; i <= kBlocks; ++i)
    for (const double y : {0.0, kDepth}) t.vertices.push_back({{kLength * i / kBlocks, y}});
  for (int i = 0; i < kBlocks; ++i) {
    t.cells.push_back({2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
    phase.push_back(2 * i < kBlocks ? 0 : 1);
  }
  return specimen::specimen_from(std::move(t), {"aggregate", "mortar"}, std::move(phase));
}

/// It can crack where its halves meet, and nowhere else.
std::string bar_deck(const std::string& rest) {
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
f_t = "2.5 MPa"
G_f1 = "60 N/m"
f_cm = "31 MPa"
beta = 0.05
c_o = "3.8 MPa"
c_res = "0.038 MPa"
phi = "34 deg"
phi_res = "34 deg"
G_f2 = "240 N/m"
[mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = "0 m/s2"
[output]
[heat]
field = "uniform"
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
)DECK" + rest;
}

/// Bar of one crack, which its own shortening would tear: f_t l / E is more than the crack opens by.
TEST(ControlVerification, ABarSnapsBackAlongItsClosedForm) {
  constexpr double kLastOpening = 2.0 * kEnergy / kStrength;
  ASSERT_GT(kStrength * kLength / kYoung, kLastOpening);
  pyroclast::Setup setup = pyroclast::read(bar_deck(R"DECK(
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
[[sets]]
name = "left"
line = [["0 mm", "0 mm"], ["0 mm", "50 mm"]]
[[sets]]
name = "right"
line = [["1 m", "0 mm"], ["1 m", "50 mm"]]
)DECK"));
  const auto simulation = make_simulation(setup, bar());
  pyroclast::Run run(*simulation, std::move(setup.stages));
  EXPECT_EQ(run.run(), Outcome::completed);
  const History& history = run.history();
  const RowRange rows = run.records()[0].rows;
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
  const StageReport report = run.stages()[0]->report(history, rows, Outcome::completed);
  EXPECT_TRUE(report.warnings.empty());
}

}  // namespace
}  // namespace pyroclast
