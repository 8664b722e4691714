#include "pyroclast/simulation/coupling.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "heated_specimen.hpp"
#include "pyroclast/base/error.hpp"

namespace pyroclast {
namespace {

// Every contact gets parameters of its own temperature, and each is checked: what was possible where the deck
// was checked may not be in between.
TEST(PropertiesOfAComputedField, AreRefusedWhereTheyMakeNoLaw) {
  const Model<2> body = small_body();
  auto field = conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
  field.advance(100.0, 600.0);
  ConcreteMaterials materials;
  materials.solids.resize(3);
  materials.contacts.resize(4, ContactMaterial(table_of<Cohesive>()));
  for (auto& solid : materials.solids) solid.young = Curve::constant(30e9);
  for (auto& contact : materials.contacts)
    for (const auto& [key, value] : {std::pair{"K_n", 1e13},
                                     {"K_s", 1e13},
                                     {"f_t", 2e6},
                                     {"G_f1", 100.0},
                                     {"G_f2", 100.0},
                                     {"f_cm", 30e6},
                                     {"beta", 0.05},
                                     {"c_o", 3e6}})
      contact[key] = Curve::constant(value);
  EXPECT_NO_THROW(properties_at(body, materials, field, {}));
  // without fracture energy from 50 to 60 degC
  materials.contacts[mortar_mortar]["G_f1"] = Curve::table(
      {0.0, 49.0, 50.0, 60.0, 61.0, 1000.0}, {100.0, 100.0, 0.0, 0.0, 100.0, 100.0}, temperature_axis());
  try {
    properties_at(body, materials, field, {});
    FAIL() << "were taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("G_f1"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(body.interface_names[mortar_mortar]), std::string::npos) << e.what();
  }
}

/// Materials of a body of aggregate, mortar and platens that are all elastic, and mortar that creeps.
ConcreteMaterials creeping_materials(OnCooling on_cooling) {
  ConcreteMaterials materials;
  materials.on_cooling = on_cooling;
  materials.solids.resize(3);
  materials.contacts.resize(4, ContactMaterial(table_of<Elastic>()));
  const Curve falls = Curve::table({-100.0, 900.0}, {1.1, 0.1}, temperature_axis());
  for (auto& solid : materials.solids) solid.young = falls * 30e9;
  materials.solids.back().is_of_bearing = true;
  for (auto& contact : materials.contacts)
    for (const char* key : {"K_n", "K_s"}) contact[key] = falls * 1e13;
  auto& creep = materials.solids[mortar_material].creep.emplace();
  creep.strain = Curve::table({20.0, 120.0, 820.0}, {0.0, 1e-3, 30e-3}, temperature_axis());
  creep.strength = 35e6;
  creep.choices.poisson = 0.3;
  return materials;
}

/// Of the hottest zone of mortar, and of the others together.
std::pair<double, double> compliances(const Model<2>& body, const BodyProperties& properties) {
  std::pair<double, double> of{0.0, 0.0};
  const auto blocks = zone_blocks(body);
  for (int z = 0; z < body.zone_count(); ++z) {
    auto& largest = body.block_material[blocks[z]] == mortar_material ? of.first : of.second;
    largest = std::max(largest, properties.creep[z].compliance);
  }
  return of;
}

// Promise: what creeps in an exchange is what B rises by above the hottest of before, to the last digit, and
// nothing below it; aggregate and platens never creep.
TEST(CreepOfAnExchange, IsThatOfTheFirstHeating) {
  const Model<2> body = small_body();
  const auto materials = creeping_materials(OnCooling::irreversible);
  const Curve& strain = materials.solids[mortar_material].creep->strain;
  TemperatureField field(body, 20.0);
  HottestTemperatures hottest(materials, field);
  double hottest_so_far = 20.0;
  for (const double to : {400.0, 20.0, 400.0, 450.0, 10.0, 300.0, 500.0}) {
    field.set_uniform(to);
    const auto [mortar, others] = compliances(body, properties_at(body, materials, field, hottest));
    EXPECT_EQ(mortar, to > hottest_so_far ? (strain(to) - strain(hottest_so_far)) / 35e6 : 0.0) << to;
    EXPECT_EQ(others, 0.0);
    hottest.take(field);
    hottest_so_far = std::max(hottest_so_far, to);
  }
  // brought to its first temperature without stress
  const TemperatureField warm(body, 300.0);
  field.set_uniform(350.0);
  const auto first = properties_at(body, materials, field, HottestTemperatures(materials, warm));
  EXPECT_EQ(compliances(body, first).first, (strain(350.0) - strain(300.0)) / 35e6);
  const TemperatureField cold(body, -30.0);
  field.set_uniform(120.0);
  const auto from_cold = properties_at(body, materials, field, HottestTemperatures(materials, cold));
  EXPECT_EQ(compliances(body, from_cold).first, strain(120.0) / 35e6);
}

// Promise: on cooling E and stiffnesses stay those of the hottest, zone by zone and contact by contact, or
// come back; in a uniform field and in a computed one.
TEST(PropertiesOnCooling, StayThoseOfTheHottestOrComeBack) {
  const Model<2> body = small_body();
  const auto blocks = zone_blocks(body);
  const auto expect = [&](const TemperatureField& field, const TemperatureField& marked,
                          const BodyProperties& p) {
    const Curve falls = Curve::table({-100.0, 900.0}, {1.1, 0.1}, temperature_axis());
    for (int z = 0; z < body.zone_count(); ++z) {
      const double T = body.is_of_bearing(blocks[z]) ? field.zones()[z] : marked.zones()[z];
      EXPECT_NEAR(p.zones[z].mu, 0.5 * falls(T) * 30e9, 1.0) << z;
    }
    for (int c = 0; c < body.contact_count(); ++c)
      EXPECT_NEAR(p.contacts.numbers(p.of_contact[c])[0], falls(marked.contacts()[c]) * 1e13, 1e3) << c;
  };
  for (const OnCooling on_cooling : {OnCooling::irreversible, OnCooling::reversible}) {
    const auto materials = creeping_materials(on_cooling);
    const bool stays = on_cooling == OnCooling::irreversible;
    TemperatureField field(body, 20.0);
    const TemperatureField hot(body, 400.0);
    HottestTemperatures hottest(materials, field);
    hottest.take(hot);
    expect(field, stays ? hot : field, properties_at(body, materials, field, hottest));

    auto computed =
        conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
    const auto before = computed.zones();
    computed.advance(100.0, 600.0);
    HottestTemperatures uneven(materials, computed);
    expect(field, stays ? computed : field, [&] {
      // a computed field that has cooled to 20 degC
      const auto cold =
          conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
      return properties_at(body, materials, cold, uneven);
    }());
    EXPECT_EQ(before.front(), 20.0);
  }
}

}  // namespace
}  // namespace pyroclast
