#include "pyroclast/experiment/case.hpp"

#include <cmath>

#include <fmt/format.h>

#include "pyroclast/experiment/read_materials.hpp"
#include "pyroclast/material/builtin_curves.hpp"

namespace pyroclast {

namespace {

constexpr double kGravity = 9.80665;  // m/s², standard

/// Placing an aggregate is given up after this many random centres.
constexpr int kPlacementAttempts = 100'000;

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

SettleStage read_settle(const Section& s) {
  SettleStage stage;
  stage.unbalanced_ratio = s.number("unbalanced_ratio", Range::positive());
  stage.most_steps = s.integer("most_steps", Range::between(1, 1e12));
  return stage;
}

CompressStage read_compress(const Section& s) {
  CompressStage stage;
  stage.velocity = s.quantity("velocity", unit::velocity, Range::positive());
  stage.ramp_time = s.quantity("ramp_time", unit::time, Range::non_negative());
  stage.stop_strain = s.number("stop_strain", Range::inside(0.0, 1.0));
  stage.stop_fraction =
      s.number("stop_fraction_of_peak", {.lower = 0.0, .upper = 1.0, .upper_inclusive = false}, 0.0);
  return stage;
}

std::vector<Stage> read_stages(const Section& root) {
  enum class Kind { settle, compress };
  std::vector<Stage> stages;
  for (const Section& s : root.sections("stages")) {
    switch (s.choice<Kind>("kind", {{"settle", Kind::settle}, {"compress", Kind::compress}})) {
      case Kind::settle:
        stages.emplace_back(read_settle(s));
        break;
      case Kind::compress:
        stages.emplace_back(read_compress(s));
        break;
    }
  }
  return stages;
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

}  // namespace

Case read_case(const Deck& deck, const std::filesystem::path& folder) {
  const Section root = deck.root();
  Case c;
  c.title = root.text("title");
  read_specimen_tables(root, folder, c.specimen);
  c.thickness = root.section("specimen").quantity("thickness", unit::length, Range::positive(), 1.0);
  // Includes the reference temperature, at which masses and stated stiffnesses hold.
  c.temperatures = {kReferenceTemperature, kReferenceTemperature};
  CurveReader curves(folder, temperature_axis(), c.temperatures, builtin_curves());
  c.solids = read_solids(root, curves);
  c.platen_thickness = root.section("platens").quantity("thickness", unit::length, Range::positive());
  c.contacts = read_contacts(root, curves);
  c.curves = curves.curves();
  c.mechanics = read_mechanics(root.section("mechanics"));
  c.stages = read_stages(root);
  const Section output = root.section("output");
  c.sampling.history_strain = output.number("history_strain", Range::positive());
  c.sampling.frame_strain = output.number("frame_strain", Range::positive());
  check_contacts(root, c);
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
