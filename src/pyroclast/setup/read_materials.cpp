#include "pyroclast/setup/read_materials.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/material/thermal_strain.hpp"

namespace pyroclast {

namespace {

/// Where strains from a coefficient are defined, beside what the run needs: the range of the fire standards,
/// °C.
constexpr Interval kStandardRange{20.0, 1200.0};

/// Free strain at the reference temperature that is taken for none: the standards' own polynomials leave
/// 2e-7.
constexpr double kNoStrain = 1e-6;

constexpr Meaning kSolid = "a solid of the specimen";

/// Records an error unless the curve, where it is defined there, has this value at the reference temperature.
void require_at_reference(const Section& s, std::string_view key, const Curve& curve, double expected,
                          double tolerance) {
  if (!s.ok() || !curve.range().contains(kReferenceTemperature)) return;
  const double value = curve(kReferenceTemperature);
  if (std::abs(value - expected) <= tolerance) return;
  s.error(key,
          fmt::format("is {:.6g} at {} degC, but must be {} there", value, kReferenceTemperature, expected));
}

Interval strain_range(const Interval& needed) {
  return {std::min(needed.lower, kStandardRange.lower), std::max(needed.upper, kStandardRange.upper)};
}

Curve read_thermal_strain(const Section& s, ExpansionReading reading, CurveReader& curves) {
  if (s.has("expansion")) {
    const Curve expansion = curves.read(s, "expansion", unit::expansion, Range::any(),
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

/// Density, and what conduction needs where it is given.
SolidMaterial read_heat_properties(const Section& s, CurveReader& curves) {
  const auto optional = [&](std::string_view key, const Unit& unit, Meaning meaning) -> std::optional<Curve> {
    if (!s.has(key)) return std::nullopt;
    return curves.read(s, key, unit, Range::positive(), meaning);
  };
  SolidMaterial m;
  m.density = curves.read(s, "density", unit::density, Range::positive(),
                          "masses are those at 20 °C; heat conduction follows the curve");
  m.conductivity = optional("conductivity", unit::conductivity,
                            "thermal conductivity; heat conduction needs that of aggregate and mortar");
  m.specific_heat =
      optional("specific_heat", unit::specific_heat, "heat conduction needs that of aggregate and mortar");
  return m;
}

SolidMaterial read_solid(const Section& s, ExpansionReading reading, CurveReader& curves) {
  SolidMaterial m = read_heat_properties(s, curves);
  m.young = curves.read(s, "E", unit::stress, Range::positive(), "Young's modulus");
  m.poisson = s.number("nu", Range{-1.0, 0.5, false, false}, "Poisson's ratio");
  m.thermal_strain = read_thermal_strain(s, reading, curves);
  return m;
}

SolidMaterial read_conducting_solid(const Section& s, CurveReader& curves) {
  s.know({"E", "nu", "expansion", "thermal_strain"});
  return read_heat_properties(s, curves);
}

std::optional<Curve> read_temperature_ratio(const Section& s, CurveReader& curves) {
  if (!s.has("temperature_ratio")) return std::nullopt;
  const Curve ratio = curves.read(
      s, "temperature_ratio", unit::dimensionless, Range::positive(),
      "multiplies those of f_t, f_cm, c_o, c_res, G_f1 and G_f2 that are plain constants; 1 at 20 °C");
  require_at_reference(s, "temperature_ratio", ratio, 1.0, kRatioTolerance);
  return ratio;
}

/// A number of a law that follows the temperature, but for a stiffness: that comes from the solids.
Curve read_property(const Section& s, const PropertyInfo& info, const std::optional<Curve>& ratio,
                    bool& ratio_has_effect, CurveReader& curves) {
  const Curve curve = curves.read(s, info.key, info.unit, info.range, Meaning(info.meaning));
  const bool scales = info.role == Role::strength || info.role == Role::energy;
  if (!ratio || !scales || !curve.is_constant()) return curve;
  ratio_has_effect = true;
  return (curve * *ratio).named(s.path() + "." + info.key);
}

int read_choice(const Section& s, const ChoiceInfo& info) {
  if (info.options[0].name == std::string_view("false"))
    return s.flag(info.key, false, Meaning(info.meaning)) ? 1 : 0;
  std::vector<Choice<int>> options;
  for (int i = 0; i < ChoiceInfo::kMostOptions && info.options[i].name; ++i)
    options.push_back({info.options[i].name, i, Meaning(info.options[i].meaning)});
  return s.choice_or_first(info.key, options, Meaning(info.meaning));
}

/// \param choices  where the law's choices stand
ContactMaterial read_contact(const Section& s, const LawTable& law, const Section& choices,
                             CurveReader& curves) {
  const std::optional<Curve> ratio = read_temperature_ratio(s, curves);
  bool ratio_has_effect = false;
  ContactMaterial m(law);
  for (std::size_t i = 0; i < law.properties.size(); ++i) {
    const PropertyInfo& info = law.properties[i];
    if (info.role != Role::normal_stiffness && info.role != Role::shear_stiffness)
      m.numbers[i] = read_property(s, info, ratio, ratio_has_effect, curves);
  }
  if (ratio && !ratio_has_effect)
    s.error("temperature_ratio", "has no effect: no property of this contact is a plain constant");
  for (std::size_t i = 0; i < law.choices.size(); ++i) m.choices[i] = read_choice(choices, law.choices[i]);
  return m;
}

}  // namespace

ExpansionReading read_expansion_reading(const Section& root) {
  return root.section("materials", "solids that the body is made of")
      .choice<ExpansionReading>(
          "expansion_reading",
          {{"secant", ExpansionReading::secant, "thermal strain is α(T) (T − 20 °C)"},
           {"tangent", ExpansionReading::tangent, "thermal strain is ∫ α dT from 20 °C"}},
          ExpansionReading::secant, "how the coefficients of thermal expansion α are read");
}

std::array<SolidMaterial, 3> read_solids(const Section& root, ExpansionReading reading, CurveReader& curves) {
  const Section s = root.section("materials");
  return {read_solid(s.section("aggregate", kSolid), reading, curves),
          read_solid(s.section("mortar", kSolid), reading, curves),
          read_solid(s.section("platen", "the platens' solid, at 20 °C in every run"), reading, curves)};
}

std::array<SolidMaterial, 3> read_conducting_solids(const Section& root, CurveReader& curves) {
  const Section s = root.section("materials");
  s.know({"expansion_reading", "platen"});
  return {read_conducting_solid(s.section("aggregate", kSolid), curves),
          read_conducting_solid(s.section("mortar", kSolid), curves), SolidMaterial{}};
}

ContactParameters read_contacts(const Section& root, CurveReader& curves) {
  const Section s =
      root.section("contacts", "what all contacts share: K_n = E / t_b, K_s = G / t_b, Eq. (17)");
  ContactParameters c;
  c.fracture_zone = s.quantity("t_b", unit::length, Range::positive(), "thickness of the fracture zone, t_b");
  const bool scales = s.choice<bool>(
      "t_b_scaling",
      {{"block size", true, "yes, it scales with it, so that the specimen's E does not depend on it"},
       {"fixed", false, "no, it holds for any block size"}},
      "whether t_b depends on the block size");
  if (scales)
    c.fracture_zone_size = s.quantity("t_b_block_size", unit::length, Range::positive(),
                                      "block size √(area / count) at which t_b holds");
  c.platen_friction = s.number("platen_friction", Range::non_negative(),
                               "coefficient of friction between platen and specimen");

  const Section mortar = s.section("mortar_mortar", "contacts between two blocks of mortar (Table 2)");
  c.mortar = read_contact(mortar, table_of<Cohesive>(), s, curves);
  if (mortar.has("K_n"))
    c.normal_stiffness = mortar.quantity("K_n", unit::stiffness_per_area, Range::positive(),
                                         "normal stiffness at 20 °C, instead of E / t_b");
  if (mortar.has("K_s"))
    c.shear_stiffness = mortar.quantity("K_s", unit::stiffness_per_area, Range::positive(),
                                        "shear stiffness at 20 °C, instead of G / t_b");

  const Section itz =
      s.section("aggregate_mortar",
                "contacts between aggregate and mortar, as factors of those between mortar and mortar");
  c.interface_stiffness = itz.number("stiffness_factor", Range::positive(), "of K_n and K_s");
  c.interface_strength = itz.number("strength_factor", Range::positive(), "of f_t, c_o, c_res and f_cm");
  c.scale_interface_energy =
      itz.flag("scale_fracture_energy", false, "whether strength_factor acts on G_f1 and G_f2 too");
  return c;
}

}  // namespace pyroclast
