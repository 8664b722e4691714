#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "messages.hpp"
#include "pyroclast/base/sort_unique.hpp"
#include "pyroclast/model/concrete_model.hpp"
#include "pyroclast/model/sets.hpp"
#include "pyroclast/specimen/specimen.hpp"
#include "pyroclast/specimen/stone.hpp"
#include "solid_bodies.hpp"

namespace pyroclast::specimen {
namespace {

SpecimenParameters concrete(int blocks, std::uint64_t seed = 1) {
  SpecimenParameters p;
  p.seed = seed;
  p.aggregates = {.phase = "aggregate",
                  .fraction = 0.25,
                  .d_min = 0.012,
                  .d_max = 0.032,
                  .fuller_exponent = 0.5,
                  .sieves = {0.012, 0.016, 0.02, 0.032},
                  .minimum_gap = 0.0005,
                  .attempts = 100000};
  p.blocks.count = blocks;
  p.superposition = Superposition::each;
  return p;
}

// Promise: aggregates have the fraction and the grading that are asked for, by volume, and lie apart within
// the body; blocks take their volume.
TEST(SpecimenInSpace, HasItsAggregatesByVolume) {
  const Prism body = cylinder(0.1, 0.2);
  const Specimen<3> s = made_in(concrete(3000), body);
  EXPECT_NEAR(s.fraction_placed, 0.25, 0.001);
  EXPECT_NEAR(s.fraction_superposed, s.fraction_placed, 1.0 / 3000);
  ASSERT_EQ(s.classes.size(), 3U);
  double asked = 0.0, superposed = 0.0;
  int stones = 0;
  for (const SizeClass& c : s.classes) {
    // a class takes what the larger ones left: less than its smallest stone
    EXPECT_NEAR(c.placed, c.asked, extent_of_round<3>(c.to) / body.extent());
    EXPECT_NEAR(c.superposed, c.placed, 0.25 * c.placed);
    EXPECT_EQ(c.without_a_block, 0);
    asked += c.asked;
    superposed += c.superposed;
    stones += c.stones;
  }
  EXPECT_NEAR(asked, 0.25, 1e-12);
  EXPECT_NEAR(superposed, s.fraction_superposed, 1e-12);
  EXPECT_EQ(stones, static_cast<int>(s.stones.size()));
  for (std::size_t i = 0; i < s.stones.size(); ++i) {
    EXPECT_LE(body.distance(s.stones[i].centre), -0.5 * s.stones[i].diameter - 0.0005);
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GE(norm(s.stones[i].centre - s.stones[j].centre),
                0.5 * (s.stones[i].diameter + s.stones[j].diameter) + 0.0005);
  }
}

TEST(SpecimenInSpace, BlocksLeaveTheAggregatesWhereTheyAreAndSeedsMoveAll) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const auto centres = [](const Specimen<3>& s) {
    std::vector<Vec<3>> all;
    for (const Stone<3>& ball : s.stones) all.push_back(ball.centre);
    return all;
  };
  const Specimen<3> one = made_in(concrete(300), body), same = made_in(concrete(300), body);
  EXPECT_TRUE(one.cells.vertices == same.cells.vertices);
  EXPECT_EQ(one.phase, same.phase);
  EXPECT_TRUE(centres(made_in(concrete(500), body)) == centres(one));
  EXPECT_FALSE(centres(made_in(concrete(300, 2), body)) == centres(one));
}

// Promise: by the rule of fit each stone has a block, also where blocks are as large as stones.
TEST(SpecimenInSpace, EachStoneHasABlockAndCoarseBlocksAreTold) {
  const Prism body = cuboid(0.1, 0.1, 0.1);
  auto p = concrete(500);  // blocks of 12.6 mm
  const Specimen<3> fit = made_in(p, body);
  for (const SizeClass& c : fit.classes) EXPECT_EQ(c.without_a_block, 0);
  const auto told = warnings(fit);
  ASSERT_EQ(told.size(), 1U);
  expect_in("smaller than 3 blocks of 12.6 mm", told[0]);
  p.superposition = Superposition::area;
  p.covered_fraction = 0.7;
  const Specimen<3> by_area = made_in(p, body);
  int without = 0;
  for (const SizeClass& c : by_area.classes) without += c.without_a_block;
  EXPECT_GT(without, 0);
  expect_in("have no block of their own", warnings(by_area).back());
}

// Promise: fibres of a solid keep off stones and the surface, look all ways, and are the blocks that they
// cross.
TEST(SpecimenInSpace, FibresTakeTheBlocksThatTheyCross) {
  auto p = concrete(2000);
  constexpr double kLength = 0.03, kGap = 1e-3;
  p.inclusions = {FibreParameters{
      .phase = "steel", .count = 60, .length = kLength, .minimum_gap = kGap, .attempts = 100'000}};
  const Prism body = cuboid(0.1, 0.1, 0.1);
  const Specimen<3> s = made_in(p, body);
  ASSERT_EQ(s.fibres.size(), 60U);
  const int steel = s.fibres.front().phase;
  EXPECT_EQ(s.phases[steel], "steel");
  std::array<double, 3> squares{};
  for (const Fibre<3>& fibre : s.fibres) {
    const Vec<3> along = fibre.to - fibre.from;
    EXPECT_NEAR(norm(along), kLength, 1e-12);
    for (int d = 0; d < 3; ++d) squares[d] += along[d] * along[d] / (kLength * kLength * 60.0);
    for (const Vec<3>& end : {fibre.from, fibre.to}) EXPECT_LE(body.distance(end), -kGap);
    for (const Stone<3>& stone : s.stones)
      EXPECT_GT(distance_from_segment(stone.centre, fibre.from, fibre.to),
                0.5 * stone.diameter + kGap - 1e-3 * stone.diameter);
  }
  for (const double square : squares) EXPECT_NEAR(square, 1.0 / 3.0, 0.12);
  // a block that holds a place of a fibre is steel, and a block far from all fibres is not
  const double size = s.metrics.mean_size;
  for (std::size_t cell = 0; cell < s.cells.cells.size(); ++cell) {
    double nearest = 1.0;
    for (const Fibre<3>& fibre : s.fibres)
      nearest = std::min(nearest, distance_from_segment(centroid(s.cells, cell), fibre.from, fibre.to));
    if (nearest < 0.15 * size) {
      EXPECT_EQ(s.phase[cell], steel) << cell;
    } else if (nearest > 1.5 * size) {
      EXPECT_NE(s.phase[cell], steel) << cell;
    }
  }
}

std::vector<Bearing> two_platens() {
  return platens(0.02);
}

// Promise: platens lie on the whole of both ends, with contacts of the ends' area, and fill their thickness.
TEST(SolidModel, HasPlatensOnTheWholeOfItsEnds) {
  for (const Prism& body : {cylinder(0.1, 0.2), cuboid(0.1, 0.2, 0.08)}) {
    const Specimen<3> s = made_in(concrete(400), body);
    const ModelOf<3> model = make_model(s, 1.0, {}, two_platens());
    const double end = body.section().is_rectangle() ? 0.1 * 0.08 : body.section().extent();
    const auto volumes = model.zone_volumes();
    double filled = 0.0, of_platens = 0.0;
    for (int b = 0; b < model.block_count(); ++b)
      for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
        (model.is_of_bearing(b) ? of_platens : filled) += volumes[z];
    EXPECT_NEAR(filled, body.extent(), 1e-12 * filled);
    EXPECT_NEAR(of_platens, 2 * 0.02 * end, 1e-12);
    for (const char* const platen : {"bottom_platen", "top_platen"}) {
      double area = 0.0;
      for (const int c : model.contact_sets.at(platen)) area += model.joint(c).area;
      EXPECT_NEAR(area, end, 1e-9 * end) << platen;
    }
    for (const int g : model.set("top_platen_support")) EXPECT_NEAR(model.position[g][1], 0.22, 1e-15);
    for (const int g : model.set("bottom_platen_support")) EXPECT_NEAR(model.position[g][1], -0.02, 1e-15);
    for (const int g : model.set("top")) EXPECT_EQ(model.position[g][1], 0.2);
    // each gridpoint of the outline lies on a side
    std::size_t on_sides = 0;
    for (const Side& side : body.sides()) on_sides += model.set(side.name).size();
    EXPECT_GE(on_sides, model.set("outline").size());
    for (const int g : model.set("outline")) EXPECT_NEAR(body.distance(model.position[g]), 0.0, 1e-12);
    if (!body.section().is_rectangle()) {
      std::vector<int> of_quarters;
      double area = 0.0, rim = 0.0;
      for (const Face& face : faces_in(model, model.set("rim"))) rim += face.area;
      for (const char* const quarter : {"rim_left", "rim_right", "rim_front", "rim_back"}) {
        const auto& its = model.set(quarter);
        of_quarters.insert(of_quarters.end(), its.begin(), its.end());
        for (const Face& face : faces_in(model, its)) area += face.area;
      }
      sort_unique(of_quarters);
      EXPECT_EQ(of_quarters, model.set("rim"));
      EXPECT_NEAR(area, rim, 1e-12 * rim);
    }
  }
}

}  // namespace
}  // namespace pyroclast::specimen
