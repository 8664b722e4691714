#include "pyroclast/specimen/superposition.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "examples.hpp"
#include "pyroclast/specimen/polygon.hpp"
#include "pyroclast/specimen/topology.hpp"

namespace pyroclast::specimen {
namespace {

/// The unit square in four quarters, lower row first.
const Tessellation quarters{
    {{{0, 0}}, {{0.5, 0}}, {{1, 0}}, {{0, 0.5}}, {{0.5, 0.5}}, {{1, 0.5}}, {{0, 1}}, {{0.5, 1}}, {{1, 1}}},
    {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}};

SpecimenParameters unit_square(Superposition rule, double covered_fraction = 0.5) {
  SpecimenParameters p;
  p.region = Region::rectangle(1, 1);
  p.superposition = rule;
  p.covered_fraction = covered_fraction;
  return p;
}

constexpr int kMatrix = 2;

std::vector<Cover> covers_of(const std::vector<Aggregate>& circles) {
  return covers_of(quarters, Region::rectangle(1, 1).box(), circles);
}

TEST(Superposition, CoveredFractionIsTheShareOfACircleInEachCell) {
  const std::vector<Aggregate> circle{{{{0.5, 0.5}}, 0.5}};
  for (const Cover& cover : covers_of(circle)) EXPECT_NEAR(cover.share, std::numbers::pi / 16, 1e-14);
}

TEST(Superposition, SeveralCirclesAddUpInACell) {
  const std::vector<Aggregate> circles{{{{0.1, 0.1}}, 0.1}, {{{0.3, 0.3}}, 0.2}};
  const std::vector<Cover> covers = covers_of(circles);
  EXPECT_NEAR(covers[0].share, std::numbers::pi * (0.05 * 0.05 + 0.1 * 0.1) / 0.25, 1e-14);
  EXPECT_EQ(covers[3].share, 0);
}

TEST(Superposition, AreaRuleTurnsACellAtTheStatedFraction) {
  const std::vector<Aggregate> circle{{{{0.25, 0.25}}, 0.4}};  // covers 0.50 of cell 0
  const double covered = covers_of(circle)[0].share;
  EXPECT_EQ(superpose(quarters, circle, unit_square(Superposition::area, covered - 1e-9), kMatrix).phase[0],
            0);
  EXPECT_EQ(superpose(quarters, circle, unit_square(Superposition::area, covered + 1e-9), kMatrix).phase[0],
            kMatrix);
}

// Promise: the rule that fits takes the most covered cells, as many as bring their area nearest to that of
// the circles.
TEST(Superposition, TheFittingFractionKeepsTheArea) {
  const std::vector<Aggregate> circles{{{{0.25, 0.25}}, 0.5}, {{{0.75, 0.3}}, 0.3}, {{{0.6, 0.75}}, 0.1}};
  const std::vector<Cover> covers = covers_of(circles);                // 0.79, 0.28, 0.02, 0.01
  const double area = 0.25 * std::numbers::pi * (0.25 + 0.09 + 0.01);  // 0.275: one cell of 0.25
  ASSERT_NEAR(area, 0.275, 1e-3);
  const double bound = fitting_fraction(quarters, covers, circles);
  EXPECT_LT(bound, covers[0].share);
  EXPECT_GT(bound, std::ranges::max(std::span(covers).subspan(1), {}, &Cover::share).share);
  const Superposed fitted = superpose(quarters, circles, unit_square(Superposition::fit, 0.99),
                                      kMatrix);  // what is stated is not asked
  EXPECT_EQ(fitted.covered_fraction, bound);
  EXPECT_EQ(fitted.phase, (std::vector<int>{0, kMatrix, kMatrix, kMatrix}));
  const std::vector<Aggregate> small{{{{0.25, 0.25}}, 0.1}};
  EXPECT_EQ(fitting_fraction(quarters, covers_of(small), small),
            std::nextafter(1.0, 0.0));  // nothing fits better than no cell
}

TEST(Superposition, CentroidRuleLooksAtTheCentroidOnly) {
  const std::vector<Aggregate> small{{{{0.25, 0.25}}, 0.02}};
  const std::vector<Aggregate> beside{{{{0.6, 0.6}}, 0.2}};
  EXPECT_EQ(superpose(quarters, small, unit_square(Superposition::centroid), kMatrix).phase[0], 0);
  EXPECT_EQ(superpose(quarters, beside, unit_square(Superposition::centroid), kMatrix).phase[3], kMatrix);
}

TEST(Superposition, WithoutAggregatesAllIsMortar) {
  for (const int phase : superpose(quarters, {}, unit_square(Superposition::area, 0.0), kMatrix).phase)
    EXPECT_EQ(phase, kMatrix);
}

TEST(Superposition, ACellIsOfThePhaseThatCoversMostOfIt) {
  const std::vector<Aggregate> circles{{{{0.15, 0.15}}, 0.2, 0}, {{{0.3, 0.35}}, 0.26, 1}};
  const double covered = covers_of(circles)[0].share;
  EXPECT_EQ(superpose(quarters, circles, unit_square(Superposition::area, covered - 1e-9), kMatrix).phase[0],
            1);
  EXPECT_EQ(superpose(quarters, circles, unit_square(Superposition::area, covered + 1e-9), kMatrix).phase[0],
            kMatrix);
}

TEST(Superposition, AFibreTakesTheCellsThatItRunsThrough) {
  std::vector<int> phase(4, kMatrix), grain(4, 7);
  const std::vector<Fibre> fibre{{{{0.1, 0.1}}, {{0.9, 0.2}}, 0}};
  superpose(quarters, fibre, phase, grain);
  EXPECT_EQ(std::ranges::count(phase, 0), 2);
  EXPECT_EQ(phase[0], 0);
  EXPECT_EQ(phase[3], kMatrix);
  EXPECT_EQ(grain, (std::vector<int>{-1, -1, 7, 7})) << "a fibre is no stone";
  const std::vector<Fibre> along_an_edge{{{{0.1, 0.5}}, {{0.4, 0.5}}, 1}};  // runs through none
  superpose(quarters, along_an_edge, phase, grain);
  EXPECT_EQ(std::ranges::count(phase, 1), 0);
}

TEST(Superposition, CellsShareOutTheCirclesExactly) {
  const Specimen s = make_specimen(paper_specimen(2));
  const std::vector<Cover> covers = covers_of(s.tessellation, s.region.box(), s.aggregates);
  double sum = 0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < covers.size(); ++c) {
    corners(s.tessellation, c, polygon);
    sum += covers[c].share * area(polygon);
  }
  double circles = 0;
  for (const Aggregate& a : s.aggregates) circles += 0.25 * std::numbers::pi * a.diameter * a.diameter;
  EXPECT_NEAR(sum / circles, 1, 1e-11);  // rounding of 5000 cells, each relative to its own small area
}

}  // namespace
}  // namespace pyroclast::specimen
