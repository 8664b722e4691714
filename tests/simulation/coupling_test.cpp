#include "pyroclast/simulation/coupling.hpp"

#include <string>

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
  EXPECT_NO_THROW(properties_at(body, materials, field));
  // without fracture energy from 50 to 60 degC
  materials.contacts[mortar_mortar]["G_f1"] = Curve::table(
      {0.0, 49.0, 50.0, 60.0, 61.0, 1000.0}, {100.0, 100.0, 0.0, 0.0, 100.0, 100.0}, temperature_axis());
  try {
    properties_at(body, materials, field);
    FAIL() << "were taken";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("G_f1"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find(body.interface_names[mortar_mortar]), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace pyroclast
