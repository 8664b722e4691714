#include "pyroclast/experiment/experiment.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "decks.hpp"
#include "pyroclast/experiment/case.hpp"
#include "pyroclast/experiment/heating_response.hpp"
#include "pyroclast/experiment/response.hpp"
#include "pyroclast/experiment/simulation.hpp"

namespace pyroclast {
namespace {

/// Sixty blocks of a prism, 60 mm x 120 mm, whose parts differ in their expansion at most.
std::string deck(const std::string& stages, const std::string& expansion = "\"1e-5 1/K\"") {
  return R"DECK(title = "small"
[specimen]
width = "60 mm"
height = "120 mm"
seed = 1
[aggregates]
fraction = 0.1
d_min = "8 mm"
d_max = "16 mm"
fuller_exponent = 0.45
sieves = ["12 mm"]
minimum_gap = "0.5 mm"
[blocks]
count = 60
shortest_edge = 0.2
[superposition]
rule = "centroid"
[materials.aggregate]
E = { value = "29.4 GPa", times = { table = [["20 degC", 1], ["820 degC", 0.2]] } }
nu = 0.2
density = "2200 kg/m3"
expansion = )DECK" +
         expansion + R"DECK(
conductivity = "40 W/(m K)"
specific_heat = "1000 J/(kg K)"
[materials.mortar]
E = { value = "29.4 GPa", times = { table = [["20 degC", 1], ["820 degC", 0.2]] } }
nu = 0.2
density = "2200 kg/m3"
expansion = "1e-5 1/K"
conductivity = "40 W/(m K)"
specific_heat = "1000 J/(kg K)"
[materials.platen]
E = "200 GPa"
nu = 0.3
density = "7850 kg/m3"
[platens]
thickness = "10 mm"
[contacts]
t_b = "1.6 mm"
t_b_scaling = "fixed"
platen_friction = 0.0
[contacts.mortar_mortar]
temperature_ratio = { table = [["20 degC", 1], ["820 degC", 0.1]] }
f_t = "2.5 MPa"
G_f1 = "60 N/m"
f_cm = "31 MPa"
beta = 0.05
c_o = "3.8 MPa"
c_res = "0.038 MPa"
phi = "34 deg"
phi_res = "34 deg"
G_f2 = "240 N/m"
[contacts.aggregate_mortar]
stiffness_factor = 1.0
strength_factor = 1.0
[mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
viscous_damping = "500 1/s"
local_damping = 0.8
damping_form = "combined"
[output]
history_strain = 1e-5
frame_strain = 1e-3
[coupling]
exchange_increment = "5 K"
unbalanced_ratio = 1e-3
platen_difference = "20 kPa"
least_cycles = 50
most_cycles = 5000
failure_strain = 0.005
)DECK" + stages;
}

const std::string kUniform = "[heat]\nfield = \"uniform\"\n";
const std::string kSettle = "[[stages]]\nkind = \"settle\"\nunbalanced_ratio = 1e-6\nmost_steps = 100000\n";

std::string load(const std::string& how) {
  return "[[stages]]\nkind = \"load\"\n" + how +
         "\nramp_time = \"20 ms\"\nunbalanced_ratio = 1e-6\nmost_steps = 100000\n";
}

std::string heat(const std::string& to, const std::string& platen = "force") {
  return "[[stages]]\nkind = \"heat\"\nto = \"" + to + "\"\nrate = \"5 K/min\"\nplaten = \"" + platen +
         "\"\n";
}

const std::string kCompress =
    "[[stages]]\nkind = \"compress\"\nvelocity = \"2 mm/s\"\nramp_time = \"5 ms\"\nstop_strain = 0.0002\n";

struct Frames : Observer {
  std::vector<double> temperatures;
  void frame(const Experiment&, const Sample& s) override { temperatures.push_back(s.heat.mean); }
};

struct Trial {
  explicit Trial(const std::string& text)
      : c(read_case(Deck::parse(text, "deck.toml"), ".")),
        simulation(c),
        experiment(simulation, c.stages, c.sampling, frames),
        outcome(experiment.run()) {}

  const std::vector<Sample>& history() const { return experiment.history(); }
  const Sample& last() const { return experiment.history().back(); }
  /// Last row of a stage.
  const Sample& end_of(int stage) const {
    const Sample* row = nullptr;
    for (const auto& s : history())
      if (s.stage == stage) row = &s;
    return *row;
  }

  Case c;
  Simulation simulation;
  Frames frames;
  Experiment experiment;
  Outcome outcome;
};

// Promise: the load is what was asked for on both platens, whether as a stress or as a level.
TEST(LoadStage, BothPlatensCarryTheStressAskedFor) {
  const Trial a(deck(kUniform + kSettle + load("stress = \"6 MPa\"")));
  EXPECT_EQ(a.outcome, Outcome::completed);
  // 1e-4: the platen's own weight is 1e-4 of it, the unbalanced ratio 1e-6
  EXPECT_NEAR(a.last().stress_top, 6e6, 6e6 * 3e-4);
  EXPECT_NEAR(a.last().stress_bottom, 6e6, 6e6 * 1e-3);  // with the weight of the specimen
  const Trial b(deck(kUniform + kSettle + load("level = 0.2\nf_c = \"30 MPa\"")));
  EXPECT_DOUBLE_EQ(a.last().strain, b.last().strain);
}

// Promise: an even body of one expansion expands by alpha dT in both directions and stays sound; the energy
// ledger closes.
TEST(HeatStage, AnEvenBodyExpandsFreely) {
  const Trial r(deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC")));
  EXPECT_EQ(r.outcome, Outcome::completed);
  EXPECT_DOUBLE_EQ(r.last().heat.mean, 220.0);
  EXPECT_NEAR(r.last().heat.time, 200.0 / (5.0 / 60.0), 1e-9);
  const double softening = 1.0 - 0.8 * 200.0 / 800.0;
  const double loaded = r.end_of(1).specimen_strain / softening;
  EXPECT_NEAR(r.last().specimen_strain, loaded - 2e-3, 1e-5);  // 0.5 % of the expansion: what motion is left
  EXPECT_NEAR(r.last().lateral_strain, 2e-3, 1e-5);            // and Poisson's part of the load
  EXPECT_EQ(r.last().cracks.tension_mm.softening, 0);
  const auto response = heating_response(r.history(), r.c.stages, r.outcome);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->exchanges, 40);
  EXPECT_EQ(response->not_converged, 0);
  EXPECT_FALSE(response->critical_temperature);
  EXPECT_LT(std::abs(r.last().energy.error()), 1e-6 * r.last().energy.turnover());
}

// Promise: cooled down again, an elastic body is where it was.
TEST(HeatStage, CoolingBringsAnElasticBodyBack) {
  const Trial r(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC") + heat("20 degC")));
  EXPECT_EQ(r.outcome, Outcome::completed);
  EXPECT_NEAR(r.last().strain, r.end_of(1).strain, 1e-6);
  EXPECT_NEAR(r.last().stress_top, 3e6, 2e4);  // the difference between platens that counts as rest
}

// Promise: a modulus that falls adds strain under a constant load (total form, physics of the zones).
TEST(HeatStage, ALoadedBodyShortensAsItSoftens) {
  const Trial r(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("420 degC")));
  const double softening = 1.0 - 0.8 * 400.0 / 800.0;  // E(420) / E(20)
  EXPECT_NEAR(r.last().strain + 4e-3, r.end_of(1).strain / softening, 0.02 * r.end_of(1).strain);
}

// Promise: between fixed platens the thrust is that of the thermal strain, less what the platens give, E as
// measured at 20 degC.
TEST(HeatStage, FixedPlatensTakeTheThrust) {
  const Trial measured(deck(kUniform + kSettle + load("stress = \"1 MPa\"")));
  const double young = 1e6 / measured.last().strain;
  const Trial r(deck(kUniform + kSettle + heat("70 degC", "fixed")));
  EXPECT_EQ(r.outcome, Outcome::completed);
  const double expected = young * (1.0 - 0.8 * 50.0 / 800.0) * (5e-4 + r.last().strain);
  EXPECT_NEAR(r.last().stress_top, expected, 0.005 * expected);
  EXPECT_NEAR(r.last().strain, 0.0, 0.02 * 5e-4);
}

// Promise: a load above the strength that is left is found: the platen runs away, and where is told.
TEST(HeatStage, ASpecimenThatIsTooWeakRunsAway) {
  const Trial r(deck(kUniform + kSettle + load("stress = \"15 MPa\"") + heat("820 degC")));
  EXPECT_EQ(r.outcome, Outcome::ran_away);
  const auto response = heating_response(r.history(), r.c.stages, r.outcome);
  ASSERT_TRUE(response && response->critical_temperature);
  EXPECT_EQ(*response->critical_temperature, r.last().heat.mean);
  EXPECT_GT(*response->critical_temperature, 200.0);
  EXPECT_LT(*response->critical_temperature, 700.0);
  EXPECT_DOUBLE_EQ(response->load_stress, 15e6);
}

// Promise: an exchange that does not come to rest within its cycles is flagged.
TEST(HeatStage, AnExchangeThatIsCutShortIsFlagged) {
  const Trial r(with(deck(kUniform + kSettle + heat("120 degC"), "\"3e-5 1/K\""), "most_cycles = 5000",
                     "most_cycles = 60"));
  const auto response = heating_response(r.history(), r.c.stages, r.outcome);
  ASSERT_TRUE(response);
  EXPECT_EQ(response->not_converged, 20);
  EXPECT_EQ(response->cycles, 1200);
  EXPECT_GT(response->worst_ratio, 1e-5);
}

// Promise: strain of a compression after heating counts from its own beginning, so that the modulus is that
// of the hot body.
TEST(CompressStage, AfterHeatingMeasuresTheHotModulus) {
  const Trial cold(deck(kUniform + kSettle + kCompress));
  const Trial hot(deck(kUniform + kSettle + load("stress = \"0.2 MPa\"") + heat("420 degC") + kCompress));
  const auto a = compression_response(cold.history(), cold.c.stages);
  const auto b = compression_response(hot.history(), hot.c.stages);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(b->modulus / a->modulus, 0.6, 0.02);
  EXPECT_NEAR(hot.last().stage_strain, 0.0002, 2e-5);
}

const std::string kPredictor = "least_cycles = 50\npredictor = true";

// Promise: the predictor changes how a body gets to its new size, not which size: an even body under load
// expands by alpha dT and softens as without it, in fewer cycles, and the energy ledger closes.
TEST(Predictor, BringsABodyToTheSameStateInFewerCycles) {
  const std::string text = deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC"));
  const Trial plain(text);
  const Trial predicted(with(text, "least_cycles = 50", kPredictor));
  EXPECT_EQ(predicted.outcome, Outcome::completed);
  EXPECT_NEAR(predicted.last().specimen_strain, plain.last().specimen_strain,
              1e-5);  // motion left in `plain`
  EXPECT_NEAR(predicted.last().lateral_strain, plain.last().lateral_strain, 1e-5);
  const auto a = heating_response(plain.history(), plain.c.stages, plain.outcome);
  const auto b = heating_response(predicted.history(), predicted.c.stages, predicted.outcome);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(b->not_converged, 0);
  EXPECT_LT(b->cycles, a->cycles);
  EXPECT_LT(std::abs(predicted.last().energy.error()), 1e-6 * predicted.last().energy.turnover());
}

// Promise: cooled down again with the predictor, an elastic body is where it was.
TEST(Predictor, CoolingBringsAnElasticBodyBack) {
  const Trial r(
      with(deck(kUniform + kSettle + load("stress = \"3 MPa\"") + heat("320 degC") + heat("20 degC")),
           "least_cycles = 50", kPredictor));
  EXPECT_EQ(r.outcome, Outcome::completed);
  EXPECT_NEAR(r.last().strain, r.end_of(1).strain, 1e-6);
}

// Promise: the predictor leaves fixed platens where they are.
TEST(Predictor, FixedPlatensTakeTheThrust) {
  const std::string text = deck(kUniform + kSettle + heat("70 degC", "fixed"));
  const Trial plain(text);
  const Trial predicted(with(text, "least_cycles = 50", kPredictor));
  EXPECT_NEAR(predicted.last().stress_top, plain.last().stress_top, 0.01 * plain.last().stress_top);
  EXPECT_NEAR(predicted.last().strain, 0.0, 0.02 * 5e-4);  // but for the platens' own give
}

const std::string kFailure =
    "[[stages]]\nkind = \"compress\"\nvelocity = \"1 mm/s\"\nramp_time = \"10 ms\"\nstop_strain = 0.004\n";
const std::string kControl =
    "fastest_velocity = \"10 mm/s\"\nunbalanced_ratio = 2e-4\nkinetic_over_strain = 5e-3\n"
    "platen_difference = 0.01\ndissipation_rate = \"50 1/s\"\n";

// Promise: a controlled velocity finds the modulus and the strength of the slow test in fewer steps, and is
// quasi-static up to the peak.
TEST(CompressStage, AControlledVelocityFindsTheSlowStrengthInFewerSteps) {
  const Trial slow(deck(kUniform + kSettle + kFailure));
  const Trial fast(deck(kUniform + kSettle + kFailure + kControl));
  const auto a = compression_response(slow.history(), slow.c.stages);
  const auto b = compression_response(fast.history(), fast.c.stages);
  ASSERT_TRUE(a && b);
  EXPECT_NEAR(b->modulus, a->modulus, 0.005 * a->modulus);
  EXPECT_NEAR(b->strength, a->strength,
              0.02 * a->strength);  // a brittle body of 60 blocks: one crack more or less
  EXPECT_LT(fast.last().step, slow.last().step / 2);
  EXPECT_TRUE(quasi_static_report(fast.history(), fast.c.stages).to_peak);
  EXPECT_LT(std::abs(fast.last().energy.error()), 5e-3 * fast.last().energy.turnover());
}

// Promise: the controlled velocity stays between its bounds, whatever the tolerances.
TEST(CompressStage, AControlledVelocityStaysWithinItsBounds) {
  for (const auto* tolerance : {"unbalanced_ratio = 1e-12", "unbalanced_ratio = 1"}) {
    const Trial r(deck(kUniform + kSettle + with(kFailure, "0.004", "0.0005") +
                       with(kControl, "unbalanced_ratio = 2e-4", tolerance)));
    for (std::size_t i = 1; i < r.history().size(); ++i) {
      const Sample& now = r.history()[i];
      if (now.stage != 1 || now.stage_strain < 1e-4) continue;  // past the ramp
      const Sample& before = r.history()[i - 1];
      // the platens' faces give a little less than their outer sides are driven
      const double velocity = (now.strain - before.strain) * 0.12 / (now.time - before.time);
      EXPECT_GT(velocity, 0.9e-3);
      EXPECT_LT(velocity, 10.5e-3);
    }
  }
}

// Promise: frames come at the stated steps of temperature, and at the end.
TEST(Frames, ComeAtStepsOfTemperature) {
  const Trial r(with(deck(kUniform + kSettle + load("stress = \"0.5 MPa\"") + heat("220 degC")),
                     "frame_strain = 1e-3", "frame_strain = 1e-3\nframe_temperature = \"50 K\""));
  const std::vector<double> expected{20, 20, 20, 50, 100, 150, 200, 220};
  ASSERT_EQ(r.frames.temperatures.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_DOUBLE_EQ(r.frames.temperatures[i], expected[i]);
}

// Promise: with conduction the mechanics gets the computed field: a prism heated on one side bends that way,
// and temperatures differ over it.
TEST(ExposeStage, HeatsOneSideMoreThanTheOther) {
  const Trial r(
      with(deck(kSettle + "[[stages]]\nkind = \"expose\"\nduration = \"6 min\"\nplaten = \"force\"\n" +
                "[heat]\nfield = \"conduction\"\n[[heat.boundaries]]\nfaces = \"left\"\n"
                "kind = \"temperature\"\ntemperature = { from = \"20 degC\", rate = \"10 K/min\", to = "
                "\"70 degC\" }\n"),
           "most_cycles = 5000", "most_cycles = 2000"));
  EXPECT_EQ(r.outcome, Outcome::completed);
  EXPECT_NEAR(r.last().heat.time, 360.0, 1e-6);
  EXPECT_NEAR(r.last().heat.maximum, 70.0, 0.1);
  EXPECT_LT(r.last().heat.minimum, 69.9);
  EXPECT_GT(r.last().heat.mean, r.last().heat.minimum);
  // 5 %: what motion is left, and the weight
  EXPECT_NEAR(r.last().lateral_strain, 1e-5 * (r.last().heat.mean - 20.0), 2.5e-5);
}

// Promise: what contradicts itself is refused at its line.
TEST(Stages, ContradictionsAreRefused) {
  const auto message = [](const std::string& text) -> std::string {
    try {
      read_case(Deck::parse(text, "deck.toml"), ".");
    } catch (const DeckError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_EQ(message(deck(kUniform + kSettle + heat("120 degC"))), "");
  EXPECT_NE(message(deck(kUniform + kSettle + heat("920 degC"))).find("820"), std::string::npos);
  EXPECT_EQ(message(deck(kUniform + kSettle + kFailure + kControl)), "");
  EXPECT_NE(message(deck(kUniform + kSettle + with(kFailure, "1 mm/s", "20 mm/s") + kControl))
                .find("must not be less than velocity"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + with(kFailure, "10 ms", "0 s") + kControl)).find("ramp_time"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + kFailure + "unbalanced_ratio = 1e-4\n")).find("has no effect"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle + load("level = 0.2\nf_c = \"30 MPa\"\nstress = \"6 MPa\"")))
                .find("either stress, or level"),
            std::string::npos);
  EXPECT_NE(message(deck(kUniform + kSettle +
                         "[[stages]]\nkind = \"expose\"\nduration = \"1 h\"\nplaten = "
                         "\"force\"\n"))
                .find("conduction"),
            std::string::npos);
  EXPECT_NE(
      message(with(deck(kSettle + "[[stages]]\nkind = \"expose\"\nduration = \"1 h\"\nplaten = \"force\"\n"),
                   "least_cycles = 50", kPredictor))
          .find("uniform"),
      std::string::npos);
}

}  // namespace
}  // namespace pyroclast
