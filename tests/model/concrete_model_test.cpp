#include "pyroclast/model/concrete_model.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "pyroclast/base/error.hpp"
#include "small_specimen.hpp"

namespace pyroclast {
namespace {

TEST(ConcreteModel, PlatensMeetTheSpecimenAlongItsWholeWidth) {
  const auto specimen = small_specimen();
  const auto body = make_concrete_model(specimen, 0.01, 0.5);
  double bottom = 0.0, top = 0.0;
  for (int c : body.platen_contacts) {
    const auto& contact = body.model.contacts[c];
    EXPECT_EQ(body.model.position[contact.a], body.model.position[contact.b]);
    EXPECT_NEAR(std::abs(contact.normal[1]), 1.0, 1e-12);
    (contact.normal[1] < 0.0 ? bottom : top) += contact.area;
  }
  EXPECT_NEAR(bottom, 0.05 * 0.5, 1e-12);
  EXPECT_NEAR(top, 0.05 * 0.5, 1e-12);
}

TEST(ConcreteModel, WithoutPlatensTheSpecimenIsTheSame) {
  const auto specimen = small_specimen();
  const auto with = make_concrete_model(specimen, 0.01, 1.0);
  const auto without = make_concrete_model(specimen, std::nullopt, 1.0);
  EXPECT_EQ(without.model.block_count(), with.model.block_count() - 2);
  EXPECT_EQ(without.model.contacts.size(), with.model.contacts.size() - with.platen_contacts.size());
  EXPECT_EQ(without.bottom_side.size(), with.bottom_side.size());
  EXPECT_EQ(without.top_side.size(), with.top_side.size());
  EXPECT_TRUE(without.top_support.empty() && without.bottom_face.empty() && without.platen_contacts.empty());
  double area = 0.0;
  for (double v : zone_geometry(without.model).volume) area += v;
  EXPECT_NEAR(area, 0.05 * 0.1, 1e-12);  // rounding
}

TEST(ConcreteModel, ZonesFillSpecimenAndPlatensAndContactsJoinCoincidentGridpoints) {
  const auto specimen = small_specimen();
  const auto body = make_concrete_model(specimen, 0.01, 1.0);
  const auto geometry = zone_geometry(body.model);
  double volume = 0.0;
  for (double v : geometry.volume) volume += v;
  EXPECT_NEAR(volume, 0.05 * (0.1 + 2.0 * 0.01), 1e-12);
  for (const auto& c : body.model.contacts) {
    EXPECT_EQ(body.model.position[c.a], body.model.position[c.b]);
    EXPECT_NEAR(norm(c.normal), 1.0, 1e-12);
    EXPECT_NEAR(dot(c.normal, c.tangents[0]), 0.0, 1e-12);
  }
}

TEST(ConcreteModel, InterfacesFollowFromTheMaterialsOfTheirTwoBlocks) {
  const auto specimen = small_specimen();
  const auto body = make_concrete_model(specimen, 0.01, 1.0);
  const auto& m = body.model;
  const auto block_of = [&](int g) {
    int block = 0;
    while (m.block_gridpoints[block + 1] <= g) ++block;
    return block;
  };
  int found[4] = {};
  for (const auto& c : m.contacts) {
    const int a = m.block_material[block_of(c.a)], b = m.block_material[block_of(c.b)];
    ++found[c.interface];
    if (a == platen_material || b == platen_material)
      EXPECT_EQ(c.interface, platen_interface);
    else if (a != b)
      EXPECT_EQ(c.interface, aggregate_mortar);
    else
      EXPECT_EQ(c.interface, a == aggregate_material ? aggregate_aggregate : mortar_mortar);
  }
  for (int count : found) EXPECT_GT(count, 0);
}

// Normals point from a to b: side a's block lies behind its face.
TEST(ConcreteModel, NormalsPointOutOfTheBlockOfSideA) {
  const auto specimen = small_specimen();
  const auto body = make_concrete_model(specimen, 0.01, 1.0);
  const auto& m = body.model;
  std::vector<Vec<2>> centre;
  std::vector<int> block(m.position.size());
  for (int b = 0; b < m.block_count(); ++b) {
    Vec<2> sum{};
    for (int g = m.block_gridpoints[b]; g < m.block_gridpoints[b + 1]; ++g) {
      sum += m.position[g];
      block[g] = b;
    }
    centre.push_back(sum * (1.0 / (m.block_gridpoints[b + 1] - m.block_gridpoints[b])));
  }
  for (const auto& c : m.contacts) {
    EXPECT_GT(dot(m.position[c.a] - centre[block[c.a]], c.normal), 0.0);
    EXPECT_LT(dot(m.position[c.b] - centre[block[c.b]], c.normal), 0.0);
  }
}

TEST(Model, RefusesAZoneWithoutVolume) {
  Model<2> model;
  model.add_block({{{0, 0}}, {{1, 0}}, {{2, 0}}}, {{0, 1, 2}}, 0);
  EXPECT_THROW(zone_geometry(model), Error);
}

}  // namespace
}  // namespace pyroclast
