#include "pyroclast/setup/setup.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/rounding.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/setup/effects.hpp"
#include "pyroclast/setup/read_bearings.hpp"
#include "pyroclast/setup/read_bodies.hpp"
#include "pyroclast/setup/read_heat.hpp"
#include "pyroclast/setup/read_materials.hpp"
#include "pyroclast/setup/read_moisture.hpp"
#include "pyroclast/setup/read_probes.hpp"
#include "pyroclast/setup/read_references.hpp"
#include "pyroclast/setup/read_sets.hpp"
#include "pyroclast/setup/read_space.hpp"
#include "pyroclast/setup/read_spalling.hpp"
#include "pyroclast/setup/read_specimen.hpp"
#include "pyroclast/setup/read_stages.hpp"
#include "pyroclast/setup/read_symmetry.hpp"
#include "pyroclast/stages/run_verdict.hpp"
#include "pyroclast/thermal/fire_curves.hpp"

namespace pyroclast {

namespace {

// Block sizes over d_max, from docs/validation/block_size.md: of 250 and of 1,600 blocks on 150 mm x 300 mm
// with d_max = 32 mm.
constexpr double kCoarsestStudied = 0.42, kCoarsestHeated = 0.165;

constexpr double kGravity = 9.80665;  // m/s², standard

/// Number of temperatures, evenly over the run's, at which the contact law must be possible.
constexpr int kCheckedTemperatures = 33;

MechanicsParameters read_mechanics(const Section& s, const DeckSpace& space) {
  MechanicsParameters m;
  m.gravity = {{0.0, -s.quantity("gravity", unit::acceleration, Range::non_negative().usually(0.0, 10.0),
                                 kGravity, "acceleration downwards")}};
  m.local_damping = s.number("local_damping",
                             Range{.lower = 0.0, .upper = 1.0, .upper_inclusive = false}.usually(0.1, 0.95),
                             "coefficient λ of Eq. (8)");
  m.damping_form = s.choice<DampingForm>(
      "damping_form",
      {{"combined", DampingForm::combined,
        "with (sgn v − sgn dF/dt)/2: damps vibration about a steady motion too"},
       {"local", DampingForm::local, "Eq. (8) as printed, sgn v: drags a body in steady motion"}},
      "form of local damping");
  m.viscous_damping =
      s.quantity("viscous_damping", unit::frequency, Range::non_negative(), 0.0, "coefficient ξ of Eq. (3)");
  m.mass = s.choice<MassChoice>(
      "mass",
      {{"scaled", MassChoice::scaled,
        "density scaling, for quasi-static runs: the limit of each gridpoint is the common time step"},
       {"real", MassChoice::real, "density times volume, for dynamics"}},
      "mass that moves; the weight always follows the real mass");
  if (m.mass == MassChoice::scaled)
    m.time_step =
        s.quantity("time_step", unit::time, Range::positive().usually(1e-8, 1e-4), "common time step");
  m.found.is_on = s.choice<bool>(
      "contacts",
      {{"first", false, "contacts join the faces that coincide at the start, for ever"},
       {"found", true,
        "blocks that part may meet others, see [Contacts that are found](../understand/found.md)"}},
      false, "which blocks may touch");
  const std::initializer_list<Choice<Kinematics>> kinematics = {
      {"small", Kinematics::small, "zones and contact frames keep their orientation"},
      {"finite", Kinematics::finite, "they turn with the body; strains stay small"}};
  constexpr Meaning kKinematics = "whether the body may turn";
  // in the plane pairs turn with their edges, in space they take directions from places
  const bool must_turn = m.found.is_on && !space.is_solid();
  m.kinematics = must_turn ? s.choice<Kinematics>("kinematics", kinematics, kKinematics)
                           : s.choice<Kinematics>("kinematics", kinematics, Kinematics::small, kKinematics);
  if (must_turn && m.kinematics == Kinematics::small && s.ok())
    s.error("contacts", "blocks that meet others turn: kinematics = \"finite\" is needed");
  m.safety =
      s.number("safety", Range{.lower = 0.0, .upper = 1.0, .lower_inclusive = false}.usually(0.3, 0.95),
               "fraction of the stable step that is taken");
  return m;
}

/// Reads [contacts.found].
void read_found(const Section& contacts, const ContactParameters& parameters, FoundParameters& found) {
  if (!found.is_on) {
    if (const auto s = contacts.optional_section(kFoundTable)) s->know({"like", "damping"});
    return;
  }
  const std::array<std::string, 2> of_matrix{parameters.matrix, parameters.matrix};
  for (const InterfaceParameters& interface : parameters.interfaces)
    if (std::ranges::find(interface.between, of_matrix) != interface.between.end())
      found.like = interface.name;
  const Section s = contacts.section_or_none(kFoundTable, "contacts between blocks that meet anew");
  found.damping =
      s.number("damping", Range{.lower = 0.0, .upper = 1.0, .upper_inclusive = false}.usually(0.0, 0.3), 0.0,
               "share of critical damping while blocks press each other; never pulls");
  if (s.has("like"))
    found.like = s.text("like",
                        "interface, broken, between blocks whose materials no interface joins, or several; "
                        "without this key that of the matrix with itself");
  if (s.ok() && std::ranges::find(parameters.interfaces, found.like, &InterfaceParameters::name) ==
                    parameters.interfaces.end())
    s.error("like", fmt::format("must be an interface of [contacts]; got \"{}\"", found.like));
}

/// Returns the time for which boundaries act, s.
double exposure(const std::vector<std::unique_ptr<Stage>>& stages) {
  double duration = 0.0;
  for (const auto& stage : stages) duration += stage->heating().duration;
  return duration;
}

/// Records an error where a stage needs the other kind of field. A uniform field is changed by stages that
/// set it, a computed one by exposing the specimen.
void check_heat(const Section& root, const HeatConditions& conditions,
                const std::vector<std::unique_ptr<Stage>>& stages) {
  const auto heat = root.optional_section("heat");
  for (const auto& stage : stages) {
    const FieldChoice field = stage->needs().field;
    if (field == FieldChoice::computed && conditions.uniform) {
      const auto message =
          fmt::format("a stage of kind \"{}\" needs [heat] with field = \"conduction\"", stage->kind());
      heat ? heat->error("field", message) : root.error("stages", message);
      return;
    }
    if (field == FieldChoice::uniform && !conditions.uniform) {
      heat->error("field", fmt::format("a stage of kind \"{}\" needs field = \"uniform\"; "
                                       "with conduction use \"expose\"",
                                       stage->kind()));
      return;
    }
  }
}

/// Records an error for a stage that moves the body without the temperatures of the stages before it. The
/// body is as the last exchange left it: what `conduct` did since then would have no effect on it.
void check_hand_over(const Section& root, const std::vector<std::unique_ptr<Stage>>& stages) {
  const auto sections = root.sections("stages");
  std::optional<std::size_t> pending;  // a stage whose temperatures are still to be handed over
  for (std::size_t i = 0; i < std::min(stages.size(), sections.size()); ++i) {
    const StageNeeds needs = stages[i]->needs();
    if (needs.exchanges) pending.reset();
    if (!needs.mechanics) pending = i;
    if (!pending || !needs.mechanics) continue;
    sections[i].error(
        "kind",
        fmt::format("moves the body, but no stage has handed over the temperatures of stage {} ({}); put a "
                    "stage of kind \"expose\" between them, or in the place of that one",
                    *pending + 1, stages[*pending]->kind()));
    return;
  }
}

bool is_cylinder(const specimen::SpecimenParameters& specimen) {
  return specimen.prism() && specimen.prism()->axis() == specimen::Prism::Axis::y;
}

/// Boundaries of a table of the deck: what flows through them, and the faces of each.
struct DeckBoundaries {
  const char* table;
  const char* flow;
  std::vector<BoundaryFaces> faces;
};

std::vector<DeckBoundaries> boundaries_of(const HeatConditions& heat) {
  std::vector<DeckBoundaries> all{{"heat", "heat", {}}, {"moisture", "water", {}}};
  for (const auto& boundary : heat.boundaries) all[0].faces.push_back(boundary.faces);
  if (heat.moisture)
    for (const auto& boundary : heat.moisture->boundaries) all[1].faces.push_back(boundary.faces);
  return all;
}

/// Records an error for each boundary on a side or set that the specimen does not have.
void check_sides(const Section& root, const Setup& setup) {
  std::vector<std::string> names{BoundaryFaces::kOutline, BoundaryFaces::kBox};
  for (const specimen::Side& side : setup.specimen.sides()) names.push_back(side.name);
  if (is_cylinder(setup.specimen)) names.insert(names.end(), kQuartersOfRim.begin(), kQuartersOfRim.end());
  for (const auto& set : setup.sets)
    if (set.of != SetOf::contacts) names.push_back(set.name);
  for (const DeckBoundaries& boundaries : boundaries_of(setup.heat)) {
    const auto table = root.optional_section(boundaries.table);
    if (!table || boundaries.faces.empty()) continue;
    const auto sections = table->optional_sections("boundaries");
    for (std::size_t i = 0; i < std::min(sections.size(), boundaries.faces.size()); ++i)
      if (const std::string& part = boundaries.faces[i].part; std::ranges::find(names, part) == names.end())
        sections[i].error("faces",
                          fmt::format("must be one of {}; got \"{}\"", fmt::join(names, ", "), part));
  }
}

/// Records an error for a boundary on a plane of symmetry.
void check_symmetric_sides(const Section& root, const HeatConditions& heat,
                           const std::vector<PlaneOfSymmetry>& symmetry) {
  for (const auto& [table, flow, all_faces] : boundaries_of(heat))
    for (std::size_t i = 0; i < all_faces.size(); ++i) {
      const std::string& part = all_faces[i].part;
      const Section boundary = root.section(table).optional_sections("boundaries")[i];
      if (part == BoundaryFaces::kOutline && !symmetry.empty())
        boundary.error("faces",
                       fmt::format("\"outline\" has \"{}\", a plane of symmetry (specimen.symmetry), through "
                                   "which no {} flows: name the other sides, a boundary each",
                                   symmetry.front().side, flow));
      if (std::ranges::find(symmetry, part, &PlaneOfSymmetry::side) != symmetry.end())
        boundary.error(
            "faces",
            fmt::format("no {} flows through \"{}\", a plane of symmetry (specimen.symmetry)", flow, part));
    }
}

/// Warns of blocks that are coarser than any that were studied, or than a test heated under load allows
/// (docs/validation/block_size.md).
void warn_of_coarse_blocks(const Section& root, const Setup& setup) {
  const specimen::SpecimenParameters& s = setup.specimen;
  if (s.blocks.count == 0 || s.aggregates.fraction == 0.0 || !setup.moving) return;
  const double size = s.largest_block_size(), share = size / s.aggregates.d_max;
  const auto any = [&](auto is) { return std::ranges::any_of(setup.stages, is); };
  const bool is_heated_under_load =
      any([](const auto& stage) { return stage->held_stress() != 0.0; }) &&
      any([](const auto& stage) { return stage->heating().to || stage->heating().duration > 0.0; });
  const Section blocks = root.section("blocks");
  const char* const key = blocks.has("size") ? "size" : "count";
  if (share > kCoarsestStudied)
    blocks.warn(
        key, fmt::format("blocks of {:.3g} mm are {:.2f} of d_max, coarser than any that were studied ({})",
                         1e3 * size, share, kCoarsestStudied));
  else if (is_heated_under_load && share > kCoarsestHeated)
    blocks.warn(
        key,
        fmt::format(
            "blocks of {:.3g} mm are {:.2f} of d_max: above {} critical temperatures scatter by "
            "100 K and more from seed to seed{}",
            1e3 * size, share, kCoarsestHeated,
            s.blocks.finer.empty()
                ? fmt::format("; {:.0f} blocks are as fine as that, and strengths are calibrated "
                              "with as many",
                              std::ceil(s.blocks.count * std::pow(share / kCoarsestHeated, s.dimension())))
                : ""));
}

/// Tells whether a curve is a property other than expansion and creep that follows the temperature.
bool follows_temperature(const ReadCurve& read) {
  return !read.curve.is_constant() && !read.path.ends_with("expansion") &&
         !read.path.ends_with("thermal_strain") && !read.path.ends_with("creep.strain");
}

/// Warns of properties that come back on cooling.
void warn_of_healing(const Section& root, const Setup& setup) {
  if (!setup.moving || setup.moving->on_cooling == OnCooling::irreversible) return;
  if (std::ranges::none_of(setup.curves, follows_temperature)) return;
  double temperature = setup.heat.initial;
  for (std::size_t i = 0; i < setup.stages.size(); ++i) {
    const auto to = setup.stages[i]->heating().to;
    if (!to) continue;
    if (*to < temperature) {
      root.warn("stages", fmt::format("stage {} cools to {:.6g} degC: properties come back along their "
                                      "curves, but real concrete does not heal, so the remaining strength "
                                      "and stiffness is too high",
                                      i + 1, *to));
      return;
    }
    temperature = *to;
  }
}

/// Warns at a key, given by its full path, such as "output.references[0].file".
void warn_at(Section table, std::string_view path, std::string message) {
  for (auto dot = path.find('.'); dot != std::string_view::npos; dot = path.find('.')) {
    const std::string_view name = path.substr(0, dot);
    path.remove_prefix(dot + 1);
    const auto bracket = name.find('[');
    std::size_t number = 0;
    if (bracket != std::string_view::npos)
      std::from_chars(name.data() + bracket + 1, name.data() + name.size(), number);
    table = bracket == std::string_view::npos ? table.section(name)
                                              : table.optional_sections(name.substr(0, bracket)).at(number);
  }
  table.warn(path, std::move(message));
}

/// Warns of files that a run wrote that finds fault with its own numbers.
void warn_of_runs(const Deck& deck) {
  for (const DeckFile& named : deck.files()) {
    if (named.key.empty()) continue;
    if (const std::string verdict = verdict_on_run_of(named.file); !verdict.empty())
      warn_at(deck.root(), named.key, fmt::format("is of a run in doubt: {}", verdict));
  }
}

/// Returns the range of all temperatures to which a run may come, with the reference temperature, at which
/// masses and stated stiffnesses hold.
Interval run_temperatures(const Section& root, const HeatConditions& conditions,
                          const std::optional<StressFree>& stress_free,
                          const std::vector<std::unique_ptr<Stage>>& stages) {
  Interval t{std::min(kReferenceTemperature, conditions.initial),
             std::max(kReferenceTemperature, conditions.initial)};
  const auto include = [&](double low, double high) {
    t = {std::min(t.lower, low), std::max(t.upper, high)};
  };
  if (stress_free) include(stress_free->range().lower, stress_free->range().upper);
  const bool stages_are_known =
      std::ranges::all_of(root.sections("stages"), [](const Section& s) { return s.ok(); });
  if (!stages_are_known) return t;  // a value that stands in for an error asks nothing of curves
  for (const auto& stage : stages)
    if (const auto to = stage->heating().to) include(*to, *to);
  const auto heat_table = root.optional_section("heat");
  if (!conditions.uniform && heat_table && heat_table->ok()) {
    const Interval computed = temperature_range(conditions, exposure(stages));
    include(computed.lower, computed.upper);
  }
  return t;
}

/// Checks the contact laws' own conditions, at 20 °C and over the temperatures of the run. Records an error
/// at the key that the user can change.
void check_contacts(const Section& root, const Setup& setup) {
  const Section contacts = root.section("contacts");
  if (!root.ok()) return;
  const auto concrete = make_concrete(setup.block_materials, setup.moving->contacts,
                                      expected_block_size(setup.specimen, setup.moving->contacts));
  const auto check = [&](const ContactMaterial& contact, const std::string& key) {
    const auto [lower, upper] = setup.temperatures;
    double T = kReferenceTemperature, highest = T;
    const bool loses =
        std::ranges::any_of(contact.residual_ratios, [](const auto& r) { return r.has_value(); });
    try {
      validate(contact.at(T), key);
      for (int i = 0; i < kCheckedTemperatures; ++i) {
        T = highest = lower + i * (upper - lower) / (kCheckedTemperatures - 1);
        validate(contact.at(T), key);
        if (!loses || highest <= kReferenceTemperature) continue;
        T = kReferenceTemperature;
        validate(contact.at(T, highest), key);
      }
    } catch (const PropertyError& e) {
      const Section own = contacts.section(key);
      const std::string at =
          fmt::format("at {:.6g} degC{}", T, T < highest ? fmt::format(" after {:.6g} degC", highest) : "");
      if (own.has(e.key))
        own.error(e.key, fmt::format("{} it must be {}", at, e.wanted));
      else
        contacts.error(key, fmt::format("{}: {}", at, e.what()));
    } catch (const Error& e) {
      contacts.error(key, e.what());
    }
  };
  const std::size_t bearings = setup.moving->contacts.bearings.size();
  for (std::size_t i = 0; i + bearings < concrete.contacts.size(); ++i)
    check(concrete.contacts[i], concrete.interfaces[i]);
}

/// Records an error where a bearing is too thin: beside the specimen's coordinates, doubles would not hold
/// it.
void check_thickness(const Section& s, double thickness, const specimen::SpecimenParameters& specimen) {
  constexpr double kThinnest = 1e-9;  // over the size of the specimen
  const double least = kThinnest * std::pow(specimen.extent(), 1.0 / specimen.dimension());
  if (s.ok() && thickness < least)
    s.error("thickness", fmt::format("must be at least {:.2g} m beside this specimen", least));
}

/// Adds the platens. Returns false where the deck has none.
bool read_platens(const Section& root, const Setup& setup, std::vector<Bearing>& bearings) {
  const auto s =
      root.optional_section("platens", "two elastic blocks as wide as the specimen, under and above it");
  if (!s) {
    for (const auto& stage : setup.stages)
      if (stage->needs().press)
        root.error(fmt::format("a stage of kind \"{}\" needs the table [platens]", stage->kind()));
    return false;
  }
  const double thickness = s->quantity("thickness", unit::length, Range::positive(), "of each platen");
  check_thickness(*s, thickness, setup.specimen);
  const auto sides = specimen::names_of(setup.specimen.sides());
  const auto lacks = [&](const char* name) { return std::ranges::find(sides, name) == sides.end(); };
  for (const char* name : {"bottom", "top", "left", "right"})
    if (!is_cylinder(setup.specimen) && lacks(name)) {
      s->error(
          fmt::format("platens need a specimen with the sides bottom, top, left, right, such as a rectangle, "
                      "or a cylinder; this one has no side \"{}\"",
                      name));
      break;
    }
  bearings = platens(thickness);
  return true;
}

/// Returns what an error of a curve that ends too early says in the end: how the run may come to need less.
std::string cure_of_short_curve(const HeatConditions& heat, const Interval& needed, const Interval& given) {
  const bool begins_late =
      given.lower > std::max(needed.lower, std::min(kReferenceTemperature, heat.initial));
  if (begins_late) return "";
  if (heat.uniform) return fmt::format("; or heat to {:.6g} degC at most", given.upper);
  if (heat.temperature_range)
    return fmt::format("; or end heat.temperature_range at {:.6g} degC, if the specimen stays colder",
                       given.upper);
  return fmt::format(
      "; or state heat.temperature_range = [\"{:.6g} degC\", \"{:.6g} degC\"], if the specimen stays "
      "colder than the gas: `pyroclast check` then tells whether it does",
      needed.lower, given.upper);
}

/// Returns the materials of bearings and of bodies of their own, each once, in the order of the model.
std::vector<std::string> materials_of(const MovingBody& moving) {
  std::vector<std::string> names;
  const auto add = [&](const std::string& material) {
    if (std::ranges::find(names, material) == names.end()) names.push_back(material);
  };
  for (const Bearing& bearing : moving.bearings) add(bearing.material);
  for (const LooseBody& body : moving.bodies) add(body.material);
  return names;
}

/// Records an error for each body of its own whose name or material belongs to something else, and where
/// contacts are not found.
void check_bodies(const std::vector<ReadBody>& bodies, const std::vector<std::string>& phases,
                  const MovingBody& moving) {
  for (const ReadBody& read : bodies) {
    const Section& section = read.section;
    const LooseBody& body = read.body;
    if (!section.ok()) continue;
    if (std::ranges::find(phases, body.material) != phases.end())
      section.error("material", fmt::format("\"{}\" is a phase of the specimen; a body needs a material of "
                                            "its own",
                                            body.material));
    const auto has_name = [&](const auto& other) { return other.name == body.name; };
    if (std::ranges::any_of(moving.contacts.interfaces, has_name) ||
        std::ranges::any_of(moving.contacts.bearings, has_name) ||
        std::ranges::find(phases, body.name) != phases.end())
      section.error("name",
                    fmt::format("\"{}\" is the name of an interface, a bearing or a phase", body.name));
    if (!moving.mechanics.found.is_on)
      section.error("name", "a body meets others only with [mechanics] contacts = \"found\"");
  }
}

double read_thickness(const Section& s, const DeckSpace& space) {
  if (space.is_solid() && s.has("thickness"))
    s.error("thickness", space.depth
                             ? "has no meaning beside depth, which makes the specimen a solid: leave one out"
                             : "has no meaning here: a cylinder is a solid");
  return s.quantity("thickness", unit::length, Range::positive(), 1.0,
                    "out of plane; forces, energies and heats are for this thickness");
}

/// Reads the materials and all that moves, where a stage moves the body.
void read_moving(const Section& root, const DeckSpace& space, const std::vector<ReadBearing>& bearings,
                 const std::vector<ReadBody>& bodies, CurveReader& curves, const LawFinder& find_law,
                 Setup& setup) {
  const MaterialRules rules = read_material_rules(root);
  setup.expansion_reading = rules.expansion_reading;
  const auto phases = specimen::phases(setup.specimen);
  setup.moving.emplace();
  MovingBody& moving = *setup.moving;
  const bool has_platens = read_platens(root, setup, moving.bearings);
  for (const ReadBearing& read : bearings) {
    check_thickness(read.section, read.bearing.thickness, setup.specimen);
    const auto lies_there = [&](const Bearing& b) { return b.side == read.bearing.side; };
    if (has_platens && read.section.ok() && std::ranges::any_of(moving.bearings, lies_there))
      read.section.error(
          "side", fmt::format("a platen or another bearing lies on \"{}\" already", read.bearing.side));
    moving.bearings.push_back(read.bearing);
  }
  for (const ReadBody& read : bodies) moving.bodies.push_back(read.body);
  moving.velocities = read_velocities(root, space);
  moving.on_cooling = rules.on_cooling;
  const ReadConcrete concrete = read_concrete(root, phases, rules, curves);
  moving.strain_of_concrete = concrete.of_phases;
  setup.block_materials = read_block_materials(root, phases, materials_of(moving), rules, concrete, curves);
  moving.contacts = read_contacts(root, phases, specimen::phases_of_stones(setup.specimen),
                                  setup.specimen.matrix, has_platens, rules.on_cooling, find_law, curves);
  for (const ReadBearing& read : bearings) moving.contacts.bearings.push_back(read.interface);
  setup.moving->mechanics = read_mechanics(
      root.section("mechanics", "how the body moves; see [Motion](../understand/theory.md#motion)"), space);
  read_found(root.section("contacts"), moving.contacts, moving.mechanics.found);
  if ((moving.spalling = read_spalling(root, setup.stages))) moving.mechanics.loses_blocks = true;
  check_bodies(bodies, phases, moving);
  for (const ReadBody& read : bodies) moving.contacts.bearings.push_back(read.interface);
  if (setup.code_not_allowed.empty()) check_contacts(root, setup);
}

/// Reads the materials where only heat moves.
void read_resting(const Section& root, CurveReader& curves, Setup& setup) {
  setup.block_materials = read_conducting_materials(root, specimen::phases(setup.specimen), curves);
  root.know({"platens", "bearings", "bodies", "velocities", "contacts", "mechanics", "concrete", "spalling"});
}

}  // namespace

Setup read_setup(const Deck& deck, const std::filesystem::path& folder, const StageRegistry& kinds,
                 LawSources laws) {
  const Section root = deck.root();
  Setup setup;
  setup.title = root.text("title", "name of the run, for figures and summary");
  const DeckSpace space = read_space(root);
  laws.compiler.dimension = space.dimension();
  deck.finish_early();  // without a space, every place and every block would be a second error
  const std::vector<RecordParameters> records = read_records(root, space);
  auto read = read_stages(root, kinds, records, space, folder);
  setup.stages = std::move(read.stages);
  setup.stage_names = std::move(read.names);
  setup.exposure = exposure(setup.stages);
  CurveReader time_curves(folder, time_axis(), {0.0, setup.exposure}, fire_curves());
  if (auto heat = read_heat(root, time_curves, space)) setup.heat = std::move(*heat);
  check_heat(root, setup.heat, setup.stages);
  check_hand_over(root, setup.stages);
  if (root.ok()) check_flow(root, setup);
  setup.temperatures = run_temperatures(root, setup.heat, read.stress_free, setup.stages);
  const auto bearings = read.any_moves ? read_bearings(root, space) : std::vector<ReadBearing>();
  setup.sets = read_sets(root, space);
  setup.specimen = read_specimen(root, folder, space, setup.sets, bearings);
  setup.thickness = read_thickness(root.section("specimen"), space);
  if (setup.heat.uniform)
    root.know({"probes"});
  else
    setup.probes = read_probes(root, setup.specimen);
  CurveReader curves(folder, temperature_axis(), setup.temperatures, builtin_curves());
  curves.set_cure(
      [&](const Interval& given) { return cure_of_short_curve(setup.heat, setup.temperatures, given); });
  if (!setup.heat.uniform) setup.heat.cracks = read_crack_heat(root, curves);
  setup.heat.moisture =
      read_moisture(root, setup.specimen, space, setup.heat, read.any_moves, time_curves, curves);
  if (root.ok()) check_sides(root, setup);
  if (read.any_moves)
    read_moving(
        root, space, bearings, read_bodies(root, space, setup.specimen.block_size()), curves,
        [&](const std::string& name, bool named) -> const LawTable& {
          try {
            return find_law(name, folder, laws, laws.deck_names || (named && laws.changes_name));
          } catch (const CodeNotAllowed& error) {
            setup.code_not_allowed.emplace_back(error.what());
            throw;
          }
        },
        setup);
  else
    read_resting(root, curves, setup);
  const auto symmetry =
      read_symmetry(root, setup.specimen, setup.moving ? setup.moving->bearings : std::vector<Bearing>());
  if (root.ok()) check_symmetric_sides(root, setup.heat, symmetry);
  if (setup.moving) setup.moving->symmetry = symmetry;
  setup.records = records;
  if (setup.moving) setup.moving->stress_free = read.stress_free;
  setup.curves = curves.curves();
  if (setup.heat.moisture && root.ok())
    warn_of_free_evaporation(root, *setup.heat.moisture, setup.block_materials);
  warn_of_healing(root, setup);
  warn_of_first_strain(root, setup);
  if (root.ok()) warn_of_even_temperatures(root, setup);
  if (root.ok()) warn_of_coarse_blocks(root, setup);
  const Section output = root.section_or_none("output");
  setup.has_fields =
      output.flag("fields", true, "whether frames of the fields are written, for figures and ParaView");
  setup.checkpoints.interval =
      output.quantity("checkpoint", unit::time, Range::non_negative(), setup.checkpoints.interval,
                      "wall time between two checkpoints, from which `pyroclast resume` goes on; 0: after "
                      "every batch of steps");
  setup.checkpoints.keep_stages =
      output.flag("keep_stage_checkpoints", true,
                  "whether the state at the end of each stage is kept, for [forks](../do/restart.md#forks)");
  setup.unused_sets = unused_sets(setup);
  setup.unused_properties = unused_properties(root, setup);
  setup.references = read_references(output, folder, setup);
  deck.finish();
  warn_of_runs(deck);
  setup.warnings = deck.warnings();
  return setup;
}

void require_code(const Setup& setup) {
  const auto& refused = setup.code_not_allowed;
  if (!refused.empty()) throw CodeNotAllowed(fmt::format("{}", fmt::join(refused, "\n")), Code{});
}

DeckSchema deck_schema(const StageRegistry& kinds) {
  return survey_deck([&](const Deck& deck) { read_setup(deck, {}, kinds); });
}

std::unique_ptr<Simulation> make_simulation(const Setup& setup, std::shared_ptr<Team> team,
                                            std::shared_ptr<Ranks> ranks) {
  if (!team) team = std::make_shared<Team>();
  MadeSpecimen specimen = make_checked_specimen(setup.specimen, team.get(), !setup.heat.uniform);
  return make_simulation(setup, std::move(specimen), std::move(team), std::move(ranks));
}

std::unique_ptr<Simulation> make_simulation(const Setup& setup, MadeSpecimen specimen,
                                            std::shared_ptr<Team> team, std::shared_ptr<Ranks> ranks) {
  if (!team) team = std::make_shared<Team>();
  if (phases(specimen) != specimen::phases(setup.specimen))
    throw Error(fmt::format("the specimen's phases are {}, but the deck has {}",
                            fmt::join(phases(specimen), ", "),
                            fmt::join(specimen::phases(setup.specimen), ", ")));
  return std::make_unique<Simulation>(std::move(specimen), setup.thickness, setup.block_materials, setup.sets,
                                      setup.heat, setup.probes, setup.records, setup.moving, std::move(team),
                                      std::move(ranks));
}

std::unique_ptr<Simulation> make_simulation(const Setup& setup, SpecimenBody body, std::shared_ptr<Team> team,
                                            std::shared_ptr<Ranks> ranks) {
  if (setup.moving) body.model->symmetry = setup.moving->symmetry;
  if (const specimen::Region* region = setup.specimen.region()) body.notches = region->notches();
  return std::make_unique<Simulation>(std::move(body), setup.block_materials, setup.heat, setup.probes,
                                      setup.records, setup.moving, std::move(team), std::move(ranks));
}

double expected_block_size(const specimen::SpecimenParameters& specimen, const ContactParameters& contacts) {
  if (specimen.blocks.count == 0) return contacts.fracture_zone_size.value_or(1.0);
  return specimen.block_size();
}

}  // namespace pyroclast
