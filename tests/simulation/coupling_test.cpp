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
  const ModelOf<2> body = small_body();
  auto field = conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
  field.advance(100.0, 600.0);
  ConcreteMaterials materials;
  materials.block_materials.resize(3);
  materials.contacts.resize(4, ContactMaterial(table_of<Cohesive>()));
  for (auto& material : materials.block_materials) material.young = Curve::constant(30e9);
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
  materials.block_materials.resize(3);
  materials.contacts.resize(4, ContactMaterial(table_of<Elastic>()));
  const Curve falls = Curve::table({-100.0, 900.0}, {1.1, 0.1}, temperature_axis());
  for (auto& material : materials.block_materials) material.young = falls * 30e9;
  materials.block_materials.back().is_of_bearing = true;
  for (auto& contact : materials.contacts)
    for (const char* key : {"K_n", "K_s"}) contact[key] = falls * 1e13;
  auto& creep = materials.block_materials[mortar_material].creep.emplace();
  creep.strain = Curve::table({20.0, 120.0, 820.0}, {0.0, 1e-3, 30e-3}, temperature_axis());
  creep.strength = 35e6;
  creep.choices.poisson = 0.3;
  return materials;
}

/// Of the hottest zone of mortar, and of the others together.
std::pair<double, double> compliances(const ModelOf<2>& body, const BodyProperties& properties) {
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
  const ModelOf<2> body = small_body();
  const auto materials = creeping_materials(OnCooling::irreversible);
  const Curve& strain = materials.block_materials[mortar_material].creep->strain;
  TemperatureField field(body, 20.0);
  HottestTemperatures hottest(body, materials, field);
  double hottest_so_far = 20.0;
  for (const double to : {400.0, 20.0, 400.0, 450.0, 10.0, 300.0, 500.0}) {
    field.set_uniform(to);
    const auto [mortar, others] = compliances(body, properties_at(body, materials, field, hottest));
    EXPECT_EQ(mortar, to > hottest_so_far ? (strain(to) - strain(hottest_so_far)) / 35e6 : 0.0) << to;
    EXPECT_EQ(others, 0.0);
    hottest.note_exchange(field);
    hottest_so_far = std::max(hottest_so_far, to);
  }
  // brought to its first temperature without stress
  const TemperatureField warm(body, 300.0);
  field.set_uniform(350.0);
  const auto first = properties_at(body, materials, field, HottestTemperatures(body, materials, warm));
  EXPECT_EQ(compliances(body, first).first, (strain(350.0) - strain(300.0)) / 35e6);
  const TemperatureField cold(body, -30.0);
  field.set_uniform(120.0);
  const auto from_cold = properties_at(body, materials, field, HottestTemperatures(body, materials, cold));
  EXPECT_EQ(compliances(body, from_cold).first, strain(120.0) / 35e6);
}

// Promise: on cooling E and stiffnesses stay those of the hottest, zone by zone and contact by contact, or
// come back; in a uniform field and in a computed one.
TEST(PropertiesOnCooling, StayThoseOfTheHottestOrComeBack) {
  const ModelOf<2> body = small_body();
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
    HottestTemperatures hottest(body, materials, field);
    hottest.note_exchange(hot);
    expect(field, stays ? hot : field, properties_at(body, materials, field, hottest));

    auto computed =
        conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
    const auto before = computed.zones();
    computed.advance(100.0, 600.0);
    HottestTemperatures uneven(body, materials, computed);
    expect(field, stays ? computed : field, [&] {
      // a computed field that has cooled to 20 degC
      const auto cold =
          conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
      return properties_at(body, materials, cold, uneven);
    }());
    EXPECT_EQ(before.front(), 20.0);
  }
}

/// A field that was heated from its left, and is not even.
TemperatureField heated_field(const ModelOf<2>& body) {
  auto field = conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
  field.advance(100.0, 600.0);
  return field;
}

/// The same before it was heated.
TemperatureField cold_field(const ModelOf<2>& body) {
  return conduct(body, heat_conditions({on("left", convection(25.0, Curve::constant(600.0)))}), 600.0);
}

// Promise: below the highest temperature that it was at, the free strain of a phase goes back by the slope of
// the phase, and to its curve beyond; zone by zone, in a uniform field and in a computed one, whatever
// becomes of E.
TEST(FreeStrainOnCooling, HasTheSlopeOfItsPhase) {
  const ModelOf<2> body = small_body();
  const auto blocks = zone_blocks(body);
  for (const OnCooling on_cooling : {OnCooling::irreversible, OnCooling::reversible}) {
    auto materials = creeping_materials(on_cooling);
    materials.block_materials[mortar_material].creep.reset();
    materials.block_materials[mortar_material].contraction = 6e-6;
    for (auto& material : materials.block_materials)
      material.thermal_strain = Curve::table({-100.0, 900.0}, {-1.2e-3, 8.8e-3}, temperature_axis());
    const auto expect = [&](const std::vector<double>& now, const std::vector<double>& hottest,
                            const BodyProperties& p) {
      for (int z = 0; z < body.zone_count(); ++z) {
        const bool of_mortar = body.block_material[blocks[z]] == mortar_material;
        const double way_back = of_mortar ? 6e-6 : 1e-5;
        const double expected = 1e-5 * (hottest[z] - 20.0) - way_back * (hottest[z] - now[z]);
        if (body.is_of_bearing(blocks[z]))
          EXPECT_EQ(p.zones[z].thermal_strain, 0.0);
        else
          EXPECT_NEAR(p.zones[z].thermal_strain, expected, 1e-15) << z;
      }
    };
    TemperatureField field(body, 20.0);
    HottestTemperatures hottest(body, materials, field);
    double hottest_so_far = 20.0;
    for (const double to : {400.0, 20.0, 300.0, 400.0, 450.0, 60.0}) {
      field.set_uniform(to);
      hottest_so_far = std::max(hottest_so_far, to);
      expect(field.zones(), std::vector<double>(field.zones().size(), hottest_so_far),
             properties_at(body, materials, field, hottest));
      hottest.note_exchange(field);
    }
    const auto hot = heated_field(body);
    const auto cold = cold_field(body);
    expect(cold.zones(), hot.zones(),
           properties_at(body, materials, cold, HottestTemperatures(body, materials, hot)));
    expect(hot.zones(), hot.zones(),
           properties_at(body, materials, hot, HottestTemperatures(body, materials, cold)));
  }
}

// Promise: on the way down from the highest temperature, E, stiffnesses and strengths lose evenly what the
// deck says, each by its own curve; numbers that are plain follow the temperature; on heating nothing is
// lost.
TEST(PropertiesOnCooling, LoseTheirResidualShareEvenly) {
  const ModelOf<2> body = small_body();
  const auto blocks = zone_blocks(body);
  auto materials = creeping_materials(OnCooling::irreversible);
  const Curve of_young = Curve::table({20.0, 420.0, 900.0}, {1.0, 0.8, 0.8}, temperature_axis());
  const Curve of_strength = Curve::table({20.0, 420.0, 900.0}, {1.0, 0.6, 0.6}, temperature_axis());
  for (auto& material : materials.block_materials)
    if (!material.is_of_bearing) material.residual_ratio = of_young;
  materials.contacts.assign(4, ContactMaterial(table_of<Cohesive>()));
  for (auto& contact : materials.contacts) {
    for (const auto& [key, value] :
         {std::pair{"G_f1", 100.0}, {"G_f2", 100.0}, {"f_cm", 30e6}, {"beta", 0.05}})
      contact[key] = Curve::constant(value);
    contact["phi"] = Curve::table({-100.0, 900.0}, {0.5, 0.4}, temperature_axis());
    for (const Role role : {Role::normal_stiffness, Role::shear_stiffness})
      contact.set(role, Curve::constant(1e13), of_young);
    contact["f_t"] = Curve::table({-100.0, 900.0}, {2.5e6, 1.5e6}, temperature_axis());
    contact["c_o"] = Curve::constant(3e6);
    for (std::size_t i = 0; i < contact.numbers.size(); ++i)
      if (contact.law->properties[i].role == Role::strength) contact.residual_ratios[i] = of_strength;
  }
  const auto left = [](double ratio, double now, double hottest) {
    return now < hottest ? 1.0 - (1.0 - ratio) * (hottest - now) / (hottest - 20.0) : 1.0;
  };
  const auto expect = [&](const TemperatureField& field, const TemperatureField& hot,
                          const BodyProperties& p) {
    for (int z = 0; z < body.zone_count(); ++z) {
      if (body.is_of_bearing(blocks[z])) continue;
      const double young = 30e9 * (1.1 - 1e-3 * (hot.zones()[z] + 100.0));
      const double share = left(of_young(hot.zones()[z]), field.zones()[z], hot.zones()[z]);
      EXPECT_NEAR(p.zones[z].mu, 0.5 * young * share, 1.0) << z;
    }
    for (int c = 0; c < body.contact_count(); ++c) {
      const double now = field.contacts()[c], hottest = hot.contacts()[c];
      const auto contact = p.contacts[p.of_contact[c]].as<Cohesive>();
      EXPECT_NEAR(contact.normal_stiffness, 1e13 * left(of_young(hottest), now, hottest), 1e3);
      EXPECT_NEAR(contact.tensile_strength,
                  (2.5e6 - 1e3 * (hottest + 100.0)) * left(of_strength(hottest), now, hottest), 1e-3);
      EXPECT_NEAR(contact.cohesion, 3e6 * left(of_strength(hottest), now, hottest), 1e-3);
      EXPECT_EQ(contact.mode_1_energy, 100.0);
      EXPECT_NEAR(contact.friction_angle, 0.5 - 1e-4 * (now + 100.0), 1e-12);
    }
  };
  TemperatureField field(body, 20.0);
  HottestTemperatures hottest(body, materials, field);
  const TemperatureField hot(body, 420.0);
  expect(hot, hot, properties_at(body, materials, hot, hottest));
  hottest.note_exchange(hot);
  for (const double T : {220.0, 20.0, 320.0, 420.0}) {
    field.set_uniform(T);
    expect(field, hot, properties_at(body, materials, field, hottest));
  }
  const auto uneven = heated_field(body);
  const auto cold = cold_field(body);
  expect(uneven, uneven, properties_at(body, materials, uneven, HottestTemperatures(body, materials, cold)));
  expect(cold, uneven, properties_at(body, materials, cold, HottestTemperatures(body, materials, uneven)));
}

}  // namespace
}  // namespace pyroclast
