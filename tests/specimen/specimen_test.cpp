#include "pyroclast/specimen/specimen.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "examples.hpp"
#include "pyroclast/specimen/polygon.hpp"

namespace pyroclast::specimen {
namespace {

TEST(Specimen, MeetsThePapersRequest) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const SpecimenParameters p = paper_specimen(seed);
    const Specimen<2> s = make_specimen(p);
    // Gradation is off by at most half the smallest aggregate.
    const double smallest = 0.25 * std::numbers::pi * p.aggregates.d_min * p.aggregates.d_min / p.extent();
    EXPECT_NEAR(s.fraction_placed, 0.34, 0.5 * smallest * (1 + 1e-9));
    // The paper loses 0.03 by superposition; a rule that loses or gains more is another specimen.
    EXPECT_NEAR(s.fraction_superposed, s.fraction_placed, 0.03);
    EXPECT_EQ(s.cells.cells.size(), 5000U);
    EXPECT_EQ(s.phase.size(), 5000U);
    EXPECT_GE(s.metrics.shortest_edge, 0.2 * s.metrics.mean_edge * (1 - 1e-12));
    EXPECT_EQ(s.metrics.edges_left_short, 0);
    EXPECT_NEAR(s.metrics.mean_size, 3e-3, 1e-12);   // sqrt(150 mm x 300 mm / 5000)
    EXPECT_NEAR(s.metrics.zones_per_block, 5, 0.5);  // "approximately five"
  }
}

// Promise: size classes add up to the whole request, and tell the stones that no block is left for.
TEST(Specimen, CountsWhatBecameOfEachSize) {
  SpecimenParameters p = paper_specimen(1);
  p.blocks.count = 1000;
  const Specimen<2> s = make_specimen(p);
  ASSERT_EQ(s.classes.size(), p.aggregates.sieves.size() - 1);
  double asked = 0.0, placed = 0.0, superposed = 0.0;
  std::size_t stones = 0;
  for (const SizeClass& c : s.classes) {
    asked += c.asked;
    placed += c.placed;
    superposed += c.superposed;
    stones += static_cast<std::size_t>(c.stones);
  }
  EXPECT_NEAR(asked, 0.34, 1e-12);
  EXPECT_NEAR(placed, s.fraction_placed, 1e-12);
  EXPECT_NEAR(superposed, s.fraction_superposed, 1e-12);
  EXPECT_EQ(stones, s.stones.size());
  EXPECT_GT(s.classes.front().without_a_block, 0);
  EXPECT_EQ(s.classes.back().without_a_block, 0);
}

TEST(Specimen, TheSameSeedGivesTheSameSpecimen) {
  const Specimen<2> a = make_specimen(paper_specimen(11));
  const Specimen<2> b = make_specimen(paper_specimen(11));
  const Specimen<2> other = make_specimen(paper_specimen(12));
  EXPECT_EQ(a.cells.vertices, b.cells.vertices);
  EXPECT_EQ(a.cells.cells, b.cells.cells);
  EXPECT_EQ(a.phase, b.phase);
  EXPECT_NE(a.cells.vertices, other.cells.vertices);
}

TEST(Specimen, AggregatesDoNotDependOnTheBlocks) {
  SpecimenParameters p = paper_specimen(1);
  const Specimen<2> fine = make_specimen(p);
  p.blocks.count = 1000;
  const Specimen<2> coarse = make_specimen(p);
  ASSERT_EQ(fine.stones.size(), coarse.stones.size());
  for (std::size_t i = 0; i < fine.stones.size(); ++i) {
    EXPECT_EQ(fine.stones[i].centre, coarse.stones[i].centre);
  }
}

TEST(Specimen, WithoutAggregatesIsAllMortar) {
  SpecimenParameters p = paper_specimen(1);
  p.aggregates = {};
  const Specimen<2> s = make_specimen(p);
  EXPECT_TRUE(s.stones.empty());
  EXPECT_EQ(s.fraction_superposed, 0);
}

TEST(Specimen, RefusesAFractionThatTheGradationCannotMeet) {
  SpecimenParameters p = paper_specimen(1);
  p.outline = Region::rectangle(10e-3, 10e-3);  // 0.34 of it is less than two of the smallest
  p.blocks.count = 10;
  EXPECT_TRUE(says(message([&] { make_specimen(p); }), "too large for the specimen"));
}

TEST(Specimen, NamesAParameterOutOfRangeAndItsValue) {
  const auto refusal = [](const std::function<void(SpecimenParameters&)>& spoil) {
    SpecimenParameters p = paper_specimen(1);
    spoil(p);
    return message([&] { make_specimen(p); });
  };
  EXPECT_TRUE(says(refusal([](auto& p) { p.outline = {}; }), "area of the specimen is 0"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.fraction = 1; }), "aggregate fraction is 1"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.d_min = 0; }), "smallest aggregate diameter is 0"));
  EXPECT_TRUE(
      says(refusal([](auto& p) { p.aggregates.d_max = 1e-3; }), "largest aggregate diameter is 0.001"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.fuller_exponent = 0; }), "Fuller exponent is 0"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.sieves.pop_back(); }), "sieves are"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.minimum_gap = -1; }), "minimum gap"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.aggregates.attempts = 0; }), "attempts"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.blocks.count = 0; }), "number of blocks is 0"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.blocks.radius_spread = 1; }), "radius spread is 1"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.blocks.relaxation = -1; }), "relaxation"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.blocks.shortest_edge = 0.9; }), "shortest edge is 0.9"));
  EXPECT_TRUE(says(refusal([](auto& p) { p.covered_fraction = 1; }), "covered fraction is 1"));
}

// Promise: coarse blocks change the area of the aggregates, which is told; the rule that fits keeps it.
TEST(Specimen, TellsWhenSuperpositionLosesAggregate) {
  SpecimenParameters p = paper_specimen(1);
  p.blocks.count = 500;
  p.superposition = Superposition::area;
  p.covered_fraction = 0.55;
  const Specimen<2> coarse = make_specimen(p);
  EXPECT_LT(coarse.fraction_superposed, 0.9 * coarse.fraction_placed);
  ASSERT_EQ(warnings(coarse).size(), 1U);
  EXPECT_TRUE(says(warnings(coarse).front(), "rule = \"fit\""));
  p.superposition = Superposition::fit;
  const Specimen<2> fitted = make_specimen(p);
  EXPECT_NEAR(fitted.fraction_superposed, fitted.fraction_placed,
              0.5 * 1.0 / 500 * 3);  // half of a large block
  EXPECT_TRUE(warnings(fitted).empty());
  EXPECT_LT(fitted.covered_fraction, 0.55);
}

// Promise: what can never fit is refused before it is tried, with the place in the deck.
TEST(Specimen, RefusesAtOnceWhatCannotFit) {
  SpecimenParameters p = paper_specimen(1);
  p.aggregates.d_min = p.aggregates.sieves.front() = 0.1e-3;
  p.aggregates.minimum_gap = 2e-3;  // with it the small ones take more than there is
  p.aggregates.place = "mine.toml:12: aggregates";
  p.aggregates.attempts = 1'000'000'000;  // trying would take hours
  const std::string error = message([&] { make_specimen(p); });
  EXPECT_TRUE(says(error, "cannot fit")) << error;
}

TEST(ZoneBlock, FansOutAroundTheCentroid) {
  const std::vector<Vec<2>> cell{{{0, 0}}, {{2, 0}}, {{3, 1}}, {{2, 3}}, {{0, 2}}};
  const ZonedCell<2> block = zone_block(cell);
  ASSERT_EQ(block.gridpoints.size(), 6U);
  ASSERT_EQ(block.zones.size(), 5U);
  EXPECT_EQ(block.gridpoints.back(), centroid(cell));
  double sum = 0;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    EXPECT_EQ(block.gridpoints[i], cell[i]);
    const auto at = [&](int k) {
      return block.gridpoints[static_cast<std::size_t>(block.zones[i][static_cast<std::size_t>(k)])];
    };
    const double zone = 0.5 * cross(at(1) - at(0), at(2) - at(0));
    EXPECT_GT(zone, 0);
    sum += zone;
  }
  EXPECT_NEAR(sum, area(cell), 1e-14);
}

}  // namespace
}  // namespace pyroclast::specimen
