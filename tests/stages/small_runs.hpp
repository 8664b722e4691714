#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "decks.hpp"
#include "pyroclast/setup/setup.hpp"
#include "pyroclast/simulation/loop/run.hpp"

/// Runs of a small prism, and what they give, for tests.
namespace pyroclast {

/// Strengths and fracture energies of a contact of mortar.
inline const std::string kMortarBond = R"(f_t = "2.5 MPa"
G_f1 = "60 N/m"
f_cm = "31 MPa"
beta = 0.05
c_o = "3.8 MPa"
c_res = "0.038 MPa"
phi = "34 deg"
phi_res = "34 deg"
G_f2 = "240 N/m"
)";

/// Contacts of mortar that stay elastic at the stresses of tests, but for what is stated.
inline std::string strong_bond(const std::string& f_t = "25 MPa", const std::string& c_o = "100 MPa",
                               const std::string& G_f1 = "6 kN/m") {
  return "f_t = \"" + f_t + "\"\nG_f1 = \"" + G_f1 + "\"\nc_o = \"" + c_o + R"("
f_cm = "1 GPa"
beta = 0.05
c_res = "1 MPa"
phi = "34 deg"
phi_res = "34 deg"
G_f2 = "24 kN/m"
)";
}

/// A body that comes to rest by scaled mass.
inline std::string resting_mechanics(const std::string& gravity) {
  return R"([mechanics]
mass = "scaled"
time_step = "10 us"
safety = 0.9
local_damping = 0.8
damping_form = "combined"
gravity = ")" +
         gravity + "\"\n";
}

/// Sixty blocks of a prism, 60 mm x 120 mm, whose parts differ in their expansion at most.
inline std::string deck(const std::string& stages, const std::string& expansion = "\"1e-5 1/K\"") {
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
[materials]
on_cooling = "reversible"
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
)DECK" + kMortarBond +
         R"DECK([contacts.aggregate_mortar]
like = "mortar_mortar"
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

inline const std::string kUniform = "[heat]\nfield = \"uniform\"\n";
inline const std::string kSettle =
    "[[stages]]\nkind = \"settle\"\nunbalanced_ratio = 1e-6\nmost_steps = 100000\n";

inline std::string load(const std::string& how) {
  return "[[stages]]\nkind = \"load\"\n" + how +
         "\nramp_time = \"20 ms\"\nunbalanced_ratio = 1e-6\nmost_steps = 100000\n";
}

inline std::string heat(const std::string& to, const std::string& platen = "force") {
  return "[[stages]]\nkind = \"heat\"\nto = \"" + to + "\"\nrate = \"5 K/min\"\nplaten = \"" + platen +
         "\"\n";
}

inline const std::string kCompress =
    "[[stages]]\nkind = \"compress\"\nvelocity = \"0.5 mm/s\"\nramp_time = \"20 ms\"\nstop_strain = 0.0002\n";

inline const std::string kFailure =
    "[[stages]]\nkind = \"compress\"\nvelocity = \"1 mm/s\"\nramp_time = \"10 ms\"\nstop_strain = 0.004\n";
inline const std::string kControl =
    "fastest_velocity = \"10 mm/s\"\nunbalanced_ratio = 2e-4\nkinetic_over_strain = 5e-3\n"
    "platen_difference = 0.01\ndissipation_rate = \"50 1/s\"\n";
inline const std::string kExpose =
    "[[stages]]\nkind = \"expose\"\nduration = \"6 min\"\nplaten = \"force\"\n";
/// A face that is heated from 20 to 70 degC.
inline const std::string kHeatedFace =
    "[heat]\nfield = \"conduction\"\n[[heat.boundaries]]\nfaces = \"left\"\nkind = \"temperature\"\n"
    "temperature = { from = \"20 degC\", rate = \"10 K/min\", to = \"70 degC\" }\n";

/// A prism whose aggregate grows away from its mortar in a fire on its left.
inline std::string hot_deck(const std::string& cracks) {
  std::string text = with(deck(kSettle + kExpose, "\"6e-5 1/K\"") + kHeatedFace,
                          "rate = \"10 K/min\", to = \"70", "rate = \"100 K/min\", to = \"620");
  for (int material = 0; material < 2; ++material)
    text = with(text, "conductivity = \"40 W/(m K)\"", "conductivity = \"4 W/(m K)\"");
  return with(text, "exchange_increment = \"5 K\"", "exchange_increment = \"40 K\"") + cracks;
}

inline Setup read(const std::string& text, const StageRegistry& kinds = {}) {
  return read_setup(Deck::parse(text, "deck.toml"), ".", kinds);
}

/// A deck that can be run.
struct Trial {
  explicit Trial(const std::string& text, const StageRegistry& kinds = {})
      : setup(pyroclast::read(text, kinds)),
        simulation(make_simulation(setup)),
        run(*simulation, std::move(setup.stages)) {}
  /// On a body that is there already.
  Trial(const std::string& text, MadeSpecimen body)
      : setup(pyroclast::read(text)),
        simulation(make_simulation(setup, std::move(body))),
        run(*simulation, std::move(setup.stages)) {}

  Setup setup;
  std::unique_ptr<Simulation> simulation;
  Run run;
};

/// Ends each batch of a run after so many steps of the mechanics at most.
inline void cut_batches(Run& run, int steps) {
  if (run.simulation().moves())
    run.call_at(run.simulation().motion().steps() + steps,
                [steps](Run& again) { cut_batches(again, steps); });
}

/// A deck that was run to its end.
struct Finished : Trial {
  template <class... Body>
  explicit Finished(const std::string& text, Body&&... body) : Trial(text, std::forward<Body>(body)...) {
    while (run.next())
      if (run.frame_is_due()) frames.push_back(last("temperature_degC"));
  }

  double last(const char* column) const { return run.history().last(column).value(); }
  /// In the last row of a stage.
  double end_of(int stage, const char* column) const {
    return run.history().cell(run.courses()[stage].rows.last - 1, column).value();
  }
  double energy_error_over_turnover() const {
    double turnover = 0.0;
    for (const char* put_in :
         {"energy_loading_J", "energy_gravity_J", "energy_property_change_J", "energy_mass_scaling_J"})
      turnover += std::abs(last(put_in));
    return std::abs(last("energy_error_J")) / turnover;
  }
  StageReport report(int stage) const {
    const StageCourse& record = run.courses()[stage];
    return run.stages()[stage]->report(run.history(), record.rows, record.outcome);
  }
  /// A result of a stage; empty where the report has none, or has nothing in its place.
  std::optional<double> result(int stage, const std::string& name) const {
    for (const Result& result : report(stage).results) {
      if (result.name != name) continue;
      if (const auto* real = std::get_if<double>(&result.value)) return *real;
      if (const auto* count = std::get_if<std::int64_t>(&result.value)) return static_cast<double>(*count);
      if (const auto* flag = std::get_if<bool>(&result.value)) return *flag ? 1.0 : 0.0;
    }
    return std::nullopt;
  }

  std::vector<double> frames;  ///< mean temperatures, °C
};

}  // namespace pyroclast
