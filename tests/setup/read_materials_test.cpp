#include "pyroclast/setup/read_materials.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "deck/diagnostics_of.hpp"
#include "phases.hpp"
#include "pyroclast/material/builtin_curves.hpp"
#include "pyroclast/model/concrete_model.hpp"

namespace pyroclast {
namespace {

constexpr Interval kFire{20.0, 800.0};

struct Properties {
  std::string expansion_reading = {};
  std::string mortar = "E = \"29.4 GPa\"\n";
  std::string contact =
      "f_t = \"2.5 MPa\"\nG_f1 = \"60 N/m\"\nf_cm = \"31 MPa\"\nc_o = \"3.8 MPa\"\nc_res = \"0.038 MPa\"\n"
      "G_f2 = \"240 N/m\"\n";
};

Deck deck_of(const Properties& p) {
  return Deck::parse("[materials]\n" + p.expansion_reading +
                         "[materials.aggregate]\nE = \"70 GPa\"\nnu = 0.2\ndensity = \"2650 kg/m3\"\n"
                         "[materials.platen]\nE = \"200 GPa\"\nnu = 0.3\ndensity = \"7850 kg/m3\"\n"
                         "[contacts]\nt_b = \"1.6 mm\"\nt_b_scaling = \"fixed\"\nplaten_friction = 0\n"
                         "[contacts.aggregate_mortar]\nlike = \"mortar_mortar\"\nstiffness_factor = "
                         "0.8\nstrength_factor = 0.8\n"
                         "[contacts.mortar_mortar]\nbeta = 0.05\nphi = \"34 deg\"\nphi_res = \"34 deg\"\n" +
                         p.contact + "[materials.mortar]\nnu = 0.2\ndensity = \"2200 kg/m3\"\n" + p.mortar,
                     "deck.toml");
}

struct Materials {
  std::vector<BlockMaterial> block_materials;
  ContactParameters contacts;
  std::vector<ReadCurve> curves;

  const BlockMaterial& mortar() const { return block_materials[mortar_material]; }
};

/// Of two blocks of mortar.
ContactMaterial mortar_contact(const Materials& m) {
  return std::ranges::find(m.contacts.interfaces, "mortar_mortar", &InterfaceParameters::name)->contact;
}

Materials read(const Deck& deck, Interval needed = kFire) {
  CurveReader curves(".", temperature_axis(), needed, builtin_curves());
  Materials m;
  const std::vector<std::string> phases{"aggregate", "mortar"};
  const MaterialRules rules = read_material_rules(deck.root());
  m.block_materials = read_block_materials(deck.root(), phases, {"platen"}, rules, {}, curves);
  m.contacts = read_contacts(
      deck.root(), phases, {"aggregate"}, "mortar", true, rules.on_cooling,
      [](const auto&, bool) -> const LawTable& { return table_of<Cohesive>(); }, curves);
  m.curves = curves.curves();
  return m;
}

Materials read_good(const Properties& p, Interval needed = kFire) {
  const Deck deck = deck_of(p);
  Materials m = read(deck, needed);
  EXPECT_NO_THROW(deck.finish());
  return m;
}

void expect_error(const Properties& p, const std::string& key, const std::string& message) {
  const Deck deck = deck_of(p);
  read(deck);
  const Diagnostic diagnostic = only_diagnostic_of(deck);
  EXPECT_EQ(diagnostic.key, key);
  EXPECT_TRUE(mentions(diagnostic.message, message)) << diagnostic.message;
}

TEST(ReadMaterials, PropertiesFollowTheTemperature) {
  const Materials m = read_good({.mortar = "E = { value = \"29.4 GPa\", times = \"glasgow_modulus\" }\n"
                                           "conductivity = { builtin = \"en1992_conductivity_lower\" }\n"
                                           "specific_heat = { builtin = \"en1992_specific_heat_u0\" }\n"});
  EXPECT_DOUBLE_EQ(m.mortar().young(520.0), 29.4e9 * 0.25);
  EXPECT_DOUBLE_EQ(m.mortar().conductivity->operator()(100.0), 1.36 - 0.136 + 0.0057);
  EXPECT_DOUBLE_EQ(m.mortar().specific_heat->operator()(300.0), 1050.0);
  EXPECT_EQ(m.mortar().density(20.0), 2200.0);
}

TEST(ReadMaterials, HeatPropertiesMayBeLeftOut) {
  const Materials m = read_good({});
  EXPECT_FALSE(m.mortar().conductivity);
  EXPECT_FALSE(m.mortar().specific_heat);
}

TEST(ReadMaterials, WithoutExpansionNothingExpands) {
  const Materials m = read_good({});
  for (const BlockMaterial& material : m.block_materials) EXPECT_EQ(material.thermal_strain(500.0), 0.0);
}

TEST(ReadMaterials, ExpansionIsSecantUnlessSaidToBeTangent) {
  Properties p;
  p.mortar += "expansion = { builtin = \"paper_mortar_expansion\" }\n";
  const double T = 600.0;
  // Rounding of terms that are 1e-2 at most.
  EXPECT_NEAR(read_good(p).mortar().thermal_strain(T), (9e-7 - 6e-11 * T * T) * (T - 20.0), 1e-14);
  p.expansion_reading = "expansion_reading = \"secant\"\n";
  EXPECT_NEAR(read_good(p).mortar().thermal_strain(T), (9e-7 - 6e-11 * T * T) * (T - 20.0), 1e-14);
  p.expansion_reading = "expansion_reading = \"tangent\"\n";
  EXPECT_NEAR(read_good(p).mortar().thermal_strain(T), 9e-7 * (T - 20.0) - 2e-11 * (T * T * T - 8000.0),
              1e-14);
}

TEST(ReadMaterials, ThermalStrainMayBeGivenItself) {
  Properties p;
  p.mortar += "thermal_strain = { builtin = \"en1992_siliceous_elongation\" }\n";
  EXPECT_DOUBLE_EQ(read_good(p).mortar().thermal_strain(700.0), 14e-3);
}

TEST(ReadMaterials, AQuartzStepComesToTheStrainOfThePhase) {
  Properties p;
  p.mortar += "expansion = \"1e-5 1/K\"\nquartz_step = 0.0035\n";
  const Materials m = read_good(p);
  EXPECT_NEAR(m.mortar().thermal_strain(540.0), 5.2e-3, 1e-15);
  EXPECT_NEAR(m.mortar().thermal_strain(620.0), 6e-3 + 3.5e-3, 1e-15);
  p.mortar += "quartz_range = [\"560 degC\", \"590 degC\"]\n";
  EXPECT_NEAR(read_good(p).mortar().thermal_strain(560.0), 5.4e-3, 1e-15);
  EXPECT_NEAR(read_good(p).mortar().thermal_strain(590.0), 5.7e-3 + 3.5e-3, 1e-15);
}

TEST(ReadMaterials, RefusesAQuartzStepThatMakesNoSense) {
  const auto told = [](const std::string& lines, const std::string& key, const std::string& what) {
    Properties p;
    p.mortar += lines;
    expect_error(p, "materials.mortar." + key, what);
  };
  told("quartz_step = 0.0035\n", "quartz_step", "give its expansion or thermal_strain too");
  told("expansion = \"1e-5 1/K\"\nquartz_step = 0.35\n", "quartz_step", "between 0 and 0.02");
  told("expansion = \"1e-5 1/K\"\nquartz_step = 0.0035\nquartz_range = [\"600 degC\", \"550 degC\"]\n",
       "quartz_range", "the first below the second");
  told("expansion = \"1e-5 1/K\"\nquartz_range = [\"550 degC\", \"600 degC\"]\n", "quartz_range",
       "has no effect");
}

// A run at room temperature alone needs the curves only there.
TEST(ReadMaterials, ExpansionIsReadForARunAtOneTemperature) {
  Properties p;
  p.mortar += "expansion = \"1e-5 1/K\"\n";
  const Materials m = read_good(p, {20.0, 20.0});
  EXPECT_EQ(m.mortar().thermal_strain(20.0), 0.0);
}

TEST(ReadMaterials, RefusesTwoSourcesOfThermalStrain) {
  Properties p;
  p.mortar += "expansion = \"1e-5 1/K\"\nthermal_strain = { builtin = \"en1992_siliceous_elongation\" }\n";
  const Deck deck = deck_of(p);
  read(deck);
  EXPECT_EQ(only_diagnostic_of(deck).key, "materials.mortar.thermal_strain");
}

TEST(ReadMaterials, RefusesAStrainThatDoesNotStartAtTheReferenceTemperature) {
  Properties p;
  p.mortar += "thermal_strain = { table = [[\"20 degC\", 0.001], [\"800 degC\", 0.01]] }\n";
  expect_error(p, "materials.mortar.thermal_strain", "is 0.001 at 20 degC, but must be 0 there");
}

TEST(ReadMaterials, RefusesACurveThatEndsBeforeTheRun) {
  Properties p;
  p.mortar = "E = { table = [[\"20 degC\", \"29.4 GPa\"], [\"600 degC\", \"5 GPa\"]] }\n";
  expect_error(p, "materials.mortar.E",
               "given from 20 to 600 degC, but the run needs it from 20 to 800 degC");
}

// Promise of the physics: f_t, c, f_cm and the energies follow one curve, so that the ultimate opening
// u_f = 2 G_f1 / f_t stays.
TEST(ReadContacts, TemperatureRatioScalesWhatIsAConstant) {
  Properties p;
  p.contact += "temperature_ratio = { builtin = \"en1992_siliceous_strength\" }\n";
  const ContactMaterial c = mortar_contact(read_good(p));
  const auto cold = c.at(20.0).as<Cohesive>(), hot = c.at(600.0).as<Cohesive>();  // K_n, K_s are not set yet
  EXPECT_DOUBLE_EQ(hot.tensile_strength, 0.45 * 2.5e6);
  EXPECT_DOUBLE_EQ(hot.compressive_limit, 0.45 * 31e6);
  EXPECT_DOUBLE_EQ(hot.cohesion, 0.45 * 3.8e6);
  EXPECT_DOUBLE_EQ(hot.residual_cohesion, 0.45 * 0.038e6);
  EXPECT_DOUBLE_EQ(hot.mode_1_energy, 0.45 * 60.0);
  EXPECT_DOUBLE_EQ(hot.mode_2_energy, 0.45 * 240.0);
  EXPECT_DOUBLE_EQ(hot.ultimate_opening(), cold.ultimate_opening());
}

TEST(ReadContacts, APropertyWithACurveOfItsOwnDoesNotFollowTheTemperatureRatio) {
  Properties p;
  p.contact =
      "f_t = \"2.5 MPa\"\nf_cm = \"31 MPa\"\nc_o = \"3.8 MPa\"\nc_res = \"0.038 MPa\"\nG_f2 = \"240 N/m\"\n"
      "G_f1 = { value = \"60 N/m\", times = { table = [[\"20 degC\", 1], [\"800 degC\", 0.5]] } }\n"
      "temperature_ratio = { builtin = \"en1992_siliceous_strength\" }\n";
  const ContactMaterial c = mortar_contact(read_good(p));
  EXPECT_DOUBLE_EQ(c["G_f1"](800.0), 30.0);
  EXPECT_DOUBLE_EQ(c["f_t"](800.0), 0.15 * 2.5e6);
}

TEST(ReadContacts, StatedStiffnessesFollowTheMortarsModulus) {
  Properties p;
  p.contact += "K_n = \"18400 GPa/m\"\nK_s = \"7660 GPa/m\"\n";
  p.mortar = "E = { value = \"29.4 GPa\", times = \"glasgow_modulus\" }\n";
  const Materials m = read_good(p);
  const auto concrete = make_concrete(m.block_materials, m.contacts, 3e-3);
  EXPECT_DOUBLE_EQ(concrete.contacts[mortar_mortar]["K_n"](520.0), 0.25 * 18400e9);
  EXPECT_DOUBLE_EQ(concrete.contacts[mortar_mortar]["K_s"](520.0), 0.25 * 7660e9);
}

TEST(ReadContacts, RefusesARatioThatIsNotOneAtTheReferenceTemperature) {
  Properties p;
  p.contact += "temperature_ratio = { builtin = \"en1992_ultimate_strain\" }\n";
  expect_error(p, "contacts.mortar_mortar.temperature_ratio", "is 0.02 at 20 degC, but must be 1 there");
}

TEST(ReadContacts, RefusesARatioThatReachesZeroInTheRun) {
  Properties p;
  p.contact += "temperature_ratio = { table = [[\"20 degC\", 1], [\"800 degC\", 0]] }\n";
  expect_error(p, "contacts.mortar_mortar.temperature_ratio", "must be greater than 0");
}

TEST(ReadMaterials, KeepsEveryCurveOfTheDeck) {
  Properties p;
  p.contact += "temperature_ratio = { builtin = \"en1992_siliceous_strength\" }\n";
  p.mortar += "expansion = \"1e-5 1/K\"\n";
  std::string paths;
  for (const ReadCurve& read : read_good(p).curves) paths += read.path + " ";
  for (const std::string path :
       {"materials.aggregate.E ", "materials.mortar.expansion ", "materials.platen.density ",
        "contacts.mortar_mortar.temperature_ratio ", "contacts.mortar_mortar.G_f2 "}) {
    EXPECT_NE(paths.find(path), std::string::npos) << path << "in " << paths;
  }
}

// ---- Cooling

constexpr const char* kHalf = "residual_ratio = { table = [[\"20 degC\", 1], [\"800 degC\", 0.5]] }\n";

// Promise: what E of a phase loses, the stiffnesses of its contacts lose; strengths and fracture energies
// lose what their interface says, whether they are constants or curves, and so do those of what is like it.
TEST(ReadContacts, ResidualRatiosGoToWhatTheyAreOf) {
  Properties p;
  p.mortar += kHalf;
  p.contact =
      "f_t = { value = \"2.5 MPa\", times = \"glasgow_tensile_strength\" }\nG_f1 = \"60 N/m\"\nf_cm = \"31 "
      "MPa\"\n"
      "c_o = \"3.8 MPa\"\nc_res = \"0.038 MPa\"\nG_f2 = \"240 N/m\"\n"
      "residual_ratio = { table = [[\"20 degC\", 1], [\"420 degC\", 0.6], [\"800 degC\", 0.6]] }\n";
  const Materials m = read_good(p);
  const auto concrete = make_concrete(m.block_materials, m.contacts, 3e-3);
  EXPECT_DOUBLE_EQ(m.mortar().young_at(20.0, 800.0), 0.5 * 29.4e9);
  for (const int interface : {mortar_mortar, aggregate_mortar}) {
    const ContactMaterial& contact = concrete.contacts[interface];
    const auto hot = contact.at(420.0).as<Cohesive>(), cooled = contact.at(20.0, 420.0).as<Cohesive>();
    const double of_young = 1.0 - 0.5 * 400.0 / 780.0;
    EXPECT_NEAR(cooled.normal_stiffness / hot.normal_stiffness, of_young, 1e-12);
    EXPECT_NEAR(cooled.shear_stiffness / hot.shear_stiffness, of_young, 1e-12);
    for (const auto number :
         {&Cohesive::Properties<double>::tensile_strength, &Cohesive::Properties<double>::cohesion,
          &Cohesive::Properties<double>::mode_1_energy, &Cohesive::Properties<double>::mode_2_energy,
          &Cohesive::Properties<double>::compressive_limit})
      EXPECT_NEAR(cooled.*number / (hot.*number), 0.6, 1e-12);
    EXPECT_EQ(cooled.friction_angle, hot.friction_angle);
  }
  EXPECT_DOUBLE_EQ(concrete.contacts[aggregate_aggregate].at(20.0, 420.0).as<Elastic>().normal_stiffness,
                   70e9 / 1.6e-3);
}

TEST(ReadMaterials, RefusesAResidualRatioThatMakesNoSense) {
  Properties p;
  p.mortar += "residual_ratio = 0.9\n";
  expect_error(p, "materials.mortar.residual_ratio", "is 0.9 at 20 degC, but must be 1 there");
  p = {};
  p.mortar += "residual_ratio = { table = [[\"20 degC\", 1], [\"800 degC\", 1.1]] }\n";
  expect_error(p, "materials.mortar.residual_ratio", "greater than 0 and at most 1");
  p = {};
  p.expansion_reading = "on_cooling = \"reversible\"\n";
  p.mortar += kHalf;
  expect_error(p, "materials.mortar.residual_ratio",
               "has no meaning with materials.on_cooling = \"reversible\"");
  p = {};
  p.expansion_reading = "on_cooling = \"reversible\"\n";
  p.contact += kHalf;
  expect_error(p, "contacts.mortar_mortar.residual_ratio", "has no meaning with materials.on_cooling");
}

}  // namespace
}  // namespace pyroclast
