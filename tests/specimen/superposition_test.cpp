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
const Cells<2> quarters{
    {{{0, 0}}, {{0.5, 0}}, {{1, 0}}, {{0, 0.5}}, {{0.5, 0.5}}, {{1, 0.5}}, {{0, 1}}, {{0.5, 1}}, {{1, 1}}},
    {{0, 1, 4, 3}, {1, 2, 5, 4}, {3, 4, 7, 6}, {4, 5, 8, 7}}};

SpecimenParameters unit_square(Superposition rule, double covered_fraction = 0.5) {
  SpecimenParameters p;
  p.outline = Region::rectangle(1, 1);
  p.superposition = rule;
  p.covered_fraction = covered_fraction;
  return p;
}

constexpr int kMatrix = 2;

std::vector<Cover> covers_of(const std::vector<Stone<2>>& circles) {
  return covers_of<2>(quarters, common_parts<2>(quarters, Region::rectangle(1, 1), circles), circles);
}

Superposed superposed(const std::vector<Stone<2>>& circles, const SpecimenParameters& p) {
  return superpose<2>(quarters, *p.region(), circles, p, kMatrix);
}

TEST(Superposition, CoveredFractionIsTheShareOfACircleInEachCell) {
  const std::vector<Stone<2>> circle{{{{0.5, 0.5}}, 0.5}};
  for (const Cover& cover : covers_of(circle)) EXPECT_NEAR(cover.share, std::numbers::pi / 16, 1e-14);
}

TEST(Superposition, SeveralCirclesAddUpInACell) {
  const std::vector<Stone<2>> circles{{{{0.1, 0.1}}, 0.1}, {{{0.3, 0.3}}, 0.2}};
  const std::vector<Cover> covers = covers_of(circles);
  EXPECT_NEAR(covers[0].share, std::numbers::pi * (0.05 * 0.05 + 0.1 * 0.1) / 0.25, 1e-14);
  EXPECT_EQ(covers[3].share, 0);
}

TEST(Superposition, AreaRuleTurnsACellAtTheStatedFraction) {
  const std::vector<Stone<2>> circle{{{{0.25, 0.25}}, 0.4}};  // covers 0.50 of cell 0
  const double covered = covers_of(circle)[0].share;
  EXPECT_EQ(superposed(circle, unit_square(Superposition::area, covered - 1e-9)).phase[0], 0);
  EXPECT_EQ(superposed(circle, unit_square(Superposition::area, covered + 1e-9)).phase[0], kMatrix);
}

// Promise: the rule that fits takes the most covered cells, as many as bring their area nearest to that of
// the circles.
TEST(Superposition, TheFittingFractionKeepsTheArea) {
  const std::vector<Stone<2>> circles{{{{0.25, 0.25}}, 0.5}, {{{0.75, 0.3}}, 0.3}, {{{0.6, 0.75}}, 0.1}};
  const std::vector<Cover> covers = covers_of(circles);                // 0.79, 0.28, 0.02, 0.01
  const double area = 0.25 * std::numbers::pi * (0.25 + 0.09 + 0.01);  // 0.275: one cell of 0.25
  ASSERT_NEAR(area, 0.275, 1e-3);
  const Superposed fitted = superposed(circles, unit_square(Superposition::fit, 0.99));
  const double bound = fitted.covered_fraction;  // what is stated is not asked
  EXPECT_LT(bound, covers[0].share);
  EXPECT_GT(bound, std::ranges::max(std::span(covers).subspan(1), {}, &Cover::share).share);
  EXPECT_EQ(fitted.phase, (std::vector<int>{0, kMatrix, kMatrix, kMatrix}));
  const std::vector<Stone<2>> small{{{{0.25, 0.25}}, 0.1}};
  EXPECT_EQ(superposed(small, unit_square(Superposition::fit)).covered_fraction,
            std::nextafter(1.0, 0.0));  // nothing fits better than no cell
}

// Promise: by the rule `each` every circle has a cell before the most covered ones follow, as in space.
TEST(Superposition, EachCircleHasItsCell) {
  const std::vector<Stone<2>> circles{{{{0.9, 0.9}}, 0.1}, {{{0.3, 0.25}}, 0.8}};  // 0.51: two cells of 0.25
  EXPECT_EQ(superposed(circles, unit_square(Superposition::fit)).stone, (std::vector<int>{1, 1, -1, -1}));
  EXPECT_EQ(superposed(circles, unit_square(Superposition::each)).stone, (std::vector<int>{1, -1, -1, 0}));
}

TEST(Superposition, CentroidRuleLooksAtTheCentroidOnly) {
  const std::vector<Stone<2>> small{{{{0.25, 0.25}}, 0.02}};
  const std::vector<Stone<2>> beside{{{{0.6, 0.6}}, 0.2}};
  EXPECT_EQ(superposed(small, unit_square(Superposition::centroid)).phase[0], 0);
  EXPECT_EQ(superposed(beside, unit_square(Superposition::centroid)).phase[3], kMatrix);
}

TEST(Superposition, WithoutAggregatesAllIsMortar) {
  for (const int phase : superposed({}, unit_square(Superposition::area, 0.0)).phase)
    EXPECT_EQ(phase, kMatrix);
}

TEST(Superposition, ACellIsOfThePhaseThatCoversMostOfIt) {
  const std::vector<Stone<2>> circles{{{{0.15, 0.15}}, 0.2, 0}, {{{0.3, 0.35}}, 0.26, 1}};
  const double covered = covers_of(circles)[0].share;
  EXPECT_EQ(superposed(circles, unit_square(Superposition::area, covered - 1e-9)).phase[0], 1);
  EXPECT_EQ(superposed(circles, unit_square(Superposition::area, covered + 1e-9)).phase[0], kMatrix);
}

TEST(Superposition, AFibreTakesTheCellsThatItRunsThrough) {
  std::vector<int> phase(4, kMatrix), stone(4, 7);
  const std::vector<Fibre<2>> fibre{{{{0.1, 0.1}}, {{0.9, 0.2}}, 0}};
  superpose<2>(quarters, fibre, phase, stone);
  EXPECT_EQ(std::ranges::count(phase, 0), 2);
  EXPECT_EQ(phase[0], 0);
  EXPECT_EQ(phase[3], kMatrix);
  EXPECT_EQ(stone, (std::vector<int>{-1, -1, 7, 7})) << "a fibre is no stone";
  const std::vector<Fibre<2>> along_an_edge{{{{0.1, 0.5}}, {{0.4, 0.5}}, 1}};  // runs through none
  superpose<2>(quarters, along_an_edge, phase, stone);
  EXPECT_EQ(std::ranges::count(phase, 1), 0);
}

TEST(Superposition, CellsShareOutTheCirclesExactly) {
  const Specimen<2> s = make_specimen(paper_specimen(2));
  const std::vector<Cover> covers =
      covers_of<2>(s.cells, common_parts<2>(s.cells, s.outline, s.stones), s.stones);
  double sum = 0;
  std::vector<Vec<2>> polygon;
  for (std::size_t c = 0; c < covers.size(); ++c) {
    corners(s.cells, c, polygon);
    sum += covers[c].share * area(polygon);
  }
  double circles = 0;
  for (const Stone<2>& a : s.stones) circles += 0.25 * std::numbers::pi * a.diameter * a.diameter;
  EXPECT_NEAR(sum / circles, 1, 1e-11);  // rounding of 5000 cells, each relative to its own small area
}

}  // namespace
}  // namespace pyroclast::specimen
