#include "pyroclast/experiment/case.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/experiment/read_heat.hpp"
#include "pyroclast/experiment/read_materials.hpp"
#include "pyroclast/experiment/read_probes.hpp"
#include "pyroclast/experiment/read_stages.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

namespace pyroclast {

namespace {

constexpr double kGravity = 9.80665;  // m/s², standard

/// Placing an aggregate is given up after this many random centres.
constexpr int kPlacementAttempts = 100'000;

/// Between two frames while the temperature changes, K, where the deck does not say.
constexpr double kFrameTemperature = 50.0;

/// Even temperatures of the run at which the contact law must be possible.
constexpr int kCheckedTemperatures = 33;

specimen::AggregateParameters read_aggregates(const Section& s) {
  specimen::AggregateParameters a;
  a.fraction = s.number("fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false});
  a.d_min = s.quantity("d_min", unit::length, Range::positive());
  a.d_max = s.quantity("d_max", unit::length, Range::positive());
  a.fuller_exponent = s.number("fuller_exponent", Range::positive());
  a.minimum_gap = s.quantity("minimum_gap", unit::length, Range::non_negative());
  a.attempts = static_cast<int>(s.integer("attempts", Range::between(1, 1e9), kPlacementAttempts));
  const auto between = s.quantities("sieves", unit::length, Range::positive());
  if (!s.ok()) return a;
  if (a.d_max <= a.d_min) s.error("d_max", "must be greater than d_min");
  a.sieves = {a.d_min};
  for (double sieve : between) {
    if (sieve <= a.sieves.back() || sieve >= a.d_max) {
      s.error("sieves", "must ascend and lie between d_min and d_max, both excluded");
      return a;
    }
    a.sieves.push_back(sieve);
  }
  a.sieves.push_back(a.d_max);
  return a;
}

specimen::BlockParameters read_blocks(const Section& s, const std::filesystem::path& folder) {
  specimen::BlockParameters b;
  b.shortest_edge = s.number("shortest_edge", Range::between(0.0, 0.5));
  if (s.has("file")) {
    b.file = folder / s.text("file");
    if (s.has("count")) s.error("count", "has no meaning beside file: the tessellation is read, not made");
    return b;
  }
  b.count = static_cast<int>(s.integer("count", Range::between(4, 100e6)));
  b.relaxation = static_cast<int>(s.integer("relaxation", Range::between(0, 1000), 0));
  b.radius_spread = s.number("radius_spread", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0);
  return b;
}

void read_specimen_tables(const Section& root, const std::filesystem::path& folder,
                          specimen::SpecimenParameters& p) {
  const Section s = root.section("specimen");
  p.width = s.quantity("width", unit::length, Range::positive());
  p.height = s.quantity("height", unit::length, Range::positive());
  p.seed = static_cast<std::uint64_t>(s.integer("seed", Range::between(0, 9e15)));
  p.aggregates = read_aggregates(root.section("aggregates"));
  p.blocks = read_blocks(root.section("blocks"), folder);
  const Section superposition = root.section("superposition");
  p.superposition = superposition.choice<specimen::Superposition>(
      "rule", {{"area", specimen::Superposition::area}, {"centroid", specimen::Superposition::centroid}});
  if (p.superposition == specimen::Superposition::area)
    p.covered_fraction =
        superposition.number("covered_fraction", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false});
}

MechanicsParameters<2> read_mechanics(const Section& s) {
  MechanicsParameters<2> m;
  m.gravity = {{0.0, -s.quantity("gravity", unit::acceleration, Range::non_negative(), kGravity)}};
  m.local_damping = s.number("local_damping", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false});
  m.damping_form = s.choice<DampingForm>(
      "damping_form", {{"combined", DampingForm::combined}, {"local", DampingForm::local}});
  m.viscous_damping = s.quantity("viscous_damping", unit::frequency, Range::non_negative(), 0.0);
  m.mass = s.choice<MassChoice>("mass", {{"scaled", MassChoice::scaled}, {"real", MassChoice::real}});
  if (m.mass == MassChoice::scaled) m.time_step = s.quantity("time_step", unit::time, Range::positive());
  m.kinematics = s.choice<Kinematics>(
      "kinematics", {{"small", Kinematics::small}, {"finite", Kinematics::finite}}, Kinematics::small);
  m.safety = s.number("safety", {.lower = 0.0, .upper = 1.0, .lower_inclusive = false});
  return m;
}

template <class S>
bool any_stage(const std::vector<Stage>& stages) {
  return std::any_of(stages.begin(), stages.end(),
                     [](const Stage& s) { return std::holds_alternative<S>(s); });
}

/// A uniform field is changed by heat stages, a computed one by exposing the specimen.
void check_heat(const Section& root, const Case& c) {
  const auto heat = root.optional_section("heat");
  if ((c.conduct || any_stage<ExposeStage>(c.stages)) && c.heat.uniform) {
    const auto message = fmt::format("a stage of kind \"{}\" needs [heat] with field = \"conduction\"",
                                     c.conduct ? "conduct" : "expose");
    heat ? heat->error("field", message) : root.error("stages", message);
  }
  if (any_stage<HeatStage>(c.stages) && !c.heat.uniform)
    heat->error("field",
                "a stage of kind \"heat\" needs field = \"uniform\"; use \"expose\" with conduction");
}

/// Time for which boundaries act, s.
double exposure(const Case& c) {
  double duration = c.conduct ? c.conduct->duration : 0.0;
  for (const auto& stage : c.stages)
    if (const auto* expose = std::get_if<ExposeStage>(&stage)) duration += expose->duration;
  return duration;
}

/// All temperatures that a run may come to, and the reference temperature, at which masses and stated
/// stiffnesses hold.
Interval run_temperatures(const Section& root, const Case& c) {
  Interval t{std::min(kReferenceTemperature, c.heat.initial),
             std::max(kReferenceTemperature, c.heat.initial)};
  const auto include = [&](double low, double high) {
    t = {std::min(t.lower, low), std::max(t.upper, high)};
  };
  for (const auto& stage : c.stages)
    if (const auto* heat = std::get_if<HeatStage>(&stage)) include(heat->to, heat->to);
  const auto heat_table = root.optional_section("heat");
  if (!c.heat.uniform && heat_table && heat_table->ok()) {
    const Interval computed = temperature_range(c.heat, exposure(c));
    include(computed.lower, computed.upper);
  }
  return t;
}

/// The contact law's own conditions, told where the user can act on them: at 20 °C and over what the run
/// needs.
void check_contacts(const Section& root, const Case& c) {
  const Section contacts = root.section("contacts");
  if (!root.ok()) return;
  const auto concrete = make_concrete(c.solids, c.contacts, expected_block_size(c));
  const auto check = [&](InterfaceIndex interface, const char* key) {
    const auto [lower, upper] = c.temperatures;
    double T = kReferenceTemperature;
    try {
      validate(concrete.contacts[interface].at(T), key);
      for (int i = 0; i < kCheckedTemperatures; ++i) {
        T = lower + i * (upper - lower) / (kCheckedTemperatures - 1);
        validate(concrete.contacts[interface].at(T), key);
      }
    } catch (const Error& e) {
      contacts.error(key, fmt::format("at {:.6g} degC: {}", T, e.what()));
    }
  };
  check(mortar_mortar, "mortar_mortar");
  check(aggregate_mortar, "aggregate_mortar");
}

/// Everything but the specimen, where there is mechanics.
void read_mechanical(const Section& root, CurveReader& curves, Case& c) {
  c.expansion_reading = read_expansion_reading(root);
  c.solids = read_solids(root, c.expansion_reading, curves);
  c.platen_thickness = root.section("platens").quantity("thickness", unit::length, Range::positive());
  c.contacts = read_contacts(root, curves);
  c.mechanics = read_mechanics(root.section("mechanics"));
  const Section output = root.section("output");
  c.sampling.history_strain = output.number("history_strain", Range::positive());
  c.sampling.frame_strain = output.number("frame_strain", Range::positive());
  c.sampling.frame_temperature = output.quantity("frame_temperature", unit::temperature_difference,
                                                 Range::positive(), kFrameTemperature);
  output.know({"frame_interval"});
  root.know({"probes"});
}

/// Everything but the specimen, for heat conduction alone.
void read_conduction_alone(const Section& root, CurveReader& curves, Case& c) {
  c.solids = read_conducting_solids(root, curves);
  const Section output = root.section("output");
  c.conduct->frame_interval = output.quantity("frame_interval", unit::time, Range::positive());
  output.know({"history_strain", "frame_strain", "frame_temperature"});
  root.know({"platens", "contacts", "mechanics"});
  c.probes = read_probes(root, c.specimen.width, c.specimen.height);
}

}  // namespace

Case read_case(const Deck& deck, const std::filesystem::path& folder) {
  const Section root = deck.root();
  Case c;
  c.title = root.text("title");
  auto [stages, conduct] = read_stages(root);
  c.stages = std::move(stages);
  c.conduct = conduct;
  CurveReader time_curves(folder, time_axis(), {0.0, exposure(c)}, fire_curves());
  if (auto heat = read_heat(root, time_curves)) c.heat = std::move(*heat);
  check_heat(root, c);
  c.temperatures = run_temperatures(root, c);
  read_specimen_tables(root, folder, c.specimen);
  c.thickness = root.section("specimen").quantity("thickness", unit::length, Range::positive(), 1.0);
  CurveReader curves(folder, temperature_axis(), c.temperatures, builtin_curves());
  if (c.conduct) {
    read_conduction_alone(root, curves, c);
  } else {
    read_mechanical(root, curves, c);
    check_contacts(root, c);
  }
  c.curves = curves.curves();
  deck.finish();
  return c;
}

double expected_block_size(const Case& c) {
  if (c.specimen.blocks.count == 0) return c.contacts.fracture_zone_size.value_or(1.0);
  return std::sqrt(c.specimen.width * c.specimen.height / c.specimen.blocks.count);
}

double estimate_modulus(const ConcreteModel& body, const ConcreteMaterials& materials) {
  const auto& model = body.model;
  const auto geometry = zone_geometry(model);
  const auto blocks = zone_blocks(model);
  double volume = 0.0, compliance = 0.0;
  for (int z = 0; z < model.zone_count(); ++z) {
    const int material = model.block_material[blocks[z]];
    if (material == platen_material) continue;
    volume += geometry.volume[z];
    compliance += geometry.volume[z] / materials.solids[material].young(kReferenceTemperature);
  }
  for (const auto& c : model.contacts) {
    if (c.interface == platen_interface) continue;
    const auto p = materials.contacts[c.interface].at(kReferenceTemperature);
    const double normal = c.normal[1] * c.normal[1];           // traction over stress, along the normal
    const double tangential = c.normal[1] * c.tangents[0][1];  // and along the face
    compliance +=
        c.area * (normal * normal / p.normal_stiffness + tangential * tangential / p.shear_stiffness);
  }
  return volume / compliance;
}

}  // namespace pyroclast
