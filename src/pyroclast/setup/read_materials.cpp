#include "pyroclast/setup/read_materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/nearest.hpp"
#include "pyroclast/laws/registry.hpp"
#include "pyroclast/material/thermal_strain.hpp"
#include "pyroclast/plugin/code_permission.hpp"
#include "pyroclast/plugin/open_library.hpp"

namespace pyroclast {

namespace {

/// Range on which strains from a coefficient are defined, beside the range of the run: that of the fire
/// standards, °C.
constexpr Interval kStandardRange{20.0, 1200.0};

/// Largest free strain at the reference temperature that counts as none: the standards' own polynomials leave
/// 2e-7.
constexpr double kNoStrain = 1e-6;

constexpr Meaning kMaterialOfBearing = "the material of platens or other bearings, at 20 °C in every run";
constexpr Meaning kMaterialOfPhase = "a phase of the specimen; each phase has such a table";

/// Records an error unless the curve, where it is defined there, has this value at the reference temperature.
void require_at_reference(const Section& s, std::string_view key, const Curve& curve, double expected,
                          double tolerance) {
  if (!s.ok() || !curve.holds(kReferenceTemperature)) return;
  const double value = curve(kReferenceTemperature);
  if (std::abs(value - expected) <= tolerance) return;
  s.error(key,
          fmt::format("is {:.6g} at {} degC, but must be {} there", value, kReferenceTemperature, expected));
}

/// Objects to a curve that falls anywhere in the run's temperatures.
/// \param why  reason why it must not
void require_no_fall(const Section& s, std::string_view key, const Curve& curve, std::string_view why,
                     const CurveReader& curves) {
  const auto [lower, upper] = curves.needed();
  if (!s.ok() || !curve.holds(curves.needed())) return;
  if (const auto fall = curve.first_fall(lower, upper))
    s.error(key, fmt::format("falls from {:.6g} at {:.6g} degC to {:.6g} at {:.6g} degC: {}",
                             curve(fall->lower), fall->lower, curve(fall->upper), fall->upper, why));
}

Interval strain_range(const Interval& needed) {
  return {std::min(needed.lower, kStandardRange.lower), std::max(needed.upper, kStandardRange.upper)};
}

Curve read_thermal_strain(const Section& s, ExpansionReading reading, CurveReader& curves) {
  if (s.has("expansion")) {
    const Curve expansion = curves.read(s, "expansion", unit::expansion, Range::any().usually(-5e-5, 1e-4),
                                        "coefficient of thermal expansion; may be negative");
    if (s.has("thermal_strain"))
      s.error("thermal_strain", "has no meaning beside \"expansion\": give one of the two");
    if (!s.ok()) return Curve::constant(0.0);
    try {
      return free_thermal_strain(expansion, reading, strain_range(curves.needed()))
          .named(s.path() + ".thermal_strain");
    } catch (const Error& error) {
      s.error("expansion", error.what());
      return Curve::constant(0.0);
    }
  }
  const Curve strain = curves.read(s, "thermal_strain", unit::dimensionless, Range::any(), 0.0,
                                   "free thermal strain since 20 °C, instead of expansion");
  require_at_reference(s, "thermal_strain", strain, 0.0, kNoStrain);
  return strain;
}

/// Reads the share of a property that is left after cooling; returns none where the deck does not state it.
std::optional<Curve> read_residual_ratio(const Section& s, OnCooling on_cooling, Meaning meaning,
                                         CurveReader& curves) {
  constexpr const char* kKey = "residual_ratio";
  if (!s.has(kKey)) return std::nullopt;
  const Curve ratio = curves.read(s, kKey, unit::dimensionless,
                                  Range{.lower = 0.0, .upper = 1.0, .lower_inclusive = false}, meaning);
  require_at_reference(s, kKey, ratio, 1.0, kRatioTolerance);
  if (on_cooling == OnCooling::reversible)
    s.error(
        kKey,
        "has no meaning with materials.on_cooling = \"reversible\": properties then come back along their "
        "curves");
  return ratio;
}

/// Reads the step of quartz; returns none where the deck has none, or after an error.
std::optional<QuartzStep> read_quartz_step(const Section& s, const ReadConcrete& concrete) {
  if (!s.has("quartz_step")) {
    s.know({"quartz_range"});
    return std::nullopt;
  }
  QuartzStep step;
  step.strain = s.number("quartz_step", Range::between(0.0, 0.02).usually(0.003, 0.0045),
                         "linear strain that quartz in the phase adds to its own expansion or thermal_strain "
                         "where the quartz turns into its other form, near 573 °C");
  if (s.has("quartz_range")) {
    const auto ends = s.quantities("quartz_range", unit::temperature, Range::at_least(kReferenceTemperature),
                                   "where the step begins and where it ends; 550 and 600 °C unless stated");
    if (ends.size() == 2 && ends[0] < ends[1])
      step.over = {ends[0], ends[1]};
    else if (!ends.empty())
      s.error("quartz_range", "must be two temperatures, the first below the second");
  }
  if (concrete.of_phases)
    s.error(
        "quartz_step",
        fmt::format("has no meaning beside concrete.inclusion_ratio: the strain of the phase follows from "
                    "that of the concrete, which holds the step already ({})",
                    concrete.place));
  else if (!s.has("expansion") && !s.has("thermal_strain"))
    s.error("quartz_step", "comes to the strain of the phase: give its expansion or thermal_strain too");
  return s.ok() ? std::optional(step) : std::nullopt;
}

/// Reads the density, and the conductivity and specific heat where they are given.
BlockMaterial read_heat_properties(const Section& s, CurveReader& curves) {
  const auto optional = [&](std::string_view key, const Unit& unit, const Range& range,
                            Meaning meaning) -> std::optional<Curve> {
    if (!s.has(key)) return std::nullopt;
    return curves.read(s, key, unit, range, meaning);
  };
  BlockMaterial m;
  m.name = s.path().substr(s.path().rfind('.') + 1);
  m.density = curves.read(s, "density", unit::density, Range::positive().usually(500.0, 20e3),
                          "masses are those at 20 °C; heat conduction follows the curve");
  m.conductivity = optional("conductivity", unit::conductivity, Range::positive().usually(0.02, 500.0),
                            "thermal conductivity; heat conduction needs one for every phase");
  m.specific_heat = optional("specific_heat", unit::specific_heat, Range::positive().usually(100.0, 2e4),
                             "heat conduction needs one for every phase");
  return m;
}

BlockMaterial read_block_material(const Section& s, CurveReader& curves) {
  BlockMaterial m = read_heat_properties(s, curves);
  m.young = curves.read(s, "E", unit::stress, Range::positive().usually(1e9, 500e9), "Young's modulus");
  m.poisson = s.number("nu", Range::inside(-1.0, 0.5).usually(0.0, 0.45), "Poisson's ratio");
  return m;
}

/// Returns B of Anderberg and Thelandersson 1976: `k2` times the free strain of the concrete; beyond the end
/// of that law B grows by a strain per kelvin.
Curve anderberg_thelandersson(double k2, const Curve& free_strain) {
  constexpr double kEnd = 550.0, kSlopeBeyond = 1e-4;
  return Curve::function(
      fmt::format("{} times the free strain of the concrete to {} degC, then {} 1/K", k2, kEnd, kSlopeBeyond),
      [=](double T) { return k2 * free_strain(std::min(T, kEnd)) + kSlopeBeyond * std::max(T - kEnd, 0.0); },
      free_strain.range(), temperature_axis(), {kEnd});
}

/// Reads B, as a curve or by k2.
Curve read_creep_strain(const Section& s, const ReadConcrete& concrete, CurveReader& curves) {
  constexpr Meaning kStrain = "B: strain since 20 °C for each unit of stress over f_c, both in compression";
  if (!s.has("k2")) return curves.read(s, "strain", unit::dimensionless, Range::non_negative(), kStrain);
  const double k2 = s.number("k2", Range::positive().usually(1.5, 2.5),
                             "instead of strain: B is this times the thermal strain of [concrete] to 550 °C, "
                             "and grows by 1e-4 1/K beyond (Anderberg and Thelandersson 1976)");
  if (s.has("strain")) s.error("strain", "has no meaning beside \"k2\": give one of the two");
  if (!concrete.thermal_strain || concrete.thermal_strain->is_constant()) {
    if (concrete.is_readable)
      s.error("k2", "needs the thermal strain of the concrete: thermal_strain or expansion in [concrete]");
    return Curve::constant(0.0);
  }
  return anderberg_thelandersson(k2, *concrete.thermal_strain);
}

std::optional<CreepMaterial> read_creep(const Section& phase, const ReadConcrete& concrete,
                                        CurveReader& curves) {
  const auto s = phase.optional_section(
      "creep",
      "load-induced thermal strain (transient creep): shortening of the phase under stress on its first "
      "heating; see [Creep under load](../understand/deck.md#creep-under-load)");
  if (!s) return std::nullopt;
  CreepMaterial m;
  m.strain = read_creep_strain(*s, concrete, curves);
  const char* const key = s->has("k2") ? "k2" : "strain";
  if (s->ok()) {
    require_at_reference(*s, key, m.strain, 0.0, kNoStrain);
    require_no_fall(*s, key, m.strain, "creep never goes back, so B may stay or rise, but not fall", curves);
  }
  m.level = s->choice<CreepLevel>(
      "of",
      {{"concrete", CreepLevel::concrete,
        "B holds for the concrete as a whole; the phase, its matrix, creeps more by 1 / R"},
       {"phase", CreepLevel::phase, "B holds for this phase"}},
      CreepLevel::concrete, "material to which B belongs");
  if (m.level == CreepLevel::phase)
    s->know({"share"});
  else if (s->has("share"))
    m.share =
        s->number("share", Range{.lower = 0.0, .upper = 1.0, .lower_inclusive = false},
                  "R: creep of the concrete over creep of its matrix; by default from the specimen's share "
                  "of inclusions, by the self-consistent scheme");
  m.strength = s->quantity("f_c", unit::stress, Range::positive().usually(1e6, 200e6), 35e6,
                           "strength of the concrete at 20 °C that B counts stresses by");
  m.choices.poisson = s->number("nu", Range{.lower = -1.0, .upper = 0.5, .lower_inclusive = false}, 0.3,
                                "Poisson's ratio of the creep, ν_L");
  m.choices.tension = s->number("tension", Range::between(0.0, 1.0), 1.0,
                                "χ_t: creep under tension over that under as much compression");
  m.choices.confinement =
      s->number("confinement", Range::non_negative().usually(0.0, 2.0), 0.0,
                "γ: creep is 1 + (C − 1) γ times as much, C = 1 with one compressive stress, "
                "√2 with two and √3 with three equal ones (Torelli and others 2018)");
  return m;
}

/// Reads a phase of the specimen, not a material of bearings.
BlockMaterial read_phase(const Section& s, const MaterialRules& rules, const ReadConcrete& concrete,
                         CurveReader& curves) {
  BlockMaterial m = read_block_material(s, curves);
  m.residual_ratio = read_residual_ratio(
      s, rules.on_cooling,
      "share of E at T_max, the highest temperature so far, that is left at 20 °C: a curve of T_max, "
      "1 at 20 °C; E falls to it evenly on cooling; see [Cooling](../understand/deck.md#cooling)",
      curves);
  m.thermal_strain = read_thermal_strain(s, rules.expansion_reading, curves);
  m.quartz_step = read_quartz_step(s, concrete);
  if (m.quartz_step)
    m.thermal_strain = with_quartz_step(m.thermal_strain, *m.quartz_step, strain_range(curves.needed()))
                           .named(s.path() + ".thermal_strain");
  for (const char* key : {"expansion", "thermal_strain"})
    if (concrete.of_phases && s.has(key))
      s.error(key, "has no meaning beside concrete.inclusion_ratio, from which it follows");
  if (s.has("contraction"))
    m.contraction =
        s.quantity("contraction", unit::expansion, Range::any().usually(0.0, 3e-5),
                   "expansion coefficient below the highest temperature so far, T_max: free strain is then "
                   "its value at T_max − contraction (T_max − T); without this key free strain goes back "
                   "along its curve; see [Cooling](../understand/deck.md#cooling)");
  m.creep = read_creep(s, concrete, curves);
  return m;
}

BlockMaterial read_conducting_material(const Section& s, CurveReader& curves) {
  s.know({"E", "nu", "expansion", "thermal_strain", "quartz_step", "quartz_range", "contraction",
          "residual_ratio", "creep"});
  return read_heat_properties(s, curves);
}

std::optional<Curve> read_temperature_ratio(const Section& s, CurveReader& curves) {
  if (!s.has("temperature_ratio")) return std::nullopt;
  const Curve ratio =
      curves.read(s, "temperature_ratio", unit::dimensionless, Range::positive(),
                  "multiplies the strengths and fracture energies that are plain constants; 1 at 20 °C");
  require_at_reference(s, "temperature_ratio", ratio, 1.0, kRatioTolerance);
  return ratio;
}

/// Reads a number of a law that follows the temperature. A stiffness is none: it comes from the blocks.
Curve read_property(const Section& s, const PropertyInfo& info, const std::optional<Curve>& ratio,
                    bool& ratio_has_effect, CurveReader& curves) {
  const Curve curve = curves.read(s, info.key, info.unit, info.range, Meaning(info.meaning));
  const bool scales = info.role == Role::strength || is_energy(info.role);
  if (info.role == Role::hidden_cracks) {
    require_at_reference(s, info.key, curve, 0.0, kNoStrain);
    require_no_fall(s, info.key, curve, "these cracks only grow as the contact gets hotter", curves);
  }
  if (!ratio || !scales || !curve.is_constant()) return curve;
  ratio_has_effect = true;
  return (curve * *ratio).named(s.path() + "." + info.key);
}

/// Reads one residual ratio for all strengths and fracture energies, whether they are constants or curves.
void read_residual_ratios(const Section& s, OnCooling on_cooling, ContactMaterial& m, CurveReader& curves) {
  const auto ratio =
      read_residual_ratio(s, on_cooling,
                          "share of strengths and fracture energies at T_max, the highest temperature so "
                          "far, that is left at 20 °C: a curve of T_max, 1 at 20 °C; they fall to it "
                          "evenly on cooling; see [Cooling](../understand/deck.md#cooling)",
                          curves);
  if (!ratio) return;
  bool has_effect = false;
  for (std::size_t i = 0; i < m.numbers.size(); ++i) {
    const Role role = m.law->properties[i].role;
    if (role != Role::strength && !is_energy(role)) continue;
    m.residual_ratios[i] = ratio;
    has_effect = true;
  }
  if (!has_effect)
    s.error(
        "residual_ratio",
        fmt::format("has no effect: the law \"{}\" has neither strength nor fracture energy", m.law->name));
}

int read_choice(const Section& s, const ChoiceInfo& info) {
  if (info.options[0].name == std::string_view("false"))
    return s.flag(info.key, false, Meaning(info.meaning)) ? 1 : 0;
  std::vector<Choice<int>> options;
  for (int i = 0; i < ChoiceInfo::kMostOptions && info.options[i].name; ++i)
    options.push_back({info.options[i].name, i, Meaning(info.options[i].meaning)});
  return s.choice_or_first(info.key, options, Meaning(info.meaning));
}

bool is_stiffness(const PropertyInfo& info) {
  return info.role == Role::normal_stiffness || info.role == Role::shear_stiffness;
}

/// Reads numbers and choices of a law. Those that an interface does not state are taken from `like`, where it
/// has one.
/// \param shared  table whose choices hold where the interface states none and has no `like`
ContactMaterial read_contact(const Section& s, const LawTable& law, const Section& shared,
                             OnCooling on_cooling, const std::optional<ContactMaterial>& like,
                             CurveReader& curves) {
  const std::optional<Curve> ratio = read_temperature_ratio(s, curves);
  bool ratio_has_effect = false, new_strength = false;
  ContactMaterial m = like.value_or(ContactMaterial(law));
  for (std::size_t i = 0; i < law.properties.size(); ++i) {
    const PropertyInfo& info = law.properties[i];
    if (is_stiffness(info) || info.of_option) continue;
    const bool may_lack = like || info.role == Role::cold_strength;
    if (!may_lack || s.has(info.key)) {
      m.numbers[i] = read_property(s, info, ratio, ratio_has_effect, curves);
      new_strength = new_strength || info.role == Role::strength;
    } else if (info.role == Role::cold_strength && new_strength) {
      const Curve& strength = m.of(Role::strength);  // the contact's first one
      m.numbers[i] =
          Curve::constant(strength.holds(kReferenceTemperature) ? strength(kReferenceTemperature) : 0.0);
    }
  }
  if (ratio && !ratio_has_effect)
    s.error("temperature_ratio", "has no effect: no property of this contact is a plain constant");
  read_residual_ratios(s, on_cooling, m, curves);
  for (std::size_t i = 0; i < law.choices.size(); ++i) {
    const char* const key = law.choices[i].key;
    if (s.has(key))
      m.choices[i] = read_choice(s, law.choices[i]);
    else if (!like)
      m.choices[i] = read_choice(shared, law.choices[i]);
  }
  for (std::size_t i = 0; i < law.properties.size(); ++i) {
    const PropertyInfo& info = law.properties[i];
    if (!info.of_option) continue;
    if (!m.has(info)) {
      s.know({info.key});
      if (s.has(info.key))
        s.error(info.key, fmt::format("has no meaning here: it belongs to \"{}\"", info.of_option));
      m.numbers[i] = Curve::constant(1.0);
    } else if (s.has(info.key) || !like || !like->has(info)) {
      m.numbers[i] = read_property(s, info, {}, ratio_has_effect, curves);
    }
  }
  return m;
}

constexpr const char* kBetweenStones = "between_stones";

/// Returns the two phases that the name of an interface, `a_b`, joins; empty where it names no two phases.
std::vector<std::array<std::string, 2>> pair_in_name(const std::string& name,
                                                     const std::vector<std::string>& phases) {
  for (const auto& a : phases)
    for (const auto& b : phases)
      if (name == a + "_" + b) return {{a, b}};
  return {};
}

/// Reads the phases of which an interface joins two stones.
std::vector<std::string> read_between_stones(const Section& s, const std::vector<std::string>& of_stones) {
  auto list =
      s.optional_texts(kBetweenStones,
                       "phases such as aggregate: these contacts also join two stones of a phase where "
                       "their blocks touch, else such stones hold together as one; see [Stones that "
                       "touch](../do/grading.md#stones-that-touch)");
  if (!s.ok() || !s.has(kBetweenStones)) return {};
  for (const auto& phase : list)
    if (std::ranges::find(of_stones, phase) == of_stones.end())
      s.error(kBetweenStones, of_stones.empty()
                                  ? "has no meaning here: which block belongs to which stone is not known; "
                                    "leave it out, or state []"
                                  : fmt::format("\"{}\" is no phase of stones; such phases are {}", phase,
                                                quoted_list(of_stones)));
  return list;
}

/// Reads the pairs of phases that an interface joins: names that follow one another two and two. There may be
/// none where the interface joins stones.
std::vector<std::array<std::string, 2>> read_between(const Section& s, const std::string& name,
                                                     const std::vector<std::string>& phases,
                                                     bool joins_stones) {
  const auto list = s.optional_texts("between",
                                     "the two phases whose blocks these contacts join, or several pairs in a "
                                     "row: a, b, c, d; without this key the two in the table's name, a_b");
  if (!s.ok()) return {};
  if (!s.has("between")) {
    auto pair = pair_in_name(name, phases);
    if (pair.empty() && !joins_stones)
      s.error(
          fmt::format("names no two phases of the specimen, as a_b, and has no \"between\"; phases are {}",
                      quoted_list(phases)));
    return pair;
  }
  std::vector<std::array<std::string, 2>> pairs;
  for (std::size_t i = 0; i + 1 < list.size(); i += 2) pairs.push_back({list[i], list[i + 1]});
  if (list.empty() || list.size() % 2 == 1) s.error("between", "must name two phases, or pairs of them");
  for (const auto& phase : list)
    if (std::ranges::find(phases, phase) == phases.end())
      s.error("between",
              fmt::format("\"{}\" is no phase of the specimen; phases are {}", phase, quoted_list(phases)));
  return pairs;
}

/// Adds an error for each choice of a built-in law that [contacts] states for interfaces whose laws lack it.
void refuse_choices_of_no_law(const Section& s, const std::vector<InterfaceParameters>& interfaces) {
  const auto has = [](const LawTable& law, std::string_view key) {
    return std::ranges::any_of(law.choices, [key](const ChoiceInfo& info) { return info.key == key; });
  };
  std::vector<std::string_view> refused;
  for (const LawTable* const law : built_in_laws())
    for (const ChoiceInfo& info : law->choices) {
      const std::string_view key = info.key;
      if (!s.has(info.key) || std::ranges::find(refused, key) != refused.end() ||
          std::ranges::any_of(interfaces, [&](const auto& i) { return has(*i.contact.law, key); }))
        continue;
      refused.push_back(key);
      s.know({info.key});
      s.error(info.key,
              fmt::format("has no meaning here: it is a choice of the law \"{}\", which no interface "
                          "of this deck has; leave it out",
                          law->name));
    }
}

/// Reader of the interfaces, which are tables of [contacts].
class InterfaceReader {
 public:
  InterfaceReader(const Section& shared, const std::vector<std::string>& phases,
                  const std::vector<std::string>& of_stones, OnCooling on_cooling, const LawFinder& find_law,
                  CurveReader& curves)
      : shared_(shared),
        sections_(shared.named_sections("NAME", "contacts between the blocks of two phases (Table 2)")),
        phases_(phases),
        of_stones_(of_stones),
        on_cooling_(on_cooling),
        find_law_(find_law),
        curves_(curves) {
    std::erase_if(sections_, [](const auto& section) { return section.first == kFoundTable; });
  }

  /// Reads all interfaces. An interface comes before those that are like it.
  std::vector<InterfaceParameters> read() {
    for (const auto& [name, section] : sections_) find(name);
    return std::move(read_);
  }

  const std::vector<std::pair<std::string, Section>>& sections() const { return sections_; }

 private:
  /// Finds the interface of that name and reads it if it was not read yet. Returns null if there is none, or
  /// while it is being read.
  const InterfaceParameters* find(const std::string& name) {
    const auto known = std::ranges::find(read_, name, &InterfaceParameters::name);
    if (known != read_.end()) return &*known;
    const auto stated = std::ranges::find(sections_, name, &std::pair<std::string, Section>::first);
    if (stated == sections_.end() || std::ranges::find(begun_, name) != begun_.end()) return nullptr;
    begun_.push_back(name);
    InterfaceParameters interface = read_interface(stated->second, name);
    read_.push_back(std::move(interface));
    return &read_.back();
  }

  InterfaceParameters read_interface(const Section& s, const std::string& name) {
    InterfaceParameters p;
    p.name = name;
    p.between_stones = read_between_stones(s, of_stones_);
    p.between = read_between(s, name, phases_, !p.between_stones.empty());
    std::optional<ContactMaterial> base;
    if (s.has("like")) base = read_like(s, p);
    const LawTable& law = base ? *base->law : read_law(s);
    if (base)
      s.know({"law"});
    else
      s.know({"stiffness_factor", "strength_factor", "scale_fracture_energy"});
    p.contact = read_contact(s, law, shared_, on_cooling_, base, curves_);
    for (const PropertyInfo& info : law.properties) {
      if (!is_stiffness(info) || !s.has(info.key)) continue;
      const double value = s.quantity(
          info.key, info.unit, info.range,
          Meaning(info.role == Role::normal_stiffness ? "normal stiffness at 20 °C and at t_b_block_size"
                                                      : "shear stiffness at 20 °C and at t_b_block_size"));
      (info.role == Role::normal_stiffness ? p.normal_stiffness : p.shear_stiffness) = value;
    }
    return p;
  }

  /// Reads the contact of the interface that this one is like, times the factors. Returns a contact of the
  /// first built-in law after an error.
  std::optional<ContactMaterial> read_like(const Section& s, InterfaceParameters& p) {
    p.like = s.text("like", "interface that gives the law and all that is not stated, times the factors");
    p.stiffness_factor = s.number("stiffness_factor", Range::positive(), 1.0, "of K_n and K_s");
    const double strength = s.number("strength_factor", Range::positive(), 1.0, "of strengths and cohesions");
    const bool energy =
        s.flag("scale_fracture_energy", false, "whether strength_factor acts on fracture energies too");
    const InterfaceParameters* other = find(*p.like);
    if (!other) {
      s.error("like",
              fmt::format("must be another interface that is not like this one; got \"{}\"", *p.like));
      return ContactMaterial(*built_in_laws().front());
    }
    if (s.has("law"))
      s.error("law", fmt::format("has no meaning beside \"like\": the law is that of {}", *p.like));
    return other->contact.times(Role::strength, strength)
        .times(Role::cold_strength, strength)
        .times(Role::energy, energy ? strength : 1.0)
        .times(Role::sliding_energy, energy ? strength : 1.0);
  }

  const LawTable& read_law(const Section& s) {
    std::vector<Choice<int>> words;
    for (const LawTable* law : built_in_laws())
      words.push_back({law->name, static_cast<int>(words.size()), Meaning(law->meaning)});
    const std::string stated =
        s.word_or_text("law", words, "a law of your own, see [Contact laws](laws.md)", "contact law");
    s.take_keys_of_code("law");
    try {
      const LawTable& law = find_law_(stated, s.is_changed("law"));
      for (const OpenedLaw* opened : opened_laws())
        if (&opened->table == &law)
          name_files(s, opened->headers.empty() ? std::vector{opened->shared_object} : opened->headers,
                     stated);
      return law;
    } catch (const CodeNotAllowed& error) {
      name_files(s, error.code().files, stated);
      s.leave_open();
      return unknown_law();
    } catch (const Error& error) {
      s.error("law", error.what());
      s.leave_open();
      return *built_in_laws().front();
    }
  }

  /// Returns a law that stands in for one that may not run: no key is its own.
  static const LawTable& unknown_law() {
    static const LawTable law = [] {
      LawTable table = *built_in_laws().front();
      table.name = "unknown";
      table.properties = {};
      table.choices = {};
      return table;
    }();
    return law;
  }

  /// Names the files of a law that is not part of the program. The first is mine.so, or mine.hpp with or
  /// without ":Type"; the others are the files that mine.hpp includes.
  static void name_files(const Section& s, const std::vector<std::filesystem::path>& files,
                         const std::string& stated) {
    const std::string name = files.front().filename().string();
    const auto begin = stated.rfind(name);
    const bool is_named = begin != std::string::npos;  // "mine" stands for mine.so
    s.names_file("law", files.front(), is_named ? stated.substr(begin + name.size()) : "");
    for (auto included = files.begin() + 1; included != files.end(); ++included)
      s.needs_file(included->lexically_normal());
  }

  const Section& shared_;
  std::vector<std::pair<std::string, Section>> sections_;
  const std::vector<std::string>& phases_;
  const std::vector<std::string>& of_stones_;
  OnCooling on_cooling_;
  const LawFinder& find_law_;
  CurveReader& curves_;
  std::vector<std::string> begun_;
  std::vector<InterfaceParameters> read_;
};

/// Records an error where two interfaces join one pair of phases, or two stones of one phase.
void check_pairs(const std::vector<std::pair<std::string, Section>>& sections,
                 const std::vector<InterfaceParameters>& interfaces) {
  std::map<std::array<std::string, 2>, std::string> taken;
  std::map<std::string, std::string> taken_of_stones;
  for (const InterfaceParameters& interface : interfaces) {
    const auto& section =
        std::ranges::find(sections, interface.name, &std::pair<std::string, Section>::first)->second;
    for (std::array<std::string, 2> pair : interface.between) {
      std::ranges::sort(pair);
      if (const auto [known, is_new] = taken.emplace(pair, interface.name); !is_new)
        section.error("between",
                      fmt::format("{} and {} are joined by {} already", pair[0], pair[1], known->second));
    }
    for (const std::string& phase : interface.between_stones)
      if (const auto [known, is_new] = taken_of_stones.emplace(phase, interface.name); !is_new)
        section.error(kBetweenStones,
                      fmt::format("stones of {} are joined by {} already", phase, known->second));
  }
}

/// Records an error for every two phases that may meet and have no interface, and for a matrix that has none
/// with itself.
void check_complete(const Section& s, const std::vector<InterfaceParameters>& interfaces,
                    const std::vector<std::string>& phases, const std::string& matrix) {
  if (!s.ok()) return;
  const auto has = [&](const std::string& a, const std::string& b) {
    return std::ranges::any_of(interfaces, [&](const InterfaceParameters& interface) {
      return std::ranges::any_of(interface.between, [&](const auto& pair) {
        return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
      });
    });
  };
  for (std::size_t i = 0; i < phases.size(); ++i)
    for (std::size_t j = i; j < phases.size(); ++j)
      if ((i != j || phases[i] == matrix) && !has(phases[i], phases[j]))
        s.error(
            fmt::format("no interface is between {} and {}: [contacts.{}_{}] is needed, or another with "
                        "between = [\"{}\", \"{}\"]",
                        phases[i], phases[j], phases[i], phases[j], phases[i], phases[j]));
}

}  // namespace

MaterialRules read_material_rules(const Section& root) {
  const Section s = root.section("materials", "phases and bearings of the body");
  return {
      s.choice<ExpansionReading>(
          "expansion_reading",
          {{"secant", ExpansionReading::secant, "thermal strain is α(T) (T − 20 °C)"},
           {"tangent", ExpansionReading::tangent, "thermal strain is ∫ α dT from 20 °C"}},
          ExpansionReading::secant, "how the coefficients of thermal expansion α are read"),
      s.choice<OnCooling>("on_cooling",
                          {{"irreversible", OnCooling::irreversible,
                            "they stay as at the highest temperature so far: concrete does not heal"},
                           {"reversible", OnCooling::reversible, "they come back along their curves"}},
                          OnCooling::irreversible,
                          "change of E, strengths, fracture energies and stiffnesses where the body cools")};
}

ReadConcrete read_concrete(const Section& root, const std::vector<std::string>& phases,
                           const MaterialRules& rules, CurveReader& curves) {
  ReadConcrete concrete;
  const auto s = root.optional_section("concrete",
                                       "strains of the concrete as a whole; see [Creep under "
                                       "load](../understand/deck.md#creep-under-load)");
  if (!s) return concrete;
  concrete.thermal_strain = read_thermal_strain(*s, rules.expansion_reading, curves);
  concrete.is_readable = s->ok();
  const char* const key = s->has("expansion") ? "expansion" : "thermal_strain";
  concrete.place = fmt::format("{}: concrete.{}", s->where(key), key);
  if (!s->has("inclusion_ratio")) {
    s->know({"inclusion_weight"});
    return concrete;
  }
  StrainOfConcrete& strain = concrete.of_phases.emplace();
  strain.strain = *concrete.thermal_strain;
  strain.ratio = s->number("inclusion_ratio", Range::positive().usually(1.0, 1.6),
                           "κ: thermal strain of the inclusions over thermal strain of the concrete; the "
                           "matrix gets the strain that "
                           "gives the concrete's, and neither is stated in [materials]");
  if (s->has("inclusion_weight"))
    strain.weight = s->number("inclusion_weight", Range::inside(0.0, 1.0),
                              "weight w of the inclusions in the strain of the concrete; without this key "
                              "from the specimen's share of inclusions, by Mori and Tanaka, and Levin");
  if (phases.size() > 2)
    s->error("inclusion_ratio",
             fmt::format("is for a matrix and one kind of inclusions, but the phases are {}",
                         quoted_list(phases)));
  return concrete;
}

std::vector<BlockMaterial> read_block_materials(const Section& root, const std::vector<std::string>& phases,
                                                const std::vector<std::string>& of_bearings,
                                                const MaterialRules& rules, const ReadConcrete& concrete,
                                                CurveReader& curves) {
  const Section s = root.section("materials");
  s.take_names_of_deck();
  std::vector<BlockMaterial> block_materials;
  for (const auto& phase : phases)
    block_materials.push_back(read_phase(s.section(phase, kMaterialOfPhase), rules, concrete, curves));
  for (const auto& name : of_bearings) {
    const Section own = s.section(name, kMaterialOfBearing);
    block_materials.push_back(read_block_material(own, curves));
    block_materials.back().thermal_strain = read_thermal_strain(own, rules.expansion_reading, curves);
    block_materials.back().is_of_bearing = true;
  }
  s.know({"platen"});
  return block_materials;
}

std::vector<BlockMaterial> read_conducting_materials(const Section& root,
                                                     const std::vector<std::string>& phases,
                                                     CurveReader& curves) {
  const Section s = root.section("materials");
  s.take_names_of_deck();
  s.know({"expansion_reading", "on_cooling", "platen"});
  std::vector<BlockMaterial> block_materials;
  for (const auto& phase : phases)
    block_materials.push_back(read_conducting_material(s.section(phase, kMaterialOfPhase), curves));
  return block_materials;
}

ContactParameters read_contacts(const Section& root, const std::vector<std::string>& phases,
                                const std::vector<std::string>& of_stones, const std::string& matrix,
                                bool has_platens, OnCooling on_cooling, const LawFinder& find_law,
                                CurveReader& curves) {
  const Section s = root.section("contacts", "all contacts: K_n = E / t_b, K_s = G / t_b, Eq. (17)");
  ContactParameters c;
  c.matrix = matrix;
  c.fracture_zone = s.quantity("t_b", unit::length, Range::positive().usually(1e-5, 0.05),
                               "thickness of the fracture zone, t_b");
  const bool scales = s.choice<bool>(
      "t_b_scaling",
      {{"block size", true,
        "t_b scales with the block size, and stated stiffnesses with 1 / block size, so that E changes "
        "little with the number of blocks, see [Block size](../validation/block_size.md)"},
       {"fixed", false, "t_b is the same for any block size"}},
      "whether t_b depends on the block size");
  if (scales)
    c.fracture_zone_size =
        s.quantity("t_b_block_size", unit::length, Range::positive(),
                   "block size √(area / count), of a solid ∛(volume / count), at which t_b and "
                   "stated stiffnesses hold");
  const bool keeps_slope =
      scales &&
      s.choice<bool>(
          "second_slope",
          {{"with K_n", false,
            "beta is the same at any block size: finer blocks yield along a steeper slope"},
           {"fixed", true,
            "beta holds at t_b_block_size and goes with the block size, so that beta K_n is the same, see "
            "[f_c over the number of blocks](../validation/grains.md#f_c-over-the-number-of-blocks)"}},
          false, "whether the slope of contacts beyond f_cm, beta K_n, depends on the block size");
  const bool slides_by_volume =
      scales &&
      s.choice<bool>(
          "mode_2_energy",
          {{"as stated", false, "G_f2 is the same at any block size: finer blocks lose more by sliding"},
           {"block size", true,
            "G_f2 holds at t_b_block_size and goes with the block size, so that sliding loses as much per "
            "volume, see [One concrete](../validation/one_concrete.md)"}},
          false, "whether the mode II fracture energy of contacts depends on the block size");
  const bool tears_by_volume =
      scales &&
      s.choice<bool>("mode_1_slope",
                     {{"as stated", false, "softening in tension is the same at any block size"},
                      {"block size", true,
                       "initial_share holds at t_b_block_size and goes with the block size, at most 1: "
                       "contacts begin to soften over a strain, and a tail keeps G_f1, see [One "
                       "concrete](../validation/one_concrete.md)"}},
                     false, "whether the first slope of softening in tension depends on the block size");
  if (!scales) s.know({"second_slope", "mode_2_energy", "mode_1_slope"});
  if (has_platens)
    c.bearings.push_back({.name = "platen",
                          .friction = s.number("platen_friction", Range::non_negative().usually(0.0, 1.0),
                                               "coefficient of friction between platen and specimen")});
  else
    s.know({"platen_friction"});
  InterfaceReader reader(s, phases, of_stones, on_cooling, find_law, curves);
  c.interfaces = reader.read();
  refuse_choices_of_no_law(s, c.interfaces);
  const auto go_with_size = [&](bool stated, const char* key, Role role, const char* lacking) {
    if (!stated) return;
    const auto has_one = [role](const InterfaceParameters& interface) {
      const ContactMaterial& contact = interface.contact;
      return std::ranges::any_of(contact.law->properties, [&](const PropertyInfo& info) {
        return info.role == role && contact.has(info);
      });
    };
    if (std::ranges::none_of(c.interfaces, has_one))
      s.error(key, fmt::format("has no meaning here: no contact law of these interfaces has {}", lacking));
    c.with_size.push_back(role);
  };
  go_with_size(keeps_slope, "second_slope", Role::second_slope, "a second slope");
  go_with_size(slides_by_volume, "mode_2_energy", Role::sliding_energy, "an energy of sliding");
  go_with_size(tears_by_volume, "mode_1_slope", Role::first_softening, "softening with a tail");
  check_pairs(reader.sections(), c.interfaces);
  check_complete(s, c.interfaces, phases, matrix);
  return c;
}

}  // namespace pyroclast
