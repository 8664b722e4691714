#include "pyroclast/model/concrete_model.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "phases.hpp"
#include "pyroclast/base/error.hpp"
#include "small_specimen.hpp"

namespace pyroclast {
namespace {

TEST(ConcreteModel, PlatensMeetTheSpecimenAlongItsWholeWidth) {
  const auto specimen = small_specimen();
  const auto body = between_platens(specimen, 0.01, 0.5);
  double bottom = 0.0, top = 0.0;
  for (const auto& contact : body.contacts) {
    if (!body.is_of_bearing(contact)) continue;
    EXPECT_EQ(body.position[contact.a], body.position[contact.b]);
    EXPECT_NEAR(std::abs(contact.normal[1]), 1.0, 1e-12);
    (contact.normal[1] < 0.0 ? bottom : top) += contact.area;
  }
  EXPECT_NEAR(bottom, 0.05 * 0.5, 1e-12);
  EXPECT_NEAR(top, 0.05 * 0.5, 1e-12);
}

TEST(ConcreteModel, WithoutPlatensTheSpecimenIsTheSame) {
  const auto specimen = small_specimen();
  const auto with = between_platens(specimen, 0.01, 1.0);
  const auto without = make_model(specimen, 1.0);
  EXPECT_EQ(without.block_count(), with.block_count() - 2);
  const auto at_platens = std::count_if(with.contacts.begin(), with.contacts.end(),
                                        [&](const auto& c) { return with.is_of_bearing(c); });
  EXPECT_EQ(without.contacts.size(), with.contacts.size() - at_platens);
  for (const auto* side : {"bottom", "top", "left", "right"})
    EXPECT_EQ(without.set(side).size(), with.set(side).size());
  EXPECT_EQ(without.set("specimen").size(), with.set("specimen").size());
  for (const auto* set : {"bottom_platen_support", "top_platen_support", "bottom_platen_face",
                          "top_platen_face", "bottom_platen", "top_platen"})
    EXPECT_FALSE(without.sets.contains(set));
  double area = 0.0;
  for (double v : zone_geometry(without).volume) area += v;
  EXPECT_NEAR(area, 0.05 * 0.1, 1e-12);  // rounding
}

TEST(ConcreteModel, ZonesFillSpecimenAndPlatensAndContactsJoinCoincidentGridpoints) {
  const auto specimen = small_specimen();
  const auto body = between_platens(specimen, 0.01, 1.0);
  const auto geometry = zone_geometry(body);
  double volume = 0.0;
  for (double v : geometry.volume) volume += v;
  EXPECT_NEAR(volume, 0.05 * (0.1 + 2.0 * 0.01), 1e-12);
  for (const auto& c : body.contacts) {
    EXPECT_EQ(body.position[c.a], body.position[c.b]);
    EXPECT_NEAR(norm(c.normal), 1.0, 1e-12);
    EXPECT_NEAR(dot(c.normal, c.tangents[0]), 0.0, 1e-12);
  }
}

TEST(ConcreteModel, InterfacesFollowFromTheMaterialsOfTheirTwoBlocks) {
  const auto specimen = small_specimen();
  const auto body = between_platens(specimen, 0.01, 1.0);
  const auto& m = body;
  const auto block_of = [&](int g) {
    int block = 0;
    while (m.block_gridpoints[block + 1] <= g) ++block;
    return block;
  };
  int found[4] = {};
  for (const auto& c : m.contacts) {
    const int a = m.block_material[block_of(c.a)], b = m.block_material[block_of(c.b)];
    ++found[c.interface];
    if (body.is_of_bearing(body.block_of(c.a)) || body.is_of_bearing(body.block_of(c.b)))
      EXPECT_TRUE(body.is_of_bearing(c));
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
  const auto body = between_platens(specimen, 0.01, 1.0);
  const auto& m = body;
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

TEST(ConcreteModel, SetsHoldTheGridpointsThatTheyAreNamedAfter) {
  const auto body = between_platens(small_specimen(), 0.01, 1.0);
  const auto lie_at = [&](const char* set, int component, double place) {
    EXPECT_FALSE(body.set(set).empty());
    for (int g : body.set(set)) EXPECT_NEAR(body.position[g][component], place, 1e-15) << set;
  };
  lie_at("bottom_platen_support", 1, -0.01);
  lie_at("bottom_platen_face", 1, 0.0);
  lie_at("bottom", 1, 0.0);
  lie_at("top", 1, 0.1);
  lie_at("top_platen_face", 1, 0.1);
  lie_at("top_platen_support", 1, 0.11);
  lie_at("left", 0, 0.0);
  lie_at("right", 0, 0.05);
  for (int b = 0; b < body.block_count(); ++b)
    for (int g = body.block_gridpoints[b]; g < body.block_gridpoints[b + 1]; ++g) {
      const auto is_in = [&](const char* set) { return std::ranges::count(body.set(set), g) == 1; };
      const bool platen = body.is_of_bearing(b);
      EXPECT_EQ(is_in("specimen"), !platen);
      EXPECT_EQ(is_in("top_platen"), platen && body.position[g][1] > 0.05);
      EXPECT_EQ(is_in("bottom_platen"), platen && body.position[g][1] < 0.05);
    }
  EXPECT_THROW(body.set("buttom"), Error);
}

TEST(Model, AFaceInSpaceHasItsFirstTangentAlongItsFirstEdgeAndAThirdOfItsTrianglesAtEachCorner) {
  const std::vector<Vec<3>> rectangle{{{0, 0, 0}}, {{2, 0, 0}}, {{2, 1, 0}}, {{0, 1, 0}}};
  ModelOf<3> model;
  model.add_block(rectangle, {}, 0);
  model.add_block(rectangle, {}, 0);
  model.join_faces({0, 1, 2, 3}, {4, 5, 6, 7}, 0);
  ASSERT_EQ(model.contact_count(), 4);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(model.contacts[i].normal, (Vec<3>{{0, 0, 1}}));
    EXPECT_EQ(model.contacts[i].tangents[0], (Vec<3>{{1, 0, 0}}));
    EXPECT_EQ(model.contacts[i].tangents[1], (Vec<3>{{0, 1, 0}}));
    EXPECT_NEAR(model.contacts[i].area, i % 2 == 0 ? 2.0 / 3.0 : 1.0 / 3.0, 1e-15);  // two triangles or one
  }
}

TEST(Model, RefusesAZoneWithoutVolume) {
  ModelOf<2> model;
  model.add_block({{{0, 0}}, {{1, 0}}, {{2, 0}}}, {{0, 1, 2}}, 0);
  EXPECT_THROW(zone_geometry(model), Error);
}

/// Heights of the rows of zones of the lower platen, from its seat.
std::vector<double> row_heights(double thickness) {
  const auto body = between_platens(small_specimen(), thickness, 1.0);
  std::set<double> places;
  for (int g : body.set("bottom_platen")) places.insert(body.position[g][1]);
  std::vector<double> heights;
  for (auto place = places.rbegin(); std::next(place) != places.rend(); ++place)
    heights.push_back(*place - *std::next(place));
  return heights;
}

// A row is twice as high as the one nearer to the seat, so that rows go with the logarithm of a bearing's
// zones. A column of the seat of 300 blocks is some 4 mm wide, and the first row at most twice as high.
TEST(ConcreteModel, RowsOfABearingDoubleAwayFromItsSeat) {
  for (const auto& [thickness, rows] :
       {std::pair<double, std::size_t>{0.01, 2}, {0.04, 3}, {0.1, 4}, {0.2, 5}, {0.4, 6}}) {
    const auto heights = row_heights(thickness);
    ASSERT_EQ(heights.size(), rows) << thickness;
    for (std::size_t i = 1; i < rows; ++i) EXPECT_NEAR(heights[i], 2.0 * heights[i - 1], 1e-12);
    EXPECT_NEAR(heights.front() * (std::exp2(rows) - 1.0), thickness, 1e-12);
  }
}

/// A disc on a strip.
TEST(ConcreteModel, BearingsCoverTheirSeatsAndNoMore) {
  specimen::SpecimenParameters p;
  const double half = std::asin(0.1), radius = 0.05;
  const auto corners = specimen::circle_corners(
      {}, 2.0 * radius, 0.004, {1.5 * std::numbers::pi - half, 1.5 * std::numbers::pi + half});
  const auto second = std::ranges::find_if(corners, [&](const Vec<2>& c) {
    return std::abs(std::atan2(c[1], c[0]) - (half - 0.5 * std::numbers::pi)) < 1e-9;
  });
  p.outline = specimen::Region::polygon(corners, {"rim"}, true)
                  .with_patches(std::array{specimen::Patch{"strip_seat", corners[0], *second}});
  p.seed = 1;
  p.blocks.count = 400;
  p.blocks.shortest_edge = 0.2;
  const auto specimen = specimen::make_specimen(p);
  const ModelOf<2> body =
      make_model(specimen, 0.5, {}, {{"strip", "strip_seat", 0.006, "steel", "glue", true}});
  double seat = 0.0;
  for (const auto& c : body.contacts) {
    if (!body.is_of_bearing(c)) continue;
    EXPECT_EQ(body.position[c.a], body.position[c.b]);
    EXPECT_EQ(body.interface_names[c.interface], "glue");
    EXPECT_LT(body.position[c.a][1], -0.049);
    seat += c.area;
  }
  double chords = 0.0;
  for (const auto& piece : p.region()->pieces())
    if (p.region()->sides()[piece.side].name == "strip_seat") chords += norm(piece.to - piece.from);
  EXPECT_NEAR(seat, 0.5 * chords, 1e-9);
  EXPECT_NEAR(chords, 2.0 * radius * half, 2e-3 * chords);
  const Vec<2> pivot = body.position[body.set("strip_pivot").front()];
  EXPECT_NEAR(pivot[0], 0.0, 1e-12);
  for (int g : body.set("strip_support")) EXPECT_NEAR(body.position[g][1], pivot[1], 1e-12);
  EXPECT_NO_THROW(zone_geometry(body));
}

}  // namespace
}  // namespace pyroclast
